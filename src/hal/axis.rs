//! A drive on a board: one call a tick, and the reaction to each fault.

use super::Board;
use crate::balancing::Balancer;
use crate::drive::{ConfigOf, Drive};
use crate::fault::Faults;
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::Number;
use crate::observer::Observer;
use crate::sample::{Command, Sample};

/// The usual tripping faults: a failed torque output or enable line, and a lost angle.
pub const TRIPPING: Faults = Faults::TORQUE_OUTPUT.with(Faults::ENABLE).with(Faults::ANGLE_LOST);

/// A drive on a board. It starts with the power stage off.
#[derive(Debug)]
// Not logged: holds the parts of a board.
pub struct Axis<P, N, O, F = (), G = (), B = ()> {
    board: P,
    drive: Drive<N, O, F, G, B>,
    tripping: Faults,
    /// The last output.
    set: N,
    enabled: bool,
    /// Parts of the board that failed and have not recovered.
    pending: Faults,
}

impl<P, N, O, F, G, B> Axis<P, N, O, F, G, B>
where
    P: Board<N>,
    N: Number,
    O: Observer<N>,
    F: Fluctuation<N>,
    G: Governor<N>,
    B: Balancer<N>,
{
    /// An axis that the faults of `tripping` trip. The power stage is switched off; the first tick reports a failure of
    /// that.
    pub fn new(board: P, config: &ConfigOf<Drive<N, O, F, G, B>>, tripping: Faults) -> Self {
        let mut board = board;
        // where there is none yet, the drive finds it later
        let drive = Drive::new(config, board.angle().unwrap_or(0));
        let mut axis = Axis { board, drive, tripping, set: N::ZERO, enabled: false, pending: Faults::NONE };
        axis.trip();
        axis
    }

    /// Switches the power stage on: first no torque, then the enable chain. The governor starts from the speed that the
    /// drive has estimated, so that a machine may turn meanwhile, as long as [`Axis::tick`] has been called all the
    /// time.
    ///
    /// # Errors
    /// [`Faults::ANGLE_LOST`], which a machine at rest leaves by [`Axis::at_rest`], or the board's fault; the power
    /// stage stays off.
    pub fn start(&mut self, config: &ConfigOf<Drive<N, O, F, G, B>>) -> Result<(), Faults> {
        let lost = if self.drive.is_lost() { Err(Faults::ANGLE_LOST) } else { Ok(()) };
        self.drive.engage(config);
        self.set = N::ZERO;
        let started = lost
            .and_then(|()| self.board.set_torque(N::ZERO, self.drive.angle()))
            .and_then(|()| self.board.set_enabled(true));
        match started {
            Ok(()) => {
                self.pending = Faults::NONE;
                self.enabled = true;
            }
            Err(_) => self.trip(),
        }
        started
    }

    /// Finds a lost angle while the machine stands, its brake closed. The drive alone would wait for two angles in a
    /// row that differ: to it one that does not move may be that of a frozen encoder. The axis is tripped;
    /// [`Axis::start`] comes next.
    ///
    /// # Errors
    /// The board's fault of the angle; the angle stays lost.
    pub fn at_rest(&mut self, config: &ConfigOf<Drive<N, O, F, G, B>>) -> Result<(), Faults> {
        self.trip();
        let angle = self.board.angle()?;
        self.drive.hold(config, angle, N::ZERO);
        Ok(())
    }

    /// Takes the torque away and the enable chain back, in this order, whatever fails of it, until [`Axis::start`].
    pub fn trip(&mut self) {
        self.enabled = false;
        self.set = N::ZERO;
        let torque = self.board.set_torque(N::ZERO, self.drive.angle());
        let enable = self.board.set_enabled(false);
        self.pending = torque.err().unwrap_or_default() | enable.err().unwrap_or_default();
    }

    /// One tick: angle in, drive, torque out. While the axis is tripped it estimates, gives no torque, raises
    /// [`Faults::TRIPPED`], and retries a line that has failed. Ticks that the board reports as missed are made up
    /// first and raise [`Faults::TICK_MISSED`].
    #[inline]
    pub fn tick(&mut self, config: &ConfigOf<Drive<N, O, F, G, B>>, setpoint: N) -> Command<N> {
        let missed = self.board.missed();
        let (torque, mut faults) = match self.board.torque(self.set) {
            Ok(torque) => (torque, Faults::NONE),
            Err(faults) => (self.set, faults),
        };
        let Command { torque, faults: found } = match self.board.angle() {
            Ok(angle) => self.drive.tick_after(config, &Sample { angle, torque, setpoint }, missed),
            Err(missing) => {
                faults |= missing;
                if missed != 0 {
                    faults |= self.drive.make_up(config, torque, missed);
                }
                self.drive.coast(config, torque, setpoint)
            }
        };
        faults |= found;
        if !self.enabled {
            self.drive.engage(config);
            if !self.pending.is_none() {
                self.trip();
            }
        } else if faults.intersects(self.tripping) {
            self.trip();
        } else if let Err(output) = self.board.set_torque(torque, self.drive.angle()) {
            faults |= output;
            self.trip();
        } else {
            self.set = torque;
        }
        faults |= self.pending;
        if !self.enabled {
            faults |= Faults::TRIPPED;
        }
        self.board.alive();
        Command { torque: self.set, faults }
    }

    /// Gives the balancer a sample of the vibration, taken with the last angle; where there is none, nothing. A fault
    /// is given to the balancer too, whose reading is doubted then, and comes back.
    pub fn vibration(
        &mut self,
        config: &ConfigOf<Drive<N, O, F, G, B>>,
        sample: Result<Option<B::Vibration>, Faults>,
    ) -> Faults {
        match sample {
            Ok(Some(vibration)) => self.drive.vibration(config, &vibration),
            Ok(None) => {}
            Err(faults) => {
                self.drive.vibration_missing(faults);
                return faults;
            }
        }
        Faults::NONE
    }

    /// Whether the power stage is on.
    pub fn is_enabled(&self) -> bool {
        self.enabled
    }

    /// The drive.
    pub fn drive(&self) -> &Drive<N, O, F, G, B> {
        &self.drive
    }

    /// The drive, for actions between two ticks: beginning a reading, taking over a state.
    pub fn drive_mut(&mut self) -> &mut Drive<N, O, F, G, B> {
        &mut self.drive
    }

    /// The board.
    pub fn board(&mut self) -> &mut P {
        &mut self.board
    }

    /// The board again, switched off.
    pub fn release(mut self) -> P {
        self.trip();
        self.board
    }
}
