//! The governors under attack: whatever comes over the wires, whatever is asked and in whatever order, the torque is a
//! number within its limits, none is commanded after a trip until it is reset, and nothing jolts that need not.

use driveline::design::{
    Actuator, Disturbance, Encoder, GovernorDesign, LoadFeedForward, Rate, TwoMassDesign, VirtualInertia,
};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::governor::{
    AccelerationFeedback, AccelerationFeedbackConfig, Droop, DroopConfig, FeedForward, FeedForwardConfig, Gains,
    Governor, MovingAverage, MovingAverageConfig, RunRequest, RunState, Sequencer, SequencerConfig, Slew, SlewConfig,
    SpeedGovernor, SpeedGovernorConfig, SymmetricLimit, SymmetricLimitConfig,
};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass as Machine};
use driveline::number::{Fixed, Number, StateOf};
use driveline::observer::{TwoMassConfig, TwoMassObserver};
use driveline::sample::{Estimate, Sample};
use driveline::settings::{Bases, Screening, SequencerSettings, SpeedLoopSettings};
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_firmware::scene::{Input, Scene};
use driveline_firmware::scenes::find;
use driveline_firmware::scenes::generator::{RATED_SPEED, panel};
use driveline_lab::generator::faults::MOST;
use driveline_lab::generator::set::Kind;
use proptest::prelude::*;

const MACHINE: Machine = Machine::new(Inertia(4.4), Inertia(8.0), Stiffness(5.0e4), Damping(66.0));
const TORQUE: f64 = 2500.0;
const SPEED: f64 = 157.0;
const PERIOD: f64 = 5e-4;
const RATE: Rate = Rate::every(PERIOD);
const RAMP: f64 = 40.0;
const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE, ramp: RAMP };
const BASES: Bases = Bases::new(&MACHINE, 2.5 * TORQUE, 1.34 * SPEED);
const LATE: Actuator = Actuator { delay: 0.02, lag: 0.02 };
const FED: GovernorDesign = MACHINE.governor(RATE, LATE, 2.5, LoadFeedForward { share: 0.9, lag: 0.02 });
const HEAVY: GovernorDesign = MACHINE.governor_with_inertia(RATE, LATE, 3.0, VirtualInertia { share: 0.3, lag: 0.02 });
const OBSERVER: TwoMassDesign = MACHINE.observer(
    RATE,
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 600.0, load_torque_step: TORQUE, within: 1.0 },
);
const SCREENING: Screening =
    Screening { torque: 1.4 * TORQUE, setpoint: 1.2 * SPEED, innovation: 0.05, frozen_turn: 1.5e-3, max_coast: 30 };
const MODES: SequencerSettings = SequencerSettings {
    overspeed: 1.1 * SPEED,
    underspeed: 0.8 * SPEED,
    reverse: 0.02 * SPEED,
    shaft_torque: 3.0 * TORQUE,
    standstill: 0.01 * SPEED,
    trip_delay: 0.01,
    underspeed_delay: 0.1,
    start: 5.0,
};

/// A governor of every part that adds, delays or limits.
type Whole =
    SpeedGovernor<Droop, (FeedForward, AccelerationFeedback), Slew<SymmetricLimit>, Sequencer, MovingAverage<32>>;
type Attacked<N> = Drive<N, TwoMassObserver, Whole>;
type Constants<N> = <StateOf<Whole, N> as Governor<N>>::Config;

/// A number with its constants: two governors to switch between, with a slew of the torque (N m/s).
trait Wired: Number {
    const UNIT: [f64; 2];
    fn governors(slew: f64) -> [Constants<Self>; 2];
    fn limits() -> Limits<Self>;
    fn observer() -> TwoMassConfig<Self>;
    fn of(value: f64) -> Self;
}

macro_rules! wired {
    ($number:ident, $unit:expr, |$value:ident| $of:expr, $bases:expr) => {
        impl Wired for $number {
            const UNIT: [f64; 2] = $unit;
            fn governors(slew: f64) -> [Constants<Self>; 2] {
                [(&FED, 0.0), (&HEAVY, 0.04)].map(|(design, droop)| SpeedGovernorConfig {
                    gains: Gains::<$number>::new(design, SETTINGS, $bases),
                    shape: DroopConfig::<$number>::new(droop, SPEED, TORQUE, $bases),
                    compensation: (
                        FeedForwardConfig::<$number>::new(design.share, $bases),
                        AccelerationFeedbackConfig::<$number>::new(design, $bases),
                    ),
                    limit: SlewConfig::<$number, _>::new(
                        slew,
                        SymmetricLimitConfig::<$number>::new(TORQUE, $bases),
                        PERIOD,
                        $bases,
                    ),
                    sequence: SequencerConfig::<$number>::new(&MODES, PERIOD, $bases),
                    filter: MovingAverageConfig::<$number, 32>::of_ticks(),
                })
            }
            fn limits() -> Limits<Self> {
                Limits::<$number>::new(&SCREENING, $bases)
            }
            fn observer() -> TwoMassConfig<Self> {
                TwoMassConfig::<$number>::new(&OBSERVER, $bases)
            }
            fn of($value: f64) -> Self {
                $of
            }
        }
    };
}

wired!(f32, [1.0, 1.0], |value| value as f32, Bases::SI);
wired!(Fixed, [BASES.torque, BASES.speed], |value| Fixed::from_f64(value), BASES);

/// What is done to a drive.
#[derive(Clone, Copy, Debug)]
enum Act {
    /// It turns by so much in each of so many ticks, told the torque that it commands.
    Turns(u16, i32),
    /// Words as they come, for so many ticks: how far the angle is off, torque, setpoint.
    Words(u8, u32, u32, u32),
    /// No angle, for so many ticks.
    Blind(u8, u32, u32),
    /// Held, with a torque.
    Hold(u32),
    Ask(RunRequest),
    Switch,
    Engage,
}

/// Words that are at an edge, and any.
fn word() -> impl Strategy<Value = u32> {
    let edges: Vec<u32> =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, f32::MIN_POSITIVE, -0.0, 3500.0]
            .map(f32::to_bits)
            .into_iter()
            .chain([0, 1, u32::MAX, i32::MAX as u32, 1 << 28, 1 << 29, 3 << 28, 0xf000_0000])
            .collect();
    prop_oneof![any::<u32>(), prop::sample::select(edges)]
}

fn act() -> impl Strategy<Value = Act> {
    // 157 rad/s are 53.7 million of 2^-32 turns in half a millisecond.
    prop_oneof![
        4 => (1..400_u16, -20_000_000..70_000_000_i32).prop_map(|(ticks, turn)| Act::Turns(ticks, turn)),
        3 => (1..60_u8, word(), word(), word()).prop_map(|(ticks, a, t, r)| Act::Words(ticks, a, t, r)),
        1 => (1..60_u8, word(), word()).prop_map(|(ticks, t, r)| Act::Blind(ticks, t, r)),
        1 => word().prop_map(Act::Hold),
        4 => prop::sample::select(
            vec![RunRequest::Start, RunRequest::Start, RunRequest::Stop, RunRequest::Reset, RunRequest::Trip]
        )
            .prop_map(Act::Ask),
        2 => Just(Act::Switch),
        1 => Just(Act::Engage),
    ]
}

/// Runs a drive through it all.
fn attack<N: Wired>(acts: &[Act]) -> Result<(), TestCaseError> {
    let [torque_unit, speed_unit] = N::UNIT;
    let configs: [ConfigOf<Attacked<N>>; 2] = N::governors(20.0 * TORQUE).map(|governor| Config {
        limits: N::limits(),
        observer: N::observer(),
        fluctuation: (),
        governor,
        balancer: (),
    });
    // A unit in the last place of what the words hold.
    let most = N::of(TORQUE * (1.0 + 1e-6) / torque_unit);
    let screened = N::of(SCREENING.torque * (1.0 + 1e-6) / torque_unit);
    let setpoint = N::of(SPEED / speed_unit);
    let mut drive = Attacked::<N>::new(&configs[0], 0);
    let (mut chosen, mut angle, mut last) = (0, 0_u32, N::ZERO);
    for act in acts {
        let (ticks, turn) = match *act {
            Act::Turns(ticks, turn) => (usize::from(ticks), turn),
            Act::Words(ticks, ..) | Act::Blind(ticks, ..) => (usize::from(ticks), 0),
            Act::Hold(_) => (1, 0),
            Act::Ask(request) => {
                let modes = drive.governor_mut().sequence_mut();
                let before = modes.state();
                modes.request(request);
                if matches!(before, RunState::Tripped(_)) && request != RunRequest::Reset {
                    prop_assert_eq!(modes.state(), before);
                }
                continue;
            }
            Act::Switch => {
                let estimate = drive.estimate(&configs[chosen]);
                let to = 1 - chosen;
                drive.governor_mut().switch(&configs[chosen].governor, &configs[to].governor, &estimate);
                chosen = to;
                continue;
            }
            Act::Engage => {
                drive.engage(&configs[chosen]);
                continue;
            }
        };
        let config = &configs[chosen];
        for _ in 0..ticks {
            let before = drive.governor().sequence().state();
            let command = match *act {
                Act::Words(_, off, torque, setpoint) => {
                    angle = angle.wrapping_add(off);
                    let (torque, setpoint) = (N::from_word(torque), N::from_word(setpoint));
                    drive.tick(config, &Sample { angle, torque, setpoint })
                }
                Act::Blind(_, torque, setpoint) => drive.coast(config, N::from_word(torque), N::from_word(setpoint)),
                Act::Hold(torque) => drive.hold(config, angle, N::from_word(torque)),
                _ => {
                    angle = angle.wrapping_add_signed(turn);
                    drive.tick(config, &Sample { angle, torque: last, setpoint })
                }
            };
            last = command.torque;
            let allowed = if matches!(act, Act::Hold(_)) { screened } else { most };
            // What exceeds is too much or no number.
            prop_assert!(!last.exceeds(allowed), "{:?}: {:?}", act, last);
            let mode = drive.governor().sequence().state();
            if matches!(before, RunState::Tripped(_)) {
                prop_assert_eq!(mode, before);
            }
            if matches!(mode, RunState::Stopped | RunState::Tripped(_)) {
                prop_assert_eq!(last, N::ZERO);
            }
            let estimate = drive.estimate(config);
            for value in [estimate.motor_speed, estimate.shaft_torque, estimate.load_speed, estimate.load_torque] {
                prop_assert!(value.to_real().is_finite(), "{estimate:?}");
            }
            prop_assert!(drive.governor().integral().to_real().is_finite());
        }
    }
    // Whatever it went through, it can be started again and governs: towards its setpoint, within a second.
    drive.governor_mut().sequence_mut().request(RunRequest::Stop);
    drive.governor_mut().sequence_mut().request(RunRequest::Reset);
    for _ in 0..2000 {
        angle = angle.wrapping_add(100_000);
        last = drive.tick(&configs[chosen], &Sample { angle, torque: N::ZERO, setpoint }).torque;
    }
    let modes = drive.governor_mut().sequence_mut();
    modes.request(RunRequest::Reset);
    modes.request(RunRequest::Start);
    for _ in 0..2000 {
        angle = angle.wrapping_add(100_000);
        last = drive.tick(&configs[chosen], &Sample { angle, torque: last, setpoint }).torque;
    }
    prop_assert!(last > N::ZERO, "{last:?} {:?}", drive.governor().sequence());
    Ok(())
}

/// Runs a generator set's scene through words: torque between nothing and the curve, modes as they must be.
fn besiege(kind: Kind, words: Words, acts: &[Act]) -> Result<(), TestCaseError> {
    let units = Units::new(words, kind.constants().bases());
    let rated = kind.constants().rated_torque;
    let number = if words == Words::Single { "f32" } else { "fixed" };
    let mut scene = find(&format!("generator/{number}/{}/2400", kind.name())).unwrap().start();
    let mut input = Input { setpoint: units.speed_word(RATED_SPEED), flags: Input::RELEASED, ..Input::default() };
    for act in acts {
        let (ticks, turn) = match *act {
            Act::Turns(ticks, turn) => (usize::from(ticks), turn as u32),
            Act::Words(ticks, off, torque, setpoint) => {
                (input.torque, input.setpoint) = (torque, setpoint);
                (usize::from(ticks), off)
            }
            Act::Ask(RunRequest::Trip) => {
                scene.panel([panel::TRIP, 0]);
                continue;
            }
            Act::Ask(request) => {
                input.flags = if request == RunRequest::Start { Input::RELEASED } else { 0 };
                (1, 0)
            }
            Act::Switch => {
                scene.panel([panel::CONSTANTS, input.angle % 4]);
                continue;
            }
            Act::Hold(_) | Act::Blind(..) | Act::Engage => continue,
        };
        for _ in 0..ticks {
            let before = scene.panel([panel::MODE, 0]);
            input.angle = input.angle.wrapping_add(turn);
            let output = scene.tick(&input);
            let torque = units.torque(output.torque) / rated;
            prop_assert!((0.0..=MOST).contains(&torque), "{act:?}: {torque}");
            let mode = scene.panel([panel::MODE, 0]);
            // The run switch taken back resets; else the trip stands.
            if before >= 16 && input.flags != 0 {
                prop_assert_eq!(mode, before);
            }
            if mode == 0 || mode >= 16 {
                prop_assert_eq!(torque, 0.0);
            }
            if matches!(act, Act::Turns(..)) {
                (input.torque, input.setpoint) = (output.torque, units.speed_word(RATED_SPEED));
            }
        }
    }
    Ok(())
}

/// What is changed between two ticks of a machine that turns steadily.
#[derive(Clone, Copy, Debug)]
enum Change {
    Setpoint(f64),
    Ask(RunRequest),
    Switch,
    Nothing,
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        2 => (130.0..170.0_f64).prop_map(Change::Setpoint),
        1 => prop::sample::select(vec![RunRequest::Start, RunRequest::Stop]).prop_map(Change::Ask),
        1 => Just(Change::Switch),
        2 => Just(Change::Nothing),
    ]
}

/// The torque from tick to tick while setpoint, mode and constants change, with a load whose torque swings by more than
/// the rated one in every firing interval.
fn steady<N: Wired>(changes: &[(Change, u8)]) -> Result<(), TestCaseError> {
    let [torque_unit, speed_unit] = N::UNIT;
    // A slew that hides nothing, twice the rated torque in a tick.
    let configs = N::governors(4e3 * TORQUE);
    let mut governor = <StateOf<Whole, N>>::default();
    let (mut chosen, mut setpoint, mut tick) = (0, 150.0, 0_u32);
    let mut last = 0.0;
    let mut run = |governor: &mut StateOf<Whole, N>, chosen: usize, setpoint: f64| {
        let swing = 1500.0 * (f64::from(tick) / 32.0 * core::f64::consts::TAU).sin();
        tick += 1;
        let now = Estimate {
            motor_speed: N::of(150.0 / speed_unit),
            shaft_torque: N::of(800.0 / torque_unit),
            load_speed: N::of(150.0 / speed_unit),
            load_torque: N::of((800.0 + swing) / torque_unit),
        };
        governor.set_setpoint(N::of(setpoint / speed_unit));
        let torque = governor.command(&configs[chosen], &now);
        (torque.to_real() * torque_unit, now)
    };
    // The mean fills while it is stopped.
    for _ in 0..64 {
        prop_assert_eq!(run(&mut governor, chosen, setpoint).0, 0.0);
    }
    let mut now = run(&mut governor, chosen, setpoint).1;
    governor.sequence_mut().request(RunRequest::Start);
    for &(change, ticks) in changes {
        match change {
            Change::Setpoint(to) => setpoint = to,
            Change::Ask(request) => {
                governor.sequence_mut().request(request);
            }
            Change::Switch => {
                let to = 1 - chosen;
                governor.switch(&configs[chosen], &configs[to], &now);
                chosen = to;
            }
            Change::Nothing => {}
        }
        for _ in 0..ticks {
            let error = (governor.ramped_setpoint().to_real() * speed_unit - 150.0).abs() + 10.0;
            let (torque, seen) = run(&mut governor, chosen, setpoint);
            now = seen;
            // A tick's ramp, 0.02 rad/s, at k_p, and the integral's tick on the error, whose ten more are the droop's:
            // the ramp of the setpoint. Twice, for a change of constants makes one of each; and what f32 loses of
            // the mean's sum of 150 rad/s in 32 additions, at k_p.
            let bound = 2.0 * (FED.proportional * (RAMP * PERIOD + 3e-4) + FED.integral * PERIOD * error);
            prop_assert!((torque - last).abs() < bound, "{change:?}: {last} to {torque}, {bound}");
            last = torque;
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn no_words_and_no_requests_break_a_drive(acts in prop::collection::vec(act(), 1..60)) {
        attack::<f32>(&acts)?;
        attack::<Fixed>(&acts)?;
    }

    #[test]
    fn no_words_and_no_switches_break_a_generator_set(acts in prop::collection::vec(act(), 1..60)) {
        besiege(Kind::Diesel, Words::Single, &acts)?;
        besiege(Kind::Diesel, Words::Fixed, &acts)?;
        besiege(Kind::Turbine, Words::Single, &acts)?;
        besiege(Kind::Turbine, Words::Fixed, &acts)?;
    }

    #[test]
    fn nothing_jolts(changes in prop::collection::vec((change(), 1..40_u8), 1..30)) {
        steady::<f32>(&changes)?;
        steady::<Fixed>(&changes)?;
    }
}
