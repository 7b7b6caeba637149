//! The loop of a composed governor with the average of the speed in it, against its response on paper.

use driveline::design::{Actuator, Averaging, Error, GovernorDesign, LoadFeedForward, Rate, Robustness};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};

/// So stiff that it is one mass to the governor.
const MACHINE: TwoMass = TwoMass::new(Inertia(4.4), Inertia(8.0), Stiffness(5.0e7), Damping(6.6e4));
const PERIOD: f64 = 1.0 / 2_400.0;
const ACTUATOR: Actuator = Actuator { delay: 0.0167, lag: 0.02 };

fn design(factor: f64) -> GovernorDesign {
    MACHINE.governor(Rate::every(PERIOD), ACTUATOR, factor, LoadFeedForward::NONE)
}

/// Phase margin of `(k_p + k_i T z/(z - 1)) T/(J (z - 1)) exp(-s d)/(1 + s lag)/z` with a mean over ticks, summed term
/// by term: the phase at the first frequency with a gain below one.
fn phase(design: &GovernorDesign, ticks: u32) -> f64 {
    type C = (f64, f64);
    let times = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
    let inverse = |a: C| (a.0 / (a.0 * a.0 + a.1 * a.1), -a.1 / (a.0 * a.0 + a.1 * a.1));
    let turn = |angle: f64| -> C { (angle.cos(), angle.sin()) };
    let mut frequency = 1.0;
    loop {
        let angle = frequency * PERIOD;
        let (z, less_one) = (turn(angle), (angle.cos() - 1.0, angle.sin()));
        let integral = times(z, inverse(less_one));
        let law = (design.proportional + design.integral * PERIOD * integral.0, design.integral * PERIOD * integral.1);
        let glide = times((PERIOD / 12.4, 0.0), inverse(less_one));
        let late = times(turn(-frequency * ACTUATOR.delay), inverse((1.0, frequency * ACTUATOR.lag)));
        let mean = (0..ticks).fold((0.0, 0.0), |sum: C, k| {
            let (real, imaginary) = turn(-angle * f64::from(k));
            (sum.0 + real / f64::from(ticks), sum.1 + imaginary / f64::from(ticks))
        });
        let open = [law, glide, late, mean, inverse(z)].into_iter().fold((1.0, 0.0), times);
        if open.0.hypot(open.1) < 1.0 {
            return (-open.1).atan2(-open.0).abs();
        }
        frequency *= 1.0001;
    }
}

/// A moving average takes its phase from the loop, and one that takes too much is refused: with 37 degrees by itself
/// the loop of the usual factor of 2 keeps 28 behind a mean over 32 ticks.
#[test]
fn an_average_of_the_speed_is_in_the_loop_s_test() {
    for factor in [1.5, 2.0, 2.5, 4.0] {
        let design = design(factor);
        for ticks in [1, 8, 32, 64] {
            let (averaging, expected) = (Averaging::Ticks(ticks), phase(&design, ticks));
            let found = design.margins_behind(&MACHINE, averaging);
            // the sweep here is in steps of 1e-4
            assert!((found.phase - expected).abs() < 1e-3, "{factor} {ticks}: {} {expected}", found.phase);
            let tested = design.try_robust(&MACHINE, averaging, &Robustness::USUAL);
            if expected > Robustness::USUAL.phase + 1e-3 {
                assert!(tested != Err(Error::GovernorPhase), "{factor} {ticks}: {tested:?}");
            } else {
                assert!(tested.is_err(), "{factor} {ticks}: {}", expected.to_degrees());
            }
        }
    }
    assert_eq!(design(2.0).try_robust(&MACHINE, Averaging::None, &Robustness::USUAL), Ok(()));
    assert_eq!(design(2.0).try_robust(&MACHINE, Averaging::Ticks(32), &Robustness::USUAL), Err(Error::GovernorPhase));
}
