//! Five machines and one more, as a drive is told of them and as they are.

use driveline::configure::{Machine, Rating};
use driveline::design::{
    Disturbance, Encoder, LoadStep, SpeedLoopDesign, SpeedLoopTuning, Spread, StepChoice, Tolerance, TwoMassDesign,
    Undescribed,
};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Inertia, Length, LinearDamping, Mass, Ratio, Speed, Stiffness, Torque,
};
use driveline::settings::Screening;

use crate::plant::Plant;

/// What a machine does before it fails.
#[derive(Clone, Copy, Debug)]
pub struct Duty {
    pub name: &'static str,
    /// Load torque at standstill, held by the motor, and at speed (N m).
    pub held: f64,
    pub load: f64,
    /// When the load begins and how fast it rises, behind the release (s).
    pub loads: f64,
    pub rise: f64,
    /// When it fails, behind the release (s).
    pub fails: f64,
    /// Setpoint (rad/s).
    pub speed: f64,
    /// Whether the weakest shaft is a rope.
    pub rope: bool,
    /// The mass that jams.
    pub jam: usize,
}

impl Duty {
    /// Of a machine that holds nothing and whose load, which jams, is behind one shaft.
    const TURNING: Duty =
        Duty { name: "", held: 0.0, load: 0.0, loads: 0.0, rise: 0.0, fails: 0.0, speed: 0.0, rope: false, jam: 1 };

    /// Load torque at a time behind the release, in ticks of `period` (s).
    pub fn load_at(&self, time: f64, period: f64) -> f64 {
        let risen = ((time - self.loads) / self.rise.max(period)).clamp(0.0, 1.0);
        self.held + (self.load - self.held) * risen
    }
}

/// A machine that a test can run.
pub trait Tested: Machine {
    const DUTY: Duty;
    /// Inertia of the last mass as it may be.
    const DRAWN_LOAD: Spread = Self::TOLERANCE.load_inertia;

    /// Masses and shafts as they are; the shaft that breaks is the softest.
    fn plant() -> Plant {
        let chain = Self::CHAIN;
        let shafts: Vec<[f64; 2]> = chain.shafts().iter().map(|shaft| [shaft.stiffness, shaft.damping]).collect();
        Plant::new(chain.masses(), &shafts, Self::RATING.speed.0)
    }
}

/// 12 t on two falls of 12 m.
pub struct Hoist;

impl Machine for Hoist {
    const CHAIN: Chain = Chain::motor(Inertia(0.62))
        .shaft(Stiffness(5.0e4), Damping(2.0))
        .rotor(Inertia(0.08))
        .gear(Ratio(31.5), Efficiency(1.0))
        .drum(Diameter(0.8))
        .damped_rope(Falls(2), Stiffness(2.9e6), LinearDamping(3.6e3))
        .lifted(Mass(12_000.0));
    const RATING: Rating = Rating { torque: Torque(750.0), speed: Speed(155.0), torque_limit: Torque(1_350.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 300.0, within: 50.0, ..Self::RATING.disturbance() }.torque_over(
            60.0,
            1e-4,
            Self::RATE,
        );
    const OBSERVER: TwoMassDesign =
        Self::TWO_MASS.observer(Self::RATE, Self::ENCODER, Self::DISTURBANCE).with_step(StepChoice::SemiImplicit);
    const TUNING: SpeedLoopTuning = SpeedLoopTuning::USUAL;
    const TOLERANCE: Tolerance = Tolerance {
        load_inertia: Spread::between(0.5 / 12.0, 13.0 / 12.0),
        stiffness: Spread::between(12.0 / 30.0, 12.0 / 5.0),
        torque: Spread::within(0.03),
        ..Tolerance::USUAL
    };
    const RAMP: f64 = Self::RATING.speed.0 / 2.0;
    /// A load is picked up at creep speed.
    const LOAD_STEP: LoadStep = LoadStep { torque: 0.2 * Self::RATING.torque.0, rise: 0.2 };
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

impl Tested for Hoist {
    const DRAWN_LOAD: Spread = Spread::between(0.5, 1.08);
    const DUTY: Duty =
        Duty { name: "hoist", held: 747.0, load: 747.0, fails: 3.5, speed: 155.0, rope: true, jam: 2, ..Duty::TURNING };
}

/// A crane's travelling drive with a swinging load.
pub struct Crane;

impl Machine for Crane {
    const CHAIN: Chain = Chain::motor(Inertia(0.2))
        .gear(Ratio(30.0), Efficiency(1.0))
        .drum(Diameter(0.5))
        .driven(Mass(25_000.0))
        .swinging(Mass(15_000.0), Length(10.0));
    const RATING: Rating = Rating { torque: Torque(147.0), speed: Speed(150.0), torque_limit: Torque(290.0) };
    const ENCODER: Encoder = Encoder::lines(1024);
    const RATE_HZ: u32 = 1_000;
    const DISTURBANCE: Disturbance = Disturbance {
        torque_accuracy: 0.03 * Self::RATING.torque.0,
        load_torque_step: 0.05 * Self::RATING.torque.0,
        within: 100.0,
    };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.5, damping: 1.0, shaft_damping: 0.25 };
    /// The drive shaft is that of the plant: it is far stiffer than this active damping would excite.
    const TOLERANCE: Tolerance = Tolerance { undescribed: Undescribed::NONE, ..Tolerance::USUAL };
    const RAMP: f64 = Self::RATING.speed.0 / 6.0;
    const LOAD_STEP: LoadStep = LoadStep { torque: 0.2 * Self::RATING.torque.0, rise: 0.0 };
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

impl Tested for Crane {
    /// Motor, bridge and load, with 30 Hz of the motor against the wheels.
    fn plant() -> Plant {
        let travel = 0.25_f64 / 30.0;
        let (bridge, load) = (25_000.0 * travel * travel, 15_000.0 * travel * travel);
        let pendulum = 15_000.0 * 9.80665 / 10.0 * travel * travel;
        let shaft = 0.18 * (core::f64::consts::TAU * 30.0_f64).powi(2);
        let mut plant = Plant::new(
            &[0.2, bridge, load],
            &[[shaft, 0.1 * 0.18 * core::f64::consts::TAU * 30.0], [pendulum, 0.0]],
            150.0,
        );
        plant.weak = 0;
        plant
    }

    const DUTY: Duty = Duty { name: "crane", load: 30.0, rise: 0.5, fails: 4.0, speed: 150.0, ..Duty::TURNING };
}

/// A strip mill's stand.
pub struct Mill;

impl Machine for Mill {
    const CHAIN: Chain = Chain::motor(Inertia(3000.0))
        .shaft(Stiffness(6.0e7), Damping(1.0e4))
        .rotor(Inertia(300.0))
        .shaft(Stiffness(5.0e7), Damping(1.0e4))
        .rotor(Inertia(400.0))
        .shaft(Stiffness(6.0e6), Damping(4.0e3))
        .rotor(Inertia(2500.0));
    const RATING: Rating = Rating { torque: Torque(2.0e5), speed: Speed(12.0), torque_limit: Torque(4.0e5) };
    const ENCODER: Encoder = Encoder::lines(262_144);
    const RATE_HZ: u32 = 10_000;
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.05 };
    const SPEED_LOOP: SpeedLoopDesign = Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING);
    /// Without the lag of its damping the loop has less; it is a plant for the supervision.
    const ROBUSTNESS: driveline::design::Robustness = driveline::design::Robustness { gain: 1.0, phase: 0.0 };
    const RAMP: f64 = Self::RATING.speed.0 / 3.0;
    /// A strip is bitten within 50 ms.
    const LOAD_STEP: LoadStep = LoadStep { torque: 0.7 * Self::RATING.torque.0, rise: 0.05 };
    const SCREENING: Screening = Screening {
        innovation: core::f64::consts::TAU / 512.0,
        max_coast: Self::RATE_HZ / 5,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

impl Tested for Mill {
    const DUTY: Duty = Duty {
        name: "strip mill",
        load: 1.4e5,
        loads: 3.5,
        rise: 0.05,
        fails: 5.0,
        speed: 12.0,
        jam: 3,
        ..Duty::TURNING
    };
}

/// A machine tool's spindle.
pub struct Spindle;

impl Machine for Spindle {
    const CHAIN: Chain = Chain::motor(Inertia(0.012)).shaft(Stiffness(7.6e4), Damping(0.3)).rotor(Inertia(0.004));
    const RATING: Rating = Rating { torque: Torque(70.0), speed: Speed(314.0), torque_limit: Torque(110.0) };
    const ENCODER: Encoder = Encoder::lines(131_072).interpolation(512, 0.005).jitter(0.1e-6, Self::RATING.speed.0);
    const RATE_HZ: u32 = 10_000;
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 1.5 * Self::RATING.torque.0, ..Self::RATING.disturbance() };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.02, damping: 1.0, shaft_damping: 0.006 };
    const TOLERANCE: Tolerance = Tolerance { damping: Spread::between(0.3, 2.0), ..Tolerance::USUAL };
    const RAMP: f64 = 2.0 * Self::RATING.speed.0;
    /// The tool meets the work within 3 ms.
    const LOAD_STEP: LoadStep = LoadStep { torque: 0.66 * Self::RATING.torque.0, rise: 0.003 };
    const SCREENING: Screening = Screening {
        innovation: core::f64::consts::TAU / 256.0,
        max_coast: Self::RATE_HZ / 167,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

impl Tested for Spindle {
    const DUTY: Duty =
        Duty { name: "spindle", load: 45.0, loads: 0.8, rise: 0.003, fails: 1.2, speed: 314.0, ..Duty::TURNING };
}

/// A generator set of 400 kW.
pub struct Set;

impl Machine for Set {
    const CHAIN: Chain = Chain::motor(Inertia(4.4)).shaft(Stiffness(5.0e4), Damping(66.0)).rotor(Inertia(8.0));
    const RATING: Rating = Rating { torque: Torque(2546.0), speed: Speed(157.08), torque_limit: Torque(3055.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 2_400;
    const DISTURBANCE: Disturbance = Disturbance { torque_accuracy: 25.0, load_torque_step: 1273.0, within: 1.0 };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.05 };
    const RAMP: f64 = 0.25 * Self::RATING.speed.0;
}

impl Tested for Set {
    const DUTY: Duty =
        Duty { name: "generator set", load: 2000.0, loads: 5.0, fails: 7.0, speed: 157.08, ..Duty::TURNING };
}

/// A winder of paper: a soft belt between motor and reel, a web that runs on.
pub struct Winder;

impl Machine for Winder {
    const CHAIN: Chain = Chain::motor(Inertia(0.05)).shaft(Stiffness(900.0), Damping(0.4)).rotor(Inertia(0.3));
    const RATING: Rating = Rating { torque: Torque(60.0), speed: Speed(120.0), torque_limit: Torque(120.0) };
    const ENCODER: Encoder = Encoder::lines(2500);
    const RATE_HZ: u32 = 4_000;
    /// The web's tension changes by a fifth of rated torque within a tenth of a second.
    const LOAD_STEP: LoadStep = LoadStep { torque: 0.2 * Self::RATING.torque.0, rise: 0.1 };
}

impl Tested for Winder {
    const DUTY: Duty =
        Duty { name: "winder", load: 50.0, loads: 3.0, rise: 0.5, fails: 5.0, speed: 120.0, ..Duty::TURNING };
}
