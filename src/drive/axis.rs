//! Further ticks of a drive: one without an angle, and starting while the machine turns.

use super::{ConfigOf, Drive, NONE_YET};
use crate::balancing::Balancer;
use crate::fault::Faults;
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::Number;
use crate::observer::Observer;
use crate::sample::Command;

impl<N, O, F, G, B> Drive<N, O, F, G, B>
where
    N: Number,
    O: Observer<N>,
    F: Fluctuation<N>,
    G: Governor<N>,
    B: Balancer<N>,
{
    /// One tick by prediction alone (dead reckoning), without an angle: the sensor's bus failed, or its value was
    /// invalid or not new.
    ///
    /// It raises [`Faults::ANGLE_MISSING`]; after more than the limit of such ticks also
    /// [`Faults::ANGLE_LOST`], and commands no torque. Torque and setpoint are screened as in [`Drive::tick`].
    pub fn coast(&mut self, config: &ConfigOf<Self>, torque: N, setpoint: N) -> Command<N> {
        let limits = &config.limits;
        let (mut torque, mut faults) = (torque, Faults::ANGLE_MISSING);
        if torque.exceeds(limits.torque) {
            torque = self.commanded;
            faults |= Faults::TORQUE;
        } else if !G::COMMANDS {
            self.commanded = torque;
        }
        self.fluctuation.disturb();
        if self.coasted < 0 {
            // the search for two angles in a row begins anew
            self.coasted = NONE_YET;
            let estimate = self.estimate(config);
            self.governor.angle_lost(&config.governor, &estimate);
            self.commanded = N::ZERO;
            return Command { torque: N::ZERO, faults: faults | Faults::ANGLE_LOST };
        }
        if setpoint.exceeds(limits.setpoint) {
            faults |= Faults::SETPOINT;
        } else {
            self.governor.set_setpoint(setpoint);
        }
        let last = self.observer.angle();
        let predicted = self.observer.predict(&config.observer, last, torque);
        self.observer.coast(predicted, last);
        self.coasted = if (self.coasted as u32) < limits.max_coast { self.coasted.wrapping_add(1) } else { NONE_YET };
        let estimate = self.estimate(config);
        let torque = self.governor.command(&config.governor, &estimate);
        if G::COMMANDS {
            self.commanded = torque;
        }
        Command { torque, faults: faults | Faults::range(self.observer.beyond_base()) }
    }

    /// The governor starts anew, from the speed that the machine has and no torque; its setpoint is zero. The estimates
    /// stand.
    pub fn engage(&mut self, config: &ConfigOf<Self>) {
        let estimate = self.estimate(config);
        self.governor.start(&config.governor, &estimate, N::ZERO);
        self.commanded = N::ZERO;
    }

    /// Whether the angle is lost: [`Faults::ANGLE_LOST`] was raised and no two angles in a row have been found since.
    pub fn is_lost(&self) -> bool {
        self.coasted < 0
    }
}
