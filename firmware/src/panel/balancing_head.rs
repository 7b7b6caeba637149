//! A rotor that balances itself by its head: the library's task, and its state on the panel.

use core::convert::Infallible;

use driveline::angle::Synchronous;
use driveline::balancing::{
    BalancingDesign, BalancingHead, BalancingState, BalancingTask, Complex, HeadPosition, Look, Phasors, PhasorsConfig,
};
use driveline::configure::{HasVibration, VibrationNumber};
use driveline::drive::ConfigOf;
use driveline::fluctuation::Fluctuation;
use driveline::governor::Governor;
use driveline::number::Part;
use driveline::observer::Observer;
use driveline::parameters::Store;

use super::flash_model::{self, Pages};
use crate::scene::balanced::{BalancedDrive, CHANNELS, EDGES, Sampled};
use crate::scene::composed::Beside;
use crate::scene::panel_keys::{DONE, Key, MEASURING, refused};
use crate::scene::{Input, Output};

/// A machine with a balancing head.
pub trait SelfBalanced: HasVibration {
    /// Rotor and head.
    const BALANCING: BalancingDesign;
}

/// A head whose two masses are driven by steps: it follows its command along a straight line.
pub struct SteppedHead {
    at: Complex<f32>,
    to: Complex<f32>,
    /// Step of a tick (kg m).
    step: f32,
}

impl SteppedHead {
    fn tick(&mut self) {
        let left = self.to - self.at;
        let square = left.re * left.re + left.im * left.im;
        if square <= self.step * self.step {
            self.at = self.to;
        } else {
            // a step along the larger part, the other one in proportion
            let most = left.re.abs().max(left.im.abs());
            self.at += left.scale(self.step / most);
        }
    }
}

impl BalancingHead for SteppedHead {
    type Error = Infallible;

    fn set(&mut self, [to]: &[Complex<f32>; 1]) -> Result<(), Infallible> {
        self.to = *to;
        Ok(())
    }

    fn position(&mut self) -> Result<HeadPosition, Infallible> {
        Ok(if self.at == self.to { HeadPosition::At([self.at]) } else { HeadPosition::Moving })
    }
}

/// The task of a machine `M`, with its head and its flash; it is on from the start where it stands beside a tick.
pub struct HeadPanel<M> {
    task: Option<BalancingTask<M, SteppedHead, Store<Pages>>>,
    on: bool,
    /// Ticks at the last look: the head takes a step in each of them, or later.
    ticks: u32,
}

const ZERO: Complex<f32> = Complex { re: 0.0, im: 0.0 };

impl<M: SelfBalanced> HeadPanel<M> {
    /// A head at zero, and an empty flash.
    pub fn new(on: bool) -> Self {
        // the whole capacity in a second
        let step = const { M::BALANCING.capacity[0] / M::RATE_HZ as f32 };
        let head = SteppedHead { at: ZERO, to: ZERO, step };
        let store = Store::new(Pages::new(), 0..4 * flash_model::WORDS as u32);
        HeadPanel {
            task: store.ok().and_then(|store| BalancingTask::new(M::BALANCING, head, store).ok()),
            on,
            ticks: 0,
        }
    }

    /// Between two ticks.
    pub fn look<N: VibrationNumber>(
        &mut self,
        phasors: &mut Phasors<CHANNELS, EDGES, N>,
    ) -> Option<Look<N, CHANNELS, EDGES>> {
        let task = self.task.as_mut().filter(|_| self.on)?;
        if core::mem::replace(&mut self.ticks, phasors.ticks()) != phasors.ticks() {
            task.head().tick();
        }
        Some(task.look(phasors))
    }

    /// Beside the ticks. A fault of the flash shows in the state: less is remembered.
    pub fn proceed<N: VibrationNumber>(
        &mut self,
        config: &PhasorsConfig<N, CHANNELS>,
        look: &Look<N, CHANNELS, EDGES>,
    ) {
        if let Some(task) = &mut self.task {
            let _ = task.proceed(config, look);
        }
    }

    /// Answers a key of the head; none for another key.
    pub fn ask(&mut self, key: Key, value: u32) -> Option<u32> {
        let task = self.task.as_mut()?;
        let at = task.head().at;
        Some(match key {
            Key::Balance => {
                self.on = value != 0;
                DONE
            }
            Key::HeadRe => at.re.to_bits(),
            Key::HeadIm => at.im.to_bits(),
            Key::Grade => match task.state() {
                BalancingState::Held(Some(verdict)) => verdict.grade.to_bits(),
                _ => 0,
            },
            Key::State if self.on => match task.state() {
                BalancingState::Held(_) => DONE,
                BalancingState::Moving | BalancingState::Measuring => MEASURING,
                BalancingState::Waiting(_) => refused(0),
                BalancingState::OffSpeed => refused(1),
                BalancingState::HeadStuck => refused(2),
                BalancingState::Stopped(_) => refused(3),
            },
            _ => return None,
        })
    }
}

impl<M, N, O, G, F> Beside<BalancedDrive<N, O, G, F>> for HeadPanel<M>
where
    M: SelfBalanced,
    N: VibrationNumber + Synchronous,
    O: Part<N, State: Observer<N>>,
    G: Part<N, State: Governor<N>>,
    F: Part<N, State: Fluctuation<N>>,
{
    fn start(_: &mut BalancedDrive<N, O, G, F>, _: &ConfigOf<BalancedDrive<N, O, G, F>>) -> Self {
        HeadPanel::new(true)
    }

    #[inline(always)]
    fn tick(
        &mut self,
        drive: &mut BalancedDrive<N, O, G, F>,
        config: &ConfigOf<BalancedDrive<N, O, G, F>>,
        input: &Input,
    ) -> Output {
        Sampled.tick(drive, config, input)
    }

    fn panel(
        &mut self,
        drive: &mut BalancedDrive<N, O, G, F>,
        config: &mut &'static ConfigOf<BalancedDrive<N, O, G, F>>,
        [key, value]: [u32; 2],
    ) -> u32 {
        if let Some(look) = self.look(drive.balancer_mut()) {
            self.proceed(&config.balancer, &look);
        }
        Key::of(key).and_then(|key| self.ask(key, value)).unwrap_or_default()
    }
}
