//! Constants that change while a drive runs: bumpless transfer, and a gain schedule.

use super::{Config, ConfigOf, Drive};
use crate::balancing::Balancer;
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::{Interpolate, Number, Part};
use crate::observer::Observer;
use crate::scheduling::Schedule;

impl<N, O, G, F, B> Drive<N, O, G, F, B>
where
    N: Number,
    O: Part<N, State: Observer<N>>,
    G: Part<N, State: Governor<N>>,
    F: Part<N, State: Fluctuation<N>>,
    B: Part<N, State: Balancer<N>>,
{
    /// Bumpless transfer from the constants `from` to `to`, between two ticks: estimate and torque are the same under
    /// both. Every further tick takes `to`.
    pub fn switch(&mut self, from: &ConfigOf<Self>, to: &ConfigOf<Self>) {
        let estimate = self.estimate(from);
        self.observer.switch(&from.observer, &to.observer);
        self.governor.switch(&from.governor, &to.governor, &estimate);
    }

    /// Takes the constants of a schedule at these values of its variables, by [`switch`](Self::switch), between two
    /// ticks.
    ///
    /// Some twenty times a second are enough for a rope, and more do no harm. The interpolation may run beside the
    /// ticks, by [`Schedule::at`]; only the transfer has to stand between two of them.
    pub fn follow<const I: usize, const K: usize>(
        &mut self,
        config: &mut ConfigOf<Self>,
        schedule: &Schedule<(<O::State as Observer<N>>::Config, <G::State as Governor<N>>::Config), I, K>,
        first: f32,
        second: f32,
    ) where
        O::State: Observer<N, Config: Interpolate>,
        G::State: Governor<N, Config: Interpolate>,
        F::State: Fluctuation<N, Config: Copy>,
        B::State: Balancer<N, Config: Copy>,
    {
        let (observer, governor) = schedule.at(first, second);
        let Config { limits, fluctuation, balancer, .. } = *config;
        let next = Config { limits, observer, fluctuation, governor, balancer };
        self.switch(config, &next);
        *config = next;
    }
}
