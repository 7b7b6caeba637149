//! The points of a gain schedule: tested for margins and tolerances, with filters in the speed loop.

use crate::hoist::Hoist;
use driveline::configure::{Family, Machine, Rating, ScheduleOf, test_schedule};
use driveline::design::{Robustness, SpeedLoopDesign, StepChoice};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::{DampingLag, SetpointLag, SpeedLoop};
use driveline::machine::{Match, Speed, Torque, TwoMass};
use driveline::observer::TwoMassObserver;
use driveline::prelude::{Chain, Damping, Encoder, Inertia, Stiffness};

/// Every point of the hoist's schedule has 6 dB and 30 degrees, and is stable half way to its neighbours. At 10 kHz its
/// semi-implicit step is within the threshold, at 1 kHz it is not.
#[test]
fn the_hoists_points_are_robust() {
    let fast = test_schedule::<Hoist<10_000>, 5, 4>().unwrap();
    assert!(fast <= StepChoice::THRESHOLD, "{fast}");
    let slow = test_schedule::<Hoist<1_000>, 5, 4>().unwrap();
    // an error of the first order in the period
    assert!((slow / fast - 10.0).abs() < 1.0, "{slow}");
}

/// Two loads on two shafts with a lag of the damping; `GAIN` is the margin that is asked for.
struct Winch<const GAIN: u32>;

const fn member(load: f64, shaft: f64) -> TwoMass {
    Chain::motor(Inertia(0.62))
        .shaft(Stiffness(900.0 * shaft), Damping(0.5))
        .rotor(Inertia(0.2 * load))
        .reduce(Match::ResonanceAntiresonance)
}

impl<const GAIN: u32> Machine for Winch<GAIN> {
    const CHAIN: Chain = Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.2));
    const RATING: Rating = Rating { torque: Torque(200.0), speed: Speed(150.0), torque_limit: Torque(300.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 4_000;
    const ROBUSTNESS: Robustness = Robustness { gain: GAIN as f64, ..Robustness::USUAL };
    const SPEED_LOOP: SpeedLoopDesign =
        Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING).with_damping_lag(1.0 / Self::TWO_MASS.resonance());
}

impl<const GAIN: u32> Family<2, 2> for Winch<GAIN> {
    const FIRST: [f64; 2] = [1.0, 2.0];
    const SECOND: [f64; 2] = [1.0, 2.0];
    const MEMBERS: [[TwoMass; 2]; 2] = [[member(1.0, 1.0), member(1.0, 2.0)], [member(2.0, 1.0), member(2.0, 2.0)]];
}

/// A margin that no loop has is refused, with the first point and the cause.
#[test]
fn a_point_without_its_margin_is_refused() {
    assert!(test_schedule::<Winch<2>, 2, 2>().is_ok());
    let refused = test_schedule::<Winch<1_000>, 2, 2>();
    assert_eq!(refused, Err((0, 0, driveline::design::Error::LoopGain)));
}

/// The lag of the damping is that of each member: `1 - exp(-w T)` of its own resonance.
#[test]
fn the_filters_follow_the_schedule() {
    type Filters = (SetpointLag, DampingLag);
    type D = Drive<f64, TwoMassObserver, SpeedLoop<Filters>>;
    let schedule: ScheduleOf<D, 2, 2> = D::schedule::<Winch<2>, 2, 2>();
    let mut config: ConfigOf<D> = D::configure::<Winch<2>>();
    let mut drive = D::new(&config, 0);
    for (load, shaft, i, j) in [(1.0, 1.0, 0, 0), (2.0, 1.0, 1, 0), (1.0, 2.0, 0, 1), (2.0, 2.0, 1, 1)] {
        drive.follow(&mut config, &schedule, load, shaft);
        let resonance = Winch::<2>::MEMBERS[i][j].resonance();
        let share = -(-resonance / 4_000.0).exp_m1();
        // f64 rounding of a quotient of resonances
        assert!((config.governor.filter.1.share / share - 1.0).abs() < 1e-12, "{load} {shaft}");
    }
}
