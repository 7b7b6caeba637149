//! Constants of the observers.

use super::constants::constants;
use super::format::ANGLE_PER_RADIAN;
use super::{Bases, Error, Format};
use crate::design::{PlacedObserver, RigidDesign, StepChoice, TwoMassDesign};
use crate::observer::{RigidConfig, SemiImplicitConfig, TwoMassConfig};

const STEP: &str = "a coefficient of the observer's step is beyond the range of its number: the machine is too soft, \
    too light or too strongly damped for its bases at this rate";
const SHARE: &str = "the load's share of the inertia must be at least 0 and at most 1";
const GAIN: &str = "a gain of the observer is beyond the range of its number (a fine encoder, large disturbances, a \
    low rate): raise the bases of torque and speed, or state the accuracy of the encoder";
const TWIST: &str = "the base of the twist is too large for the exact step: take SemiImplicitObserver if the design \
    chose its step, lower the base of the torque, or state the accuracy of a fine encoder";
const COARSE: &str = "the semi-implicit step is too coarse for this machine at this rate: take TwoMassObserver, which \
    has the exact step the design chose, or overrule the design by with_step(StepChoice::SemiImplicit)";

/// The exact observer's constants, scaled to a format.
const fn two_mass(design: &PlacedObserver, format: &Format) -> TwoMassConfig<f64> {
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
const fn semi_implicit(design: &PlacedObserver, format: &Format) -> SemiImplicitConfig<f64> {
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

constants! {
    /// [`Error::Coefficient`] where one is beyond the range of its number.
    impl[] TwoMassConfig[], new, try_new(design: &TwoMassDesign), |format| {
        Self::try_of_placed(&PlacedObserver::of(design), format.bases)
    }
}

constants! {
    /// [`Error::Coefficient`] where one is beyond the range of its number.
    impl[] TwoMassConfig[], of_placed, try_of_placed(design: &PlacedObserver), |format| {
        let c = two_mass(design, &format);
        let [acceleration, compliance, speed] = get!(To::coefficients([c.acceleration, c.compliance, c.speed], STEP));
        let angle_correction = get!(To::coefficient(c.angle_correction, GAIN));
        let [g1, g2] = get!(To::coefficients([c.twist[2], c.twist_rate[2]], STEP));
        let pair = [c.twist[0], c.twist[1], c.twist_rate[0], c.twist_rate[1]];
        let [n11, n12, n21, n22] = get!(To::pair(pair, STEP));
        Ok(TwoMassConfig {
            forcing: get!(To::coefficients(c.forcing, STEP)),
            twist: [n11, n12, g1],
            twist_rate: [n21, n22, g2],
            acceleration,
            turn: [get!(To::coefficient(c.turn[0], STEP)), get!(To::coefficient(c.turn[1], TWIST))],
            correction: get!(To::coefficients(c.correction, GAIN)),
            angle_correction,
            speed,
            share: get!(To::coefficients(c.share, STEP)),
            shaft: get!(To::coefficients(c.shaft, STEP)),
            compliance,
        })
    }
}

constants! {
    /// [`Error::Value`] for a design that chose the exact step and was not overruled
    /// ([`TwoMassDesign::with_step`]), [`Error::Coefficient`] where a coefficient is beyond the range of its number.
    impl[] SemiImplicitConfig[], new, try_new(design: &TwoMassDesign), |format| {
        if matches!(design.chosen, StepChoice::Exact) {
            return Err(Error::Value(COARSE));
        }
        Self::try_of_placed(&PlacedObserver::of(design), format.bases)
    }
}

constants! {
    /// [`Error::Coefficient`] where one is beyond the range of its number.
    impl[] SemiImplicitConfig[], of_placed, try_of_placed(design: &PlacedObserver), |format| {
        let c = semi_implicit(design, &format);
        let [motor, load, turn, speed] = get!(To::coefficients([c.motor, c.load, c.turn, c.speed], STEP));
        let angle_correction = get!(To::coefficient(c.angle_correction, GAIN));
        Ok(SemiImplicitConfig {
            motor,
            load,
            shaft: get!(To::coefficients(c.shaft, STEP)),
            turn,
            correction: get!(To::coefficients(c.correction, GAIN)),
            angle_correction,
            speed,
        })
    }
}

constants! {
    /// [`Error::Value`] for a part of the inertia on the load side that is not from 0 to 1, [`Error::Coefficient`]
    /// where a coefficient is beyond the range of its number.
    impl[] RigidConfig[], new, try_new(design: &RigidDesign, load_share: f64), |format| {
        get!(share(load_share));
        let c = rigid(design, load_share, &format);
        let [acceleration, turn, load_share, speed] =
            get!(To::coefficients([c.acceleration, c.turn, c.load_share, c.speed], STEP));
        let angle_correction = get!(To::coefficient(c.angle_correction, GAIN));
        Ok(RigidConfig {
            acceleration,
            turn,
            correction: get!(To::coefficients(c.correction, GAIN)),
            angle_correction,
            speed,
            load_share,
        })
    }
}
