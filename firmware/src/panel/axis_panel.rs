//! The panel of a drive on an axis, in the main loop beside the tick: balancing, and the fluctuation.
//!
//! A tick may wait for a copy of its state, but not for the processing of it.

use driveline::balancing::PhasorsConfig;
use driveline::configure::HasVibration;
use driveline::drive::ConfigOf;
use driveline::fluctuation::{Extremes, Fluctuation, Interleaved, Ranked, Summed};
use driveline::governor::Governor;
use driveline::number::Part;
use driveline::observer::Observer;

use super::fluctuation::{FluctuationPanel, TAKE, last_turn};
use crate::scene::balanced::{Adviser, BalancedDrive, CHANNELS, Measurement, SensorUnit, reading, state};
use crate::scene::on_axis::OnAxis;
use crate::scene::panel_keys::{DONE, Key};

/// Access to a scene whose tick may come at any time.
pub trait BetweenTicks<S> {
    /// Does something with the scene between two ticks.
    fn between_ticks<T>(&mut self, action: impl FnOnce(&mut S) -> T) -> T;
}

/// A scene that no tick interrupts.
impl<M, N, O, G, F> BetweenTicks<OnAxis<M, N, O, G, F>> for OnAxis<M, N, O, G, F>
where
    N: SensorUnit,
    O: Part<N, State: Observer<N, Config: 'static>>,
    G: Part<N, State: Governor<N, Config: 'static>>,
    F: Part<N, State: Fluctuation<N, Config: 'static>>,
{
    fn between_ticks<T>(&mut self, action: impl FnOnce(&mut Self) -> T) -> T {
        action(self)
    }
}

/// State of the panel: `A` makes weights of readings.
pub struct AxisPanel<M, A> {
    adviser: A,
    fluctuation: FluctuationPanel<M>,
    /// Finished turns when the extremes were last looked at.
    cycles: u32,
}

impl<M, A: Adviser> Default for AxisPanel<M, A> {
    fn default() -> Self {
        AxisPanel { adviser: A::new(), fluctuation: FluctuationPanel::default(), cycles: 0 }
    }
}

impl<M: HasVibration, A: Adviser> AxisPanel<M, A> {
    /// Answers a request.
    pub fn ask<N, O, G, const BINS: usize>(
        &mut self,
        config: &ConfigOf<BalancedDrive<N, O, G, Interleaved<BINS>>>,
        scene: &mut impl BetweenTicks<OnAxis<M, N, O, G, Interleaved<BINS>>>,
        [key, value]: [u32; 2],
    ) -> u32
    where
        N: SensorUnit + Summed + Ranked + 'static,
        O: Part<N, State: Observer<N, Config: 'static>>,
        G: Part<N, State: Governor<N, Config: 'static>>,
    {
        match (key, Key::of(key)) {
            (TAKE, _) => {
                let window = scene.between_ticks(|scene| scene.drive_mut().fluctuation_mut().waveform_mut().take());
                self.fluctuation.keep(&config.fluctuation, window)
            }
            (_, Some(Key::Begin)) => {
                scene.between_ticks(|scene| scene.drive_mut().balancer_mut().begin());
                DONE
            }
            (_, Some(key)) => {
                let measurement = scene.between_ticks(|scene| *scene.drive().balancer());
                self.advise(&config.balancer, &measurement, key, value)
            }
            (_, None) => {
                let extremes = || scene.between_ticks(|scene| *scene.drive().fluctuation().extremes());
                self.fluctuation.number(&config.fluctuation, [key, value], extremes)
            }
        }
    }

    // Out of line: its stack is not that of the fluctuation's calculation as well.
    #[inline(never)]
    fn advise<N: SensorUnit>(
        &mut self,
        config: &PhasorsConfig<N, CHANNELS>,
        measurement: &Measurement<N>,
        key: Key,
        value: u32,
    ) -> u32 {
        match key {
            Key::State => state::<M, N>(config, measurement),
            key => self.adviser.ask(key, value, reading::<M, N>(config, measurement).ok()),
        }
    }

    /// Mean speed (rad/s) and delta of motor and load in the last turn, where one was finished since the last call.
    pub fn new_turn<N, O, G, const BINS: usize>(
        &mut self,
        config: &ConfigOf<BalancedDrive<N, O, G, Interleaved<BINS>>>,
        scene: &mut impl BetweenTicks<OnAxis<M, N, O, G, Interleaved<BINS>>>,
    ) -> Option<[f32; 3]>
    where
        N: SensorUnit + Summed + Ranked + 'static,
        O: Part<N, State: Observer<N, Config: 'static>>,
        G: Part<N, State: Governor<N, Config: 'static>>,
    {
        let last = self.cycles;
        let extremes: Extremes<N> = scene.between_ticks(|scene| {
            let extremes = scene.drive().fluctuation().extremes();
            (extremes.cycles() != last).then_some(*extremes)
        })?;
        self.cycles = extremes.cycles();
        let [mean, motor, load, ..] = last_turn::<M, N>(&config.fluctuation, &extremes);
        Some([mean, motor, load])
    }
}
