//! Listings, and what a beginner writes wrong in them.

/// Where the compiler points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// At a line of the user.
    Line,
    /// At the library; the message names the machine.
    Machine,
}
use Shown::{Line, Machine};

/// A listing with one line changed.
pub struct Case {
    pub name: &'static str,
    pub listing: &'static str,
    pub right: &'static str,
    pub wrong: &'static str,
    /// What the message must contain.
    pub phrase: &'static str,
    pub shown: Shown,
}

/// The drive of the README.
pub const ROLL: &str = "use driveline::prelude::*;
struct Roll;
impl Machine for Roll {
    const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
    const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
}
type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
fn main() {
    let mut drive = RollDrive::new(&CONFIG, 0);
    let command = drive.tick(&CONFIG, &Sample::si::<Roll>(0, 0.0, 100.0));
    assert!(command.faults.is_none());
}
";

/// The same behind a gear.
pub const GEARED: &str = "use driveline::{observer::GearedObserver, prelude::*};
struct Roll;
impl Machine for Roll {
    const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.05))
        .gear(Ratio(5.0), Efficiency(0.97)).shaft(Stiffness(9.0e4), Damping(10.0)).rotor(Inertia(12.0));
    const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
}
type RollDrive = Drive<f32, GearedObserver<TwoMassObserver>, SpeedLoop>;
static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
fn main() {
    RollDrive::new(&CONFIG, 0);
}
";

/// A generator set.
pub const SET: &str = "use driveline::{configure::*, design::*, governor::*, prelude::*};
struct Set;
impl Machine for Set {
    const CHAIN: Chain = Chain::motor(Inertia(4.4)).shaft(Stiffness(5.0e4), Damping(66.0)).rotor(Inertia(8.0));
    const RATING: Rating = Rating { torque: Torque(2546.0), speed: Speed::rpm(1500.0), torque_limit: Torque(3055.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 2_400;
    const ACTUATOR: Actuator = Actuator { delay: Actuator::firing_delay(6, true, 157.08), lag: 0.02 };
    const GAINS: GainSource = GainSource::governor::<Self>(2.5, FED);
}
const FED: LoadFeedForward = LoadFeedForward { share: 0.9, lag: 0.018 };
impl HasActuator<1> for Set { const LAGS: [f64; 1] = [0.02]; const TORQUE_DELAY: f64 = 0.0065; }
type Governed = SpeedGovernor<Droop, FeedForward, TorqueRange, Sequencer, MovingAverage<32>>;
type SetDrive = Actuated<Drive<f32, TwoMassObserver, Governed>, 1, 32>;
static CONFIG: ConfigOf<SetDrive> = SetDrive::configure::<Set>();
fn main() {
    SetDrive::new(&CONFIG, 0);
}
";

macro_rules! cases {
    ($($listing:ident: $name:ident, $right:expr => $wrong:expr, $phrase:expr, $shown:ident;)+) => {
        &[$(Case {
            name: stringify!($name),
            listing: $listing,
            right: $right,
            wrong: $wrong,
            phrase: $phrase,
            shown: $shown,
        }),+]
    };
}

pub const CASES: &[Case] = cases! {
    ROLL: speed_in_rpm, "Speed(150.0)" => "Speed(1480.0)", "write r/min as `Speed::rpm(1480.0)`", Line;
    ROLL: limit_below_rated, "Torque(550.0)" => "Torque(250.0)", "250 N m where `torque` is 300 N m", Line;
    ROLL: no_torque, "torque: Torque(300.0)" => "torque: Torque(0.0)", "RATING: `torque` must be positive", Line;
    ROLL: torque_in_kilo, "torque: Torque(300.0)" => "torque: Torque(0.3)", "`torque` in N m", Line;
    ROLL: stiffness_per_degree, "Stiffness(2.0e4)" => "Stiffness(349.0)", "0.86 rad under rated torque", Line;
    GEARED: stiffness_per_degree_behind, "Stiffness(9.0e4)" => "Stiffness(1571.0)", "1 N m/degree is 57.3 N m/rad", Line;
    ROLL: stiffness_in_mega, "Stiffness(2.0e4)" => "Stiffness(2.0e10)", "ticks a second, more than", Line;
    ROLL: damping_negative, "Damping(0.5)" => "Damping(-0.5)", "CHAIN: damping of the shaft must be zero or positive", Line;
    ROLL: inertia_in_gcm2, "Inertia(0.35)" => "Inertia(3.5e6)", "1 g cm2 is 1e-7 kg m2", Line;
    ROLL: inertia_in_kgcm2, "Inertia(0.48)" => "Inertia(4800.0)", "1 kg cm2 is 1e-4", Line;
    ROLL: inertia_missing, "Inertia(0.48)" => "Inertia(0.0)", "CHAIN: inertia of the rotor must be positive", Line;
    ROLL: no_rotor, ".rotor(Inertia(0.48))" => "", "CHAIN: a chain must end in a rotor or a mass", Line;
    ROLL: no_shaft, ".shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48))" => "", "it is a rigid machine", Machine;
    GEARED: loss_without_gear, ".gear(Ratio(5.0), Efficiency(0.97))" => "", "needs a gear with losses: add `.gear(", Line;
    GEARED: ratio_inverted, "Ratio(5.0)" => "Ratio(0.2)", "`Ratio` as motor turns per turn of the load", Line;
    GEARED: efficiency_in_percent, "Efficiency(0.97)" => "Efficiency(97.0)", "above 0 and at most 1", Line;
    GEARED: loss_for_efficiency, "Efficiency(0.97)" => "Efficiency(0.03)", "a loss of 3 % is `Efficiency(0.97)`", Line;
    ROLL: rate_in_khz, "u32 = 10_000" => "u32 = 10", "RATE_HZ: 10 ticks a second, more than", Line;
    ROLL: rate_too_low, "u32 = 10_000" => "u32 = 90", "take a higher rate, or the observer of one mass", Line;
    ROLL: rate_zero, "u32 = 10_000" => "u32 = 0", "the sample rate must be positive", Machine;
    ROLL: period_for_rate, "RATE_HZ: u32 = 10_000" => "RATE_HZ: f64 = 1.0e-4", "expected `u32`, found `f64`", Line;
    ROLL: bits_for_lines, "Encoder::lines(2048)" => "Encoder::lines(12)", "`Encoder::counts(1 << 12)`", Line;
    ROLL: no_lines, "Encoder::lines(2048)" => "Encoder::lines(0)", "ENCODER: the encoder must have at least one line", Line;
    ROLL: lines_as_float, "Encoder::lines(2048)" => "Encoder::lines(2048.0)", "expected `u32`, found floating-point", Line;
    ROLL: encoder_as_number, "Encoder::lines(2048)" => "2048", "expected `Encoder`, found integer", Line;
    ROLL: constant_missing, "    const ENCODER: Encoder = Encoder::lines(2048);\n" => "", "missing: `ENCODER`", Line;
    ROLL: field_missing, ", torque_limit: Torque(550.0)" => "", "missing field `torque_limit`", Line;
    ROLL: speed_without_unit, "speed: Speed(150.0)" => "speed: 150.0", "driveline::machine::Speed(150.0)", Line;
    ROLL: torque_for_speed, "speed: Speed(150.0)" => "speed: Torque(150.0)", "expected `Speed`, found `Torque`", Line;
    ROLL: arguments_swapped, "Stiffness(2.0e4), Damping(0.5)" => "Damping(0.5), Stiffness(2.0e4)", "swap these arguments", Line;
    ROLL: parts_swapped, "TwoMassObserver, SpeedLoop" => "SpeedLoop, TwoMassObserver", "the order is `Drive<Number, Observer", Line;
    ROLL: number_last, "f32, TwoMassObserver, SpeedLoop" => "TwoMassObserver, SpeedLoop, f32", "the number comes first", Line;
    ROLL: number_missing, "Drive<f32, " => "Drive<", "the number comes first", Line;
    ROLL: number_twice, "TwoMassObserver, " => "TwoMassObserver<Fixed>, ", "name the number once", Line;
    ROLL: number_unknown, "Drive<f32, " => "Drive<i32, ", "`f32`, `f64` or `Fixed`", Line;
    ROLL: import_missing, "use driveline::prelude::*;" => "", "cannot find trait `Machine`", Line;
    ROLL: import_wrong, "prelude::*" => "Drive", "no `Drive` in the root", Line;
    ROLL: sample_in_f64, "0, 0.0, 100.0" => "0, 0.0_f64, 100.0", "expected `f32`, found `f64`", Line;
    ROLL: angle_in_turns, "(0, 0.0, 100.0)" => "(0.5, 0.0, 100.0)", "expected `u32`, found floating-point", Line;
    ROLL: machine_missing, "Sample::si::<Roll>" => "Sample::si", "cannot infer type of the type parameter `M`", Line;
    ROLL: constants_moved, "tick(&CONFIG" => "tick(CONFIG", "consider borrowing here", Line;
    ROLL: constants_missing, "tick(&CONFIG, " => "tick(", "provide the argument", Line;
    ROLL: drive_for_machine, "configure::<Roll>" => "configure::<RollDrive>", "is no machine", Line;
    ROLL: not_mutable, "let mut drive" => "let drive", "consider changing this to be mutable", Line;
    GEARED: part_without_constants, "TwoMassObserver>, SpeedLoop" => "TwoMassObserver>, driveline::governor::SpeedGovernor<driveline::governor::Barred<1>>", "HasBarredSpeeds", Line;
    SET: actuator_not_allowed_for, "[0.02]" => "[0.2]", "give ACTUATOR at least their sum", Line;
    SET: no_run_sequence, "TorqueRange, Sequencer" => "TorqueRange, ()", "has no run sequence", Line;
    SET: trait_missing, "TorqueRange" => "Curve<3>", "HasTorqueCurve", Line;
    SET: ring_too_short, "1, 32>;\nstatic" => "1, 8>;\nstatic", "needs a RING of more than 15.6 ticks", Line;
};

/// Remedies that the messages name, by case.
pub const REMEDIES: &[(&str, &str, &str, &str)] = &[
    ("speed_in_rpm", ROLL, "Speed(150.0)", "Speed::rpm(1480.0)"),
    ("stiffness_per_degree", ROLL, "Stiffness(2.0e4)", "Stiffness(349.0 * 57.3)"),
    ("soft_coupling", ROLL, "    const RATE_HZ", "    const SHAFT_TWIST: f64 = 1.0;\n    const RATE_HZ"),
    ("inertia_in_kgcm2", ROLL, "Inertia(0.48)", "Inertia(4800.0 * 1e-4)"),
    ("bits_for_lines", ROLL, "Encoder::lines(2048)", "Encoder::counts(1 << 12)"),
    ("rate_too_low", ROLL, "u32 = 10_000", "u32 = 4_000"),
    ("loss_without_gear", GEARED, "TwoMassObserver>, ", "TwoMassObserver>, "),
    ("number_last", ROLL, "f32, TwoMassObserver", "Fixed, TwoMassObserver"),
];

/// Constants of a design, without a drive.
pub const CONSTANTS: &[(&str, &str, &str)] = &[
    (
        "negative_inertia",
        "use driveline::machine::*;
        const M: TwoMass = Chain::motor(Inertia(0.62)).shaft(Stiffness(5.0e4), Damping(2.0)).rotor(Inertia(-0.08))
            .reduce(Match::ResonanceAntiresonance);
        fn main() { let _ = M; }",
        driveline::machine::Error::RotorInertia.message(),
    ),
    (
        "unobservable_pair",
        "use driveline::{design::*, machine::*};
        const O: TwoMassDesign = TwoMass::new(Inertia(0.6), Inertia(0.1), Stiffness(0.0), Damping(0.0)).observer(
            Rate::hz(10_000),
            Encoder::lines(2048),
            Disturbance { torque_accuracy: 0.5, load_torque_step: 50.0, within: 0.05 },
        );
        fn main() { let _ = O; }",
        driveline::design::Error::Unobservable.message(),
    ),
    (
        "fragile_loop",
        "use driveline::{design::SpeedLoopTuning, prelude::*};
        struct Mill;
        impl Machine for Mill {
            const CHAIN: Chain = Chain::motor(Inertia(3.0)).shaft(Stiffness(4.0e3), Damping(2.0)).rotor(Inertia(4.0));
            const RATING: Rating = Rating { torque: Torque(400.0), speed: Speed(100.0), torque_limit: Torque(800.0) };
            const ENCODER: Encoder = Encoder::lines(2048);
            const RATE_HZ: u32 = 4_000;
            const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.4, damping: 1.0, shaft_damping: 0.9 };
        }
        type MillDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
        static CONFIG: ConfigOf<MillDrive> = MillDrive::configure::<Mill>();
        fn main() { MillDrive::new(&CONFIG, 0); }",
        driveline::design::Error::LoopGain.message(),
    ),
    (
        "too_few_ticks",
        "use driveline::{fluctuation::Extremes, prelude::*};
        struct Fan;
        impl Machine for Fan {
            const CHAIN: Chain = Chain::motor(Inertia(0.2)).shaft(Stiffness(2.0e3), Damping(0.0)).rotor(Inertia(0.5));
            const RATING: Rating = Rating { torque: Torque(70.0), speed: Speed(150.0), torque_limit: Torque(110.0) };
            const ENCODER: Encoder = Encoder::lines(2048);
            const RATE_HZ: u32 = 2_000;
        }
        type FanDrive = Drive<f32, TwoMassObserver, SpeedLoop, Extremes>;
        static CONFIG: ConfigOf<FanDrive> = FanDrive::configure::<Fan>();
        fn main() { FanDrive::new(&CONFIG, 0); }",
        // 2,000 Hz over 150 rad/s: 83.8 ticks a turn
        "RATE_HZ: 83.8 ticks a turn, 96 needed",
    ),
];
