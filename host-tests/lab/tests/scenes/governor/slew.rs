//! The slew limit by an allowed dynamic factor, on the skip winch's full plant.

use driveline::configure::Machine;
use driveline::governor::{Limit, Slew, SlewConfig, SymmetricLimit, SymmetricLimitConfig};
use driveline::machine::Torque;
use driveline::number::{Fixed, Number};
use driveline::sample::Estimate;
use driveline::settings::Bases;
use driveline_firmware::scenes::skip_winch::SkipWinch;
use driveline_solver::plant::{Chain, Shaft, Start};

/// The scene's parts, at the motor's shaft, by their own arithmetic: travel of a drum of 2 m behind a gear of 15.
const TRAVEL: f64 = 1.0 / 15.0;
const WEIGHT: f64 = 5_000.0 * 9.80665 * TRAVEL;
const SHAFT: f64 = 6.0e5;
const ROPE: f64 = 3.9e5 * TRAVEL * TRAVEL;
/// The motor takes the skip up from hanging by this much more torque than its weight (N m).
const CHANGE: f64 = 2_000.0;
const ALLOWED: f64 = 1.2;

/// Largest change of the rope's torque over the change that stays, for a torque by ticks (N m).
fn factor(mut torque: impl FnMut() -> f64) -> f64 {
    let mut plant = Chain::motor(20.0)
        .shaft(Shaft::elastic(SHAFT).damping(60.0), 1500.0 / (15.0 * 15.0))
        .efficiency(0.94)
        .shaft(Shaft::rope(ROPE).damping(1.3e3 * TRAVEL * TRAVEL), 5_000.0 * TRAVEL * TRAVEL)
        .load(WEIGHT)
        // As the motor carries it, loss of the gear included.
        .start(Start::Given { twists: vec![WEIGHT / 0.94 / SHAFT, WEIGHT / ROPE], speeds: vec![0.0; 3] })
        .build()
        .unwrap();
    let (mut peak, mut last) = (0.0_f64, 0.0);
    // The rope's damping leaves e^-14 of the swing, 1e-6, after 60 s.
    for _ in 0..(60.0 / SkipWinch::PERIOD) as usize {
        plant.advance(torque(), SkipWinch::PERIOD);
        last = plant.torque_behind_gear(1) - WEIGHT;
        peak = peak.max(last);
    }
    peak / last
}

fn slewed<N: Number>(
    step: SlewConfig<N, SymmetricLimitConfig<N>>,
    to: impl Fn(f64) -> N,
    of: impl Fn(N) -> f64,
) -> f64 {
    let estimate = Estimate::default();
    let mut slew = Slew::<SymmetricLimit, N>::default();
    slew.start(to(WEIGHT / 0.94));
    factor(|| of(slew.limit(&step, &estimate, to(WEIGHT / 0.94 + CHANGE))))
}

#[test]
fn the_rope_s_dynamic_factor_is_the_allowed_one() {
    const SLEW: f64 = SkipWinch::TWO_MASS.slew_for_factor(Torque(CHANGE), ALLOWED);
    const LIMIT: f64 = SkipWinch::RATING.torque_limit.0;
    const FLOAT: SlewConfig<f32, SymmetricLimitConfig<f32>> = SlewConfig::<f32, _>::new(
        SLEW,
        SymmetricLimitConfig::<f32>::new(LIMIT, Bases::SI),
        SkipWinch::PERIOD,
        Bases::SI,
    );
    const BASES: Bases = SkipWinch::BASES;
    const FIXED: SlewConfig<Fixed, SymmetricLimitConfig<Fixed>> =
        SlewConfig::<Fixed, _>::new(SLEW, SymmetricLimitConfig::<Fixed>::new(LIMIT, BASES), SkipWinch::PERIOD, BASES);
    let found = [
        slewed(FLOAT, |torque| torque as f32, f64::from),
        slewed(FIXED, |torque| Fixed::from_f64(torque / BASES.torque), |torque| torque.to_f64() * BASES.torque),
    ];
    for factor in found {
        // The ramp lasts for omega T/2 = 1/(factor - 1) = 5, where 1 + |sin 5|/5 is 1.192. The rope's damping ratio of
        // 0.02 takes e^-0.2 of the swing by the end of the ramp: 1.157. The motor's shaft, 350 times as stiff, adds
        // less than 1 %.
        assert!(factor <= ALLOWED && factor > 1.15, "{found:?}");
    }
    // At once it is a step's 2 but for the damping: 1 + e^(-0.02 pi) = 1.94.
    let step = factor(|| WEIGHT / 0.94 + CHANGE);
    assert!((step - 1.94).abs() < 0.01, "{step}");
}
