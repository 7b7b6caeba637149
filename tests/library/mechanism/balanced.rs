//! A four-bar press at light load, with the inertia's moment and the weight balanced by the motor, or left to the
//! flywheel: against the full solver.

use std::f64::consts::TAU;

use driveline::configure::{GainSource, HasMechanism};
use driveline::design::{
    Actuator, Encoder, GovernorDesign, LoadFeedForward, Rate, SpeedLoopDesign, SpeedLoopTuning, Spread, Tolerance,
};
use driveline::fluctuation::CycleMean;
use driveline::governor::{CycleAverage, MechanismFeedForward, SpeedGovernor, SymmetricLimit};
use driveline::machine::{DrivenMechanism, FourBar, Match, Mechanism, TwoMass};
use driveline::observer::ToolObserver;
use driveline::prelude::*;
use driveline::settings::{Bases, Cycle};
use driveline_solver::plant::train::{Coordinate, FourBar as Bars, Link, Motion, Orders, Source, Train};

const RATIO: f64 = 10.0;
const FLYWHEEL: f64 = 0.6;
/// Crank, and rocker with the slide that it drives (kg m2), weight on the rocker (N m).
const CRANK: f64 = 20.0;
const ROCKER: f64 = 250.0;
const WEIGHT: f64 = 600.0;
const BARS: Bars = Bars { crank: 0.1, coupler: 0.35, rocker: 0.3, ground: 0.4 };
const STIFFNESS: f64 = 2.0e5;
const DAMPING: f64 = 40.0;
const MECHANISM: Mechanism = Mechanism::four_bar(&FourBar::massless(
    Length(BARS.crank),
    Length(BARS.coupler),
    Length(BARS.rocker),
    Length(BARS.ground),
    Inertia(ROCKER),
))
.rotor(Inertia(CRANK))
.weight(WEIGHT);

struct Press;

impl Machine for Press {
    const CHAIN: Chain = Chain::motor(Inertia(FLYWHEEL))
        .gear(Ratio(RATIO), Efficiency(1.0))
        .shaft(Stiffness(STIFFNESS * RATIO * RATIO), Damping(DAMPING * RATIO * RATIO))
        .rotor(MECHANISM.mean_inertia());
    const RATING: Rating = Rating { torque: Torque(200.0), speed: Speed(100.0), torque_limit: Torque(400.0) };
    const ENCODER: Encoder = Encoder::counts(1 << 17);
    const RATE_HZ: u32 = 4_000;
    const TWO_MASS: TwoMass = Self::CHAIN.reduce(Match::TextbookCut(0));
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.03, damping: 1.0, shaft_damping: 0.04 };
    const SPEED_LOOP: SpeedLoopDesign =
        SpeedLoopDesign { damping: 0.0, ..Self::TWO_MASS.speed_loop(Rate::hz(Self::RATE_HZ), Self::TUNING) };
    const GAINS: GainSource = GainSource::Governor(OVER_STROKE);
    /// The mean over a stroke is too late for a tenth of the shaft's damping.
    const TOLERANCE: Tolerance = Tolerance { damping: Spread::NONE, ..Tolerance::USUAL };
    const RAMP: f64 = 100.0;
    const BASES: Bases = Bases::rigid(1_000.0, 134.0);
    const CYCLE: Cycle = Cycle { turns: RATIO as u32, cycles: 1 };
    const CYCLES: u32 = 4;
}

/// On the mean over a stroke, as the punch press has it.
const OVER_STROKE: GovernorDesign = Press::TWO_MASS.governor(
    Rate::hz(Press::RATE_HZ),
    Actuator { delay: 0.0, lag: TAU * RATIO / 80.0 / 6.75 },
    4.5,
    LoadFeedForward::NONE,
);

impl HasMechanism for Press {
    const DRIVEN: DrivenMechanism = DrivenMechanism::new(Inertia(FLYWHEEL), &MECHANISM, 1, RATIO as u32);
}

fn plant() -> Motion {
    let psi = Orders::sampled(|angle| BARS.angles(angle)[1]);
    let weight = Source::Orders(psi.slope().times(-WEIGHT).0);
    let crank = Coordinate::new(CRANK).viscous(5.0).inertia_law(Orders::inertia(&[(ROCKER, &psi)])).source(weight);
    Train::new()
        .coordinate(Coordinate::new(FLYWHEEL))
        .coordinate(crank)
        .link(Link::geared(0, 1, RATIO, STIFFNESS).damping(DAMPING))
        .build()
        .unwrap()
}

/// Delta of the motor's speed over the last three strokes by the full solver, and the drive's largest torque (N m).
macro_rules! run {
    ($drive:ty) => {{
        let config = <$drive>::configure::<Press>();
        let mut drive = <$drive>::new(&config, 0);
        drive.observer_mut().home(&config.observer, 0);
        let mut plant = plant();
        let (mut torque, mut seen) = (0.0_f32, Vec::new());
        for _ in 0..8 * Press::RATE_HZ {
            let angle = ((plant.angle(0) / TAU * 131_072.0).round() as i64) << 15;
            let command = drive.tick(&config, &Sample::si::<Press>(angle as u32, torque, 100.0));
            assert!(command.faults.is_none(), "{:?}", command.faults);
            torque = command.torque_si::<Press>();
            plant.set_torque(0, f64::from(torque));
            plant.advance(1.0 / f64::from(Press::RATE_HZ));
            seen.push([plant.speed(0), f64::from(torque)]);
        }
        let strokes = (3.0 * TAU * RATIO / 100.0 * f64::from(Press::RATE_HZ)) as usize;
        let last = &seen[seen.len() - strokes..];
        let of = |k: usize| last.iter().map(move |row| row[k]);
        let (most, least) = (of(0).fold(0.0, f64::max), of(0).fold(f64::INFINITY, f64::min));
        [2.0 * (most - least) / (most + least), of(1).map(f64::abs).fold(0.0, f64::max)]
    }};
}

type Balanced<N> = Drive<N, ToolObserver, SpeedGovernor<(), MechanismFeedForward>>;
type Left<N> = Drive<N, ToolObserver, SpeedGovernor>;
type Plain = Drive<f32, ToolObserver, SpeedLoop>;
type FlatTorque = Drive<f32, ToolObserver, SpeedGovernor<(), (), SymmetricLimit, (), CycleAverage>, CycleMean<64>>;

#[test]
fn the_motor_balances_the_inertia_or_leaves_it_to_the_flywheel() {
    let [balanced, fixed] = [run!(Balanced<f32>), run!(Balanced<Fixed>)];
    let [left, plain, flat] = [run!(Left<f32>), run!(Plain), run!(FlatTorque)];
    println!("balanced {balanced:?}, fixed {fixed:?}, left {left:?}, plain {plain:?}, flat torque {flat:?}");
    // A fifth of delta with the speed flat, of the same gains and of the plain loop; half of the peak with the torque
    // flat.
    for other in [left, plain] {
        assert!(balanced[0] < 0.2 * other[0] && fixed[0] < 0.2 * other[0], "{balanced:?} {fixed:?} {other:?}");
    }
    assert!(flat[1] < 0.5 * plain[1], "{flat:?} {plain:?}");
}
