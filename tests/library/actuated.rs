//! A drive behind an actuator: a rack and a rotor of equations of their own.

use driveline::configure::{GainSource, HasActuator};
use driveline::design::{Actuator, LoadFeedForward};
use driveline::drive::Composition as _;
use driveline::fault::Faults;
use driveline::governor::{
    Droop, FeedForward, MovingAverage, RunRequest, RunState, Sequencer, SpeedGovernor, TorqueRange, Trip,
};
use driveline::prelude::*;

struct Set;
impl Machine for Set {
    const CHAIN: Chain = Chain::motor(Inertia(4.4)).shaft(Stiffness(5.0e4), Damping(66.0)).rotor(Inertia(8.0));
    const RATING: Rating = Rating { torque: Torque(2546.0), speed: Speed::rpm(1500.0), torque_limit: Torque(3055.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 2_400;
    const DISTURBANCE: Disturbance = Disturbance { torque_accuracy: 636.0, load_torque_step: 2546.0, within: 1.0 };
    const ACTUATOR: Actuator = Actuator { delay: Actuator::firing_delay(6, true, 157.08), lag: 0.02 };
    const GAINS: GainSource = GainSource::governor::<Self>(2.5, FED);
    const BASES: driveline::settings::Bases = driveline::settings::Bases::new(&Self::TWO_MASS, 6.4e3, 210.0);
}
const FED: LoadFeedForward = LoadFeedForward { share: 0.9, lag: 0.018 };
impl HasActuator<1> for Set {
    const LAGS: [f64; 1] = [0.02];
    const TORQUE_DELAY: f64 = 0.0065;
}
type Governed = SpeedGovernor<Droop, FeedForward, TorqueRange, Sequencer, MovingAverage<32>>;
type SetDrive<N> = Actuated<Drive<N, TwoMassObserver, Governed>, 1, 32>;
static SINGLE: ConfigOf<SetDrive<f32>> = SetDrive::<f32>::configure::<Set>();
static FIXED: ConfigOf<SetDrive<Fixed>> = SetDrive::<Fixed>::configure::<Set>();

const PERIOD: f64 = 1.0 / 2_400.0;

/// A rack with a lag, a torque 6.5 ms behind it, and a rotor, in steps of a period.
struct Plant {
    rack: f64,
    /// The rack's positions of the last 16 periods: 6.5 ms are 15.6 of them.
    past: [f64; 16],
    speed: f64,
    angle: f64,
    load: f64,
    seized: bool,
}

impl Plant {
    fn advance(&mut self, command: f64) {
        if !self.seized {
            self.rack += (command - self.rack) * -(-PERIOD / 0.02).exp_m1();
        }
        let acting = self.past[15];
        self.past.rotate_right(1);
        self.past[0] = self.rack;
        self.angle += self.speed * PERIOD;
        self.speed += (acting - self.load * (self.speed / 157.08)) / 12.4 * PERIOD;
    }

    fn sample<N: driveline::configure::Units>(&self) -> Sample<N> {
        let counts = (self.angle / std::f64::consts::TAU * 8192.0) as i64 as u32;
        Sample::si::<Set>(counts << 19, self.rack as f32, 157.08)
    }
}

/// Runs the set from rest for so many ticks, of which up to `missing` in a row do not run; the load is thrown on in the
/// middle, and the rack seizes at a tick. Faults, state and plant at the end.
macro_rules! run {
    ($number:ident, $config:ident, $missing:expr, $load:expr, $seizes:expr, $ticks:expr) => {{
        let mut drive = SetDrive::<$number>::new(&$config, 0);
        let mut plant = Plant { rack: 0.0, past: [0.0; 16], speed: 0.0, angle: 0.0, load: 0.0, seized: false };
        drive.request(RunRequest::Start);
        let most: u32 = $missing;
        let (mut seen, mut command, mut drawn, mut tick) = (Faults::NONE, 0.0, 1_u32, 0_u32);
        while tick < $ticks {
            drawn = drawn.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let missed = if drawn >> 28 == 0 && most > 0 { 1 + (drawn >> 8) % most } else { 0 };
            for _ in 0..=missed {
                plant.advance(command);
            }
            tick += 1 + missed;
            plant.load = if 2 * tick < $ticks { 0.0 } else { $load };
            plant.seized = $seizes.is_some_and(|at| tick >= at);
            let given = drive.tick_after(&$config, &plant.sample(), missed);
            command = f64::from(given.torque_si::<Set>());
            seen |= given.faults;
        }
        (seen, drive.state(), plant)
    }};
}

/// The rack of a sound set is as expected, whatever ticks do not run. Under a droop of 4 % half of rated torque takes
/// 2 % off the speed: the load here is 0.5 of rated at rated speed.
#[test]
fn a_sound_actuator_raises_no_fault_in_ticks_that_do_not_run() {
    for missing in [0_u32, 1, 8] {
        let found = [
            run!(f32, SINGLE, missing, 1273.0, None::<u32>, 40_000),
            run!(Fixed, FIXED, missing, 1273.0, None::<u32>, 40_000),
        ];
        for (seen, state, plant) in found {
            let allowed = if missing == 0 { Faults::NONE } else { Faults::TICK_MISSED };
            assert!(allowed.contains(seen) && state == RunState::Running, "{missing}: {seen} {state:?}");
            // the load falls with the speed, by 2 % of itself
            assert!((plant.speed / 157.08 - 0.9804).abs() < 5e-4, "{missing}: {}", plant.speed);
        }
    }
}

/// A rack that stays where it is trips when the command leaves it, and a report that is no number trips as a sensor.
#[test]
fn an_actuator_that_does_not_follow_trips_the_sequence() {
    // it seizes a tenth of a second before the load comes
    for (seen, state, _) in [
        run!(f32, SINGLE, 0_u32, 1273.0, Some(19_760), 40_000),
        run!(Fixed, FIXED, 4_u32, 1273.0, Some(19_760), 40_000),
    ] {
        assert!(seen.contains(Faults::TORQUE) && state == RunState::Tripped(Trip::Actuator), "{seen} {state:?}");
    }
    let mut drive = SetDrive::<f32>::new(&SINGLE, 0);
    drive.request(RunRequest::Start);
    for _ in 0..241 {
        drive.tick(&SINGLE, &Sample::si::<Set>(0, f32::NAN, 0.0));
    }
    assert_eq!(drive.state(), RunState::Tripped(Trip::SensorLoss));
}

/// The moving average is in the gains by the type alone: with the equivalent delay of the symmetrical optimum, the sum
/// of dead time, lag, a tick and a half, and half of 32 ticks.
#[test]
fn the_gains_allow_for_the_average_of_the_speed() {
    let delay: f64 = 0.08 / 12.0 + 0.01 + 0.02 + 1.5 * PERIOD + 16.0 * PERIOD;
    let proportional = 12.4 / (2.5 * delay);
    let integral = proportional / (2.5 * 2.5 * delay);
    let gains = SINGLE.drive.governor.gains;
    // firing at 157.08 rad/s for 1500 r/min, and f32
    assert!((f64::from(gains.proportional) / (proportional + integral * PERIOD) - 1.0).abs() < 1e-5, "{gains:?}");
}
