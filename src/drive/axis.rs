//! Further ticks of a drive: one without an angle, ticks that did not run, and starting while the machine turns.

use super::{ConfigOf, Drive, NONE_YET};
use crate::balancing::Balancer;
use crate::fault::Faults;
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::{Number, Part};
use crate::observer::Observer;
use crate::sample::{Command, Sample};

/// The most ticks that did not run which [`Drive::make_up`] predicts: it bounds the time of the call.
pub const MADE_UP: u32 = 8;

impl<N, O, G, F, B> Drive<N, O, G, F, B>
where
    N: Number,
    O: Part<N, State: Observer<N>>,
    G: Part<N, State: Governor<N>>,
    F: Part<N, State: Fluctuation<N>>,
    B: Part<N, State: Balancer<N>>,
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

    /// [`Drive::tick`] after `missed` ticks that did not run. `sample.torque` acted during them.
    ///
    /// Up to [`MADE_UP`] ticks are predicted first ([`Drive::make_up`]). After more than these the estimates go on from
    /// the last prediction and the present angle, without a correction, which raises [`Faults::ANGLE_MISSING`] too.
    #[inline(always)]
    pub fn tick_after(&mut self, config: &ConfigOf<Self>, sample: &Sample<N>, missed: u32) -> Command<N> {
        let mut faults = Faults::NONE;
        if missed != 0 {
            faults = self.make_up(config, sample.torque, missed);
            if missed > MADE_UP {
                let Command { torque, faults: found } = self.coast(config, sample.torque, sample.setpoint);
                self.observer.resync(sample.angle);
                return Command { torque, faults: faults | found };
            }
        }
        let Command { torque, faults: found } = self.tick(config, sample);
        Command { torque, faults: faults | found }
    }

    /// Predicts `missed` ticks that did not run, at most [`MADE_UP`], under the torque that acted during them, and
    /// returns [`Faults::TICK_MISSED`]. Call it before the next tick.
    ///
    /// The governor is left as it is: its ramp and its times stand still meanwhile. The measurement of the fluctuation
    /// and a balancing reading begin anew. More ticks than the limit of those without an angle lose the angle.
    #[cold]
    #[inline(never)]
    pub fn make_up(&mut self, config: &ConfigOf<Self>, torque: N, missed: u32) -> Faults {
        let limits = &config.limits;
        self.fluctuation.disturb();
        self.balancer.missed(Faults::TICK_MISSED);
        if self.coasted < 0 || missed > limits.max_coast {
            self.coasted = NONE_YET;
            return Faults::TICK_MISSED;
        }
        let torque = if torque.exceeds(limits.torque) { self.commanded } else { torque };
        let angle = self.observer.angle();
        for _ in 0..missed.min(MADE_UP) {
            let predicted = self.observer.predict(&config.observer, angle, torque);
            self.observer.coast(predicted, angle);
        }
        Faults::TICK_MISSED
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
