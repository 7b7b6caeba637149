//! The constants that the compiler designed have the bits of those that are designed at run time.

use core::hint::black_box;

use crate::hoist::{CutAtRope, Exact, Hoist, Reduced, Rigid};
use driveline::configure::Machine as _;
use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopTuning, StepChoice};
use driveline::drive::{Config, Drive, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{
    Chain, Damping, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Match, Ratio, Stiffness, TwoMass,
};
use driveline::number::Fixed;
use driveline::observer::{GearedConfig, RigidConfig, SemiImplicitConfig, TwoMassConfig};
use driveline::settings::Screening;
use driveline::settings::{Bases, Gear, SpeedLoopSettings};

/// The hoist's chain, built where no compiler sees its figures.
fn chain() -> Chain {
    Chain::motor(Inertia(black_box(0.62)))
        .shaft(Stiffness(black_box(5.0e4)), Damping(black_box(2.0)))
        .rotor(Inertia(black_box(0.08)))
        .gear(Ratio(black_box(31.5)), Efficiency(black_box(0.94)))
        .drum(Diameter(black_box(0.8)))
        .damped_rope(Falls(black_box(2)), Stiffness(black_box(2.9e6)), LinearDamping(black_box(3.6e3)))
        .lifted(Mass(black_box(12_000.0)))
}

fn disturbance(rate: Rate) -> Disturbance {
    Disturbance { torque_accuracy: 7.5, load_torque_step: black_box(300.0), within: black_box(50.0) }.torque_over(
        black_box(60.0),
        black_box(1e-4),
        rate,
    )
}

fn settings() -> SpeedLoopSettings {
    SpeedLoopSettings { torque_limit: black_box(1_350.0), ramp: black_box(155.0) / 2.0 }
}

/// `Debug` shows every field, and every bit of a float but the payload of a NaN, of which there are none.
#[track_caller]
fn same(compiled: &impl core::fmt::Debug, run: &impl core::fmt::Debug) {
    assert_eq!(format!("{compiled:?}"), format!("{run:?}"));
}

fn test<const R: u32>() {
    let rate = black_box(R);
    let reduced: TwoMass = chain().reduce(Match::ResonanceAntiresonance);
    same(&Hoist::<R>::TWO_MASS, &reduced);
    let encoder = Encoder::lines(black_box(2048));
    let design = reduced
        .observer(Rate::hz(rate), encoder, disturbance(Rate::hz(rate)))
        .with_step(black_box(StepChoice::SemiImplicit));
    let cut = chain().reduce(Match::TextbookShaft(black_box(1))).observer(
        Rate::hz(rate),
        encoder,
        disturbance(Rate::hz(rate)),
    );
    let rigid = chain().rigid().observer(Rate::hz(rate), encoder, disturbance(Rate::hz(rate)));
    let speed_loop = reduced.speed_loop(Rate::hz(rate), SpeedLoopTuning::USUAL);
    let period = 1.0 / f64::from(rate);
    let share = reduced.load_inertia / (reduced.motor_inertia + reduced.load_inertia);
    let gear = Gear {
        efficiency: black_box(0.94),
        inertia: reduced.motor_inertia,
        deadband: 8.0 * core::f64::consts::TAU / black_box(8192.0),
    };
    let bases = black_box(Hoist::<R>::BASES);

    let rating = black_box(Hoist::<R>::RATING);
    let screening = Screening { max_coast: rate / 67, ..rating.screening(encoder, Rate::hz(rate)) };

    macro_rules! config {
        ($number:ident, $machine:ident, $with:ident, $observer:expr, $bases:expr) => {{
            let run = Config {
                limits: Limits::<$number>::new(&screening, $bases),
                observer: GearedConfig::<$number, _>::new($observer, &gear, period, $bases),
                fluctuation: (),
                governor: SpeedLoopConfig::<$number>::new(&speed_loop, settings(), $bases),
                balancer: (),
            };
            let compiled = const { Drive::<$number, $with, SpeedLoop>::configure::<$machine<R>>() };
            same(&compiled, &run);
        }};
    }
    config!(f32, Hoist, Rigid, RigidConfig::<f32>::new(&rigid, share, Bases::SI), Bases::SI);
    config!(f32, CutAtRope, Exact, TwoMassConfig::<f32>::new(&cut, Bases::SI), Bases::SI);
    config!(f32, Hoist, Exact, TwoMassConfig::<f32>::new(&design, Bases::SI), Bases::SI);
    config!(f32, Hoist, Reduced, SemiImplicitConfig::<f32>::new(&design, Bases::SI), Bases::SI);
    config!(Fixed, Hoist, Rigid, RigidConfig::<Fixed>::new(&rigid, share, bases), bases);
    config!(Fixed, CutAtRope, Exact, TwoMassConfig::<Fixed>::new(&cut, bases), bases);
    config!(Fixed, Hoist, Exact, TwoMassConfig::<Fixed>::new(&design, bases), bases);
    config!(Fixed, Hoist, Reduced, SemiImplicitConfig::<Fixed>::new(&design, bases), bases);
}

#[test]
fn compiled_and_run_constants_have_the_same_bits() {
    test::<1_000>();
    test::<4_000>();
    test::<10_000>();
}

/// The comparison sees a single bit.
#[test]
#[should_panic(expected = "assertion")]
fn a_bit_is_seen() {
    same(&0.1_f32, &0.1_f32.next_up());
}
