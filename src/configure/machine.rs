//! The machine, its rating, and the constants derived from them.

use super::GainSource;
use crate::design::{
    Actuator, BacklashDesign, BacklashTakeUpDesign, BacklashTakeUpTuning, BacklashTuning, Disturbance, Encoder,
    InputShaperDesign, LoadStep, Rate, RigidDesign, Robustness, SpeedLoopDesign, SpeedLoopTuning, Supervision,
    Tolerance, TwoMassDesign,
};
use crate::learning::LearningBounds;
use crate::machine::{Chain, Match, Speed, Torque, TwoMass};
use crate::settings::{Bases, Cycle, Gear, LoadGear, Screening, SequencerSettings};

/// Rating of the motor: a rated torque, a rated speed and the torque limit, each above zero, the limit at least the
/// rated torque. A drive whose machine breaks one of these rules is a compile error that names the field.
///
/// ```
/// use driveline::configure::Rating;
/// use driveline::machine::{Speed, Torque};
/// const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed::rpm(1480.0), torque_limit: Torque(550.0) };
/// // 2 kg m2 at the motor to 155 rad/s by 300 N m
/// assert!((RATING.run_up(2.0) - 2.0 * 154.99 / 300.0).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rating {
    /// Rated torque.
    pub torque: Torque,
    /// Rated speed: `Speed(155.0)` in rad/s, `Speed::rpm(1480.0)` in r/min.
    pub speed: Speed,
    /// Largest torque that may be commanded, either way.
    pub torque_limit: Torque,
}

impl Rating {
    /// Peripheral speed of the rotor that few motors exceed (m/s): the machines of the project's firmware have 5 to
    /// 26 m/s. A rated speed in r/min for rad/s is 9.5 times too fast, and found with 18 of 19 of them.
    pub const PERIPHERAL_SPEED: f64 = 60.0;
    /// Run-up that few machines exceed (s): those of the project's firmware take 0.1 to 8 s. Inertias in kg cm2, an
    /// inverted ratio or a torque in kN m make it a hundred times longer and more.
    pub const RUN_UP: f64 = 60.0;
    /// Twist under rated torque that few shafts exceed (rad): 20 degrees. A stiffness per degree makes it 57 times
    /// larger.
    pub const SHAFT_TWIST: f64 = 0.35;

    /// The drive holds its torque to 1 % of rated in a tick, as a current-controlled motor does; the load torque
    /// wanders by half of rated in 10 s, so that the observer follows a step of the rated torque in some tens of
    /// milliseconds.
    #[must_use]
    pub const fn disturbance(&self) -> Disturbance {
        Disturbance { torque_accuracy: 0.01 * self.torque.0, load_torque_step: 0.5 * self.torque.0, within: 10.0 }
    }

    /// A hoist's drive: the load wanders by two fifths of rated in 50 s, and the torque counts as known to 8 %, held for
    /// 0.1 ms. Constant, offset and the machine's own deviations last; over the draws of a campaign this halves the
    /// errors of load speed and load torque.
    #[must_use]
    pub const fn hoisting(&self, rate: Rate) -> Disturbance {
        self.hoist(0.4, 0.08, rate)
    }

    /// The same on a gain schedule, which follows the load: three tenths of it, and a torque known to 3 %. The active
    /// damping needs an observer that follows the twist sooner.
    #[must_use]
    pub const fn hoisting_on_schedule(&self, rate: Rate) -> Disturbance {
        self.hoist(0.12, 0.03, rate)
    }

    const fn hoist(&self, load: f64, torque: f64, rate: Rate) -> Disturbance {
        let rated = self.torque.0;
        Disturbance { load_torque_step: load * rated, within: 50.0, ..self.disturbance() }.torque_over(
            torque * rated,
            1e-4,
            rate,
        )
    }

    /// A gap taken up gently: six tenths of rated torque in it, and three times rated torque within a period of the
    /// shaft, which is as much as its swing allows; twice as fast it falls. An impact may add twice rated torque. The
    /// damping is that of a motor that outweighs its load five times.
    ///
    /// Nothing observes the load's speed through an open gap: braked twice as much, a motor of 1.1 times the inertia
    /// swings through it for ever.
    #[must_use]
    pub const fn taking_up(&self) -> BacklashTakeUpTuning {
        let rated = self.torque.0;
        BacklashTakeUpTuning {
            impact: 2.0 * rated,
            torque: 0.6 * rated,
            rise: 3.0 * rated,
            fall: 6.0 * rated,
            max_torque: self.torque_limit.0,
            damping: 0.02,
        }
    }

    /// Limits of a sample: torque two thirds over its limit, which no healthy drive reaches; setpoint a fifth over
    /// rated speed; innovation 1/128 turn, half of what fixed point holds; two counts of the encoder for an angle that
    /// stands still; and as many ticks without an angle as the motor needs for half a turn at the largest setpoint,
    /// after which the angle is ambiguous.
    ///
    /// # Panics
    /// At compile time in a constant, for an encoder without lines or a rate that is not positive.
    #[must_use]
    pub const fn screening(&self, encoder: Encoder, rate: Rate) -> Screening {
        let setpoint = 1.2 * self.speed.0;
        Screening {
            torque: 1.67 * self.torque_limit.0,
            setpoint,
            innovation: core::f64::consts::TAU / 128.0,
            frozen_turn: 2.0 * count(encoder),
            max_coast: (core::f64::consts::PI / (setpoint * period(rate))) as u32,
        }
    }

    /// Acceleration of the setpoint (rad/s2): rated speed in two seconds. Where that is more, it is the acceleration of
    /// this inertia (kg m2) by half of the torque limit, so that the other half remains for the load.
    #[must_use]
    pub const fn ramp(&self, inertia: f64) -> f64 {
        let (usual, possible) = (self.speed.0 / 2.0, 0.5 * self.torque_limit.0 / inertia);
        if usual < possible { usual } else { possible }
    }

    /// Time (s) from standstill to rated speed by rated torque, with this inertia at the motor (kg m2).
    #[must_use]
    pub const fn run_up(&self, inertia: f64) -> f64 {
        inertia * self.speed.0 / self.torque.0
    }

    /// Whether the rotor of a motor of this inertia (kg m2) has at most this peripheral speed (m/s) at rated speed,
    /// taken as a steel cylinder three radii long.
    #[must_use]
    pub const fn is_within(&self, inertia: f64, peripheral_speed: f64) -> bool {
        // J = 1.5 pi rho r^5
        let radius = inertia / (1.5 * core::f64::consts::PI * 7_850.0);
        !(fifth(self.speed.0) * radius > fifth(peripheral_speed))
    }
}

/// A machine with its motor, its encoder and its tick rate: four constants, and those that follow from them.
///
/// Every default states its derivation. Name a constant to override it; constants derived from it follow. A constant
/// that no part of the drive uses is never evaluated. Most of the 19 machines of the project's firmware, each
/// tuned on a full simulation, keep the defaults of torque accuracy, gear and screening.
///
/// ```
/// use driveline::prelude::*;
/// struct Roll;
/// impl Machine for Roll {
///     const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
///     const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
///     const ENCODER: Encoder = Encoder::lines(2048);
///     const RATE_HZ: u32 = 10_000;
///     const RAMP: f64 = 40.0; // rad/s2: named, and so not that of the rating
/// }
/// // the others follow: the antiresonance of the two masses, sqrt(k/J_l), and 0.4 of it for the speed loop
/// assert!((Roll::TWO_MASS.antiresonance() - (2.0e4_f64 / 0.48).sqrt()).abs() < 1e-9);
/// assert!((Roll::SPEED_LOOP.bandwidth - 0.4 * Roll::TWO_MASS.antiresonance()).abs() < 1e-9);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no machine",
    note = "implement `Machine` for a type of your own, with `CHAIN`, `RATING`, `ENCODER` and `RATE_HZ`, and name it: \
            `RollDrive::configure::<Roll>()`"
)]
pub trait Machine {
    /// The machine, from the motor to the load.
    const CHAIN: Chain;
    /// Rating of the motor: a rated torque, a rated speed and the torque limit, each above zero, the limit at least the
    /// rated torque. A drive whose machine breaks one of these rules is a compile error that names the field.
    const RATING: Rating;
    /// The encoder on the motor's shaft, with its accuracy where its data sheet states one.
    const ENCODER: Encoder;
    /// Ticks a second.
    const RATE_HZ: u32;

    /// The tick rate.
    const RATE: Rate = Rate::hz(Self::RATE_HZ);
    /// Largest plausible peripheral speed of the motor's rotor (m/s): [`Rating::is_within`] with the first inertia of
    /// the chain.
    const PERIPHERAL_SPEED: f64 = Rating::PERIPHERAL_SPEED;
    /// Longest plausible run-up (s): the inertia of the whole chain to rated speed by rated torque. A larger one is a
    /// compile error that asks for the units of inertias, ratios and torque.
    const RUN_UP: f64 = Rating::RUN_UP;
    /// Largest plausible twist of a shaft under rated torque (rad), on its own ends: 20 degrees, as soft couplings
    /// have. A larger one is a compile error that asks for the unit of the stiffness.
    const SHAFT_TWIST: f64 = Rating::SHAFT_TWIST;
    /// Time between two ticks (s).
    const PERIOD: f64 = period(Self::RATE);

    /// Two masses that stand for the chain: those with its first resonance and antiresonance.
    ///
    /// A machine with a gap is rather cut at the gap, by [`Match::TextbookCut`].
    const TWO_MASS: TwoMass = Self::CHAIN.reduce(Match::ResonanceAntiresonance);
    /// Share of the inertia on the load side of the shaft, from the two masses.
    const LOAD_SHARE: f64 = Self::TWO_MASS.load_inertia / (Self::TWO_MASS.motor_inertia + Self::TWO_MASS.load_inertia);

    /// How torque and load torque wander: [`Rating::disturbance`].
    ///
    /// The load's wandering is the tuning of the observer: loads that hardly
    /// change take 100 s instead of 10 s, loads that come at once take 1 s.
    const DISTURBANCE: Disturbance = Self::RATING.disturbance();
    /// The observer of two masses, from machine, rate, encoder and disturbance.
    const OBSERVER: TwoMassDesign = Self::TWO_MASS.observer(Self::RATE, Self::ENCODER, Self::DISTURBANCE);
    /// The observer of one mass, from the whole chain's inertia, rate, encoder and disturbance.
    const RIGID_OBSERVER: RigidDesign = Self::CHAIN.rigid().observer(Self::RATE, Self::ENCODER, Self::DISTURBANCE);
    /// How the observer of backlash searches for the flank.
    const BACKLASH_TUNING: BacklashTuning = BacklashTuning::USUAL;
    /// The observer of backlash, from the two masses with their gap.
    const BACKLASH_OBSERVER: BacklashDesign =
        Self::TWO_MASS.backlash_observer(Self::RATE, Self::ENCODER, Self::DISTURBANCE, Self::BACKLASH_TUNING);
    /// The losses before the shaft as the observer has to know them: their efficiency by [`Chain::losses`], the inertia
    /// on the motor side, and eight counts of the encoder by which the motor can turn while friction holds the gear.
    const GEAR: Gear = Gear {
        efficiency: Self::CHAIN.losses().before[0],
        inertia: Self::TWO_MASS.motor_inertia,
        deadband: 8.0 * count(Self::ENCODER),
    };
    /// The losses behind the shaft as the observer has to know them, by [`Chain::losses`].
    const LOAD_GEAR: LoadGear = LoadGear {
        efficiency: Self::CHAIN.losses().behind[0],
        back_efficiency: Self::CHAIN.losses().behind[1],
        inertia: Self::TWO_MASS.load_inertia,
    };

    /// How far the gear's loss, the motor's inertia and the encoder may be from this, for
    /// [`Learners`](crate::adaptive::Learners): [`LearningBounds::of`] the gear.
    const LEARNING: LearningBounds = LearningBounds::of(Self::GEAR.efficiency);

    /// How brisk the speed loop is: [`SpeedLoopTuning::of`] the two masses, 0.4 of the antiresonance.
    ///
    /// A machine that has more than one resonance within reach takes [`SpeedLoopTuning::with_bandwidth`] 0.1.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning::of(&Self::TWO_MASS);
    /// Delay and lag of the motor's torque: within the tick. The speed loop is tested with it.
    const ACTUATOR: Actuator = Actuator::DIRECT;
    /// How far machine and motor may differ from their description: [`Tolerance::USUAL`].
    ///
    /// A drive whose speed loop is unstable within them is a compile error that names the tolerance.
    const TOLERANCE: Tolerance = Tolerance::USUAL;
    /// Least margins of the speed loop with its observer: 6 dB and 30 degrees. A loop with less is a compile error.
    const ROBUSTNESS: Robustness = Robustness::USUAL;
    /// The speed loop, from the two masses, rate and tuning.
    const SPEED_LOOP: SpeedLoopDesign = Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING);
    /// Acceleration of the setpoint (rad/s2): [`Rating::ramp`] with the inertia of the whole chain.
    const RAMP: f64 = Self::RATING.ramp(Self::CHAIN.total_inertia());
    /// Source of the composed governor's gains: the speed loop.
    const GAINS: GainSource = GainSource::SpeedLoop(Self::SPEED_LOOP);
    /// Fraction of rated speed by which a [`Droop`](crate::governor::Droop) lowers the setpoint at rated torque: 4 %,
    /// as is usual for sets on one grid.
    const DROOP: f64 = 0.04;
    /// Tuning of the [`BacklashTakeUp`](crate::governor::BacklashTakeUp), for a gap or a slack rope:
    /// [`Rating::taking_up`].
    const TAKING_UP: BacklashTakeUpTuning = Self::RATING.taking_up();
    /// The taking up, from the two masses, rate and tuning.
    const TAKE_UP: BacklashTakeUpDesign = Self::TWO_MASS.take_up(Self::RATE, Self::TAKING_UP);
    /// Shaper of a setpoint that does not excite the load's swing: for the vibration that the speed loop is designed to
    /// leave.
    const SHAPER: InputShaperDesign =
        InputShaperDesign::new(Self::SPEED_LOOP.shaft_frequency, Self::TUNING.shaft_damping);
    /// Limits of the [`Sequencer`](crate::governor::Sequencer): [`SequencerSettings::of`] the rating.
    const SEQUENCER: SequencerSettings = SequencerSettings::of(&Self::RATING);
    /// Smallest torque of a motor whose limits differ (N m), zero or below: zero, as an engine cannot brake.
    const LEAST_TORQUE: f64 = 0.0;

    /// Plausibility limits of a sample: [`Rating::screening`].
    ///
    /// With an encoder of more than 2^17 counts a smaller innovation is found out sooner.
    const SCREENING: Screening = Self::RATING.screening(Self::ENCODER, Self::RATE);
    /// Largest change of the load torque that belongs to the work: rated torque at once. The slower and smaller it is, the
    /// sooner a fault is found.
    const LOAD_STEP: LoadStep = LoadStep { torque: Self::RATING.torque.0, rise: 0.0 };
    /// Limits of a supervised drive: [`Supervision::of`] observer, rating and tolerances, the innovation at most half
    /// of a sample's limit. A machine of one mass names [`RigidDesign::innovation_response`].
    const SUPERVISION: Supervision = Supervision::of(
        &Self::RATING,
        Self::OBSERVER.innovation_response(&Self::LOAD_STEP),
        &Self::TOLERANCE,
        Self::ENCODER,
        &Self::LOAD_STEP,
        Self::RAMP,
        Self::PERIOD,
    )
    .within(&Self::SCREENING);
    /// Bases of fixed point: [`Rating::bases`] with observers, gear and speed loop.
    ///
    /// A machine with a soft governor names larger ones. A machine of one mass, or one whose shaft no observer can
    /// follow, names [`Rating::rigid_bases`], [`Bases::rigid`] or [`Bases::new`].
    const BASES: Bases = Self::RATING.bases(&Self::OBSERVER, &Self::RIGID_OBSERVER, &Self::GEAR, &Self::SPEED_LOOP);

    /// The cycle, for the measurement of the speed's fluctuation: a turn of the motor.
    const CYCLE: Cycle = Cycle::TURN;
    /// Cycles in a window of the waveform.
    const CYCLES: u32 = 16;
}

const fn fifth(x: f64) -> f64 {
    x * x * x * x * x
}

/// Angle of a count of the encoder (rad).
const fn count(encoder: Encoder) -> f64 {
    or_stop!(encoder.resolution())
}

/// Time between two ticks (s).
const fn period(rate: Rate) -> f64 {
    or_stop!(rate.period())
}
