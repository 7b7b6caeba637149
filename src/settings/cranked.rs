//! Constants of the observer of a cranked machine.

use core::f64::consts::TAU;

use super::convert::{get, or_stop};
use super::{Bases, Error};
use crate::angle::RotorAngleConfig;
use crate::design::CrankedDesign;
use crate::number::Fixed;
use crate::observer::{CrankConfig, RigidConfig, TABLE_POINTS, TablePoint};

const GEAR: &str =
    "the crank must turn between 1/65536 and 15 times while the motor turns once, in at most 2^20 turns of the motor";
const LIGHT: &str = "the crank's inertia swings too far for fixed point: the least one must be above 0.35 of the mean";
const DRAG: &str = "the crank's inertia torque is too large for the bases: at the base of the speed it must be below \
    0.9 of \
    the base of the torque";

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

macro_rules! float {
    ($float:ident) => {
        impl CrankConfig<$float> {
            /// The constants of a design as floats.
            ///
            /// The shaft torque is that between the constant inertia and the crank drive.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(design: &CrankedDesign, bases: Bases) -> Self {
                or_stop!(Self::try_new(design, bases))
            }

            /// [`new`](Self::new), with an error instead of a panic.
            ///
            /// # Errors
            /// [`Error::Value`] for a gear that cannot be followed.
            pub const fn try_new(design: &CrankedDesign, bases: Bases) -> Result<Self, Error> {
                let exact = design.points(1.0, 1.0);
                let mut points = [TablePoint { inertia_ratio: 0.0, inertia_slope: 0.0 }; TABLE_POINTS];
                let mut k = 0;
                while k < TABLE_POINTS {
                    points[k] =
                        TablePoint { inertia_ratio: exact[k][0] as $float, inertia_slope: exact[k][1] as $float };
                    k += 1;
                }
                Ok(CrankConfig {
                    rigid: RigidConfig::<$float>::new(&design.rigid, design.load_share(), bases),
                    turning: get!(design.turning()),
                    points,
                })
            }
        }
    };
}

float!(f32);
float!(f64);

impl CrankConfig<Fixed> {
    /// The constants of a design in fixed point.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(design: &CrankedDesign, bases: Bases) -> Self {
        or_stop!(Self::try_new(design, bases))
    }

    /// The constants of a design in fixed point.
    ///
    /// # Errors
    /// [`Error::Coefficient`] or [`Error::Value`] for a value beyond fixed point, or a gear ratio out of range.
    pub const fn try_new(design: &CrankedDesign, bases: Bases) -> Result<Self, Error> {
        let rigid = get!(RigidConfig::<Fixed>::try_new(&design.rigid, design.load_share(), bases));
        let exact = design.points(bases.torque, bases.speed);
        let mut points = [TablePoint { inertia_ratio: Fixed::ONE, inertia_slope: Fixed::ONE }; TABLE_POINTS];
        let mut k = 0;
        while k < TABLE_POINTS {
            let [inertia_ratio, inertia_slope] = exact[k];
            // With the accelerating torque held within twice the base, the torque that is given stays within the
            // headroom.
            if !(inertia_ratio < 1.0 / 0.35) {
                return Err(Error::Value(LIGHT));
            }
            if !(inertia_slope.abs() < 0.9) {
                return Err(Error::Value(DRAG));
            }
            points[k] = TablePoint {
                inertia_ratio: Fixed::from_f64(inertia_ratio),
                inertia_slope: Fixed::from_f64(inertia_slope),
            };
            k += 1;
        }
        Ok(CrankConfig { rigid, turning: get!(design.turning()), points })
    }
}
