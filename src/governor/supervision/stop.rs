//! Counts, causes and stops of the supervision.

use super::{Stop, Supervised, SupervisionConfig};
use crate::fault::Faults;
use crate::number::Number;
use crate::sample::Estimate;

/// A torque against the motion that nobody commanded: of a blocked load, or missing from a weak power stage.
const OPPOSED: Faults = Faults::LOAD_BLOCKED.with(Faults::NOT_FOLLOWED);

impl<G, N: Number> Supervised<G, N> {
    /// Whether the motor has not turned since its start although its torque has changed.
    fn is_held(&self, limits: &SupervisionConfig<N>, estimate: &Estimate<N>) -> bool {
        !self.turned
            && (self.commanded - self.started).exceeds(limits.breakaway)
            && !estimate.motor_speed.exceeds(limits.still)
    }

    /// Counts a tick; raises the cause where a count is full. Whether the motor has turned, and no count is under way.
    pub(super) fn count(&mut self, limits: &SupervisionConfig<N>, estimate: &Estimate<N>) -> bool {
        // at rest the gear may hold the motor
        let turns = estimate.motor_speed.exceeds(limits.standstill);
        self.turned |= turns;
        let jumps = self.innovation.exceeds(limits.innovation);
        let change = estimate.load_torque - self.recent;
        let beyond = turns && (jumps || change.exceeds(limits.change));
        self.ahead = if jumps { self.innovation > N::ZERO } else { change < N::ZERO };
        self.sudden = if beyond { self.sudden.saturating_add(1) } else { self.sudden.saturating_sub(1) };
        let load_torque = estimate.load_torque - limits.load_torque_middle;
        let cause = if estimate.motor_speed.exceeds(limits.speed) || estimate.load_speed.exceeds(limits.speed) {
            Faults::OVERSPEED
        } else if estimate.shaft_torque.exceeds(limits.shaft_torque) {
            Faults::SHAFT_OVERLOAD
        } else if load_torque.exceeds(limits.load_torque_half) {
            if (load_torque > N::ZERO) == (estimate.motor_speed > N::ZERO) { OPPOSED } else { Faults::NOT_FOLLOWED }
        } else if self.is_held(limits, estimate) {
            Faults::LOAD_BLOCKED
        } else if self.difference.exceeds(limits.report) {
            Faults::TORQUE_REPORT
        } else {
            Faults::NONE
        };
        self.outside = if cause.is_none() { self.outside.saturating_sub(1) } else { self.outside.saturating_add(1) };
        if self.sudden > limits.sudden {
            self.raised |= self.sudden_cause(limits, estimate);
        } else if self.outside > limits.lasting {
            self.raised |= cause;
        }
        self.turned && self.sudden | self.outside == 0 && self.cause().is_none()
    }

    /// Begins the stop of the cause.
    pub(super) fn begin(&mut self, limits: &SupervisionConfig<N>, estimate: &Estimate<N>) {
        self.forwards = estimate.motor_speed > N::ZERO;
        self.elapsed = 0;
        self.sudden = 0;
        self.stop = match self.cause() {
            Faults::LOAD_LOST | Faults::OVERSPEED | Faults::TORQUE_REPORT => Stop::Torque,
            OPPOSED if self.outside <= limits.lasting => Stop::Torque,
            Faults::LOAD_BLOCKED if estimate.motor_speed.exceeds(limits.standstill) => Stop::Torque,
            _ => Stop::Released,
        };
    }

    /// The cause of an innovation, by the direction in which the motor departs from its prediction.
    fn sudden_cause(&self, limits: &SupervisionConfig<N>, estimate: &Estimate<N>) -> Faults {
        let ahead = self.ahead;
        let along = ahead == (estimate.motor_speed > N::ZERO);
        // what is not there cannot be lost: a sixteenth of the range
        let sixteenth = limits.load_torque_half.scaled(N::fraction(1 << 28));
        let loaded = estimate.shaft_torque.exceeds(sixteenth);
        let unloads = loaded && ahead == (estimate.shaft_torque > N::ZERO);
        if unloads {
            Faults::LOAD_LOST
        } else if along {
            Faults::NOT_FOLLOWED
        } else {
            OPPOSED
        }
    }

    /// Goes on with a stop, until the machine stands.
    pub(super) fn stopping(&mut self, limits: &SupervisionConfig<N>, estimate: &Estimate<N>) {
        self.elapsed = self.elapsed.saturating_add(1);
        if self.cause() == OPPOSED && self.stop == Stop::Torque {
            // a stop that the machine does not follow shows an innovation against its torque
            let against = self.forwards == (self.innovation > N::ZERO);
            let turned = against && self.innovation.exceeds(limits.innovation);
            self.sudden = if turned { self.sudden.saturating_add(1) } else { self.sudden.saturating_sub(1) };
            if self.sudden > limits.sudden >> 2 {
                self.stop = Stop::Released;
            } else if self.elapsed > limits.naming {
                self.name_blocked();
            }
        }
        let turned_back = self.forwards != (estimate.motor_speed > N::ZERO);
        let stands = !estimate.motor_speed.exceeds(limits.standstill) || self.stop == Stop::Torque && turned_back;
        let runs_away = self.elapsed > limits.naming
            && self.cause() == Faults::OVERSPEED
            && estimate.motor_speed.exceeds(limits.speed);
        if stands || runs_away {
            if self.cause() == OPPOSED && self.stop == Stop::Torque {
                self.name_blocked();
            }
            self.stop = Stop::Released;
        }
        if self.stop == Stop::Released {
            self.raised |= Faults::STOPPED;
        }
    }

    /// Names the blocked load of the pair: the machine follows the stop.
    fn name_blocked(&mut self) {
        self.raised = Faults::from_bits(self.raised.bits() & !Faults::NOT_FOLLOWED.bits());
    }
}
