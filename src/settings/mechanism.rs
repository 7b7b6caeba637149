//! Constants of the observer of a machine with a mechanism.

use super::Error;
use super::constants::constants;
use crate::angle::RotorAngleConfig;
use crate::design::MechanismDesign;
use crate::machine::MECHANISM_POINTS;
use crate::observer::{ForceLimitConfig, MechanismConfig, RigidConfig, TABLE_POINTS, TablePoint, Tool};

const GEAR: &str =
    "the crank must turn between 1/65536 and 15 times while the motor turns once, in at most 2^20 turns of the motor";
const LIGHT: &str = "the mechanism's inertia swings too far for its number: the least one must be above 0.35 of the \
    mean in fixed point";
const DRAG: &str = "the mechanism's inertia torque is too large for its number: in fixed point, at the base of the \
    speed, it must with that of the weight be below 0.9 of the base of the torque";
const SHARP: &str = "the mechanism's inertia torque has a peak that the observer's table of 64 places does not resolve: \
    off by more than a twentieth of the largest; move the bars away from their change point, lengthen the rod";
const WEIGHT: &str = "the mechanism has a weight that this observer leaves out: take ToolObserver";

/// Places of the machine's own table to one of the observer's.
const STRIDE: usize = MECHANISM_POINTS / TABLE_POINTS;

impl MechanismDesign {
    /// Mean inertia over inertia, torque of the inertia at the base of the speed per base of the torque, and leverage
    /// per unit of the largest: at a point of the table.
    const fn point(&self, k: usize, mean: f64, torque: f64, speed: f64, most: f64) -> [f64; 3] {
        let here = self.machine.point(k * STRIDE);
        let leverage = if most > 0.0 { here.leverage / most } else { 0.0 };
        [mean / here.inertia, 0.5 * here.derivative * speed * speed / torque, leverage]
    }

    /// Largest deviation of the inertia torque from the straight lines between the observer's places, of the largest
    /// inertia torque; infinite where one is no number.
    const fn between_places(&self) -> f64 {
        let (mut most, mut off) = (0.0_f64, 0.0_f64);
        each!(j, 0..MECHANISM_POINTS, {
            let (place, part) = (j - j % STRIDE, (j % STRIDE) as f64 / STRIDE as f64);
            let (from, to) = (self.machine.point(place).derivative, self.machine.point(place + STRIDE).derivative);
            let here = self.machine.point(j).derivative;
            let away = (here - from - part * (to - from)).abs();
            if !away.is_finite() {
                return f64::INFINITY;
            }
            (most, off) = (most.max(here.abs()), off.max(away));
        });
        if most > 0.0 { off / most } else { 0.0 }
    }

    const fn turning(&self) -> Result<RotorAngleConfig, Error> {
        match RotorAngleConfig::new(self.machine.turns, self.machine.motor_turns) {
            Some(turning) => Ok(turning),
            None => Err(Error::Value(GEAR)),
        }
    }

    /// The part of the mean inertia that lies behind the motor's shaft.
    const fn load_share(&self) -> f64 {
        1.0 - self.machine.constant / self.machine.mean_inertia()
    }
}

constants! {
    /// [`Error::Coefficient`] or [`Error::Value`] for a value beyond its number, a gear ratio out of range, a weight
    /// that the observer has no tool for, or an inertia that changes within less than the table's places.
    impl[const TOOLS: usize] MechanismConfig[, TOOLS], new, try_new(design: &MechanismDesign), |format| {
        if TOOLS > 1 || (TOOLS == 0 && design.machine.mechanism.weight != 0.0) {
            return Err(Error::Value(WEIGHT));
        }
        if design.between_places() > 0.05 {
            return Err(Error::Value(SHARP));
        }
        let rigid = get!(RigidConfig::<Number>::try_new(&design.rigid, design.load_share(), format.bases));
        let mean = design.machine.mean_inertia();
        let most = design.machine.most_leverage();
        let heavy = design.machine.mechanism.weight * most / format.bases.torque;
        let none = get!(To::exactly(0.0, DRAG));
        let mut points = [TablePoint { inertia_ratio: none, inertia_slope: none }; TABLE_POINTS];
        let weight = if TOOLS == 0 { none } else { get!(To::exactly(heavy, DRAG)) };
        let mut tool = [Tool { leverage: [none; TABLE_POINTS], weight }; TOOLS];
        each!(k, 0..TABLE_POINTS, {
            let [inertia_ratio, inertia_slope, leverage] =
                design.point(k, mean, format.bases.torque, format.bases.speed, most);
            // With the accelerating torque held within twice the base, the torque that is given stays within the
            // headroom.
            if format.unit != 1.0 && !(inertia_ratio < 1.0 / 0.35) {
                return Err(Error::Value(LIGHT));
            }
            if format.unit != 1.0 && !(inertia_slope.abs() + heavy.abs() * leverage.abs() < 0.9) {
                return Err(Error::Value(DRAG));
            }
            points[k] = TablePoint {
                inertia_ratio: get!(To::exactly(inertia_ratio, LIGHT)),
                inertia_slope: get!(To::exactly(inertia_slope, DRAG)),
            };
            if TOOLS > 0 {
                tool[0].leverage[k] = get!(To::exactly(leverage, DRAG));
            }
        });
        Ok(MechanismConfig { rigid, turning: get!(design.turning()), points, tool })
    }
}

const FORCE: &str = "the limit of the tool's force and its idle torque must be numbers of the torque's base, limit and \
    least leverage positive, of a mechanism with a tool";

constants! {
    /// [`Error::Value`] for a mechanism without a tool, a torque beyond its number, or a least leverage that is not
    /// positive.
    impl[] ForceLimitConfig[], new, try_new(design: &MechanismDesign, force: f64, idle: f64, least: f64), |format| {
        let full = force * design.machine.most_leverage() / format.bases.torque;
        if !(full > 0.0 && least > 0.0) {
            return Err(Error::Value(FORCE));
        }
        let lag = 3.0 * design.load_delay();
        Ok(ForceLimitConfig {
            torque: get!(To::exactly(full, FORCE)),
            idle: get!(To::exactly(idle / format.bases.torque, FORCE)),
            least: get!(To::exactly(least, FORCE)),
            lead: get!(To::coefficients([0.25, design.rigid.period / lag], FORCE)),
        })
    }
}
