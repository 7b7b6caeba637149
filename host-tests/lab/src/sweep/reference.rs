//! Reference: the exact motion of two masses under torques held over a tick, by independent arithmetic.
//!
//! In the twist times omega, the slip and the time times omega the pair is `x1' = x2`, `x2' = u - x1 - 2 zeta x2` with
//! `u = (tau_m/J_m + tau_L/J_l)/omega`. Its step is the exponential of the joined matrix of states and input, as a
//! Taylor series of a small part of the tick and repeated squaring of `e^M - 1`.

use super::grid::{PERIOD, Place};

type Three = [[f64; 3]; 3];

/// The state that every step is compared with.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// Motor speed (rad/s).
    pub motor_speed: f64,
    /// Shaft torque (N m).
    pub shaft_torque: f64,
    /// Load speed (rad/s).
    pub load_speed: f64,
    /// Square root of twice the kinetic and the strain energy.
    pub size: f64,
}

/// The exact motion in `f64`.
#[derive(Clone, Debug)]
pub struct Reference {
    increment: [[f64; 3]; 2],
    omega: f64,
    damping: f64,
    inertias: [f64; 2],
    load_torque: f64,
    twist: f64,
    slip: f64,
    mean: f64,
}

impl Reference {
    /// At rest, with a load torque that begins now.
    pub fn new(place: &Place, load_torque: f64) -> Self {
        let x = place.omega_t;
        let machine = place.machine();
        let whole = exponential_less_one(&[[0.0, x, 0.0], [-x, -2.0 * place.damping * x, x], [0.0; 3]]);
        Reference {
            increment: [whole[0], whole[1]],
            omega: place.omega(),
            damping: place.damping,
            inertias: [machine.motor_inertia, machine.load_inertia],
            load_torque,
            twist: 0.0,
            slip: 0.0,
            mean: 0.0,
        }
    }

    /// A tick under a motor torque (N m).
    #[inline]
    pub fn tick(&mut self, torque: f64) {
        let [motor, load] = self.inertias;
        let forcing = (torque / motor + self.load_torque / load) / self.omega;
        let pair = [self.twist, self.slip, forcing];
        let [twist, slip] = self.increment.map(|row| row[0] * pair[0] + row[1] * pair[1] + row[2] * pair[2]);
        self.twist += twist;
        self.slip += slip;
        self.mean += PERIOD * (torque - self.load_torque) / (motor + load);
    }

    /// The state now.
    #[inline]
    pub fn state(&self) -> Truth {
        let [motor, load] = self.inertias;
        let total = motor + load;
        let reduced = motor * (load / total);
        let motor_speed = self.mean + self.slip * (load / total);
        let load_speed = self.mean - self.slip * (motor / total);
        let shaft_torque = reduced * self.omega * (self.twist + 2.0 * self.damping * self.slip);
        let energy =
            motor * motor_speed * motor_speed + load * load_speed * load_speed + reduced * self.twist * self.twist;
        Truth { motor_speed, shaft_torque, load_speed, size: energy.sqrt() }
    }
}

/// `e^M - 1`.
fn exponential_less_one(matrix: &Three) -> Three {
    let norm = matrix.iter().map(|row| row.iter().map(|value| value.abs()).sum::<f64>()).fold(0.0, f64::max);
    let squarings = if norm > 0.5 { (2.0 * norm).log2().ceil() as i32 } else { 0 };
    let small = matrix.map(|row| row.map(|value| value * 0.5_f64.powi(squarings)));
    // Horner's scheme up to x^17/17!: what is left out is below 0.5^18/18! = 6e-22.
    let mut sum = [[0.0; 3]; 3];
    for order in (1..=17).rev() {
        for (diagonal, row) in sum.iter_mut().enumerate() {
            row[diagonal] += 1.0;
        }
        sum = product(&small, &sum).map(|row| row.map(|value: f64| value / f64::from(order)));
    }
    for _ in 0..squarings {
        let square = product(&sum, &sum);
        for (row, squared) in sum.iter_mut().zip(square) {
            for (value, more) in row.iter_mut().zip(squared) {
                *value = 2.0 * *value + more;
            }
        }
    }
    sum
}

fn product(left: &Three, right: &Three) -> Three {
    core::array::from_fn(|row| {
        core::array::from_fn(|column| (0..3).map(|inner| left[row][inner] * right[inner][column]).sum())
    })
}
