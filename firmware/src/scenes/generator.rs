//! Gensets of 50 Hz: a diesel engine of 400 kW, and a geared steam turbine of 2 MW.
//!
//! The diesel: six cylinders, four-stroke, turbocharged, 1500 r/min, a rubber coupling, a four-pole generator. Engine
//! with flywheel 4.4 kg m2, generator 8 kg m2, coupling 50 kN m/rad at a relative damping of 1.1: of the size that
//! makers' tables give for such parts, not those of one set. The rack follows its command with a lag of 20 ms, an
//! electric actuator's, and the engine's torque follows the rack when the next cylinder has fired.
//!
//! The turbine, at the generator's shaft: 1500 r/min, a stiff coupling, an acceleration time of 8 s. That is twice the
//! stored energy over the rated power: 4 s of inertia constant, as is usual for such sets. The valve has a lag of 0.1 s
//! and the steam chest one of 0.25 s, the values that are usual for the model TGOV1 without reheat [IEEE PES-TR1 2013
//! §2.1]. The observer's input is the torque of the chest's pressure.
//!
//! # The loss of the turbine's whole load
//! By the time the valve can have closed the steam has gone on driving: rated torque for the sum of the lags, 0.35 s,
//! and the governor's view and ticks, 7 ms. Against 8 s of acceleration time that is a rise of 4.4 %, less what
//! friction takes (2 % of rated torque, less than 0.1 % of speed), and no governor does better. A proportional and
//! integral loop closes the valve only as fast as the speed rises: at a span of 2.5 it rose by 9.68 %. A span of 1.4
//! would keep the 7 % of class D, at a phase margin of 15 degrees. So the governor without feed-forward opposes the
//! estimated acceleration, as half the set's inertia more would ([`VirtualInertia`]), which raises the margins as well.
//!
//! # Inputs that fail
//! The monitor of an [`Actuated`] drive compares rack or chest with the command. Reaction to a fault on each input:
//!
//! | input | for 5 ms | for good |
//! |---|---|---|
//! | angle: dropped, frozen, noisy, negated, no number | coasts | trips: sensor loss, after 15 ms |
//! | rack: dropped, noisy, negated | the expected torque instead | trips: actuator, after 0.1 s and more |
//! | rack: no number | the same | trips: sensor loss, after 0.1 s |
//! | rack: frozen | accepted, since plausible | accepted until the command moves by a fifth of the rated torque, then as dropped |
//! | setpoint: frozen, noisy, no number | the ramp hardly moves; the last good one | rides through |
//! | setpoint: dropped, negated | the ramp hardly moves | is one: the set slows down, and trips by underspeed, or its coupling by overload |

pub mod cylinders;
pub mod parts;

use core::marker::PhantomData;

use driveline::configure::{GainSource, HasActuator, HasBarredSpeeds, HasTorqueCurve, Machine, Rating};
use driveline::design::{
    Actuator, BarredSpeeds, Disturbance, Encoder, GovernorDesign, LoadFeedForward, NaturalDamping, Rate, Robustness,
    TorqueCurve, USUAL_MARGIN, VirtualInertia,
};
use driveline::drive::{Actuated, Composition, ConfigOf, Drive};
use driveline::fluctuation::Waveform;
use driveline::governor::{
    AccelerationFeedback, Barred, Curve, Droop, FeedForward, HasRunSequence, MovingAverage, RunRequest, RunState,
    Sequencer, SpeedGovernor, Trip,
};
use driveline::machine::{
    Chain, Characteristic, Damping, Inertia, Line, Match, Parabola, Speed, Stiffness, Torque, TwoMass as TwoMassMachine,
};
use driveline::number::Fixed;
use driveline::observer::TwoMassObserver;
use driveline::settings::{ActuatorMonitorSettings, Bases, Cycle, Screening};

use crate::scene::composed::{Beside, Composed, output, sample};
use crate::scene::table::variants;
use crate::scene::{Input, Output};

/// Ticks a second: 32 to the firing interval of the diesel at rated speed.
pub const RATE_HZ: u32 = 2_400;
const PERIOD: f64 = 1.0 / RATE_HZ as f64;
const RATE: Rate = Rate::hz(RATE_HZ);

/// Rated speed of both sets (rad/s), 1500 r/min.
pub const RATED_SPEED: f64 = 157.079_632_679_489_66;

/// The encoder on the flywheel.
pub const ENCODER: Encoder = Encoder::lines(2048);

/// Data of a genset.
pub struct Set {
    /// Rated torque (N m).
    pub rated_torque: f64,
    /// Engine or turbine, coupling, generator.
    pub machine: TwoMassMachine,
    /// The actuator.
    pub actuator: Actuator,
    /// Delay of the rack's torque for the observer (s).
    pub delay: f64,
    /// How the observer is tuned.
    pub disturbance: Disturbance,
    /// Lag of the estimated load torque (s), as measured on a step.
    pub estimate_lag: f64,
    /// Span of the governor's loop, with feed-forward and without.
    pub optimum_factor: [f64; 2],
    /// Share of the load torque that is fed forward.
    pub share: f64,
    /// Share of the inertia that is given against the acceleration, without feed-forward.
    pub inertia: f64,
    /// Lags of the actuator from the command to the reported torque (s).
    pub lags: [f64; 2],
    /// Timeout of the actuator monitor (s).
    pub timeout: f64,
    /// Largest torque against speed.
    pub curve: TorqueCurve<4>,
    /// Slopes of prime mover and load at the rated point, where the governor is to be stable.
    pub natural: NaturalDamping,
    /// Acceleration of the setpoint (rad/s2).
    pub ramp: f64,
    /// Barred speeds.
    pub barred: BarredSpeeds<1>,
}

/// The parts of the diesel: engine with flywheel, coupling, generator.
pub const DIESEL_CHAIN: Chain = Chain::motor(Inertia(4.4)).shaft(Stiffness(5.0e4), Damping(66.0)).rotor(Inertia(8.0));

const DIESEL_MACHINE: TwoMassMachine = DIESEL_CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated torque of the diesel (N m): 400 kW.
pub const DIESEL_TORQUE: f64 = 4.0e5 / RATED_SPEED;

/// Lag of the rack (s).
pub const RACK_LAG: f64 = 0.02;

/// Mean time from an injection to its torque (s), for the observer, which follows the mean torque.
pub const TORQUE_DELAY: f64 = 0.0065;

/// Dead time that the governor allows for (s), which has to bear with every phase of the firing.
pub const FIRING_DELAY: f64 = Actuator::firing_delay(6, true, RATED_SPEED);

/// Friction of the diesel at rated speed, of rated torque: a mean effective pressure of 2 bar in 12.4 l.
pub const DIESEL_FRICTION: f64 = 0.08;

/// Full-load curve of the diesel: what the charge lets burn, through three points as a maker gives them.
const DIESEL_FULL_LOAD: Characteristic = Characteristic::Parabola(Parabola::through([
    (Speed(0.4 * RATED_SPEED), Torque(0.75 * DIESEL_TORQUE)),
    (Speed(0.7 * RATED_SPEED), Torque(1.05 * DIESEL_TORQUE)),
    (Speed(1.05 * RATED_SPEED), Torque(1.2 * DIESEL_TORQUE)),
]));

/// The diesel at the rack of its rated torque: a cycle's fuel gives the same torque at every speed, less the friction.
const DIESEL_MOVER: Characteristic =
    Characteristic::Line(Line::new((Speed(RATED_SPEED), Torque(DIESEL_TORQUE)), falling_by(DIESEL_FRICTION)));

/// Speed without load of a mover whose torque falls by a share of the rated one from standstill to rated speed.
const fn falling_by(share: f64) -> Speed {
    Speed(RATED_SPEED * (1.0 + 1.0 / share))
}

/// Natural damping at the rated point, with a load of constant power: its torque falls as the speed rises, which takes
/// some of the margins.
const fn natural(mover: &Characteristic, rated_torque: f64) -> NaturalDamping {
    let power = Characteristic::Line(Line::new((Speed(RATED_SPEED), Torque(rated_torque)), falling_by(1.0)));
    NaturalDamping::of(mover, &power, Speed(RATED_SPEED))
}

/// The diesel set. Its critical speed is that of the engine's order 1.5 on the coupling, 844 r/min; order 3, the
/// firing's, is passed under the starter.
pub const DIESEL: Set = Set {
    rated_torque: DIESEL_TORQUE,
    machine: DIESEL_MACHINE,
    actuator: Actuator { delay: FIRING_DELAY, lag: RACK_LAG },
    delay: TORQUE_DELAY,
    disturbance: Disturbance { torque_accuracy: 0.25 * DIESEL_TORQUE, load_torque_step: DIESEL_TORQUE, within: 1.0 },
    estimate_lag: 0.018,
    // 2.0 leaves 28.9 degrees without feed-forward; 2.06 lets the loss of the whole load trip the set at 110 %
    optimum_factor: [2.5, 2.0],
    share: 0.9,
    inertia: 0.0,
    // one lag; two ticks of it stand for the second
    lags: [RACK_LAG - 2.0 * PERIOD, 2.0 * PERIOD],
    timeout: 0.1,
    curve: TorqueCurve::of(&DIESEL_FULL_LOAD, [0.0, 0.4 * RATED_SPEED, 0.8 * RATED_SPEED, 1.05 * RATED_SPEED]),
    natural: natural(&DIESEL_MOVER, DIESEL_TORQUE),
    ramp: 0.25 * RATED_SPEED,
    barred: BarredSpeeds::new(&[DIESEL_MACHINE.resonance()], &[1.5], USUAL_MARGIN, 0.9 * RATED_SPEED),
};

/// Rated torque of the turbine at the generator's shaft (N m): 2 MW.
pub const TURBINE_TORQUE: f64 = 2.0e6 / RATED_SPEED;

/// Lags of the turbine's valve and of its steam chest (s).
pub const VALVE_LAG: f64 = 0.1;
/// See [`VALVE_LAG`].
pub const CHEST_LAG: f64 = 0.25;

/// Friction and windage of turbine and gear at rated speed, of rated torque.
pub const TURBINE_FRICTION: f64 = 0.02;

/// The turbine at the valve of its rated torque: half of it is lost by twice the rated speed [Wang 1989 (1-6)], and the
/// friction.
const TURBINE_MOVER: Characteristic =
    Characteristic::Line(Line::new((Speed(RATED_SPEED), Torque(TURBINE_TORQUE)), falling_by(0.5 + TURBINE_FRICTION)));

/// Sum of the turbine set's inertias (kg m2), from its acceleration time of 8 s.
pub const TURBINE_INERTIA: f64 = 8.0 * TURBINE_TORQUE / RATED_SPEED;

/// The parts of the turbine: turbine with gear, coupling, generator.
pub const TURBINE_CHAIN: Chain = Chain::motor(Inertia(0.4 * TURBINE_INERTIA))
    .shaft(Stiffness(6.0e6), Damping(600.0))
    .rotor(Inertia(0.6 * TURBINE_INERTIA));

const TURBINE_MACHINE: TwoMassMachine = TURBINE_CHAIN.reduce(Match::ResonanceAntiresonance);

/// The turbine set. Of its two lags the shorter counts as a dead time; no order excites its coupling, so its barred
/// range lies below its turning gear.
pub const TURBINE: Set = Set {
    rated_torque: TURBINE_TORQUE,
    machine: TURBINE_MACHINE,
    actuator: Actuator { delay: VALVE_LAG, lag: CHEST_LAG },
    delay: 0.0,
    disturbance: Disturbance { torque_accuracy: 0.01 * TURBINE_TORQUE, load_torque_step: TURBINE_TORQUE, within: 2.0 },
    estimate_lag: 0.05,
    optimum_factor: [3.0, 2.5],
    share: 0.5,
    inertia: 0.5,
    lags: [VALVE_LAG, CHEST_LAG],
    timeout: 0.3,
    curve: TorqueCurve::through([
        [0.0, 1.2 * TURBINE_TORQUE],
        [0.5 * RATED_SPEED, 1.15 * TURBINE_TORQUE],
        [RATED_SPEED, 1.1 * TURBINE_TORQUE],
        [1.1 * RATED_SPEED, TURBINE_TORQUE],
    ])
    .with_power_limit(1.1 * TURBINE_TORQUE * RATED_SPEED),
    natural: natural(&TURBINE_MOVER, TURBINE_TORQUE),
    ramp: 0.05 * RATED_SPEED,
    barred: BarredSpeeds::new(&[0.01], &[1.0], USUAL_MARGIN, RATED_SPEED),
};

/// Slope of the droop that may be switched to: 4 % at rated torque.
pub const DROOP: f64 = 0.04;

impl Set {
    /// Rated torque and speed, and a fifth over the torque.
    pub const fn rating(&self) -> Rating {
        Rating {
            torque: Torque(self.rated_torque),
            speed: Speed(RATED_SPEED),
            torque_limit: Torque(1.2 * self.rated_torque),
        }
    }

    /// The governor before its average of the speed, with feed-forward or without.
    pub const fn governor(&self, forward: bool) -> GovernorDesign {
        if forward {
            let forward = LoadFeedForward { share: self.share, lag: self.estimate_lag };
            return self
                .machine
                .governor(RATE, self.actuator, self.optimum_factor[0], forward)
                .with_natural_damping(&self.machine, self.natural);
        }
        let inertia = VirtualInertia { share: self.inertia, lag: self.estimate_lag };
        self.machine
            .governor_with_inertia(RATE, self.actuator, self.optimum_factor[1], inertia)
            .with_natural_damping(&self.machine, self.natural)
    }

    /// Bases of fixed point: two and a half times the rated torque, so that the estimates' swing and the gains fit, and
    /// a third over rated speed.
    pub const fn bases(&self) -> Bases {
        Bases::new(&self.machine, 2.5 * self.rated_torque, 1.34 * RATED_SPEED)
    }

    /// Plausibility limits of a sample: the torque to a sixth over its limit, half over rated speed, 1/128 turn, two
    /// counts, 15 ms, in which the set turns by less than half a turn.
    pub const fn screening(&self) -> Screening {
        Screening {
            torque: 1.4 * self.rated_torque,
            setpoint: 1.2 * RATED_SPEED,
            innovation: core::f64::consts::TAU / 128.0,
            frozen_turn: 2.0 * core::f64::consts::TAU / 8192.0,
            max_coast: RATE_HZ * 3 / 200,
        }
    }
}

/// Ticks of the firing interval, the length of the moving average.
pub const FIRING: usize = 32;

/// The governor of a genset, with feed-forward or another compensation.
pub type Governor<F = FeedForward> = SpeedGovernor<(Droop, Barred<1>), F, Curve<4>, Sequencer, MovingAverage<FIRING>>;
/// The drive of a set behind its actuator, with the ticks of the actuator's delay.
type DriveOf<N, F, const RING: usize, M = ()> = Actuated<Drive<N, TwoMassObserver, Governor<F>, M>, 2, RING>;

/// The diesel set's drive.
pub type Diesel<N> = Composed<DriveOf<N, FeedForward, 32>, Switches>;
/// The diesel set's drive with its cylinders watched.
pub type Watched<N> = Composed<cylinders::Drive<N>, cylinders::Cylinders>;
/// The turbine set's drive.
pub type Turbine<N> = Composed<DriveOf<N, (FeedForward, AccelerationFeedback), 1>, Switches>;

variants! {
    "diesel": Diesel for With<DieselSet, FED>;
    "turbine": Turbine for With<TurbineSet, FED>;
    "cylinders": Watched for With<DieselSet, FED>;
}

/// The diesel set.
pub struct DieselSet;

/// The turbine set.
pub struct TurbineSet;

/// A set.
pub trait HasSet: 'static {
    /// The chain that the set's two masses come from.
    const CHAIN: Chain;
    /// The set.
    const SET: Set;
}

impl HasSet for DieselSet {
    const CHAIN: Chain = DIESEL_CHAIN;
    const SET: Set = DIESEL;
}

impl HasSet for TurbineSet {
    const CHAIN: Chain = TURBINE_CHAIN;
    const SET: Set = TURBINE;
}

/// Constants that the panel chooses: with feed-forward and isochronous.
pub const FED: usize = 0;
/// Without feed-forward.
pub const PLAIN: usize = 1;
/// Without feed-forward, with droop.
pub const DROOPING: usize = 2;

/// A set as a machine, with one of its three kinds of constants.
pub struct With<S, const CONSTANTS: usize>(PhantomData<S>);

impl<S: HasSet, const CONSTANTS: usize> Machine for With<S, CONSTANTS> {
    const CHAIN: Chain = S::CHAIN;
    const RATING: Rating = S::SET.rating();
    const ENCODER: Encoder = ENCODER;
    const RATE_HZ: u32 = RATE_HZ;
    const TWO_MASS: TwoMassMachine = S::SET.machine;
    const DISTURBANCE: Disturbance = S::SET.disturbance;
    const ACTUATOR: Actuator = S::SET.actuator;
    const GAINS: GainSource = GainSource::Governor(S::SET.governor(CONSTANTS == FED));
    const DROOP: f64 = if CONSTANTS == DROOPING { DROOP } else { 0.0 };
    /// The diesel without feed-forward has 28.9 degrees.
    const ROBUSTNESS: Robustness = Robustness { phase: 0.5, ..Robustness::USUAL };
    const RAMP: f64 = S::SET.ramp;
    const BASES: Bases = S::SET.bases();
    const SCREENING: Screening = S::SET.screening();
    const CYCLE: Cycle = Cycle::FOUR_STROKE;
    const CYCLES: u32 = 8;
}

impl<S: HasSet, const CONSTANTS: usize> HasBarredSpeeds<1> for With<S, CONSTANTS> {
    const BARRED: BarredSpeeds<1> = S::SET.barred;
    const QUICK_RAMP: f64 = 4.0 * S::SET.ramp;
}

impl<S: HasSet, const CONSTANTS: usize> HasTorqueCurve<4> for With<S, CONSTANTS> {
    const CURVE: TorqueCurve<4> = S::SET.curve;
}

impl<S: HasSet, const CONSTANTS: usize> HasActuator<2> for With<S, CONSTANTS> {
    const LAGS: [f64; 2] = S::SET.lags;
    const TORQUE_DELAY: f64 = S::SET.delay;
    const MONITOR: ActuatorMonitorSettings =
        ActuatorMonitorSettings { timeout: S::SET.timeout, ..ActuatorMonitorSettings::of(&Self::RATING) };
}

/// Setpoints and switches of the panel, as keys of its requests.
pub mod panel {
    /// Chooses the constants: 0 with feed-forward, 1 without, 2 with droop.
    pub const CONSTANTS: u32 = 1;
    /// Requests the state; see [`super::mode_word`].
    pub const MODE: u32 = 2;
    /// Trips the genset, as an emergency stop does, and requests the state.
    pub const TRIP: u32 = 3;
}

/// A mode as a word: 0 stopped, 1 starting, 2 running, 3 braking, from 16 on tripped, in the order of
/// [`Trip::NAMES`](driveline::governor::Trip::NAMES).
pub fn mode_word(mode: RunState) -> u32 {
    match mode {
        RunState::Stopped => 0,
        RunState::Starting => 1,
        RunState::Running => 2,
        RunState::Braking => 3,
        RunState::Tripped(trip) => 16 + trip as u32,
    }
}

/// A set's drive with the constants that the panel chooses from.
pub trait Choices: Composition<Config: 'static, Governor: HasRunSequence> {
    /// In the order of [`FED`], [`PLAIN`], [`DROOPING`].
    const CONFIGS: &'static [ConfigOf<Self>; 3];
}

macro_rules! choices {
    ($($set:ident: $added:ty, $ring:literal, $measured:ty;)+) => {
        choices! { @ f32: $($set: $added, $ring, $measured;)+ }
        choices! { @ Fixed: $($set: $added, $ring, $measured;)+ }
    };
    (@ $number:ty: $($set:ident: $added:ty, $ring:literal, $measured:ty;)+) => {$(
        impl Choices for DriveOf<$number, $added, $ring, $measured> {
            const CONFIGS: &'static [ConfigOf<Self>; 3] = &[
                Self::configure::<With<$set, FED>>(),
                Self::configure::<With<$set, PLAIN>>(),
                Self::configure::<With<$set, DROOPING>>(),
            ];
        }
    )+};
}

choices! {
    DieselSet: FeedForward, 32, ();
    DieselSet: FeedForward, 32, Waveform<{ cylinders::BINS }>;
    TurbineSet: (FeedForward, AccelerationFeedback), 1, ();
}

/// The set's run switch ([`Input::RELEASED`]: on it starts, off it brakes, and off resets a trip) and its panel.
pub struct Switches {
    released: bool,
}

impl<D: Choices> Beside<D> for Switches {
    fn constants(_: &'static ConfigOf<D>) -> &'static ConfigOf<D> {
        &D::CONFIGS[FED]
    }

    fn start(_: &mut D, _: &ConfigOf<D>) -> Self {
        Switches { released: false }
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut D, config: &ConfigOf<D>, input: &Input) -> Output {
        let released = input.flags & Input::RELEASED != 0;
        if released != self.released {
            self.released = released;
            let modes = drive.governor_mut().sequencer_mut();
            if released {
                modes.request(RunRequest::Start);
            } else if !modes.request(RunRequest::Stop) {
                modes.request(RunRequest::Reset);
            }
        }
        let command = drive.tick(config, &sample(input));
        output(&command, &drive.estimate(config))
    }

    fn panel(&mut self, drive: &mut D, config: &mut &'static ConfigOf<D>, [key, value]: [u32; 2]) -> u32 {
        let modes = drive.governor_mut().sequencer_mut();
        match key {
            panel::CONSTANTS => {
                if let Some(to) = D::CONFIGS.get(value as usize) {
                    drive.switch(config, to);
                    *config = to;
                }
                return value;
            }
            panel::TRIP => modes.trip(Trip::Requested),
            panel::MODE => true,
            _ => return 0,
        };
        mode_word(modes.state())
    }
}
