//! Time of a start against a load that depends on the speed.

use super::{Characteristic, Parabola};
use crate::machine::{Rigid, Speed};

/// Nodes and weights of Gauss's quadrature with ten points, those of one half [Abramowitz and Stegun, table 25.4].
const GAUSS: [[f64; 2]; 5] = [
    [0.148_874_338_981_631_2, 0.295_524_224_714_752_9],
    [0.433_395_394_129_247_2, 0.269_266_719_309_996_4],
    [0.679_409_568_299_024_4, 0.219_086_362_515_982_04],
    [0.865_063_366_688_984_5, 0.149_451_349_150_580_6],
    [0.973_906_528_517_171_7, 0.066_671_344_308_688_14],
];

/// Coefficients of a polynomial in the speed, lowest first.
type Polynomial = [f64; 5];

impl Characteristic {
    /// Time (s) in which the motor takes a rigid machine from one speed up to another against a load torque, constant
    /// or rising as that of a fan: `J integral of d omega/(tau - tau_L)`. Infinite where the torque does not suffice.
    /// The machine's own weight is not included: it belongs in `load.constant`.
    ///
    /// Torque less load is a ratio of polynomials for every characteristic. The integral is cut into pieces so short
    /// that no root of the numerator lies within 2.6 half-lengths of a middle, where Gauss's ten points are within a
    /// few 1e-12 [Trefethen, Approximation Theory and Approximation Practice, theorem 19.3].
    ///
    /// ```
    /// # use driveline::machine::{Characteristic, Inertia, Induction, Parabola, Rigid, Speed, Torque};
    /// const MOTOR: Characteristic =
    ///     Characteristic::Induction(Induction::new(Speed(154.99), Torque(750.0), Speed(157.08), 2.5));
    /// const FAN: Parabola = Parabola { constant: 40.0, linear: 0.0, square: 0.025 };
    /// const TIME: f64 = MOTOR.time_to(&Rigid::new(Inertia(60.0)), &FAN, Speed(0.0), Speed(154.0));
    /// assert!(TIME > 25.0 && TIME < 35.0);
    /// ```
    #[must_use]
    pub const fn time_to(&self, machine: &Rigid, load: &Parabola, from: Speed, to: Speed) -> f64 {
        let load = [load.constant, load.linear, load.square];
        let (from, to) = (from.0, to.0);
        if !(from.is_finite() && to.is_finite()) {
            return f64::INFINITY;
        }
        let one = [1.0, 0.0, 0.0];
        machine.inertia
            * match self {
                Self::Line(line) => duration([line.stall, -line.slope, 0.0], one, load, from, to),
                Self::Parabola(curve) => duration([curve.constant, curve.linear, curve.square], one, load, from, to),
                Self::Series(motor) => {
                    let (r, c) = (motor.resistance, motor.flux);
                    let supply = [c * motor.voltage * motor.voltage, 0.0, 0.0];
                    duration(supply, [r * r, 2.0 * r * c, c * c], load, from, to)
                }
                Self::Induction(motor) => {
                    let (a, w) = (motor.breakdown_slip, motor.synchronous);
                    let twice = 2.0 * motor.breakdown * a;
                    let square = [1.0 + a * a, -2.0 / w, 1.0 / (w * w)];
                    duration([twice, -twice / w, 0.0], square, load, from, to)
                }
            }
    }
}

/// `integral of under/(over - load under)` from one speed to another, 0 where the other is not above.
const fn duration(over: [f64; 3], under: [f64; 3], load: [f64; 3], from: f64, to: f64) -> f64 {
    let (mut surplus, mut below) = ([0.0; 5], [0.0; 5]);
    each!(i, 0..3, {
        surplus[i] += over[i];
        below[i] = under[i];
        each!(j, 0..3, {
            surplus[i + j] -= load[i] * under[j];
        });
    });
    let (mut sum, mut speed) = (0.0, from);
    while speed < to {
        let left = to - speed;
        let mut length = left;
        // In front of a root the pieces shrink in proportion to its distance.
        while !is_far(&surplus, speed + 0.5 * length, 1.3 * length) {
            length *= 0.5;
            if !(speed + 0.5 * length > speed) {
                return f64::INFINITY;
            }
        }
        let (middle, half) = (speed + 0.5 * length, 0.5 * length);
        each!(node, 0..GAUSS.len(), {
            let [at, weight] = GAUSS[node];
            let (left, right) = (middle - half * at, middle + half * at);
            sum += half * weight * (value(&below, left) / value(&surplus, left));
            sum += half * weight * (value(&below, right) / value(&surplus, right));
        });
        speed = if length == left { to } else { speed + length };
    }
    sum
}

/// Whether the polynomial is positive at a place and at least half of that in the circle of a radius about it.
const fn is_far(polynomial: &Polynomial, at: f64, radius: f64) -> bool {
    // Taylor's coefficients at the place, by Horner's scheme again and again.
    let mut shifted = *polynomial;
    each!(row, 0..4, {
        let mut k = 3;
        while k + 1 > row {
            shifted[k] += at * shifted[k + 1];
            if k == 0 {
                break;
            }
            k -= 1;
        }
    });
    let (mut swing, mut power, mut k) = (0.0, 1.0, 1);
    while k < 5 {
        power *= radius;
        swing += shifted[k].abs() * power;
        k += 1;
    }
    shifted[0] > 0.0 && swing <= 0.5 * shifted[0]
}

const fn value(polynomial: &Polynomial, at: f64) -> f64 {
    let [a, b, c, d, e] = *polynomial;
    a + at * (b + at * (c + at * (d + at * e)))
}
