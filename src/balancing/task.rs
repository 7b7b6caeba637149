//! Balancing by itself: a task of the main loop that reads, moves a head, confirms, judges, holds and remembers.

mod design;
mod moves;
mod readings;
mod state;

use core::marker::PhantomData;

pub use design::{BalancingDesign, BalancingDesignError};
pub use state::{BalancingFault, BalancingState};

use super::Phasors;
use super::head::{BalancingHead, HeadPosition};
use super::in_run::{BalancingRecord, InRun, InRunConfig};
use super::memory::BalancingMemory;
use super::reading::PhasorsConfig;
use super::scalar::{Complex, size, zero};
use crate::configure::{HasVibration, VibrationNumber};
use crate::drive::{ConfigOf, Drive};
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::Part;
use crate::observer::Observer;

/// Share of the capacity within which a head is at its weights.
const NEAR: f32 = 0.01;
/// Commands at power-up to a head without a sensor.
const COMMANDS: u32 = 3;
/// Calls without a tick.
const CALLS: u32 = 1_000_000;

/// Where the work stands.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase<const PLANES: usize> {
    /// Power is on.
    Start,
    /// The head is to be commanded.
    Command([Complex<f32>; PLANES]),
    Moving([Complex<f32>; PLANES]),
    Settling,
    Reading,
}

/// The measurement as it is copied between two ticks.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: only the task reads it.
pub struct Look<N: VibrationNumber, const ROWS: usize, const EDGES: usize> {
    ticks: u32,
    complete: Option<Phasors<ROWS, EDGES, N>>,
}

/// A rotor that is balanced while it turns: of the machine `M`, by the head `H`, remembered by `K`.
///
/// [`BalancingTask::run`] is called at any rate. It begins each reading itself, after the head has arrived and the
/// vibration has settled. A reading is used once, with the largest variance of all channels and the speed that it was
/// taken at. [`InRun`] decides the moves.
///
/// # When it begins
/// At power-up the head goes to the weights of the record: the best ones, or those that it began with. Without a record
/// it stays where it is, or goes to zero if it has no sensor. The task waits for steady readings between half of the
/// service speed and 1.1 times. Another speed by more than 5 % begins anew, since the influence is another.
///
/// # When it goes back
/// The head goes back to those weights when the rotor stops, the sensor clips, eight readings in a row are refused,
/// or [`InRun`] aborts.
///
/// # When it ends
/// At [`BalancingState::Held`] it goes on reading. Two readings in a row that are half as large again as at first, and
/// beyond the tolerance, are a change of the rotor: balancing begins again.
///
/// ```
#[doc = include_str!("grinder.txt")]
/// const G2_5: BalanceTolerance<f32> = BalanceTolerance { grade: 2.5, mass: 140.0, speed: 77.0 };
/// const DESIGN: BalancingDesign =
///     BalancingDesign { rotor: G2_5, capacity: [0.02], travel: 3.0, settle: 0.3, quiet: 0.0 };
/// let (mut drive, head) = (GrinderDrive::new(&CONFIG, 0), Head([Complex::new(0.005, 0.0)]));
/// let mut balancing = BalancingTask::<Grinder, _, _>::new(DESIGN, head, None::<BalancingRecord<2, 1>>)?;
/// // the rotor stands: known after 20 s without a reading; the head stays
/// for _ in 0..200_000 {
///     drive.tick(&CONFIG, &Sample::si::<Grinder>(0, 0.0, 0.0));
///     drive.vibration(&CONFIG, &[0.0, 0.0]);
///     balancing.run(&mut drive, &CONFIG)?;
/// }
/// assert_eq!(balancing.state(), BalancingState::OffSpeed);
/// assert_eq!(balancing.head().0, [Complex::new(0.005, 0.0)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
// Not logged: holds the head and the memory.
#[doc(alias("active balancing", "unbalance"))]
pub struct BalancingTask<M, H, K, const ROWS: usize = 2, const PLANES: usize = 1> {
    design: BalancingDesign<PLANES>,
    moves: InRunConfig<f32, PLANES>,
    head: H,
    memory: K,
    in_run: InRun<f32, ROWS, PLANES>,
    phase: Phase<PLANES>,
    begin: bool,
    /// Ticks at the last look, and calls since they changed.
    ticks: u32,
    calls: u32,
    state: BalancingState,
    /// Whether something is to be remembered, and what was last.
    dirty: bool,
    record: BalancingRecord<ROWS, PLANES>,
    /// The rotor stood, or readings failed: the influence has to be confirmed again.
    interrupted: bool,
    /// Level at which it holds, in the unit of the sensors.
    held: Option<f32>,
    doubts: u32,
    changes: u32,
    /// The last good reading, and the weights that it was taken with.
    last: Option<([Complex<f32>; ROWS], [Complex<f32>; PLANES])>,
    /// Whether the head has a sensor; moves that showed no effect; commands to repeat.
    measured: bool,
    missed: u32,
    repeats: u32,
    /// Readings until it is tried again; attempts.
    rest: u32,
    retries: u32,
    machine: PhantomData<fn() -> M>,
}

impl<M, H, K, const ROWS: usize, const PLANES: usize> BalancingTask<M, H, K, ROWS, PLANES>
where
    M: HasVibration,
    H: BalancingHead<PLANES>,
    K: BalancingMemory<ROWS, PLANES>,
{
    /// A task that goes on from what `memory` has kept. The head is not moved here.
    ///
    /// # Errors
    /// A value of the design out of its range; the memory cannot be read.
    pub fn new(
        design: BalancingDesign<PLANES>,
        head: H,
        mut memory: K,
    ) -> Result<Self, BalancingFault<H::Error, K::Error>> {
        const { assert!(ROWS > 0 && PLANES > 0, "a sensor and a plane are needed") };
        const { assert!(M::PHASORS.order == 1, "the task needs the order 1: the vibration at the rotor's own speed") };
        let moves = design.moves().map_err(BalancingFault::Design)?;
        let record = memory.load().map_err(BalancingFault::Memory)?;
        let within = |record: &BalancingRecord<ROWS, PLANES>| {
            record.weights.iter().zip(&design.capacity).all(|(weight, most)| size(*weight) <= *most)
        };
        let kept = record.filter(within).and_then(|record| Some((InRun::remembered(moves, &record).ok()?, record)));
        let known = kept.is_some();
        let (in_run, record) = match kept {
            Some(kept) => kept,
            None => match InRun::new(moves, ROWS, [zero(); PLANES]) {
                Ok(in_run) => (in_run, BalancingRecord::new([zero(); PLANES])),
                Err(_) => return Err(BalancingFault::Design(BalancingDesignError::Capacity)),
            },
        };
        Ok(BalancingTask {
            design,
            moves,
            head,
            memory,
            in_run,
            phase: Phase::Start,
            begin: true,
            ticks: 0,
            calls: 0,
            state: BalancingState::Moving,
            dirty: !known,
            record,
            interrupted: false,
            held: None,
            doubts: 0,
            changes: 0,
            last: None,
            measured: true,
            missed: 0,
            repeats: 0,
            rest: 0,
            retries: 0,
            machine: PhantomData,
        })
    }

    /// One call of the main loop, at any rate. A drive whose ticks interrupt the main loop is given to
    /// [`BalancingTask::look`] between two ticks, and the look to [`BalancingTask::proceed`].
    ///
    /// # Errors
    /// Head or memory failed, or there are no samples; the next call goes on.
    pub fn run<N, O, G, F, B, const EDGES: usize>(
        &mut self,
        drive: &mut Drive<N, O, G, F, B>,
        config: &ConfigOf<Drive<N, O, G, F, B>>,
    ) -> Result<BalancingState, BalancingFault<H::Error, K::Error>>
    where
        N: VibrationNumber,
        O: Part<N, State: Observer<N>>,
        G: Part<N, State: Governor<N>>,
        F: Part<N, State: Fluctuation<N>>,
        B: Part<N, State = Phasors<ROWS, EDGES, N>>,
    {
        let look = self.look(drive.balancer_mut());
        self.proceed(&config.balancer, &look)
    }

    /// Begins a reading or copies a complete one: between two ticks, and short.
    pub fn look<N: VibrationNumber, const EDGES: usize>(
        &mut self,
        phasors: &mut Phasors<ROWS, EDGES, N>,
    ) -> Look<N, ROWS, EDGES> {
        if core::mem::take(&mut self.begin) {
            phasors.begin();
        }
        let complete = phasors.is_complete() && self.phase == Phase::Reading;
        Look { ticks: phasors.ticks(), complete: complete.then_some(*phasors) }
    }

    /// What takes longer than a tick: the calculations, the head, the memory.
    ///
    /// # Errors
    /// As [`BalancingTask::run`].
    pub fn proceed<N: VibrationNumber, const EDGES: usize>(
        &mut self,
        config: &PhasorsConfig<N, ROWS>,
        look: &Look<N, ROWS, EDGES>,
    ) -> Result<BalancingState, BalancingFault<H::Error, K::Error>> {
        self.calls = if look.ticks == self.ticks { self.calls.saturating_add(1) } else { 0 };
        self.ticks = look.ticks;
        if self.calls > CALLS {
            return Err(BalancingFault::NoVibration);
        }
        match self.phase {
            Phase::Start => self.start()?,
            Phase::Command(to) => {
                // what the head goes back to is kept before it moves
                let kept = self.keep();
                self.head.set(&to).map_err(BalancingFault::Head)?;
                self.phase = Phase::Moving(to);
                self.begin = true;
                kept?;
            }
            Phase::Moving(to) => self.moving(to, look.ticks)?,
            Phase::Settling => {
                if look.ticks as f32 >= self.design.settle * M::RATE_HZ as f32 {
                    self.read();
                }
            }
            Phase::Reading => {
                if let Some(complete) = &look.complete {
                    self.complete(config, complete)?;
                } else if look.ticks as f32 > Self::patience(config, EDGES, self.design.rotor.speed) {
                    self.state = BalancingState::OffSpeed;
                    self.interrupt();
                }
            }
        }
        Ok(self.state)
    }

    /// The present work.
    pub fn state(&self) -> BalancingState {
        self.state
    }

    /// The weights that the head stands at or goes to (kg m).
    pub fn weights(&self) -> &[Complex<f32>; PLANES] {
        self.in_run.weights()
    }

    /// The head.
    pub fn head(&mut self) -> &mut H {
        &mut self.head
    }

    /// Head and memory again.
    pub fn release(self) -> (H, K) {
        (self.head, self.memory)
    }

    /// Ticks of a reading at half of the service speed, and half as many again.
    fn patience<N: VibrationNumber>(config: &PhasorsConfig<N, ROWS>, edges: usize, speed: f32) -> f32 {
        let turns = config.block as f32 * edges as f32;
        1.5 * turns * core::f32::consts::TAU * M::RATE_HZ as f32 / (0.5 * speed)
    }

    /// Keeps what has changed, once.
    fn keep(&mut self) -> Result<(), BalancingFault<H::Error, K::Error>> {
        if core::mem::take(&mut self.dirty) {
            return self.memory.save(&self.record).map_err(BalancingFault::Memory);
        }
        Ok(())
    }

    /// Power is on: to the weights of the record, or where the head stands.
    fn start(&mut self) -> Result<(), BalancingFault<H::Error, K::Error>> {
        match self.position()? {
            HeadPosition::Moving => {}
            HeadPosition::At(at) if self.dirty => {
                self.record.weights = at;
                if let Ok(in_run) = InRun::new(self.moves, ROWS, at) {
                    self.in_run = in_run;
                }
                self.arrive();
                self.keep()?;
            }
            HeadPosition::At(at) if self.near(&at, &self.record.weights) => self.arrive(),
            HeadPosition::At(_) => self.phase = Phase::Command(self.record.weights),
            HeadPosition::Unmeasured => {
                // a command that is missed now would show in no reading
                self.repeats = COMMANDS - 1;
                self.phase = Phase::Command(self.record.weights);
            }
        }
        Ok(())
    }

    /// Where the head stands; one that is no number or beyond its capacity by a tenth is not valid yet.
    fn position(&mut self) -> Result<HeadPosition<PLANES>, BalancingFault<H::Error, K::Error>> {
        let position = self.head.position().map_err(BalancingFault::Head)?;
        let HeadPosition::At(at) = &position else { return Ok(position) };
        let valid = at.iter().zip(&self.design.capacity).all(|(at, most)| size(*at) <= 1.1 * most);
        Ok(if valid { position } else { HeadPosition::Moving })
    }

    /// Whether weights are the same, within a hundredth of the capacity.
    fn near(&self, a: &[Complex<f32>; PLANES], b: &[Complex<f32>; PLANES]) -> bool {
        let pairs = a.iter().zip(b).zip(&self.design.capacity);
        pairs.fold(true, |near, ((a, b), capacity)| near && size(*a - *b) <= NEAR * capacity)
    }
}
