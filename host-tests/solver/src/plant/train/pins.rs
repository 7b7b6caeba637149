//! Dry friction in the pins of a slider-crank that is driven forwards.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::super::error::{PlantError, finite, in_range, not_negative};
use super::super::event::Place;
use super::crank::{Crank, Work};
use super::series::{Series, ZERO, product, quotient};

/// Angles of a turn at which a train's pins are tried for jamming.
const TRIED: i32 = 4096;

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
/// a turn at most. Positive outwards, away from the crank.
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
    /// The torque at the crank that the pins take under a force of 1 N in the rod along the slider's way, of either
    /// sense, at an angle (rad): `mu/cos beta (r_main + r_crank (1 + beta') + r_wrist |beta'|)`, `beta` the angle of
    /// the rod to the slider's way and `beta'` its derivative by the angle of the crank. Derived: the rod passes on the
    /// force over `cos beta`, and each pin turns in its eye at the difference of the speeds of its two parts.
    ///
    /// Of the first order in the coefficient: friction turns the forces in the pins by the friction circles, which this
    /// leaves out.
    #[must_use]
    pub fn loss(&self, crank: &Crank, angle: f64) -> f64 {
        let lambda = crank.radius / crank.rod;
        let upright = (1.0 - (lambda * angle.sin()).powi(2)).sqrt();
        let swing = lambda * angle.cos() / upright;
        self.coefficient * (self.main + self.crank * (1.0 + swing) + self.wrist * swing.abs()) / upright
    }
}

/// Pins with what loads them beside the slider's mass.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pinned {
    pub pins: Pins,
    /// Angles, rad within a turn and rising, at which a force begins or ends or the rod turns about.
    ends: Vec<f64>,
    /// From each end to the next: force on the slider, N, and the sense in which the rod swings.
    pieces: Vec<(f64, f64)>,
}

impl Pinned {
    /// None where nothing rubs; numbers out of range are kept for [`validate`](Self::validate).
    pub fn of(pins: Pins, forces: &[SliderForce]) -> Option<Self> {
        let radii = [pins.main, pins.crank, pins.wrist];
        let is_size = |value: &f64| *value >= 0.0 && value.is_finite();
        let given = forces.iter().flat_map(|force| [force.force, force.from, force.to]);
        let in_range = radii.iter().chain([&pins.coefficient]).all(is_size) && given.into_iter().all(f64::is_finite);
        if in_range && (pins.coefficient == 0.0 || radii == [0.0; 3]) {
            return None;
        }
        let turns = |angle: f64| angle.rem_euclid(TAU);
        let mut ends: Vec<f64> = forces.iter().flat_map(|force| [turns(force.from), turns(force.to)]).collect();
        ends.extend([FRAC_PI_2, 3.0 * FRAC_PI_2]);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let next = ends.iter().skip(1).copied().chain([ends[0] + TAU]);
        let piece = |(from, to): (&f64, f64)| {
            let middle = 0.5 * (from + to);
            let acts = |force: &&SliderForce| turns(middle - force.from) < force.to - force.from;
            (forces.iter().filter(acts).map(|force| force.force).sum(), middle.cos().signum())
        };
        let pieces = ends.iter().zip(next).map(piece).collect();
        Some(Self { pins, ends, pieces })
    }

    /// Ends that lie at or before an angle, rad.
    pub fn passed(&self, angle: f64) -> i64 {
        let turn = (angle / TAU).floor();
        let within = self.ends.iter().filter(|end| **end <= angle - TAU * turn).count();
        turn as i64 * self.ends.len() as i64 + within as i64
    }

    /// Angle of the end after so many, rad.
    pub fn end(&self, passed: i64) -> f64 {
        let count = self.ends.len() as i64;
        TAU * passed.div_euclid(count) as f64 + self.ends[passed.rem_euclid(count) as usize]
    }

    /// Force on the slider, N, and the sense of the rod's swing behind so many ends.
    pub fn piece(&self, passed: i64) -> (f64, f64) {
        self.pieces[(passed - 1).rem_euclid(self.pieces.len() as i64) as usize]
    }

    /// The pins take their torque from what the rod carries, and the rod carries what speeds the slider up. Where a
    /// change of that torque would change the rod's force by as much again, the crank jams. With the coordinate's
    /// inertia (kg m2) at an angle (rad).
    pub fn validate(&self, crank: Option<Crank>, inertia: impl Fn(f64) -> f64, place: Place) -> Result<(), PlantError> {
        let Pins { coefficient, main, crank: pin, wrist } = self.pins;
        not_negative("coefficient of friction of the pins", place, coefficient)?;
        [main, pin, wrist].into_iter().try_for_each(|radius| not_negative("radius of a pin", place, radius))?;
        self.ends.iter().try_for_each(|end| finite("end of a force on a slider", place, *end))?;
        self.pieces.iter().try_for_each(|piece| finite("force on a slider", place, piece.0))?;
        let Some(crank) = crank else {
            let expected = "pins of a coordinate with a crank";
            return Err(PlantError::Parameter { name: "pins", place, value: coefficient, expected });
        };
        let share = |angle: f64| {
            let way = crank.slope(angle).abs();
            crank.slider_mass * way * self.pins.loss(&crank, angle) / inertia(angle)
        };
        let most = (0..TRIED).map(|i| share(TAU * f64::from(i) / f64::from(TRIED))).fold(0.0, f64::max);
        let turning = "pins that let the crank turn: less friction, smaller radii, a lighter slider or more inertia";
        in_range("coefficient of friction of the pins", place, coefficient, most < 0.99, turning)
    }
}

/// Where a pinned crank is: ends passed, and the sense of the force in its rod.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pinning {
    /// The coordinate.
    pub at: usize,
    pub passed: i64,
    /// Of the force along the slider's way that the rod takes from the slider, positive outwards.
    pub pull: f64,
}

/// The pins' loss over a stretch and what it does to the inertia, as series. `g` is [`Pins::loss`], `y` the slider's
/// way, `s` the sense of `Q = F - m d(y' w)/dt`. They take `s g Q`, so that
///
/// `(J + m y' (y' - s g)) w' + m y'' (y' - s g) w^2 = torque + F y' - s g F`.
#[derive(Debug, Clone)]
pub(super) struct Loss {
    pins: Pins,
    force: f64,
    sense: f64,
    pull: f64,
    value: Series,
    value_over: Series,
    slope: Series,
    slope_over: Series,
}

impl Loss {
    pub fn new(pinned: &Pinned, pinning: &Pinning) -> Self {
        let (force, sense) = pinned.piece(pinning.passed);
        let [value, value_over, slope, slope_over] = [ZERO; 4];
        Self { pins: pinned.pins, force, sense, pull: pinning.pull, value, value_over, slope, slope_over }
    }

    /// Fills in coefficient `k` from those of the crank up to it; what is added to that of the inertia, and to that of
    /// what the square of the speed pushes by.
    pub fn extend(&mut self, crank: &Crank, work: &Work, k: usize) -> [f64; 2] {
        let (r, one) = (crank.radius, if k == 0 { 1.0 } else { 0.0 });
        let Pins { coefficient, main, crank: pin, wrist } = self.pins;
        let size = coefficient * crank.rod;
        let swing = size * (pin + self.sense * wrist) * r;
        // g S = mu l (r_main + r_crank + (r_crank +- r_wrist) r L), and S' = -r^2 u
        self.value_over[k] = size * (main + pin) * one + swing * work.lean[k];
        self.value[k] = quotient(&self.value_over, &work.reach, &self.value, k);
        self.slope_over[k] = swing * work.lean_slope[k] + r * r * product(&self.value, &work.share, k);
        self.slope[k] = quotient(&self.slope_over, &work.reach, &self.slope, k);
        let mass = -self.pull * crank.slider_mass;
        [mass * product(&self.value, &work.slider[0], k), mass * product(&self.slope, &work.slider[0], k)]
    }

    /// Coefficient `k` of the torque of the pins under the force on the slider.
    pub fn torque(&self, k: usize) -> f64 {
        -self.pull * self.force * self.value[k]
    }

    /// The force on the slider.
    pub fn force(&self) -> f64 {
        self.force
    }
}
