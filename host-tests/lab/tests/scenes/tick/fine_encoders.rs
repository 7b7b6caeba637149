//! Fixed point with encoders of 17, 20 and 24 bits against `f32`: the same recordings of the full solver, whose torque
//! and load wander as the design assumes.

use core::f64::consts::TAU;

use cargo_driveline::replay::OfReal;
use driveline::configure::{Machine as _, Rating};
use driveline::design::{Encoder, Rate, RigidDesign, SpeedLoopTuning, StepChoice, TwoMassDesign};
use driveline::machine::{Chain, Damping, Inertia, Match, Speed, Stiffness, Torque};
use driveline::number::{Fixed, Number};
use driveline::observer::{
    GearedConfig, GearedObserver, Observer, RigidConfig, RigidObserver, SemiImplicitConfig, SemiImplicitObserver,
    TwoMassConfig, TwoMassObserver,
};
use driveline::settings::{Bases, Error, Gear};
use driveline_firmware::scenes::hoist::Hoist;
use driveline_firmware::scenes::spindle::Spindle;
use driveline_solver::noise::Noise;
use driveline_solver::plant::{self, Shaft};

/// Efficiency of the gear where there is one, that of the hoist.
const EFFICIENCY: f64 = 0.94;

/// What fixed point may be worse by than `f32`: it resolves a turn to 2^-27, an eighth of a count of 24 bits.
const WORSE: f64 = 1.1;

/// Ticks a second.
const RATES: [u32; 4] = [250, 1_000, 4_000, 10_000];

/// A machine with its drive's figures.
struct Case {
    name: String,
    rating: Rating,
    design: Option<TwoMassDesign>,
    rigid: RigidDesign,
    load_share: f64,
    gear: Gear,
    bases: Bases,
    bits: u32,
    /// Inertias, stiffness and damping.
    two: [f64; 4],
}

impl Case {
    fn new(name: &str, chain: Chain, rating: Rating, rate: u32, bits: u32, efficiency: f64) -> Self {
        let name = format!("{name}, {rate} Hz, {bits} bits, efficiency {efficiency}");
        let two = chain.reduce(Match::ResonanceAntiresonance);
        let (hz, encoder, disturbance) = (Rate::hz(rate), Encoder::counts(1 << bits), rating.disturbance());
        let design = two.try_observer(hz, encoder, disturbance).ok();
        let rigid = chain.rigid().observer(hz, encoder, disturbance);
        let count = encoder.resolution().unwrap();
        let gear = Gear { efficiency, inertia: two.motor_inertia, deadband: 8.0 * count };
        // A gentle loop, as the spindle's scene has it: the bases must hold it, and it is not run.
        let speed_loop = two.speed_loop(hz, SpeedLoopTuning { bandwidth: 0.02, damping: 1.0, shaft_damping: 0.006 });
        let bases = match &design {
            Some(design) => rating.bases(design, &rigid, &gear, &speed_loop),
            None => rating.rigid_bases(&rigid, &gear, &speed_loop),
        };
        let load_share = two.load_inertia / two.total_inertia();
        let two = [two.motor_inertia, two.load_inertia, two.stiffness, two.damping];
        Case { name, rating, design, rigid, load_share, gear, bases, bits, two }
    }

    fn period(&self) -> f64 {
        self.rigid.period
    }

    /// Constants that the bases must hold.
    #[track_caller]
    fn fits<C>(&self, constants: Result<C, Error>) -> C {
        constants.unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }

    /// Two seconds of the machine: to nine tenths of rated speed in 0.8 s, then steady.
    fn record(&self) -> Vec<Tick> {
        let [motor, load, stiffness, damping] = self.two;
        let shaft = Shaft::elastic(stiffness).damping(damping);
        let chain = plant::Chain::motor(motor).efficiency(self.gear.efficiency).shaft(shaft, load);
        let mut plant = chain.build().unwrap();
        let (rating, period) = (&self.rating, self.period());
        let disturbance = rating.disturbance();
        let step = disturbance.load_torque_variance(period).unwrap().sqrt();
        let (mut noise, mut load_torque, mut applied) = (Noise::new(1), 0.4 * rating.torque.0, 0.0);
        let counts = f64::from(1_u32 << self.bits);
        (0..(2.0 / period) as u32)
            .map(|k| {
                load_torque += step * noise.normal();
                plant.set_load_torque(1, load_torque);
                let count = (plant.motor_angle() / TAU * counts).floor() as i64;
                let truth = [plant.shaft_torque(0), plant.speed(1), load_torque];
                let tick = Tick { angle: (count << (32 - self.bits)) as u32, torque: applied, truth };
                let mean = (motor * plant.speed(0) + load * plant.speed(1)) / (motor + load);
                let setpoint = 0.9 * rating.speed.0 * (f64::from(k) * period / 0.8).min(1.0);
                // A time constant of 0.1 s.
                applied = ((setpoint - mean) * (motor + load) / 0.1 + load_torque)
                    .clamp(-rating.torque_limit.0, rating.torque_limit.0);
                plant.advance(applied + disturbance.torque_accuracy * noise.normal(), period);
                tick
            })
            .collect()
    }

    /// The errors of fixed point over those of `f32`, the largest of the three, for an observer's constants; behind the
    /// gear where it has losses. And the errors of `f32`.
    fn judge<S, F>(&self, ticks: &[Tick], single: S::Config, fixed: F::Config) -> (f64, [f64; 3])
    where
        S: Observer<f32, Config: Copy>,
        F: Observer<Fixed, Config: Copy>,
    {
        let (si, bases, period) = (Bases::SI, self.bases, self.period());
        let (single, fixed) = if self.gear.efficiency < 1.0 {
            let single = GearedConfig::<f32, _>::new(single, &self.gear, period, si);
            let fixed = self.fits(GearedConfig::<Fixed, _>::try_new(fixed, &self.gear, period, bases));
            (
                errors::<f32, GearedObserver<S>>(ticks, &single, si),
                errors::<Fixed, GearedObserver<F>>(ticks, &fixed, bases),
            )
        } else {
            (errors::<f32, S>(ticks, &single, si), errors::<Fixed, F>(ticks, &fixed, bases))
        };
        let ratio = (0..3).map(|k| fixed[k] / single[k]).fold(0.0, f64::max);
        assert!(ratio < WORSE, "{}: {fixed:?} instead of {single:?}", self.name);
        (ratio, single)
    }
}

/// A sample and the truth: shaft torque, load speed, load torque.
struct Tick {
    angle: u32,
    torque: f64,
    truth: [f64; 3],
}

/// Root mean square of the errors of shaft torque, load speed and load torque, without the first fifth.
fn errors<N: Number + OfReal, O: Observer<N>>(ticks: &[Tick], config: &O::Config, bases: Bases) -> [f64; 3] {
    let mut observer = O::steady(config, ticks[0].angle, N::ZERO, N::ZERO);
    let (mut squares, settled) = ([0.0; 3], ticks.len() / 5);
    for (k, tick) in ticks.iter().enumerate() {
        let predicted = observer.predict(config, tick.angle, N::of_real(tick.torque / bases.torque));
        observer.correct(config, predicted, tick.angle);
        if k >= settled {
            let estimate = observer.estimate(config);
            let torque = |torque: N| torque.to_real() * bases.torque;
            let load_speed = estimate.load_speed.to_real() * bases.speed;
            let estimates = [torque(estimate.shaft_torque), load_speed, torque(estimate.load_torque)];
            for ((square, estimate), truth) in squares.iter_mut().zip(estimates).zip(tick.truth) {
                *square += (estimate - truth) * (estimate - truth);
            }
        }
    }
    squares.map(|square| (square / (ticks.len() - settled) as f64).sqrt())
}

/// A coupling of 48 Hz with the antiresonance of 32 Hz, as in the README.
fn roll() -> (Chain, Rating) {
    let chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
    (chain, Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) })
}

/// A direct drive that turns once in two seconds: its speeds are small against a count in a tick.
fn slow() -> (Chain, Rating) {
    let chain = Chain::motor(Inertia(20.0)).shaft(Stiffness(1.0e6), Damping(100.0)).rotor(Inertia(60.0));
    (chain, Rating { torque: Torque(5_000.0), speed: Speed(3.0), torque_limit: Torque(9_000.0) })
}

#[test]
fn fine_encoders_cost_fixed_point_less_than_a_tenth() {
    let hoist = (Hoist::<10_000>::CHAIN, Hoist::<10_000>::RATING);
    let machines =
        [("roll", roll()), ("hoist", hoist), ("spindle", (Spindle::CHAIN, Spindle::RATING)), ("slow", slow())];
    // Runs of the exact step, the semi-implicit step, the rigid observer; where the exact step does not fit.
    let (mut runs, mut beyond) = ([0; 3], Vec::new());
    for (name, (chain, rating)) in machines {
        for rate in RATES {
            // No speed loop of a spindle is that slow.
            if name == "spindle" && rate < 1_000 {
                continue;
            }
            for bits in [17, 20, 24] {
                for efficiency in [1.0, EFFICIENCY] {
                    let case = Case::new(name, chain, rating, rate, bits, efficiency);
                    let ticks = case.record();
                    let (si, bases, share) = (Bases::SI, case.bases, case.load_share);
                    let mut worst = [0.0; 3];
                    let single = RigidConfig::<f32>::new(&case.rigid, share, si);
                    let fixed = case.fits(RigidConfig::<Fixed>::try_new(&case.rigid, share, bases));
                    (worst[2], _) = case.judge::<RigidObserver<f32>, RigidObserver<Fixed>>(&ticks, single, fixed);
                    runs[2] += 1;
                    let Some(design) = &case.design else {
                        // A shaft of 800 Hz.
                        assert!(name == "spindle" && rate == 1_000, "{}", case.name);
                        continue;
                    };
                    let chosen = design.chosen == StepChoice::SemiImplicit;
                    if chosen {
                        let single = SemiImplicitConfig::<f32>::new(design, si);
                        let fixed = case.fits(SemiImplicitConfig::<Fixed>::try_new(design, bases));
                        (worst[1], _) =
                            case.judge::<SemiImplicitObserver<f32>, SemiImplicitObserver<Fixed>>(&ticks, single, fixed);
                        runs[1] += 1;
                    }
                    match TwoMassConfig::<Fixed>::try_new(design, bases) {
                        Ok(fixed) => {
                            let single = TwoMassConfig::<f32>::new(design, si);
                            let errors;
                            (worst[0], errors) =
                                case.judge::<TwoMassObserver<f32>, TwoMassObserver<Fixed>>(&ticks, single, fixed);
                            runs[0] += 1;
                            let predicted = design.standard_deviation;
                            let predicted = [predicted.shaft_torque, predicted.load_speed, predicted.load_torque];
                            // Without a gear the recording is what the design assumes, so nothing else hides the
                            // rounding. The slowest estimates have some tens of independent values in the recording.
                            for (error, predicted) in errors.into_iter().zip(predicted) {
                                assert!(efficiency < 1.0 || error < 1.25 * predicted, "{}: {errors:?}", case.name);
                            }
                        }
                        Err(error) => {
                            let remedy = error.message().contains("take SemiImplicitObserver");
                            assert!(chosen && remedy, "{}: {error}", case.name);
                            beyond.push((name, rate, bits));
                        }
                    }
                    println!(
                        "{}: exact {:.3}, semi-implicit {:.3}, rigid {:.3}",
                        case.name, worst[0], worst[1], worst[2]
                    );
                }
            }
        }
    }
    println!("{runs:?}, beyond: {beyond:?}");
    // The rope is so soft that the twist has the range of turns, and its last place is more than that of a turn.
    beyond.dedup();
    assert_eq!(beyond, [("hoist", 4_000, 20), ("hoist", 4_000, 24), ("hoist", 10_000, 20), ("hoist", 10_000, 24)]);
    // Each machine, rate and encoder, with and without a gear; the semi-implicit step on the hoist's rope.
    assert_eq!(runs[2], (4 * 4 - 1) * 3 * 2);
    assert!(runs[1] >= 2 * 3 * 2, "{runs:?}");
}
