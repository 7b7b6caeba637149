//! Constants of the observers.

use super::convert::{fixed, get, or_stop, single};
use super::format::ANGLE_PER_RADIAN;
use super::settled::{settled, unit_single};
use super::{Bases, Error, Format};
use crate::design::{RigidDesign, TwoMassDesign};
use crate::number::Fixed;
use crate::observer::{RigidConfig, SemiImplicitConfig, TwoMassConfig};

const STEP: &str = "a coefficient of the observer's step is beyond the range of fixed point: the machine is too soft, \
    too light or too strongly damped for its bases at this rate";
const SHARE: &str = "the load's share of the inertia must be at least 0 and at most 1";
const GAIN: &str = "a gain of the observer is beyond the range of fixed point: the disturbances are too large for the \
    machine's bases, or the rate is too low";

/// The exact observer's constants, scaled to a format.
const fn two_mass(design: &TwoMassDesign, format: &Format) -> TwoMassConfig<f64> {
    let machine = &design.machine;
    let (motor, load) = (machine.motor_inertia, machine.load_inertia);
    let total = motor + load;
    let (motor_share, load_share) = (motor / total, load / total);
    let Bases { torque, speed, twist, twist_rate, forcing } = format.bases;
    let step = &design.step;
    let wide = format.widened;
    let turn = ANGLE_PER_RADIAN / (format.turn * format.unit);
    let per_angle = format.unit / (ANGLE_PER_RADIAN * format.innovation);
    let [angle, motor_gain, twist_gain, load_gain, torque_gain] = design.gains;
    TwoMassConfig {
        forcing: [torque / (motor * forcing), torque / (load * forcing)],
        twist: [step.n11 / wide, step.n12 * (twist_rate / twist) / wide, step.g1 * (forcing / twist) / wide],
        twist_rate: [step.n21 * (twist / twist_rate) / wide, step.n22 / wide, step.g2 * (forcing / twist_rate) / wide],
        acceleration: design.period / total * (torque / speed),
        turn: [0.5 * design.period * speed * turn, load_share * twist * turn / wide],
        correction: [
            (motor_share * motor_gain + load_share * load_gain) / speed * per_angle,
            (motor_gain - load_gain) / twist_rate * per_angle,
            twist_gain / twist * per_angle,
            torque_gain / torque * per_angle,
        ],
        angle_correction: -angle / format.innovation,
        speed: format.speed_of_turn(design.period),
        share: [load_share * (twist_rate / speed) / wide, -motor_share * (twist_rate / speed) / wide],
        shaft: [machine.stiffness * (twist / torque) / wide, machine.damping * (twist_rate / torque) / wide],
        compliance: torque / (machine.stiffness * twist) / wide,
    }
}

/// The semi-implicit observer's constants, scaled to a format.
const fn semi_implicit(design: &TwoMassDesign, format: &Format) -> SemiImplicitConfig<f64> {
    let machine = &design.machine;
    let Bases { torque, speed, .. } = format.bases;
    let (stiffness, damping) = (machine.stiffness, machine.damping);
    let turn = ANGLE_PER_RADIAN / (format.turn * format.unit);
    let per_angle = format.unit / (ANGLE_PER_RADIAN * format.innovation);
    let [angle, motor_gain, twist_gain, load_gain, torque_gain] = design.gains;
    let shaft_gain = stiffness * twist_gain + damping * (motor_gain - load_gain);
    SemiImplicitConfig {
        motor: design.period / machine.motor_inertia * (torque / speed),
        load: design.period / machine.load_inertia * (torque / speed),
        shaft: [(stiffness * design.period + damping) * (speed / torque), -damping * (speed / torque)],
        turn: design.period * speed * turn,
        correction: [
            motor_gain / speed * per_angle,
            load_gain / speed * per_angle,
            shaft_gain / torque * per_angle,
            torque_gain / torque * per_angle,
        ],
        angle_correction: -angle / format.innovation,
        speed: format.speed_of_turn(design.period),
    }
}

/// A part of the whole.
const fn share(value: f64) -> Result<(), Error> {
    if value >= 0.0 && value <= 1.0 { Ok(()) } else { Err(Error::Value(SHARE)) }
}

/// The rigid observer's constants, scaled to a format.
const fn rigid(design: &RigidDesign, load_share: f64, format: &Format) -> RigidConfig<f64> {
    let Bases { torque, speed, .. } = format.bases;
    let turn = ANGLE_PER_RADIAN / (format.turn * format.unit);
    let per_angle = format.unit / (ANGLE_PER_RADIAN * format.innovation);
    let [angle, speed_gain, torque_gain] = design.gains;
    RigidConfig {
        acceleration: design.period / design.machine.inertia * (torque / speed),
        turn: 0.5 * design.period * speed * turn,
        correction: [speed_gain / speed * per_angle, torque_gain / torque * per_angle],
        angle_correction: -angle / format.innovation,
        speed: format.speed_of_turn(design.period),
        load_share: load_share / format.widened,
    }
}

impl TwoMassConfig<f64> {
    /// The constants of a design in `f64`.
    pub const fn new(design: &TwoMassDesign, _: Bases) -> Self {
        two_mass(design, &Format::FLOAT)
    }
}

impl TwoMassConfig<f32> {
    /// The constants of a design in `f32`.
    pub const fn new(design: &TwoMassDesign, _: Bases) -> Self {
        let c = two_mass(design, &Format::FLOAT);
        let pair = [c.twist[0], c.twist[1], c.twist_rate[0], c.twist_rate[1]];
        let [a, b, d, e] = single(pair);
        let unit = [unit_single(pair[0]), unit_single(pair[1]), unit_single(pair[2]), unit_single(pair[3])];
        let [n11, n12, n21, n22] = single(settled(pair, [a as f64, b as f64, d as f64, e as f64], unit));
        TwoMassConfig {
            forcing: single(c.forcing),
            twist: [n11, n12, c.twist[2] as f32],
            twist_rate: [n21, n22, c.twist_rate[2] as f32],
            acceleration: c.acceleration as f32,
            turn: single(c.turn),
            correction: single(c.correction),
            angle_correction: c.angle_correction as f32,
            speed: c.speed as f32,
            share: single(c.share),
            shaft: single(c.shaft),
            compliance: c.compliance as f32,
        }
    }
}

impl TwoMassConfig<Fixed> {
    /// The constants of a design in fixed point.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(design: &TwoMassDesign, bases: Bases) -> Self {
        or_stop!(Self::try_new(design, bases))
    }

    /// The constants of a design in fixed point.
    ///
    /// # Errors
    /// [`Error::Coefficient`] where one is beyond the range of fixed point.
    pub const fn try_new(design: &TwoMassDesign, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let c = two_mass(design, &Format::fixed(bases));
        let [acceleration, compliance, speed] = get!(fixed([c.acceleration, c.compliance, c.speed], STEP));
        let [angle_correction] = get!(fixed([c.angle_correction], GAIN));
        let [g1, g2] = get!(fixed([c.twist[2], c.twist_rate[2]], STEP));
        let pair = [c.twist[0], c.twist[1], c.twist_rate[0], c.twist_rate[1]];
        let near = get!(fixed(pair, STEP));
        // Scaled by the operand's widening, and back.
        let (wide, unit) = (4.0, 4.0 / 4_294_967_296.0);
        let rounded =
            [wide * near[0].to_f64(), wide * near[1].to_f64(), wide * near[2].to_f64(), wide * near[3].to_f64()];
        let pair = [wide * pair[0], wide * pair[1], wide * pair[2], wide * pair[3]];
        let [n11, n12, n21, n22] = settled(pair, rounded, [unit; 4]);
        let [n11, n12, n21, n22] = get!(fixed([n11 / wide, n12 / wide, n21 / wide, n22 / wide], STEP));
        Ok(TwoMassConfig {
            forcing: get!(fixed(c.forcing, STEP)),
            twist: [n11, n12, g1],
            twist_rate: [n21, n22, g2],
            acceleration,
            turn: get!(fixed(c.turn, STEP)),
            correction: get!(fixed(c.correction, GAIN)),
            angle_correction,
            speed,
            share: get!(fixed(c.share, STEP)),
            shaft: get!(fixed(c.shaft, STEP)),
            compliance,
        })
    }
}

impl SemiImplicitConfig<f64> {
    /// The constants of a design in `f64`.
    pub const fn new(design: &TwoMassDesign, _: Bases) -> Self {
        semi_implicit(design, &Format::FLOAT)
    }
}

impl SemiImplicitConfig<f32> {
    /// The constants of a design in `f32`.
    pub const fn new(design: &TwoMassDesign, _: Bases) -> Self {
        let c = semi_implicit(design, &Format::FLOAT);
        SemiImplicitConfig {
            motor: c.motor as f32,
            load: c.load as f32,
            shaft: single(c.shaft),
            turn: c.turn as f32,
            correction: single(c.correction),
            angle_correction: c.angle_correction as f32,
            speed: c.speed as f32,
        }
    }
}

impl SemiImplicitConfig<Fixed> {
    /// The constants of a design in fixed point.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(design: &TwoMassDesign, bases: Bases) -> Self {
        or_stop!(Self::try_new(design, bases))
    }

    /// The constants of a design in fixed point.
    ///
    /// # Errors
    /// [`Error::Coefficient`] where one is beyond the range of fixed point.
    pub const fn try_new(design: &TwoMassDesign, bases: Bases) -> Result<Self, Error> {
        get!(bases.check());
        let c = semi_implicit(design, &Format::fixed(bases));
        let [motor, load, turn, speed] = get!(fixed([c.motor, c.load, c.turn, c.speed], STEP));
        let [angle_correction] = get!(fixed([c.angle_correction], GAIN));
        Ok(SemiImplicitConfig {
            motor,
            load,
            shaft: get!(fixed(c.shaft, STEP)),
            turn,
            correction: get!(fixed(c.correction, GAIN)),
            angle_correction,
            speed,
        })
    }
}

impl RigidConfig<f64> {
    /// The constants of a design in `f64`; `load_share` is the part of the inertia that lies behind the shaft, 0 to 1.
    ///
    /// # Panics
    /// At compile time in a constant, for a share outside 0 to 1.
    pub const fn new(design: &RigidDesign, load_share: f64, _: Bases) -> Self {
        or_stop!(share(load_share));
        rigid(design, load_share, &Format::FLOAT)
    }
}

impl RigidConfig<f32> {
    /// The constants of a design in `f32`; `load_share` is the part of the inertia that lies behind the shaft, 0 to 1.
    ///
    /// # Panics
    /// At compile time in a constant, for a share outside 0 to 1.
    pub const fn new(design: &RigidDesign, load_share: f64, _: Bases) -> Self {
        or_stop!(share(load_share));
        let c = rigid(design, load_share, &Format::FLOAT);
        RigidConfig {
            acceleration: c.acceleration as f32,
            turn: c.turn as f32,
            correction: single(c.correction),
            angle_correction: c.angle_correction as f32,
            speed: c.speed as f32,
            load_share: c.load_share as f32,
        }
    }
}

impl RigidConfig<Fixed> {
    /// The constants of a design in fixed point; `load_share` is the part of the inertia that lies behind the shaft, 0
    /// to 1.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of the [`Error`] that [`try_new`](Self::try_new) returns.
    pub const fn new(design: &RigidDesign, load_share: f64, bases: Bases) -> Self {
        or_stop!(Self::try_new(design, load_share, bases))
    }

    /// The constants of a design in fixed point.
    ///
    /// # Errors
    /// [`Error::Coefficient`] where one is beyond the range of fixed point.
    pub const fn try_new(design: &RigidDesign, load_share: f64, bases: Bases) -> Result<Self, Error> {
        get!(share(load_share));
        get!(bases.check());
        let c = rigid(design, load_share, &Format::fixed(bases));
        let [acceleration, turn, load_share, speed] =
            get!(fixed([c.acceleration, c.turn, c.load_share, c.speed], STEP));
        let [angle_correction] = get!(fixed([c.angle_correction], GAIN));
        Ok(RigidConfig {
            acceleration,
            turn,
            correction: get!(fixed(c.correction, GAIN)),
            angle_correction,
            speed,
            load_share,
        })
    }
}
