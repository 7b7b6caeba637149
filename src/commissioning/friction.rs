//! Friction and total inertia from the mean torques of eight segments: two speeds and the ramps between, both ways.

use super::Error;
use super::figure::Figure;
use crate::design::Matrix;
use crate::math::sqrt;

pub(crate) const SEGMENTS: usize = 8;

/// Speeds at both ends of a segment, of the test's speed.
pub(crate) fn ends_of(segment: usize) -> (f32, f32) {
    const SLOW: f32 = 0.4;
    let (from, to) = match segment & 3 {
        0 => (SLOW, SLOW),
        1 => (SLOW, 1.0),
        2 => (1.0, 1.0),
        _ => (1.0, SLOW),
    };
    if segment < 4 { (from, to) } else { (-from, -to) }
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Segment {
    /// Torque (N m).
    pub torque: f64,
    /// Speed (rad/s).
    pub speed: f64,
    /// Acceleration (rad/s2).
    pub acceleration: f64,
}

/// Friction and weight, at the motor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Friction {
    /// Friction that does not depend on the speed (N m), the losses of a gear under a steady load included.
    pub coulomb: Figure,
    /// Friction per speed (N m s/rad).
    pub viscous: Figure,
    /// Torque that is the same both ways: the weight of the load (N m).
    pub weight: Figure,
    /// Total inertia by the ramps (kg m2).
    pub inertia: Figure,
}

/// Least squares of `torque = weight + coulomb sign(speed) + viscous speed + inertia acceleration`.
pub(crate) fn fit(segments: &[Segment; SEGMENTS]) -> Result<Friction, Error> {
    let row = |segment: &Segment| [1.0, segment.speed.signum(), segment.speed, segment.acceleration];
    // Columns of like size.
    let mut scale = [0.0_f64; 4];
    for segment in segments {
        for (scale, value) in scale.iter_mut().zip(row(segment)) {
            *scale = scale.max(value.abs());
        }
    }
    if !scale.iter().all(|scale| *scale > 0.0) {
        return Err(Error::InertiaUnclear);
    }
    let scaled = |segment: &Segment| {
        let mut row = row(segment);
        for (value, scale) in row.iter_mut().zip(scale) {
            *value /= scale;
        }
        row
    };
    let (mut normal, mut right) = (Matrix::<4, 4>::ZERO, Matrix::<4, 1>::ZERO);
    for segment in segments {
        let row = scaled(segment);
        for ((line, right), a) in normal.0.iter_mut().zip(&mut right.0).zip(row) {
            for (entry, b) in line.iter_mut().zip(row) {
                *entry += a * b;
            }
            right[0] += a * segment.torque;
        }
    }
    let Some(inverse) = normal.solve(&Matrix::diagonal(&[1.0; 4])) else { return Err(Error::InertiaUnclear) };
    let x = inverse.times(&right);
    let mut residual = 0.0;
    for segment in segments {
        let mut left = segment.torque;
        for (a, [x]) in scaled(segment).into_iter().zip(x.0) {
            left -= a * x;
        }
        residual += left * left;
    }
    let variance = residual / (SEGMENTS - 4) as f64;
    let figure = |k: usize| {
        let value = x.0.get(k).map_or(0.0, |[x]| *x);
        let spread = inverse.0.get(k).and_then(|row| row.get(k)).map_or(0.0, |v| sqrt((variance * v).max(0.0)));
        let scale = scale.get(k).map_or(1.0, |scale| *scale);
        Figure { value: value / scale, standard_deviation: spread / scale }
    };
    let friction = Friction { weight: figure(0), coulomb: figure(1), viscous: figure(2), inertia: figure(3) };
    let inertia = friction.inertia;
    // A fifth, well within the servo's tolerance.
    if inertia.value > 0.0 && inertia.standard_deviation < 0.2 * inertia.value {
        Ok(friction)
    } else {
        Err(Error::InertiaUnclear)
    }
}
