//! Constants of the observer of a cranked machine.

use core::f64::consts::TAU;

use super::convert::{get, or_stop};
use super::{Bases, Error};
use crate::balance::TurningConfig;
use crate::design::CrankedDesign;
use crate::number::Fixed;
use crate::observer::{CrankedConfig, PLACES, Place, RigidConfig};

const GEAR: &str =
    "the crank must turn between 1/65536 and 15 times while the motor turns once, in at most 2^20 turns of the motor";
const LIGHT: &str = "the crank's inertia swings too far for fixed point: the least one must be above 0.35 of the mean";
const DRAG: &str = "the crank takes too much torque for the bases: at the base of the speed it must be below 0.9 of the base of the torque";

impl CrankedDesign {
    /// Mean inertia over inertia, and torque at the base of the speed per base of the torque, at the places of the table.
    const fn places(&self, torque: f64, speed: f64) -> [[f64; 2]; PLACES] {
        let mean = self.machine.mean_inertia();
        let mut places = [[0.0; 2]; PLACES];
        let mut k = 0;
        while k < PLACES {
            let here = self.machine.inertia(k as f64 * (TAU / PLACES as f64));
            places[k] = [mean / here.inertia, 0.5 * here.derivative * speed * speed / torque];
            k += 1;
        }
        places
    }

    const fn turning(&self) -> Result<TurningConfig, Error> {
        match TurningConfig::new(self.machine.turns, self.machine.motor_turns) {
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
        impl CrankedConfig<$float> {
            /// The constants of a design as floats.
            ///
            /// The shaft torque is that between the constant inertia and the crank drive.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
            pub const fn new(design: &CrankedDesign, bases: Bases) -> Self {
                or_stop!(Self::try_new(design, bases))
            }

            /// [`new`](Self::new), with an error instead of a panic.
            ///
            /// # Errors
            /// [`Error::Value`] for a gear that cannot be followed.
            pub const fn try_new(design: &CrankedDesign, bases: Bases) -> Result<Self, Error> {
                let exact = design.places(1.0, 1.0);
                let mut places = [Place { lightness: 0.0, drag: 0.0 }; PLACES];
                let mut k = 0;
                while k < PLACES {
                    places[k] = Place { lightness: exact[k][0] as $float, drag: exact[k][1] as $float };
                    k += 1;
                }
                Ok(CrankedConfig {
                    rigid: RigidConfig::<$float>::new(&design.rigid, design.load_share(), bases),
                    turning: get!(design.turning()),
                    places,
                })
            }
        }
    };
}

float!(f32);
float!(f64);

impl CrankedConfig<Fixed> {
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
    /// [`Error::Coefficient`] or [`Error::Value`] for what fixed point cannot hold, or a gear that cannot be followed.
    pub const fn try_new(design: &CrankedDesign, bases: Bases) -> Result<Self, Error> {
        let rigid = get!(RigidConfig::<Fixed>::try_new(&design.rigid, design.load_share(), bases));
        let exact = design.places(bases.torque, bases.speed);
        let mut places = [Place { lightness: Fixed::ONE, drag: Fixed::ONE }; PLACES];
        let mut k = 0;
        while k < PLACES {
            let [lightness, drag] = exact[k];
            // With the accelerating torque held within twice the base, the torque that is given stays within the headroom.
            if !(lightness < 1.0 / 0.35) {
                return Err(Error::Value(LIGHT));
            }
            if !(drag.abs() < 0.9) {
                return Err(Error::Value(DRAG));
            }
            places[k] = Place { lightness: Fixed::from_f64(lightness), drag: Fixed::from_f64(drag) };
            k += 1;
        }
        Ok(CrankedConfig { rigid, turning: get!(design.turning()), places })
    }
}
