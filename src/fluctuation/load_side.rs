//! Load side, order by order: shaft torque, load speed and load torque from the motor's speed and torque, without an
//! observer's lag.
//!
//! ```text
//! T = tau_m - J_m d omega_m/dt,   k delta + d d delta/dt = T,   omega_l = omega_m - d delta/dt,
//! tau_L = T - J_l d omega_l/dt
//! ```
//!
//! The law needs no knowledge of the load's torque, which an observer has to guess. It differentiates: the rounding of
//! the encoder's counts grows with the square of the order in the shaft torque, with its cube in the load's speed, so
//! take few orders.

use core::f64::consts::TAU;

use super::extremes::Fluctuations;
use super::series::{Circle, Order, Series, circle};
use super::{Bin, CycleConfig, Ripple, Summed, WaveformConfig, Window};
use crate::math::sqrt;

/// Two masses and their shaft, referred to the motor.
///
/// ```
/// use driveline::fluctuation::Drivetrain;
/// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
/// // from the machine of the design
/// const MILL: TwoMass = TwoMass::new(Inertia(0.5), Inertia(0.25), Stiffness(1.0e4), Damping(2.0));
/// assert_eq!(Drivetrain::of(&MILL).load_inertia, 0.25);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Drivetrain {
    /// Inertia of the motor (kg m2).
    pub motor_inertia: f64,
    /// Inertia of the load (kg m2).
    pub load_inertia: f64,
    /// Stiffness between them (N m/rad).
    pub stiffness: f64,
    /// Damping between them (N m s/rad).
    pub damping: f64,
}

/// Waveforms on the load side.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadSide {
    /// Torque of the shaft over the angle of the cycle (N m).
    pub shaft_torque: Series,
    /// Speed of the load (rad/s), its trend taken off.
    pub load_speed: Series,
    /// Torque of the load (N m).
    pub load_torque: Series,
    /// Extremes of the load's speed, and its delta. The deviation is the motor's, by the order that the shaft magnifies
    /// most.
    pub load: Fluctuations,
    /// Energy swing over the cycle, largest less least of the kinetic energy of both masses and the energy in the
    /// shaft: A_max (J) [Notes ch. 5].
    pub energy_swing: f64,
}

impl<N: Summed, const BINS: usize> Window<N, BINS> {
    /// The motor's torque over the angle of the cycle (N m), with orders up to `highest`: the mean of each bin over the
    /// window. A bin without a tick has the torque of the one before it.
    pub fn motor_torque(&self, config: &WaveformConfig, highest: usize) -> Series {
        let of = |bin: &Bin<N>| {
            (bin.ticks > 0).then(|| N::total_to_real(bin.torque) / f64::from(bin.ticks) * config.cycle.torque)
        };
        let mut last = self.bins.iter().rev().find_map(of).unwrap_or(0.0);
        let torques = self.bins.iter().map(|bin| {
            last = of(bin).unwrap_or(last);
            last
        });
        let mut series = Series::sampled(torques, BINS, 0.5, highest);
        // A bin's mean is smaller than the value at its middle: sin(x)/x of half a bin.
        for (n, order) in (1_u32..).zip(&mut series.orders) {
            let x = f64::from(n) * 0.5 * TAU / BINS as f64;
            let (sin, _) = crate::math::sin_cos(x);
            order.cos *= x / sin;
            order.sin *= x / sin;
        }
        series
    }
}

impl Ripple {
    /// The waveforms on the load side under the motor's `torque` over the cycle.
    ///
    /// Not for the tick: some ten thousand operations in `f64`.
    pub fn load_side(&self, cycle: &CycleConfig, machine: &Drivetrain, torque: &Series) -> LoadSide {
        let circle = circle();
        let per_angle = TAU / cycle.angle;
        let turning = self.speed.mean * per_angle;
        let shaft_torque = self.reaction(&self.speed, torque, machine.motor_inertia, per_angle, &circle);
        let mut twist = Series { mean: shaft_torque.mean / machine.stiffness, ..Series::default() };
        let mut load_speed = self.speed;
        let (fitted, mut magnified) = (self.speed.highest() as f64, 0.0_f64);
        for (((n, torque), twist), speed) in
            (1_u32..).zip(&shaft_torque.orders).zip(&mut twist.orders).zip(&mut load_speed.orders)
        {
            let n = f64::from(n);
            let (k, d) = (machine.stiffness, machine.damping * turning * n);
            let size = k * k + d * d;
            // of an order of the motor's speed: 1 - J w^2/(k + i d w)
            let inertial = machine.motor_inertia * (turning * n) * (turning * n);
            let square = ((k - inertial) * (k - inertial) + d * d) / size;
            magnified = if fitted >= n { magnified.max(sqrt(square)) } else { magnified };
            *twist =
                Order { cos: (k * torque.cos - d * torque.sin) / size, sin: (k * torque.sin + d * torque.cos) / size };
            let rate = twist.derivative(n);
            speed.cos -= turning * rate.cos;
            speed.sin -= turning * rate.sin;
        }
        let load_torque = self.reaction(&load_speed, &shaft_torque, machine.load_inertia, per_angle, &circle);
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for &(cos, sin) in &circle {
            let [motor, load, twist] = [&self.speed, &load_speed, &twist].map(|series| series.along(cos, sin));
            let kinetic = machine.motor_inertia * motor * motor + machine.load_inertia * load * load;
            let energy = 0.5 * (kinetic + machine.stiffness * twist * twist);
            least = energy.min(least);
            most = energy.max(most);
        }
        let deviation = self.motor.deviation * magnified;
        let load = Fluctuations { deviation, ..load_speed.fluctuations(self.mean, cycle.angle, &circle) };
        LoadSide { shaft_torque, load_speed, load_torque, load, energy_swing: most - least }
    }

    /// Torque beyond an inertia accelerated as in `speed`: `torque - J d omega/dt`, d/dt being omega d/dphi and the
    /// trend.
    fn reaction(&self, speed: &Series, torque: &Series, inertia: f64, per_angle: f64, circle: &Circle) -> Series {
        let slope = speed.derivative();
        let values = circle.map(|(cos, sin)| {
            let acceleration = speed.along(cos, sin) * slope.along(cos, sin) * per_angle + self.acceleration;
            torque.along(cos, sin) - inertia * acceleration
        });
        Series::of(&values, circle, speed.highest())
    }
}
