//! Dry friction in the pins of a slider-crank that is driven forwards.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::crank::Crank;
use super::linkage::Orders;
use super::source::Source;

/// Pins of a slider-crank: the main bearing of the crank, the crank pin, and the wrist pin at the slider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pins {
    /// Coefficient of friction of all three.
    pub coefficient: f64,
    /// Radius of the main bearing, m.
    pub main: f64,
    /// Radius of the crank pin, m.
    pub crank: f64,
    /// Radius of the wrist pin, m.
    pub wrist: f64,
}

/// A force (N) on the slider of a crank from one of its angles to another, rad: `from` within a turn, `to` behind it by
/// a turn at most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliderForce {
    /// Force.
    pub force: f64,
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
}

impl Pins {
    /// The torque at the crank that the pins take under a force of 1 N on the slider, of either sense, at an angle
    /// (rad): `mu/cos beta (r_main + r_crank (1 + beta') + r_wrist |beta'|)`, `beta` the angle of the rod to the
    /// slider's way and `beta'` its derivative by the angle of the crank. Derived: the rod passes on the force over
    /// `cos beta`, and each pin turns in its eye at the difference of the speeds of its two parts.
    ///
    /// Of the first order in the coefficient: friction turns the forces in the pins by the friction circles, which this
    /// leaves out. So it does the forces of the masses of slider and rod.
    #[must_use]
    pub fn loss(&self, crank: &Crank, angle: f64) -> f64 {
        self.loss_towards(crank, angle, angle.cos().signum())
    }

    /// The same with the sense in which the rod swings as it is given, so that it is smooth over the quarter turns.
    fn loss_towards(&self, crank: &Crank, angle: f64, sense: f64) -> f64 {
        let lambda = crank.radius / crank.rod;
        let upright = (1.0 - (lambda * angle.sin()).powi(2)).sqrt();
        let swing = lambda * angle.cos() / upright;
        self.coefficient * (self.main + self.crank * (1.0 + swing) + self.wrist * sense * swing) / upright
    }

    /// The torques of the pins on the crank, which only turns forwards, under forces on the slider. Forces at the same
    /// angle add before their sense is dropped.
    ///
    /// A value that is not a number is refused where the train is built.
    #[must_use]
    pub fn sources(&self, crank: &Crank, forces: &[SliderForce]) -> Vec<Source> {
        let turns = |angle: f64| angle.rem_euclid(TAU);
        let mut ends: Vec<f64> = forces.iter().flat_map(|force| [turns(force.from), turns(force.to)]).collect();
        ends.extend([FRAC_PI_2, 3.0 * FRAC_PI_2]);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let next = ends.iter().skip(1).copied().chain([ends[0] + TAU]);
        let series = [-1.0, 1.0].map(|sense| Orders::sampled(|angle| self.loss_towards(crank, angle, sense)));
        let arc = |(&from, to): (&f64, f64)| {
            let middle = 0.5 * (from + to);
            let acts = |force: &&SliderForce| turns(middle - force.from) < force.to - force.from;
            let force: f64 = forces.iter().filter(acts).map(|force| force.force).sum();
            let outwards = usize::from(middle.cos() > 0.0);
            (force != 0.0).then(|| Source::Stroke { torque: series[outwards].times(-force.abs()), from, to, turns: 1 })
        };
        ends.iter().zip(next).filter_map(arc).collect()
    }
}
