//! Constants of the observer of backlash.

use super::constants::constants;
use super::convert::positive;
use super::format::ANGLE_PER_RADIAN;
use super::{Bases, Error, Format};
use crate::design::{BacklashDesign, PlacedObserver};
use crate::observer::{BacklashConfig, Contact, FreeFlight, GapCorrection, TwoMassConfig};

const GAIN: &str = "a searching gain of the observer of backlash is beyond the range of its number: let the twist \
    wander less, or raise the rate";
const STEP: &str = "a coefficient of the observer's step in the gap is beyond the range of its number: raise the base \
    of the torque, or the rate";
const GAP: &str = "the gap must be positive and finite, and half of it at most the twist's base in fixed point: raise \
    the base of the torque";

/// Constants of the gap beside those of the shaft in contact, scaled to a format.
struct Added {
    half_gap: f64,
    /// Coefficients of the shaft's law, in the tick in which it is left.
    leaving: [f64; 3],
    free: FreeFlight<f64>,
    searching: GapCorrection<f64>,
}

const fn added(design: &BacklashDesign, format: &Format) -> Added {
    let machine = &design.contact.machine;
    let (motor, load) = (machine.motor_inertia, machine.load_inertia);
    let total = motor + load;
    let Bases { torque, speed, twist, twist_rate, forcing } = format.bases;
    let wide = format.widened;
    let per_angle = format.unit / (ANGLE_PER_RADIAN * format.innovation);
    let (contact, free, period) = (&design.contact.step, &design.free, design.contact.period);
    // From a flank with the twist rate v: v' = (1 + n22) v and delta' = n12 v, where free flight has v and y = T v.
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
        searching: GapCorrection {
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

constants! {
    /// [`Error::Coefficient`] where one is beyond the range of fixed point, [`Error::Value`] for a gap that is not
    /// positive and finite, or wider than the bases allow.
    impl[] BacklashConfig[], new, try_new(design: &BacklashDesign), |format| {
        let c = get!(TwoMassConfig::<Number>::try_of_placed(&PlacedObserver::of(&design.contact), format.bases));
        let a = added(design, &format);
        if format.unit == 1.0 {
            get!(positive(a.half_gap, GAP));
        } else if !(a.half_gap > 0.0 && a.half_gap <= 1.0) {
            return Err(Error::Value(GAP));
        }
        let angle = get!(To::coefficient(a.searching.angle, GAIN));
        let twist_rate = get!(To::coefficient(a.free.twist_rate, STEP));
        Ok(BacklashConfig {
            forcing: c.forcing,
            half_gap: get!(To::number(a.half_gap, GAP)),
            contact: Contact {
                twist: c.twist,
                twist_rate: c.twist_rate,
                leaving: get!(To::coefficients(a.leaving, STEP)),
            },
            free: FreeFlight {
                twist: get!(To::coefficients(a.free.twist, STEP)),
                twist_rate,
                meeting: get!(To::coefficients(a.free.meeting, STEP)),
            },
            acceleration: c.acceleration,
            turn: c.turn,
            settled: GapCorrection { states: c.correction, angle: c.angle_correction },
            searching: GapCorrection { states: get!(To::coefficients(a.searching.states, GAIN)), angle },
            hold: design.hold,
            speed: c.speed,
            share: c.share,
            shaft: c.shaft,
            compliance: c.compliance,
        })
    }
}
