//! A crank with its rod and slider: inertia that depends on the angle, `J w' + J'(phi) w^2/2 = torque` `[derived]`.

use super::super::error::{PlantError, in_range, not_negative, positive};
use super::super::event::Place;
use super::series::{Series, Turn, ZERO, product, quotient, root};

/// Crank, rod and slider on a coordinate. The slider's way is `r cos phi + sqrt(l^2 - r^2 sin^2 phi)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crank {
    /// Radius `r`, m, above zero and below the rod's length.
    pub radius: f64,
    /// Length `l` of the rod, m.
    pub rod: f64,
    /// Mass of the slider, kg.
    pub slider_mass: f64,
    /// Mass of the rod, kg.
    pub rod_mass: f64,
    /// Of the rod about its centre of gravity, kg m2.
    pub rod_inertia: f64,
    /// Centre of gravity of the rod, as a share of its length from the crank pin.
    pub rod_centre: f64,
}

impl Crank {
    /// A rod without mass.
    #[must_use]
    pub const fn new(radius: f64, rod: f64, slider_mass: f64) -> Self {
        Self { radius, rod, slider_mass, rod_mass: 0.0, rod_inertia: 0.0, rod_centre: 0.3 }
    }

    /// Inertia of slider and connecting rod at an angle (rad), kg m2, and its derivative, kg m2/rad.
    #[must_use]
    pub fn inertia(&self, angle: f64) -> (f64, f64) {
        let mut fixed = ZERO;
        fixed[0] = angle;
        let mut work = Work::new();
        work.extend(self, &fixed, 0);
        (work.inertia[0], 2.0 * work.half_slope[0])
    }

    /// Derivative of the slider's way by the angle, m, at an angle, rad.
    pub(super) fn slope(&self, angle: f64) -> f64 {
        let (sine, cosine) = angle.sin_cos();
        let reach = (self.rod.powi(2) - (self.radius * sine).powi(2)).sqrt();
        -self.radius * sine * (1.0 + self.radius * cosine / reach)
    }

    pub(super) fn validate(&self, place: Place) -> Result<(), PlantError> {
        positive("crank radius", place, self.radius)?;
        positive("rod length", place, self.rod)?;
        in_range("rod length", place, self.rod, self.rod > self.radius, "more than the crank's radius")?;
        not_negative("slider mass", place, self.slider_mass)?;
        not_negative("rod mass", place, self.rod_mass)?;
        not_negative("rod inertia", place, self.rod_inertia)?;
        let centre = self.rod_centre;
        in_range("rod's centre of gravity", place, centre, (0.0..=1.0).contains(&centre), "from 0 to 1")
    }
}

/// The series of a crank over a stretch. Slopes are derivatives by the angle.
#[derive(Debug, Clone)]
pub(super) struct Work {
    turn: Turn,
    /// `S^2 = l^2 - r^2 sin^2` and `S`, the rod's reach along the slider's way.
    square: Series,
    pub reach: Series,
    /// `sin cos`, `u = sin cos / S`, and `u' S`.
    both: Series,
    pub share: Series,
    share_over: Series,
    share_slope: Series,
    /// `L = cos / S`, by which the rod leans `r L` per angle, and `L' S`.
    pub lean: Series,
    lean_over: Series,
    pub lean_slope: Series,
    /// First and second derivatives: of the slider's way, of the way of the rod's centre, of its height.
    pub slider: [Series; 2],
    centre: [Series; 2],
    height: [Series; 2],
    /// Of slider and rod, kg m2.
    pub inertia: Series,
    /// Half its derivative, kg m2/rad.
    pub half_slope: Series,
}

impl Work {
    pub fn new() -> Self {
        let pair = [ZERO; 2];
        Self {
            turn: Turn::new(1.0),
            square: ZERO,
            reach: ZERO,
            both: ZERO,
            share: ZERO,
            share_over: ZERO,
            share_slope: ZERO,
            lean: ZERO,
            lean_over: ZERO,
            lean_slope: ZERO,
            slider: pair,
            centre: pair,
            height: pair,
            inertia: ZERO,
            half_slope: ZERO,
        }
    }

    /// Fills in coefficient `k` from the angle's coefficients up to it.
    pub fn extend(&mut self, crank: &Crank, angle: &Series, k: usize) {
        let (r, l, f) = (crank.radius, crank.rod, crank.rod_centre);
        self.turn.extend(angle, k);
        let (sine, cosine) = (&self.turn.sine, &self.turn.cosine);
        let one = if k == 0 { 1.0 } else { 0.0 };
        let sine_square = product(sine, sine, k);
        self.square[k] = l * l * one - r * r * sine_square;
        self.reach[k] = root(&self.square, &self.reach, k);
        self.both[k] = product(sine, cosine, k);
        // S' = -r^2 u, so u' S = cos^2 - sin^2 + r^2 u^2 and L' S = -sin + r^2 u L
        self.share[k] = quotient(&self.both, &self.reach, &self.share, k);
        self.share_over[k] = one - 2.0 * sine_square + r * r * product(&self.share, &self.share, k);
        self.share_slope[k] = quotient(&self.share_over, &self.reach, &self.share_slope, k);
        self.lean[k] = quotient(cosine, &self.reach, &self.lean, k);
        self.lean_over[k] = -sine[k] + r * r * product(&self.share, &self.lean, k);
        self.lean_slope[k] = quotient(&self.lean_over, &self.reach, &self.lean_slope, k);
        let along = |share: f64| {
            [-r * sine[k] - share * r * r * self.share[k], -r * cosine[k] - share * r * r * self.share_slope[k]]
        };
        [self.slider[0][k], self.slider[1][k]] = along(1.0);
        [self.centre[0][k], self.centre[1][k]] = along(f);
        [self.height[0][k], self.height[1][k]] = [(1.0 - f) * r * cosine[k], (f - 1.0) * r * sine[k]];
        let sum = |second: usize| {
            let of = |pair: &[Series; 2]| product(&pair[0], &pair[second], k);
            let turning = product(&self.lean, if second == 0 { &self.lean } else { &self.lean_slope }, k);
            crank.slider_mass * of(&self.slider)
                + crank.rod_mass * (of(&self.centre) + of(&self.height))
                + crank.rod_inertia * r * r * turning
        };
        (self.inertia[k], self.half_slope[k]) = (sum(0), sum(1));
    }
}

#[cfg(test)]
mod tests {
    use crate::plant::train::crank::*;

    #[test]
    fn inertia_and_slope_are_those_of_the_way_by_small_differences() {
        let crank = Crank { rod_mass: 3.0, rod_inertia: 0.05, ..Crank::new(0.1, 0.4, 12.0) };
        let place = |phi: f64| {
            let reach = (0.16 - (0.1 * phi.sin()).powi(2)).sqrt();
            let pin = 0.1 * phi.cos();
            [pin + reach, pin + 0.3 * reach, 0.7 * 0.1 * phi.sin(), (0.25 * phi.sin()).asin()]
        };
        for step in 0..12 {
            let phi = 0.1 + 0.5 * f64::from(step);
            let (ahead, behind) = (place(phi + 1e-5), place(phi - 1e-5));
            let mass = [12.0, 3.0, 3.0, 0.05];
            let expected: f64 = (0..4).map(|i| mass[i] * ((ahead[i] - behind[i]) / 2e-5_f64).powi(2)).sum();
            let slope = (crank.inertia(phi + 1e-5).0 - crank.inertia(phi - 1e-5).0) / 2e-5;
            let (inertia, found) = crank.inertia(phi);
            // central differences of 1e-5: rounding 1e-16/1e-5 and the square of the step, on numbers below 1
            assert!((inertia - expected).abs() < 1e-9, "{phi}: {inertia} {expected}");
            assert!((found - slope).abs() < 1e-9, "{phi}: {found} {slope}");
        }
    }
}
