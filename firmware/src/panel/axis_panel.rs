//! The panel of a drive on an axis, in the main loop beside the tick: balancing, and the fluctuation.
//!
//! A tick may wait for a copy of its state, but not for the processing of it.

use driveline::balancing::PhasorsConfig;
use driveline::configure::VibrationNumber;
use driveline::drive::ConfigOf;
use driveline::fluctuation::{Extremes, Fluctuation, Interleaved, Ranked, Summed};
use driveline::governor::Governor;
use driveline::number::Part;
use driveline::observer::Observer;

use super::balancing_head::{HeadPanel, SelfBalanced};
use super::fluctuation::{FluctuationPanel, TAKE, last_turn};
use crate::scene::balanced::{Adviser, BalancedDrive, CHANNELS, Measurement, reading, state};
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
    N: VibrationNumber,
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
    head: HeadPanel<M>,
    fluctuation: FluctuationPanel<M>,
    /// Finished turns when the extremes were last looked at.
    cycles: u32,
}

impl<M: SelfBalanced, A: Adviser> Default for AxisPanel<M, A> {
    fn default() -> Self {
        AxisPanel {
            adviser: A::new(),
            head: HeadPanel::new(false),
            fluctuation: FluctuationPanel::default(),
            cycles: 0,
        }
    }
}

impl<M: SelfBalanced, A: Adviser> AxisPanel<M, A> {
    /// A turn of the main loop: balances by the head, where that is on.
    pub fn balance<N, O, G, F>(
        &mut self,
        config: &ConfigOf<BalancedDrive<N, O, G, F>>,
        scene: &mut impl BetweenTicks<OnAxis<M, N, O, G, F>>,
    ) where
        N: VibrationNumber + 'static,
        O: Part<N, State: Observer<N, Config: 'static>>,
        G: Part<N, State: Governor<N, Config: 'static>>,
        F: Part<N, State: Fluctuation<N, Config: 'static>>,
    {
        let head = &mut self.head;
        if let Some(look) = scene.between_ticks(|scene| head.look(scene.drive_mut().balancer_mut())) {
            head.proceed(&config.balancer, &look);
        }
    }

    /// Answers a request.
    pub fn ask<N, O, G, const BINS: usize>(
        &mut self,
        config: &ConfigOf<BalancedDrive<N, O, G, Interleaved<BINS>>>,
        scene: &mut impl BetweenTicks<OnAxis<M, N, O, G, Interleaved<BINS>>>,
        [key, value]: [u32; 2],
    ) -> u32
    where
        N: VibrationNumber + Summed<Real = f32> + Ranked + 'static,
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
                if let Some(answer) = self.head.ask(key, value) {
                    return answer;
                }
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
    fn advise<N: VibrationNumber>(
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
        N: VibrationNumber + Summed<Real = f32> + Ranked + 'static,
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
