//! The tilting drive of a 300 t oxygen converter with its four motors: load sharing, with a bias against backlash.
//!
//! The machine of the scene `converter`, motor by motor: four motors of 110 kW at 600 r/min, each with its brake, its
//! gearbox of four-pinion trains, its encoder and its inverter, on one bull gear. The trains are alike, but for their
//! tolerances; each has a gap of 0.3 rad at the motor. Two motors pull against the other two, so that the bull gear is
//! held from both sides; above 90 % of rated torque all four share the load equally.
//!
//! The observer stands on the mean of the four angles: with a bias it moves as one motor of four inertias on four
//! shafts in parallel without a gap, whatever the motors do against each other, and the counts of four encoders blur
//! one another. So it is the linear one of two masses.
//!
//! The words of a tick that this scene has no other use for carry the further encoders: the vibration's those of motors
//! 2 and 3, the value of the panel's request that of motor 4. The torque of a tick is the sum of all four; the four
//! follow as the answer to a second exchange with [`Input::MOTORS`], which changes nothing.
//!
//! | variant | governs |
//! |---|---|
//! | `biased` | the mean speed with active damping, four torques with a bias |

use core::marker::PhantomData;

use driveline::configure::{Configure, HasLoadSharing, Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning};
use driveline::drive::{ConfigOf, Drive};
use driveline::fault::Faults;
use driveline::governor::{LoadSharing, LoadSharingConfig, SpeedLoop};
use driveline::machine::{Chain, Damping, Efficiency, Inertia, Ratio, Speed, Stiffness, Torque};
use driveline::number::Number;
use driveline::observer::TwoMassObserver;
use driveline::settings::{Bases, LoadSharingSettings, Screening};

use crate::scene::composed::{Beside, Composed, OverWords};
use crate::scene::table::variants;
use crate::scene::{Input, Output};

/// Motors on the bull gear.
pub const MOTORS: usize = 4;

/// Motor turns per turn of the trunnion.
pub const RATIO: f64 = 690.0;

/// Inertia of a motor with its brake (kg m2).
pub const MOTOR: f64 = 9.0;
/// Stiffness (N m/rad), damping (N m s/rad) and gap (rad) of a motor's train, at the motor.
pub const TRAIN: [f64; 3] = [5.0e4, 3.75, 0.3];

/// Rated torque of a motor (N m).
pub const RATED: f64 = 1_750.0;

/// The machine, from the motors to the vessel: four motors; their trains in parallel; the bull gear; the trunnion.
pub struct ConverterRing;

impl Machine for ConverterRing {
    const CHAIN: Chain = Chain::motor(Inertia(MOTORS as f64 * MOTOR))
        .shaft(Stiffness(MOTORS as f64 * TRAIN[0]), Damping(MOTORS as f64 * TRAIN[1]))
        .rotor(Inertia(4.0))
        .gear(Ratio(RATIO), Efficiency(1.0))
        .shaft(Stiffness(3.6e9), Damping(1.0e7))
        .rotor(Inertia(1.2e7));
    /// All four motors; 600 r/min.
    const RATING: Rating = Rating {
        torque: Torque(MOTORS as f64 * RATED),
        speed: Speed(62.8),
        torque_limit: Torque(2.0 * MOTORS as f64 * RATED),
    };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
    /// The load may wander by a third of rated in ten seconds.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 0.35 * Self::RATING.torque.0, ..Self::RATING.disturbance() };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.3, damping: 1.0, shaft_damping: 0.1 };
    /// Rated speed in 1.6 s: two motors carry the load and the acceleration.
    const RAMP: f64 = 40.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 2.0 * Self::RATING.speed.0);
    /// In 30 ms the motor turns by less than half a turn.
    const SCREENING: Screening = Screening {
        setpoint: 1.5 * Self::RATING.speed.0,
        max_coast: Self::RATE_HZ / 34,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

impl HasLoadSharing for ConverterRing {
    /// A ninth of rated torque holds a flank. The motors swing against the held bull gear at 12 Hz; the damping is 0.3
    /// of the critical, and lags by a twelfth of a period. The share of the shaft torque changes by up to 5 kN m/s when
    /// friction reverses; the bias has to be faster.
    const SHARING: LoadSharingSettings = LoadSharingSettings {
        motors: MOTORS as u32,
        preload: RATED / 9.0,
        equal_above: 0.9 * RATED,
        bias_below: 0.8 * RATED,
        slew: 8_000.0,
        torque_limit: 2.0 * RATED,
        damping: 400.0,
        lag: 6.4e-3,
        max_deviation: 0.7,
    };
}

/// The sharing beside the drive, with the torques of the last tick.
pub struct Motors<M, N> {
    sharing: LoadSharing<N, MOTORS>,
    torques: [N; MOTORS],
    machine: PhantomData<M>,
}

impl<M, N, D> Beside<D> for Motors<M, N>
where
    M: HasLoadSharing,
    N: Number,
    D: OverWords<Number = N>,
    LoadSharing<N, MOTORS>: Configure<M, N, Config = LoadSharingConfig<N>>,
{
    fn start(_: &mut D, _: &ConfigOf<D>) -> Self {
        Motors { sharing: LoadSharing::default(), torques: [N::ZERO; MOTORS], machine: PhantomData }
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut D, config: &ConfigOf<D>, input: &Input) -> Output {
        if input.flags & Input::MOTORS != 0 {
            let [torque, motor_speed, shaft_torque, load_speed] = self.torques.map(Number::to_word);
            return Output { torque, motor_speed, shaft_torque, load_speed, ..Output::default() };
        }
        let constants = &const { <LoadSharing<N, MOTORS> as Configure<M, N>>::CONFIG };
        let ([second, third], [_, fourth]) = (input.vibration, input.asked);
        let angles = [input.angle, second, third, fourth];
        if input.flags & Input::RELEASED == 0 {
            let output = drive.advance(config, &Input { angle: self.sharing.hold(&angles), ..*input });
            let share = N::from_word(output.torque).saturated().widened().times(constants.share);
            self.torques = [share; MOTORS];
            return output;
        }
        let angle = self.sharing.mean_angle(constants, &angles);
        let mut output = drive.advance(config, &Input { angle, ..*input });
        let torque = N::from_word(output.torque);
        self.torques = if output.faults & Faults::ANGLE_LOST.bits() != 0 {
            self.sharing.release();
            [N::ZERO; MOTORS]
        } else {
            self.sharing.torques(constants, torque, N::from_word(output.shaft_torque))
        };
        if self.sharing.left_out() != 0 {
            output.faults |= Faults::ANGLE_MISSING.bits();
        }
        output
    }

    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<Self> {
        Some(Motors { ..*self })
    }
}

/// Four motors with a bias, on one observer of two masses.
pub type Biased<N> = Composed<Drive<N, TwoMassObserver, SpeedLoop>, Motors<ConverterRing, N>>;

variants! {
    "biased": Biased for ConverterRing;
}
