//! Constants of the observer of a cranked machine.

use super::Error;
use super::constants::constants;
use super::convert::get;
use crate::angle::RotorAngleConfig;
use crate::design::CrankedDesign;
use crate::observer::{CrankConfig, RigidConfig, TABLE_POINTS, TablePoint};
use core::f64::consts::TAU;

const GEAR: &str =
    "the crank must turn between 1/65536 and 15 times while the motor turns once, in at most 2^20 turns of the motor";
const LIGHT: &str = "the crank's inertia swings too far for its number: the least one must be above 0.35 of the mean \
    in fixed point";
const DRAG: &str = "the crank's inertia torque is too large for its number: in fixed point, at the base of the speed, \
    it must be below 0.9 of the base of the torque";

impl CrankedDesign {
    /// Mean inertia over inertia, and torque at the base of the speed per base of the torque, at the points of the
    /// table.
    const fn points(&self, torque: f64, speed: f64) -> [[f64; 2]; TABLE_POINTS] {
        let mean = self.machine.mean_inertia();
        let mut points = [[0.0; 2]; TABLE_POINTS];
        let mut k = 0;
        while k < TABLE_POINTS {
            let here = self.machine.inertia(k as f64 * (TAU / TABLE_POINTS as f64));
            points[k] = [mean / here.inertia, 0.5 * here.derivative * speed * speed / torque];
            k += 1;
        }
        points
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
    /// [`Error::Coefficient`] or [`Error::Value`] for a value beyond its number, or a gear ratio out of range.
    impl[] CrankConfig[], new, try_new(design: &CrankedDesign), |format| {
        let rigid = get!(RigidConfig::<Number>::try_new(&design.rigid, design.load_share(), format.bases));
        let exact = design.points(format.bases.torque, format.bases.speed);
        let none = get!(To::exactly(0.0, DRAG));
        let mut points = [TablePoint { inertia_ratio: none, inertia_slope: none }; TABLE_POINTS];
        let mut k = 0;
        while k < TABLE_POINTS {
            let [inertia_ratio, inertia_slope] = exact[k];
            // With the accelerating torque held within twice the base, the torque that is given stays within the
            // headroom.
            if format.unit != 1.0 && !(inertia_ratio < 1.0 / 0.35) {
                return Err(Error::Value(LIGHT));
            }
            if format.unit != 1.0 && !(inertia_slope.abs() < 0.9) {
                return Err(Error::Value(DRAG));
            }
            points[k] = TablePoint {
                inertia_ratio: get!(To::exactly(inertia_ratio, LIGHT)),
                inertia_slope: get!(To::exactly(inertia_slope, DRAG)),
            };
            k += 1;
        }
        Ok(CrankConfig { rigid, turning: get!(design.turning()), points })
    }
}
