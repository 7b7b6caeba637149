//! The last ticks of a drive, kept for a replay.

use super::composition::handed_on;
use super::{Composition, ConfigOf, GovernorConfigOf, ObserverConfigOf, VibrationOf};
use crate::axis::TRIPPING;
use crate::fault::Faults;
use crate::number::Number;
use crate::sample::{Command, Estimate, Sample};

/// What a drive was given in a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Kind {
    #[default]
    Tick,
    /// A tick after this number of ticks that did not run.
    After(u32),
    /// Ticks that did not run, before a tick without an angle.
    MadeUp(u32),
    Coast,
    Hold,
    Engage,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Entry<N> {
    kind: Kind,
    sample: Sample<N>,
}

/// A state of the drive, and the inputs since.
#[derive(Clone, Copy, Debug)]
struct Block<D: Composition, const K: usize> {
    start: D,
    entries: [Entry<D::Number>; K],
    length: usize,
}

/// A drive that keeps its last ticks, between `K` and `2 K` of them: a [`Composition`] like the drive itself.
///
/// It records ticks, [`Drive::hold`](super::Drive::hold) and [`Drive::engage`](super::Drive::engage). A change by
/// [`Recorded::drive_mut`] or [`Drive::switch`](super::Drive::switch) begins a new record.
///
/// A [`Recorded`] drive keeps what each tick was given, and its own state every `K` ticks. A replay starts from
/// such a state and gives the same commands, bit for bit, on the desk as on the board. At the first of the tripping
/// faults the record is kept as it is, with the fault, until [`Recorded::release`].
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::drive::{Composition, Recorded};
/// use driveline::fault::Faults;
/// type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
/// static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
/// let mut drive = Recorded::<RollDrive, 16>::new(&CONFIG, 0);
/// let commands: Vec<_> = (0..20).map(|_| drive.tick(&CONFIG, &Sample::si::<Roll>(0, 0.0, 100.0))).collect();
/// // on the desk: the last of these ticks again, to the bit
/// let mut again = Vec::new();
/// drive.replay(&CONFIG, |command| again.push(command));
/// assert!(again.len() >= 16 && commands.ends_with(&again) && drive.reason() == Faults::NONE);
/// ```
#[derive(Clone, Copy, Debug)]
// Not logged: a telemetry frame holds single ticks.
pub struct Recorded<D: Composition, const K: usize = 64> {
    drive: D,
    /// The block that is written, and the one before.
    blocks: [Block<D, K>; 2],
    reason: Faults,
}

impl<D: Composition + Clone, const K: usize> Recorded<D, K> {
    /// The fault at which the record was kept; [`Faults::NONE`] while it goes on.
    pub fn reason(&self) -> Faults {
        self.reason
    }

    /// Ticks in the record.
    pub fn ticks(&self) -> usize {
        self.blocks[0].length + self.blocks[1].length
    }

    /// Begins a new record, after a fault.
    pub fn release(&mut self) {
        self.reason = Faults::NONE;
        self.begin();
    }

    /// The drive.
    pub fn drive(&self) -> &D {
        &self.drive
    }

    /// The drive, for actions between two ticks. It begins a new record, unless one is kept for a fault.
    pub fn drive_mut(&mut self) -> &mut D {
        if self.reason.is_none() {
            self.begin();
        }
        &mut self.drive
    }

    /// Runs the record again and gives each command, the oldest first.
    pub fn replay(&self, config: &ConfigOf<D>, mut each: impl FnMut(Command<D::Number>)) {
        let [last, before] = &self.blocks;
        let first = if before.length > 0 { before } else { last };
        let mut drive = first.start.clone();
        for block in [before, last] {
            for entry in block.entries.iter().take(block.length) {
                if let Some(command) = run(&mut drive, config, entry) {
                    each(command);
                }
            }
        }
    }

    fn begin(&mut self) {
        for block in &mut self.blocks {
            block.length = 0;
        }
    }

    /// Keeps an input and the state before it.
    #[inline(always)]
    fn keep(&mut self, kind: Kind, sample: &Sample<D::Number>) {
        if !self.reason.is_none() {
            return;
        }
        let [block, before] = &mut self.blocks;
        if block.length >= K {
            core::mem::swap(block, before);
            block.length = 0;
        }
        if block.length == 0 {
            block.start = self.drive.clone();
        }
        if let Some(entry) = block.entries.get_mut(block.length) {
            *entry = Entry { kind, sample: *sample };
            block.length += 1;
        }
    }

    #[inline(always)]
    fn watch(&mut self, command: Command<D::Number>) -> Command<D::Number> {
        if command.faults.intersects(TRIPPING.with(Faults::SUPERVISION)) && self.reason.is_none() {
            self.reason = command.faults;
        }
        command
    }
}

/// One recorded input again.
fn run<D: Composition>(drive: &mut D, config: &ConfigOf<D>, entry: &Entry<D::Number>) -> Option<Command<D::Number>> {
    let sample = &entry.sample;
    Some(match entry.kind {
        Kind::Tick => drive.tick(config, sample),
        Kind::After(missed) => drive.tick_after(config, sample, missed),
        Kind::Coast => drive.coast(config, sample.torque, sample.setpoint),
        Kind::Hold => drive.hold(config, sample.angle, sample.torque),
        Kind::MadeUp(missed) => {
            drive.make_up(config, sample.torque, missed);
            return None;
        }
        Kind::Engage => {
            drive.engage(config);
            return None;
        }
    })
}

impl<D: Composition + Clone, const K: usize> Composition for Recorded<D, K> {
    type Number = D::Number;
    type Config = D::Config;
    type Observer = D::Observer;
    type Governor = D::Governor;
    type Fluctuation = D::Fluctuation;
    type Balancer = D::Balancer;

    handed_on!();

    fn new(config: &Self::Config, angle: u32) -> Self {
        let drive = D::new(config, angle);
        let block = Block { start: drive.clone(), entries: [Entry::default(); K], length: 0 };
        Recorded { drive, blocks: [block.clone(), block], reason: Faults::NONE }
    }

    #[inline(always)]
    fn tick(&mut self, config: &Self::Config, sample: &Sample<D::Number>) -> Command<D::Number> {
        self.keep(Kind::Tick, sample);
        let command = self.drive.tick(config, sample);
        self.watch(command)
    }

    #[inline(always)]
    fn tick_after(&mut self, config: &Self::Config, sample: &Sample<D::Number>, missed: u32) -> Command<D::Number> {
        self.keep(if missed == 0 { Kind::Tick } else { Kind::After(missed) }, sample);
        let command = self.drive.tick_after(config, sample, missed);
        self.watch(command)
    }

    fn make_up(&mut self, config: &Self::Config, torque: D::Number, missed: u32) -> Faults {
        self.keep(Kind::MadeUp(missed), &Sample { angle: 0, torque, setpoint: D::Number::ZERO });
        self.drive.make_up(config, torque, missed)
    }

    fn coast(&mut self, config: &Self::Config, torque: D::Number, setpoint: D::Number) -> Command<D::Number> {
        self.keep(Kind::Coast, &Sample { angle: 0, torque, setpoint });
        let command = self.drive.coast(config, torque, setpoint);
        self.watch(command)
    }

    fn hold(&mut self, config: &Self::Config, angle: u32, torque: D::Number) -> Command<D::Number> {
        self.keep(Kind::Hold, &Sample { angle, torque, setpoint: D::Number::ZERO });
        let command = self.drive.hold(config, angle, torque);
        self.watch(command)
    }

    fn engage(&mut self, config: &Self::Config) {
        self.keep(Kind::Engage, &Sample { angle: 0, torque: D::Number::ZERO, setpoint: D::Number::ZERO });
        self.drive.engage(config);
    }

    fn switch(&mut self, from: &Self::Config, to: &Self::Config) {
        self.drive_mut().switch(from, to);
    }

    fn parts(config: &mut Self::Config) -> (&mut ObserverConfigOf<Self>, &mut GovernorConfigOf<Self>) {
        D::parts(config)
    }

    fn observer_mut(&mut self) -> &mut Self::Observer {
        self.drive_mut().observer_mut()
    }

    fn governor_mut(&mut self) -> &mut Self::Governor {
        self.drive_mut().governor_mut()
    }

    fn fluctuation_mut(&mut self) -> &mut Self::Fluctuation {
        self.drive_mut().fluctuation_mut()
    }

    #[inline(always)]
    fn vibration(&mut self, config: &Self::Config, vibration: &VibrationOf<Self>) {
        self.drive.vibration(config, vibration);
    }

    #[inline(always)]
    fn estimate(&self, config: &Self::Config) -> Estimate<D::Number> {
        self.drive.estimate(config)
    }
}
