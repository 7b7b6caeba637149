//! The flywheel for a permissible speed fluctuation, and whether one is the remedy.
//!
//! For a constant inertia J the work of the outer torques over the cycle swings by A_max, and delta is A_max/(J
//! omega_m^2) with the arithmetic mean [Notes ch. 5]; a flywheel of A_max/(omega_m^2 [delta]) less J does. Where
//! the inertia varies with the angle that is wrong, for the speed then swings without any work at all. The energy
//! balance holds always: `J(phi) omega^2/2` is the work W(phi) up to a constant. With a flywheel the speed follows from
//! `(J(phi) + J_F) omega'^2/2 = W'(phi)`, with W' reduced by the motor's fall of torque with speed.

use super::series::{Circle, FourierSeries, GRID, Grid, MAX_ORDER, circle};
use super::{CycleConfig, Ripple};
use crate::design::flywheel_inertia;
use crate::math::sqrt;
use crate::number::Real;

/// Class of machine with its permissible delta [Notes ch. 5].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MachineClass {
    /// Crusher, 1/20 to 1/5.
    Crusher,
    /// Punch, shear or forge, 1/10 to 1/7.
    Press,
    /// Farm machine, 1/50 to 1/10.
    Farm,
    /// Machine tool, 1/50 to 1/20.
    MachineTool,
    /// Car or tractor, 1/60 to 1/20.
    Vehicle,
    /// Marine engine, 1/150 to 1/20.
    MarineEngine,
    /// Compressor, 1/100 to 1/50.
    Compressor,
    /// Combustion engine, 1/150 to 1/80.
    CombustionEngine,
    /// Generator, 1/300 to 1/100.
    Generator,
}

impl MachineClass {
    /// The permissible delta: of the strictest and of the most tolerant machine of the class.
    pub const fn permissible(self) -> [f64; 2] {
        match self {
            MachineClass::Crusher => [1.0 / 20.0, 1.0 / 5.0],
            MachineClass::Press => [1.0 / 10.0, 1.0 / 7.0],
            MachineClass::Farm => [1.0 / 50.0, 1.0 / 10.0],
            MachineClass::MachineTool => [1.0 / 50.0, 1.0 / 20.0],
            MachineClass::Vehicle => [1.0 / 60.0, 1.0 / 20.0],
            MachineClass::MarineEngine => [1.0 / 150.0, 1.0 / 20.0],
            MachineClass::Compressor => [1.0 / 100.0, 1.0 / 50.0],
            MachineClass::CombustionEngine => [1.0 / 150.0, 1.0 / 80.0],
            MachineClass::Generator => [1.0 / 300.0, 1.0 / 100.0],
        }
    }
}

/// Remedy for a fluctuation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Remedy {
    /// All within limits.
    Nothing,
    /// A flywheel: the periodic part is too large.
    Flywheel,
    /// A governor: the mean moves too fast.
    Governor,
    /// Both.
    Both,
}

/// Inertia of the machine and slope of the motor's characteristic.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Balance {
    /// Inertia over the angle of the cycle, referred to the motor (kg m2): [`FourierSeries::constant`], or
    /// [`FourierSeries::from_samples`] of a table.
    pub inertia: FourierSeries,
    /// Fall of the driving torque with the speed (N m s/rad), 0 for a constant one.
    pub slope: f64,
}

/// A flywheel for a permissible delta.
///
/// ```
#[doc = include_str!("ripple.txt")]
/// const CYCLE: CycleConfig = CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI);
/// const CONFIG: WaveformConfig = WaveformConfig::new::<64>(CYCLE, 16);
/// let mut waveform = Waveform::<64, f64>::default();
/// let window = turning().find_map(|(angle, _)| {
///     waveform.measure(&CONFIG, angle, 0.0, &Estimate::default());
///     waveform.take()
/// });
/// // 4 % with 2 kg m2, 2 % wanted: as much again
/// let machine = Balance { inertia: FourierSeries::constant(2.0), slope: 0.0 };
/// let ripple = window.ok_or("it turns on and on")?.ripple(&CONFIG, 4)?;
/// let flywheel = ripple.flywheel(&CYCLE, &machine, 0.02).ok_or("no flywheel does")?;
/// assert!((flywheel.missing - 2.0).abs() < 0.02 && (flywheel.remaining - 0.02).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Flywheel {
    /// Swing of the kinetic energy over the cycle as it is (J).
    pub energy_swing: f64,
    /// Inertia to be added on the motor's shaft (kg m2); 0 where delta is permitted already.
    pub missing: f64,
    /// Delta by the arithmetic mean as it is, by the measured speed.
    pub delta: f64,
    /// Delta with the flywheel.
    pub remaining: f64,
}

impl<R: Real> Ripple<R> {
    /// The flywheel that brings delta, by the arithmetic mean, to `permissible`; `None` where no flywheel does, or a
    /// figure is not positive and finite.
    ///
    /// Not for the tick: some hundred thousand operations in `f64`, square roots among them.
    pub fn flywheel(&self, cycle: &CycleConfig, balance: &Balance, permissible: f64) -> Option<Flywheel> {
        let circle = circle();
        let speed: Grid<f64> = self.speed.grid(&super::series::circle()).map(Into::into);
        let mean: f64 = self.mean.into();
        let inertia = balance.inertia.grid(&circle);
        let sound = inertia.iter().all(|&inertia| inertia > 0.0 && inertia.is_finite())
            && speed.iter().all(|&speed| speed * mean > 0.0 && speed.is_finite());
        if !(sound && permissible > 0.0 && permissible.is_finite() && balance.slope >= 0.0 && balance.slope.is_finite())
        {
            return None;
        }
        let work = core::array::from_fn(|index| match (inertia.get(index), speed.get(index)) {
            (Some(inertia), Some(speed)) => 0.5 * inertia * speed * speed,
            _ => 0.0,
        });
        let (least, most) = extremes(&work);
        let machine = Machine { speed, inertia, work, slope: balance.slope, step: cycle.angle / GRID as f64 };
        let delta = self.motor.delta_arithmetic.into();
        let mut flywheel = Flywheel { energy_swing: most - least, missing: 0.0, delta, remaining: delta };
        if delta <= permissible {
            return Some(flywheel);
        }
        // 1/delta is next to a straight line over the inertia: the secant's method.
        let (mut before, mut at_before) = (0.0, 1.0 / machine.delta(0.0, &circle, cycle)?);
        let mean = self.motor.arithmetic_mean.into();
        let mut added = flywheel_inertia(flywheel.energy_swing, mean, permissible).max(1e-3 * balance.inertia.mean);
        for _ in 0..24 {
            let inverse = 1.0 / machine.delta(added, &circle, cycle)?;
            if (inverse * permissible - 1.0).abs() < 1e-9 || inverse == at_before {
                break;
            }
            let next = added + (1.0 / permissible - inverse) * (added - before) / (inverse - at_before);
            (before, at_before) = (added, inverse);
            added = if next > 0.0 { next } else { 0.5 * added };
        }
        flywheel.missing = added;
        flywheel.remaining = machine.delta(added, &circle, cycle)?;
        ((flywheel.remaining / permissible - 1.0).abs() < 1e-6).then_some(flywheel)
    }

    /// The remedy: a flywheel where delta exceeds the permissible value, a governor where the mean speed changes by
    /// more than `drift` of itself in a second.
    pub fn remedy(&self, permissible: f64, drift: f64) -> Remedy {
        let (delta, mean): (f64, f64) = (self.motor.delta.into(), self.mean.into());
        match (delta > permissible, self.acceleration.into().abs() > drift * mean.abs()) {
            (false, false) => Remedy::Nothing,
            (true, false) => Remedy::Flywheel,
            (false, true) => Remedy::Governor,
            (true, true) => Remedy::Both,
        }
    }
}

/// A machine over its cycle as it was measured.
struct Machine {
    speed: Grid<f64>,
    inertia: Grid<f64>,
    /// Kinetic energy, which is the work of all torques but for a constant.
    work: Grid<f64>,
    slope: f64,
    /// Angle between two points (rad).
    step: f64,
}

impl Machine {
    /// Delta by the arithmetic mean with a flywheel.
    fn delta(&self, added: f64, circle: &Circle<f64>, cycle: &CycleConfig) -> Option<f64> {
        // The mean speed over the angle is kept, for only then has the motor given the same work: Newton's method for
        // the energy to begin with.
        let mut energy = self.work.first()? + 0.5 * added * self.speed.first()? * self.speed.first()?;
        for _ in 0..20 {
            let (speed, off) = self.run(added, energy)?;
            let (_, beside) = self.run(added, energy * (1.0 + 1e-6))?;
            let change = off / ((beside - off) / (1e-6 * energy));
            energy -= change;
            if change.abs() < 1e-12 * energy {
                let series = FourierSeries::of(&speed, circle, MAX_ORDER);
                let mean = series.mean;
                return Some(series.fluctuations(mean, cycle.angle, circle).delta_arithmetic);
            }
        }
        None
    }

    /// The speed over a cycle that begins with this energy, and the sum of its increases; `None` where it stops. By the
    /// rule of trapezia for the motor's part, implicitly, so that a stiff motor does not matter.
    fn run(&self, added: f64, energy: f64) -> Option<(Grid<f64>, f64)> {
        let mut speeds: Grid<f64> = [0.0; GRID];
        let (mut energy, mut work, mut faster, mut sum) = (energy, *self.work.first()?, None, 0.0);
        let quarter = 0.5 * self.slope * self.step;
        for (((out, &was), &inertia), &now) in speeds.iter_mut().zip(&self.speed).zip(&self.inertia).zip(&self.work) {
            let was = was.abs();
            let total = inertia + added;
            let speed = match faster {
                None => sqrt(2.0 * energy / total),
                Some(faster) => {
                    // total w^2/2 + quarter w = the remainder once w is moved to this side.
                    let left = energy + (now - work) - quarter * (faster - was);
                    (sqrt(quarter * quarter + 2.0 * total * left) - quarter) / total
                }
            };
            if !(speed > 0.0) {
                return None;
            }
            energy = 0.5 * total * speed * speed;
            work = now;
            faster = Some(speed - was);
            sum += speed - was;
            *out = speed;
        }
        Some((speeds, sum))
    }
}

/// The least and the largest of a grid.
fn extremes(values: &Grid<f64>) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &value| (least.min(value), most.max(value)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Inertias of 3 and 1 kg m2 with 8 J run at 2 rad/s, as measured, and with 18 J at 3 rad/s, faster by 1 at each
    /// point. The work of a stop takes all of the 8 J.
    #[test]
    fn the_speed_is_that_of_the_energy() {
        let machine = |stop: f64| {
            let mut work = [8.0; GRID];
            work[5] = stop;
            Machine { speed: [2.0; GRID], inertia: [3.0; GRID], work, slope: 0.0, step: 0.1 }
        };
        assert_eq!(machine(8.0).run(1.0, 8.0), Some(([2.0; GRID], 0.0)));
        assert_eq!(machine(8.0).run(1.0, 18.0), Some(([3.0; GRID], GRID as f64)));
        assert_eq!(machine(0.0).run(1.0, 8.0), None);
        assert!(machine(0.125).run(1.0, 8.0).is_some());
    }
}
