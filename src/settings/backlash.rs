//! Constants of the observer of backlash.

use super::convert::{fixed, get, or_stop, positive, single};
use super::format::ANGLE_PER_RADIAN;
use super::{Bases, Error, Format};
use crate::design::BacklashDesign;
use crate::number::Fixed;
use crate::observer::{BacklashConfig, Contact, Correction, FreeFlight, TwoMassConfig};

const GAIN: &str = "a searching gain of the observer of backlash is beyond the range of fixed point: let the twist \
    wander less, or raise the rate";
const STEP: &str = "a coefficient of the observer's step in the gap is beyond the range of fixed point: raise the base \
    of the torque, or the rate";
const GAP: &str = "the gap must be positive and finite, and half of it at most the twist's base in fixed point: raise \
    the base of the torque";

/// Constants of the gap beside those of the shaft in contact, scaled to a format.
struct Added {
    half_gap: f64,
    /// Of the shaft's law, in the tick in which it is left.
    leaving: [f64; 3],
    free: FreeFlight<f64>,
    searching: Correction<f64>,
}

const fn added(design: &BacklashDesign, format: &Format) -> Added {
    let machine = &design.contact.machine;
    let (motor, load) = (machine.motor_inertia, machine.load_inertia);
    let total = motor + load;
    let Bases { torque, speed, twist, twist_rate, forcing } = format.bases;
    let wide = format.widened;
    let per_angle = format.unit / (ANGLE_PER_RADIAN * format.innovation);
    let (contact, free, period) = (&design.contact.step, &design.free, design.contact.period);
    // From a flank with the slip v: v' = (1 + n22) v and delta' = n12 v, where free flight has v and y = T v.
    let damping = machine.damping / machine.reduced_inertia();
    let late = damping * (twist / twist_rate) / wide;
    let share = (-contact.n22 / period - damping) * (twist / twist_rate) / wide;
    let catch_up = (1.0 - contact.n12 / period) / wide;
    let [angle, motor_gain, twist_gain, load_gain, torque_gain] = design.searching;
    Added {
        half_gap: 0.5 * design.gap / twist,
        leaving: [late, share, catch_up],
        free: FreeFlight {
            twist: [free.n12 * (twist_rate / twist) / wide, free.g1 * (forcing / twist) / wide],
            twist_rate: free.g2 * (forcing / twist_rate) / wide,
            meeting: [-late, -share, -catch_up],
        },
        searching: Correction {
            states: [
                (motor / total * motor_gain + load / total * load_gain) / speed * per_angle,
                (motor_gain - load_gain) / twist_rate * per_angle,
                twist_gain / twist * per_angle,
                torque_gain / torque * per_angle,
            ],
            angle: -angle / format.innovation,
        },
    }
}

macro_rules! float {
    ($float:ident, $rounded:ident) => {
        impl BacklashConfig<$float> {
            /// The constants of a design as floats.
            ///
            /// # Panics
            /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new)
            /// returns.
            pub const fn new(design: &BacklashDesign, bases: Bases) -> Self {
                or_stop!(Self::try_new(design, bases))
            }

            /// The constants of a design as floats.
            ///
            /// # Errors
            /// [`Error::Value`] for a gap that is not positive and finite.
            pub const fn try_new(design: &BacklashDesign, bases: Bases) -> Result<Self, Error> {
                let c = TwoMassConfig::<$float>::new(&design.contact, bases);
                let a = added(design, &Format::FLOAT);
                Ok(BacklashConfig {
                    forcing: c.forcing,
                    half_gap: get!(positive(a.half_gap, GAP)) as $float,
                    contact: Contact { twist: c.twist, twist_rate: c.twist_rate, leaving: $rounded(a.leaving) },
                    free: FreeFlight {
                        twist: $rounded(a.free.twist),
                        twist_rate: a.free.twist_rate as $float,
                        meeting: $rounded(a.free.meeting),
                    },
                    acceleration: c.acceleration,
                    turn: c.turn,
                    settled: Correction { states: c.correction, angle: c.angle_correction },
                    searching: Correction { states: $rounded(a.searching.states), angle: a.searching.angle as $float },
                    hold: design.hold,
                    speed: c.speed,
                    share: c.share,
                    shaft: c.shaft,
                    compliance: c.compliance,
                })
            }
        }
    };
}

float!(f32, single);
float!(f64, exactly);

const fn exactly<const K: usize>(values: [f64; K]) -> [f64; K] {
    values
}

impl BacklashConfig<Fixed> {
    /// The constants of a design in fixed point.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(design: &BacklashDesign, bases: Bases) -> Self {
        or_stop!(Self::try_new(design, bases))
    }

    /// The constants of a design in fixed point.
    ///
    /// # Errors
    /// [`Error::Coefficient`] where one is beyond the range of fixed point, [`Error::Value`] for a gap wider than the
    /// bases allow.
    pub const fn try_new(design: &BacklashDesign, bases: Bases) -> Result<Self, Error> {
        let c = get!(TwoMassConfig::<Fixed>::try_new(&design.contact, bases));
        let a = added(design, &Format::fixed(bases));
        if !(a.half_gap > 0.0 && a.half_gap <= 1.0) {
            return Err(Error::Value(GAP));
        }
        let [angle] = get!(fixed([a.searching.angle], GAIN));
        let [twist_rate] = get!(fixed([a.free.twist_rate], STEP));
        Ok(BacklashConfig {
            forcing: c.forcing,
            half_gap: Fixed::from_f64(a.half_gap),
            contact: Contact { twist: c.twist, twist_rate: c.twist_rate, leaving: get!(fixed(a.leaving, STEP)) },
            free: FreeFlight {
                twist: get!(fixed(a.free.twist, STEP)),
                twist_rate,
                meeting: get!(fixed(a.free.meeting, STEP)),
            },
            acceleration: c.acceleration,
            turn: c.turn,
            settled: Correction { states: c.correction, angle: c.angle_correction },
            searching: Correction { states: get!(fixed(a.searching.states, GAIN)), angle },
            hold: design.hold,
            speed: c.speed,
            share: c.share,
            shaft: c.shaft,
            compliance: c.compliance,
        })
    }
}
