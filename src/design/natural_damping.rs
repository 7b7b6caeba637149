//! Natural damping: what the characteristics of prime mover and load add to a speed loop by themselves.

use super::complex::{Complex, over, plus, scaled, times};
use super::{Error, Matrix, discretise};
use crate::machine::{Characteristic, Speed, TwoMass};

/// Slopes of the characteristics at the operating speed, positive where they damp: `-d tau_m/d omega` at the motor's
/// mass and `d tau_L/d omega` at the load's, both referred to the motor. Stiffness of a characteristic [Wang 1989
/// §1-2]; of turbines and engines "self-regulation".
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct NaturalDamping {
    /// Fall of the prime mover's torque with the speed, its actuator at rest (N m s/rad).
    pub motor: f64,
    /// Rise of the load's torque with the speed (N m s/rad).
    pub load: f64,
}

impl NaturalDamping {
    /// Torques that do not depend on the speed.
    pub const NONE: Self = Self { motor: 0.0, load: 0.0 };

    /// That of a prime mover and of a load's torque, both at the motor's shaft, at a speed. Of an engine it is the
    /// slope of the full-load curve, above rated speed that of the engine's own governor: not for an engine whose
    /// governor this one replaces.
    ///
    /// ```
    /// # use driveline::design::NaturalDamping;
    /// # use driveline::machine::{Characteristic, Induction, Parabola, Speed, Torque};
    /// const MOTOR: Characteristic =
    ///     Characteristic::Induction(Induction::new(Speed(154.99), Torque(750.0), Speed(157.08), 2.5));
    /// const FAN: Characteristic =
    ///     Characteristic::Parabola(Parabola { constant: 0.0, linear: 0.0, square: 750.0 / (154.99 * 154.99) });
    /// let damping = NaturalDamping::of(&MOTOR, &FAN, Speed(154.99));
    /// assert!((damping.load - 2.0 * 750.0 / 154.99).abs() < 1e-9);
    /// assert!(damping.motor > 300.0);
    /// ```
    #[must_use]
    pub const fn of(motor: &Characteristic, load: &Characteristic, speed: Speed) -> Self {
        Self { motor: -motor.slope(speed), load: load.slope(speed) }
    }

    /// Both together (N m s/rad).
    #[must_use]
    pub const fn sum(&self) -> f64 {
        self.motor + self.load
    }

    /// Unstable poles of a machine with this damping by Routh's criterion, apart from that of its rigid motion:
    /// `J_m J_l s^3 + (J_m (d + d_l) + J_l (d + d_m)) s^2 + (k J + d_m d_l + d (d_m + d_l)) s + k (d_m + d_l)`.
    pub(super) const fn unstable_vibrations(&self, machine: &TwoMass) -> u32 {
        let (jm, jl, d) = (machine.motor_inertia, machine.load_inertia, machine.damping);
        let second = jm * (d + self.load) + jl * (d + self.motor);
        let first = machine.stiffness * (jm + jl) + self.motor * self.load + d * self.sum();
        let third = second * first - jm * jl * machine.stiffness * self.sum();
        // Changes of sign along 1, `second`, `third/second`, `sum`; one of them is the rigid motion's.
        let signs = [false, second < 0.0, (third < 0.0) != (second < 0.0), self.sum() < 0.0];
        let mut changes = 0;
        each!(k, 1..signs.len(), {
            if signs[k] != signs[k - 1] {
                changes += 1;
            }
        });
        if self.sum() < 0.0 { changes - 1 } else { changes }
    }

    /// The exact step of twist, motor speed and load speed under a torque that is held for a tick.
    pub(super) const fn step(&self, machine: &TwoMass, period: f64) -> Result<DampedStep, Error> {
        let (jm, jl) = (machine.motor_inertia, machine.load_inertia);
        let (k, d) = (machine.stiffness, machine.damping);
        let a = Matrix([
            [0.0, 1.0, -1.0],
            [-k / jm, -(d + self.motor) / jm, d / jm],
            [k / jl, d / jl, -(d + self.load) / jl],
        ]);
        let b = Matrix([[0.0], [1.0 / jm], [0.0]]);
        match discretise::<3, 1, 4>(&a, &b, period) {
            Some((f, g)) if self.motor.is_finite() && self.load.is_finite() => Ok(DampedStep { f, g }),
            _ => Err(Error::NaturalDamping),
        }
    }
}

/// `x[k+1] = F x[k] + G tau`.
#[derive(Clone, Copy)]
pub(super) struct DampedStep {
    f: Matrix<3, 3>,
    g: Matrix<3, 1>,
}

impl DampedStep {
    /// Response of the motor's and the load's speed to the torque, at `z - 1`.
    pub(super) const fn response(&self, less_one: Complex) -> [Complex; 2] {
        let (f, [[g0], [g1], [g2]]) = (&self.f.0, self.g.0);
        // (z - F) x = G with the twist, of the first row, put into the others; times the twist's coefficient
        let pivot = (less_one.0 - (f[0][0] - 1.0), less_one.1);
        let (a, b) = (reduced(pivot, less_one, f, 1, 1), reduced(pivot, less_one, f, 1, 2));
        let (c, e) = (reduced(pivot, less_one, f, 2, 1), reduced(pivot, less_one, f, 2, 2));
        let (p, q) = (plus(scaled(g1, pivot), (f[1][0] * g0, 0.0)), plus(scaled(g2, pivot), (f[2][0] * g0, 0.0)));
        let determinant = plus(times(a, e), scaled(-1.0, times(b, c)));
        let motor = plus(times(p, e), scaled(-1.0, times(b, q)));
        let load = plus(times(a, q), scaled(-1.0, times(c, p)));
        [over(motor, determinant), over(load, determinant)]
    }
}

/// Entry of z - F times the first, without what the first row takes.
const fn reduced(pivot: Complex, less_one: Complex, f: &[[f64; 3]; 3], row: usize, column: usize) -> Complex {
    let unit = if row == column { 1.0 } else { 0.0 };
    let own = (unit * less_one.0 - (f[row][column] - unit), unit * less_one.1);
    plus(times(own, pivot), (-f[row][0] * f[0][column], 0.0))
}
