//! Constants of the observers.

use super::constants::constants;
use super::format::ANGLE_PER_RADIAN;
use super::{Bases, Error, Format};
use crate::design::{PlacedObserver, RigidDesign, StepChoice, TwoMassDesign};
use crate::machine::TwoMass;
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
const GROWS: &str = "the error of the estimates grows with the semi-implicit step: take TwoMassObserver";

/// Units of an angle's correction per innovation, of a turn in a tick, and of the widened operands.
const fn scales(format: &Format) -> (f64, f64, f64) {
    let per_angle = format.unit / (ANGLE_PER_RADIAN * format.innovation);
    (per_angle, ANGLE_PER_RADIAN / (format.turn * format.unit), format.widened)
}

constants! {
    /// [`Error::Coefficient`] where one is beyond the range of its number, and in fixed point for a design that chose
    /// the semi-implicit step, where the twist's unit turns the motor by more than the unit of a turn: every tick
    /// rounds the twist, and the torques of strongly damped loops were 1 % of their limit away from `f32`.
    impl[] TwoMassConfig[], new, try_new(design: &TwoMassDesign), |format| {
        let TwoMass { motor_inertia, load_inertia, .. } = design.machine;
        let twist = format.bases.twist / format.unit * ANGLE_PER_RADIAN;
        let turn = load_inertia / (motor_inertia + load_inertia) * twist;
        if format.unit != 1.0 && matches!(design.chosen, StepChoice::SemiImplicit) && turn > format.turn {
            return Err(Error::Coefficient(TWIST));
        }
        Self::try_of_placed(&PlacedObserver::of(design), format.bases)
    }

    /// [`Error::Coefficient`] where one is beyond the range of its number.
    impl[] TwoMassConfig[], of_placed, try_of_placed(design: &PlacedObserver), |format| {
        let (machine, step, period) = (&design.machine, &design.step, design.period);
        let (motor, load) = (machine.motor_inertia, machine.load_inertia);
        let total = motor + load;
        let (motor_share, load_share) = (motor / total, load / total);
        let Bases { torque, speed, twist, twist_rate, forcing } = format.bases;
        let (per_angle, turn, wide) = scales(&format);
        let [angle, motor_gain, twist_gain, load_gain, torque_gain] = design.gains;
        let (to_rate, to_twist) = (twist / twist_rate, twist_rate / twist);
        let acceleration = get!(To::coefficient(period / total * (torque / speed), STEP));
        let compliance = get!(To::coefficient(torque / (machine.stiffness * twist) / wide, STEP));
        let pair = [step.n11 / wide, step.n12 * to_twist / wide, step.n21 * to_rate / wide, step.n22 / wide];
        let [n11, n12, n21, n22] = get!(To::pair(pair, STEP));
        let forced = [step.g1 * (forcing / twist) / wide, step.g2 * (forcing / twist_rate) / wide];
        let [g1, g2] = get!(To::coefficients(forced, STEP));
        let correction = [
            (motor_share * motor_gain + load_share * load_gain) / speed * per_angle,
            (motor_gain - load_gain) / twist_rate * per_angle,
            twist_gain / twist * per_angle,
            torque_gain / torque * per_angle,
        ];
        let share = [load_share * (twist_rate / speed) / wide, -motor_share * (twist_rate / speed) / wide];
        let shaft = [machine.stiffness * (twist / torque) / wide, machine.damping * (twist_rate / torque) / wide];
        Ok(TwoMassConfig {
            forcing: get!(To::coefficients([torque / (motor * forcing), torque / (load * forcing)], STEP)),
            twist: [n11, n12, g1],
            twist_rate: [n21, n22, g2],
            acceleration,
            turn: [
                get!(To::coefficient(0.5 * period * speed * turn, STEP)),
                get!(To::coefficient(load_share * twist * turn / wide, TWIST)),
            ],
            correction: get!(To::coefficients(correction, GAIN)),
            angle_correction: get!(To::coefficient(-angle / format.innovation, GAIN)),
            speed: get!(To::coefficient(format.speed_of_turn(period), STEP)),
            share: get!(To::coefficients(share, STEP)),
            shaft: get!(To::coefficients(shaft, STEP)),
            compliance,
        })
    }

    /// [`Error::Value`] for a design that chose the exact step and was not overruled
    /// ([`TwoMassDesign::with_step`]), and where the error of the estimates grows with this step; [`Error::Coefficient`]
    /// where a coefficient is beyond the range of its number.
    impl[] SemiImplicitConfig[], new, try_new(design: &TwoMassDesign), |format| {
        if !(design.semi_implicit_radius < 1.0) {
            return Err(Error::Value(GROWS));
        }
        if matches!(design.chosen, StepChoice::Exact) {
            return Err(Error::Value(COARSE));
        }
        Self::try_of_placed(&PlacedObserver::of(design), format.bases)
    }

    /// [`Error::Coefficient`] where one is beyond the range of its number.
    impl[] SemiImplicitConfig[], of_placed, try_of_placed(design: &PlacedObserver), |format| {
        let (machine, period) = (&design.machine, design.period);
        let Bases { torque, speed, .. } = format.bases;
        let (stiffness, damping) = (machine.stiffness, machine.damping);
        let (per_angle, turn, _) = scales(&format);
        let [angle, motor_gain, twist_gain, load_gain, torque_gain] = design.gains;
        let shaft_gain = stiffness * twist_gain + damping * (motor_gain - load_gain);
        let shaft = [(stiffness * period + damping) * (speed / torque), -damping * (speed / torque)];
        let correction = [
            motor_gain / speed * per_angle,
            load_gain / speed * per_angle,
            shaft_gain / torque * per_angle,
            torque_gain / torque * per_angle,
        ];
        Ok(SemiImplicitConfig {
            motor: get!(To::coefficient(period / machine.motor_inertia * (torque / speed), STEP)),
            load: get!(To::coefficient(period / machine.load_inertia * (torque / speed), STEP)),
            shaft: get!(To::coefficients(shaft, STEP)),
            turn: get!(To::coefficient(period * speed * turn, STEP)),
            correction: get!(To::coefficients(correction, GAIN)),
            angle_correction: get!(To::coefficient(-angle / format.innovation, GAIN)),
            speed: get!(To::coefficient(format.speed_of_turn(period), STEP)),
        })
    }

    /// [`Error::Value`] for a part of the inertia on the load side that is not from 0 to 1, [`Error::Coefficient`]
    /// where a coefficient is beyond the range of its number.
    impl[] RigidConfig[], new, try_new(design: &RigidDesign, load_share: f64), |format| {
        if !(load_share >= 0.0 && load_share <= 1.0) {
            return Err(Error::Value(SHARE));
        }
        let Bases { torque, speed, .. } = format.bases;
        let ((per_angle, turn, wide), period) = (scales(&format), design.period);
        let [angle, speed_gain, torque_gain] = design.gains;
        let correction = [speed_gain / speed * per_angle, torque_gain / torque * per_angle];
        Ok(RigidConfig {
            acceleration: get!(To::coefficient(period / design.machine.inertia * (torque / speed), STEP)),
            turn: get!(To::coefficient(0.5 * period * speed * turn, STEP)),
            correction: get!(To::coefficients(correction, GAIN)),
            angle_correction: get!(To::coefficient(-angle / format.innovation, GAIN)),
            speed: get!(To::coefficient(format.speed_of_turn(period), STEP)),
            load_share: get!(To::coefficient(load_share / wide, STEP)),
        })
    }
}
