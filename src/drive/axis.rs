//! Further ticks of a drive: one without an angle, and starting while the machine turns.

use super::{ConfigOf, Drive, NONE_YET};
use crate::balancing::Balancer;
use crate::fault::Faults;
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::Number;
use crate::observer::Observer;
use crate::sample::{Command, Sample};

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
        if self.coasted < 0 {
            // The search for two angles in a row begins anew.
            self.coasted = NONE_YET;
            let torque = if torque.exceeds(config.limits.torque) { Faults::TORQUE } else { Faults::NONE };
            return self.release(config, torque | Faults::ANGLE_MISSING);
        }
        let sample = Sample { angle: self.observer.angle(), torque, setpoint };
        let (faults, _) = self.observe(config, &sample, false);
        let estimate = self.estimate(config);
        self.govern(config, &estimate, faults)
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
