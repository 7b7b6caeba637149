//! Inertia and torque of a mechanism over its turn, learnt from a run at two speeds.

use crate::machine::{MECHANISM_POINTS, Mechanism, MechanismPoint};
use crate::math::{sin_cos, sqrt};

/// Least squares of a mechanism, in `P` unknowns: `4 K + 3` for K orders of inertia and of torque.
///
/// Takes `8 P^2` bytes. A segment is a part of a turn, such as a sixty-fourth.
///
/// Between two angles a and b of the crank the work of the motor becomes kinetic energy, and what weight and friction
/// take:
///
/// ```text
/// 1/2 [J omega^2]_a^b + int_a^b G dphi + c int_a^b omega dphi = int_a^b tau dphi
/// ```
///
/// \[derived\]. J and G are Fourier series of the crank's angle with unknown coefficients, c is the viscous friction:
/// linear least squares. Two speeds part J from G; the change from one to the other gives the size of J.
///
/// ```
/// use core::f64::consts::TAU;
/// use driveline::learning::MechanismFit;
/// // a flywheel of 3 kg m2 with 5 N m of friction: a turn at 10 rad/s, a turn up to 20, a turn there
/// let mut fit = MechanismFit::<7>::default();
/// let turns = [[10.0, 10.0], [10.0, 20.0], [20.0, 20.0]];
/// for (turn, [from, to]) in turns.into_iter().enumerate() {
///     for k in 0..64 {
///         let parts = [k, k + 1].map(|k| k as f64 / 64.0);
///         let angle = parts.map(|part| (turn as f64 + part) * TAU);
///         let speed = parts.map(|part| from + (to - from) * part);
///         let work = 1.5 * (speed[1].powi(2) - speed[0].powi(2)) + 5.0 * (angle[1] - angle[0]);
///         fit.segment(angle, speed, work);
///     }
/// }
/// let learnt = fit.mechanism().ok_or("one speed alone")?;
/// assert!((learnt.mechanism.mean_inertia().0 - 3.0).abs() < 1e-6 && (learnt.friction - 5.0).abs() < 1e-6);
/// # Ok::<(), &str>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MechanismFit<const P: usize> {
    normal: [[f64; P]; P],
    right: [f64; P],
}

impl<const P: usize> Default for MechanismFit<P> {
    fn default() -> Self {
        const { assert!(P >= 7 && P % 4 == 3, "a fit of K orders has 4 K + 3 unknowns") };
        Self { normal: [[0.0; P]; P], right: [0.0; P] }
    }
}

impl<const P: usize> MechanismFit<P> {
    /// Orders of inertia and torque.
    const ORDERS: usize = (P - 3) / 4;
    const SERIES: usize = 2 * Self::ORDERS + 1;

    /// Takes a segment: angles (rad, from the mechanism's zero) and speeds (rad/s) of the crank at its two ends, and
    /// the work of the motor at the crank's shaft (J) between them. The speed counts as straight over the angle. It is
    /// to be filtered without delay: its noise makes the inertia too small. Leave out a segment in which the crank
    /// stands or turns back, where friction turns round: a few of them cost several percent.
    pub fn segment(&mut self, [from, to]: [f64; 2], [slow, fast]: [f64; 2], work: f64) {
        let mut row = [0.0; P];
        let (kinetic_from, kinetic_to) = (0.5 * slow * slow, 0.5 * fast * fast);
        let turned = to - from;
        row[0] = kinetic_to - kinetic_from;
        row[Self::SERIES] = turned;
        for order in 1..=Self::ORDERS {
            let k = order as f64;
            let ((s0, c0), (s1, c1)) = (sin_cos(k * from), sin_cos(k * to));
            let (cosine, sine) = (2 * order - 1, 2 * order);
            row[cosine] = kinetic_to * c1 - kinetic_from * c0;
            row[sine] = kinetic_to * s1 - kinetic_from * s0;
            row[Self::SERIES + cosine] = (s1 - s0) / k;
            row[Self::SERIES + sine] = (c0 - c1) / k;
        }
        row[P - 1] = 0.5 * (slow + fast) * turned;
        for (i, &of) in row.iter().enumerate() {
            for (sum, &with) in self.normal[i].iter_mut().zip(&row) {
                *sum += of * with;
            }
            self.right[i] += of * work;
        }
    }

    /// The mechanism on the crank's shaft with all that turns at a constant ratio to it; `None` where the run does not
    /// determine it, as at one speed alone. Its tool has the torque of the weight without the mean as its leverage, at a
    /// weight of 1.
    #[must_use]
    pub fn mechanism(&self) -> Option<LearntMechanism> {
        let x = solved(&self.normal, &self.right)?;
        let mut points = [MechanismPoint::default(); MECHANISM_POINTS];
        for (j, point) in points.iter_mut().enumerate() {
            let angle = core::f64::consts::TAU * j as f64 / MECHANISM_POINTS as f64;
            point.inertia = x[0];
            for order in 1..=Self::ORDERS {
                let k = order as f64;
                let (sine, cosine) = sin_cos(k * angle);
                let (a, b) = (x[2 * order - 1], x[2 * order]);
                point.inertia += a * cosine + b * sine;
                point.derivative += k * (b * cosine - a * sine);
                point.leverage += x[Self::SERIES + 2 * order - 1] * cosine + x[Self::SERIES + 2 * order] * sine;
            }
        }
        let mechanism = Mechanism::of_points(points).weight(1.0);
        Some(LearntMechanism { mechanism, friction: x[Self::SERIES], viscous: x[P - 1] })
    }
}

/// A mechanism that was learnt.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LearntMechanism {
    /// Inertia over the turn, and torque of the weight.
    pub mechanism: Mechanism,
    /// Constant friction (N m).
    pub friction: f64,
    /// Viscous friction (N m s/rad).
    pub viscous: f64,
}

/// Solution of symmetric equations by Cholesky, each unknown in the unit of its diagonal; `None` where they are
/// singular to rounding.
fn solved<const P: usize>(normal: &[[f64; P]; P], right: &[f64; P]) -> Option<[f64; P]> {
    let mut unit = [0.0; P];
    for (k, unit) in unit.iter_mut().enumerate() {
        *unit = sqrt(normal[k][k]);
        if !(*unit > 0.0 && unit.is_finite()) {
            return None;
        }
    }
    let mut lower = [[0.0; P]; P];
    let mut x = [0.0; P];
    for i in 0..P {
        for j in 0..=i {
            let scaled = normal[i][j] / (unit[i] * unit[j]);
            let rest = scaled - (0..j).map(|k| lower[i][k] * lower[j][k]).sum::<f64>();
            if i == j && !(rest > 1e-11) {
                return None;
            }
            lower[i][j] = if i == j { sqrt(rest) } else { rest / lower[j][j] };
        }
        x[i] = (right[i] / unit[i] - (0..i).map(|k| lower[i][k] * x[k]).sum::<f64>()) / lower[i][i];
    }
    for i in (0..P).rev() {
        x[i] = (x[i] - (i + 1..P).map(|k| lower[k][i] * x[k]).sum::<f64>()) / lower[i][i];
    }
    for (value, unit) in x.iter_mut().zip(unit) {
        *value /= unit;
    }
    Some(x)
}
