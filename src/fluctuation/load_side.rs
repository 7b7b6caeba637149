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
use super::series::{Circle, FourierSeries, MAX_ORDER, Order, circle};
use super::{Bin, CycleConfig, Ripple, Summed, WaveformConfig, Window};
use crate::number::Real;

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
pub struct LoadSide<R = f64> {
    /// Torque of the shaft over the angle of the cycle (N m).
    pub shaft_torque: FourierSeries<R>,
    /// Speed of the load (rad/s), its trend taken off.
    pub load_speed: FourierSeries<R>,
    /// Torque of the load (N m).
    pub load_torque: FourierSeries<R>,
    /// Extremes of the load's speed, and its delta. The deviation is the motor's, by the order that the shaft magnifies
    /// most.
    pub load: Fluctuations<R>,
    /// Energy swing over the cycle, largest less least of the kinetic energy of both masses and the energy in the
    /// shaft: A_max (J) [Notes ch. 5].
    pub energy_swing: R,
}

impl<N: Summed, const BINS: usize> Window<N, BINS> {
    /// The motor's torque over the angle of the cycle (N m), with orders up to `highest`: the mean of each bin over the
    /// window. A bin without a tick has the torque of the one before it.
    pub fn motor_torque(&self, config: &WaveformConfig, highest: usize) -> FourierSeries<N::Real> {
        let r = <N::Real as Real>::of;
        let of = |bin: &Bin<N>| {
            let total = N::total_to_real(bin.torque) * r(config.cycle.torque);
            (bin.ticks > 0).then(|| total / N::Real::count(bin.ticks))
        };
        let mut last = self.kept().iter().fold(N::Real::ZERO, |last, bin| of(bin).unwrap_or(last));
        let torques = self.kept().iter().map(|bin| {
            last = of(bin).unwrap_or(last);
            last
        });
        let mut series = FourierSeries::sampled(torques, BINS, r(0.5), highest);
        // A bin's mean is smaller than the value at its middle: sin(x)/x of half a bin.
        for (n, order) in (1_u32..).zip(&mut series.orders) {
            let x = N::Real::count(n) * r(0.5 * TAU / BINS as f64);
            let (sin, _) = x.sin_cos();
            order.cos *= x / sin;
            order.sin *= x / sin;
        }
        series
    }
}

impl<R: Real> Ripple<R> {
    /// The waveforms on the load side under the motor's `torque` over the cycle.
    ///
    /// Not for the tick: some ten thousand operations.
    pub fn load_side(&self, cycle: &CycleConfig, machine: &Drivetrain, torque: &FourierSeries<R>) -> LoadSide<R> {
        let circle = circle();
        let angle = R::of(cycle.angle);
        let per_angle = R::of(TAU) / angle;
        let [motor, load, stiffness, damping] =
            [machine.motor_inertia, machine.load_inertia, machine.stiffness, machine.damping].map(R::of);
        let turning = self.speed.mean * per_angle;
        let shaft_torque = self.reaction(&self.speed, torque, motor, per_angle, &circle);
        let mut twist = FourierSeries::constant(shaft_torque.mean / stiffness);
        let (fitted, mut magnified) = (R::count(self.speed.highest() as u32), R::ZERO);
        for ((n, torque), twist) in (1_u32..).zip(&shaft_torque.orders).zip(&mut twist.orders) {
            let n = R::count(n);
            let (k, d) = (stiffness, damping * turning * n);
            let size = k * k + d * d;
            // of an order of the motor's speed: 1 - J w^2/(k + i d w)
            let left = k - motor * (turning * n) * (turning * n);
            let square = (left * left + d * d) / size;
            magnified = if fitted >= n { square.max(magnified) } else { magnified };
            *twist =
                Order { cos: (k * torque.cos - d * torque.sin) / size, sin: (k * torque.sin + d * torque.cos) / size };
        }
        let slope = twist.derivative();
        let values = circle.map(|(cos, sin)| {
            let speed = self.speed.along(cos, sin);
            speed - speed * slope.along(cos, sin) * per_angle
        });
        let load_speed = FourierSeries::of(&values, &circle, shaft_torque.highest());
        let load_torque = self.reaction(&load_speed, &shaft_torque, load, per_angle, &circle);
        let (mut least, mut most) = (R::INFINITY, -R::INFINITY);
        for &(cos, sin) in &circle {
            // less that of the means, which would hide a small swing
            let above = |series: &FourierSeries<R>| {
                let value = series.along(cos, sin);
                (value - series.mean) * (value + series.mean)
            };
            let kinetic = motor * above(&self.speed) + load * above(&load_speed);
            let energy = R::of(0.5) * (kinetic + stiffness * above(&twist));
            least = energy.min(least);
            most = energy.max(most);
        }
        let deviation = self.motor.deviation * magnified.sqrt();
        let load = Fluctuations { deviation, ..load_speed.fluctuations(self.mean, angle, &circle) };
        LoadSide { shaft_torque, load_speed, load_torque, load, energy_swing: most - least }
    }

    /// Torque beyond an inertia accelerated as in `speed`: `torque - J d omega/dt`, d/dt being omega d/dphi and the
    /// trend. That product of two series of n orders has 2 n.
    #[inline(never)]
    fn reaction(
        &self,
        speed: &FourierSeries<R>,
        torque: &FourierSeries<R>,
        inertia: R,
        per_angle: R,
        circle: &Circle<R>,
    ) -> FourierSeries<R> {
        let slope = speed.derivative();
        let values = circle.map(|(cos, sin)| {
            let acceleration = speed.along(cos, sin) * slope.along(cos, sin) * per_angle + self.acceleration;
            torque.along(cos, sin) - inertia * acceleration
        });
        FourierSeries::of(&values, circle, (2 * speed.highest()).min(MAX_ORDER))
    }
}
