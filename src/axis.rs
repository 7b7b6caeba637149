//! A drive on a board: one call a tick, and the reaction to each fault.
//!
//! [`Axis`] ties a [`Drive`](crate::drive::Drive) to a [`Board`]. A reading is a value that is new and sound, or
//! [`Faults`]; there is no third answer, so that a failed bus never repeats the last value.
//!
//! # A board
//! A new board is one file with one type that implements [`Board`]: an angle in, a torque out, the power stage on and
//! off. [`Parts`] is that type made of parts; the crate `driveline-hal` has drivers for them.
//!
//! The timer's interrupt calls [`Axis::tick`]. A board whose interrupt may be held up for longer than a tick
//! counts the ticks that did not run, with [`MissedTicks`] behind [`Board::missed`]; the axis makes them up by
//! prediction.

mod board;
mod missed_ticks;
mod toothed_wheel;

use crate::drive::{Composition, ConfigOf, VibrationOf};
use crate::fault::Faults;
use crate::number::Number;
use crate::sample::{Command, Sample};

pub use board::{AngleSensor, Board, Enabling, Parts, TorqueOutput, VibrationSensor};
pub use missed_ticks::MissedTicks;

/// The usual tripping faults: a failed torque output or enable line, a lost angle, and the end of a stop of the
/// supervision.
pub const TRIPPING: Faults = Faults::TORQUE_OUTPUT.with(Faults::ENABLE).with(Faults::ANGLE_LOST).with(Faults::STOPPED);

/// A drive on a board. It starts with the power stage off.
///
/// # From a board to a governed motor
/// Two dozen lines, on any board; the timer's wait here stands for its interrupt. A new drive
/// takes its constants from a [`Machine`](crate::configure::Machine). A [`Config`](crate::drive::Config) by hand, as
/// here, is for values that come at run time; the functions that begin with `try_` then return an error:
///
/// ```
/// # struct MyBoard(u32);
/// # impl driveline::axis::Board<f32> for MyBoard {
/// #     fn angle(&mut self) -> Result<u32, Faults> { Ok(0) }
/// #     fn set_torque(&mut self, torque: f32, _: u32) -> Result<(), Faults> {
/// #         self.0 += (torque > 0.0) as u32;
/// #         Ok(())
/// #     }
/// #     fn set_enabled(&mut self, _: bool) -> Result<(), Faults> { Ok(()) }
/// # }
/// # impl MyBoard { fn wait_for_timer(&mut self) -> bool { self.0 < 3 } }
/// use driveline::{axis::*, settings::*, design::*, drive::*, fault::Faults, governor::*, machine::*, observer};
///
/// const TWO: TwoMass = Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.35))
///     .reduce(Match::ResonanceAntiresonance);
/// const RATE: Rate = Rate::hz(10_000);
/// const LOAD: Disturbance = Disturbance { torque_accuracy: 2.0, load_torque_step: 100.0, within: 1.0 };
/// const CONFIG: ConfigOf<Drive<f32, observer::TwoMassObserver, SpeedLoop>> = Config {
///     limits: Limits::<f32>::new(&Screening {
///         torque: 500.0, setpoint: 180.0, innovation: 0.05, frozen_turn: 0.0015, max_coast: 150,
///     }, Bases::SI),
///     observer: observer::TwoMassConfig::<f32>::new(&TWO.observer(RATE, Encoder::lines(2048), LOAD), Bases::SI),
///     fluctuation: (),
///     governor: SpeedLoopConfig::<f32>::new(
///         &TWO.speed_loop(RATE, SpeedLoopTuning::USUAL),
///         SpeedLoopSettings { torque_limit: 300.0, ramp: 75.0 },
///         Bases::SI,
///     ),
///     balancer: (),
/// };
///
/// fn run(board: MyBoard) -> Result<(), Faults> {
///     type Mill<P> = Axis<P, Drive<f32, observer::TwoMassObserver, SpeedLoop>>;
///     let mut mill = Mill::new(board, &CONFIG, TRIPPING);
///     mill.start(&CONFIG)?;
///     while mill.board().wait_for_timer() {
///         mill.tick(&CONFIG, 150.0);
///     }
///     Ok(())
/// }
/// # assert_eq!(run(MyBoard(0)), Ok(()));
/// ```
#[derive(Debug)]
// Not logged: holds the parts of a board.
pub struct Axis<P, D: Composition> {
    board: P,
    drive: D,
    tripping: Faults,
    set: D::Number,
    enabled: bool,
    /// Parts of the board that failed and have not recovered.
    pending: Faults,
}

impl<P, D> Axis<P, D>
where
    D: Composition,
    P: Board<D::Number>,
{
    /// An axis that the faults of `tripping` trip. The power stage is switched off; the first tick reports a failure of
    /// that.
    pub fn new(board: P, config: &ConfigOf<D>, tripping: Faults) -> Self {
        let mut board = board;
        // where there is none yet, the drive finds it later
        let drive = D::new(config, board.angle().unwrap_or(0));
        let mut axis = Axis { board, drive, tripping, set: D::Number::ZERO, enabled: false, pending: Faults::NONE };
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
    pub fn start(&mut self, config: &ConfigOf<D>) -> Result<(), Faults> {
        let lost = if self.drive.is_lost() { Err(Faults::ANGLE_LOST) } else { Ok(()) };
        self.drive.engage(config);
        self.set = D::Number::ZERO;
        let started = lost
            .and_then(|()| self.board.set_torque(D::Number::ZERO, self.drive.angle()))
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
    pub fn at_rest(&mut self, config: &ConfigOf<D>) -> Result<(), Faults> {
        self.trip();
        let angle = self.board.angle()?;
        self.drive.hold(config, angle, D::Number::ZERO);
        Ok(())
    }

    /// Takes the torque away and the enable chain back, in this order, whatever fails of it, until [`Axis::start`].
    pub fn trip(&mut self) {
        self.enabled = false;
        self.set = D::Number::ZERO;
        let torque = self.board.set_torque(D::Number::ZERO, self.drive.angle());
        let enable = self.board.set_enabled(false);
        self.pending = torque.err().unwrap_or_default() | enable.err().unwrap_or_default();
    }

    /// One tick: angle in, drive, torque out. While the axis is tripped it estimates, gives no torque, raises
    /// [`Faults::TRIPPED`], and retries a line that has failed. Ticks that the board reports as missed are made up
    /// first and raise [`Faults::TICK_MISSED`].
    #[inline]
    pub fn tick(&mut self, config: &ConfigOf<D>, setpoint: D::Number) -> Command<D::Number> {
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
    pub fn vibration(&mut self, config: &ConfigOf<D>, sample: Result<Option<VibrationOf<D>>, Faults>) -> Faults {
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

    /// The drive.
    pub fn drive(&self) -> &D {
        &self.drive
    }

    /// The drive, for actions between two ticks: beginning a reading, taking over a state.
    pub fn drive_mut(&mut self) -> &mut D {
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
