//! One turn of the control loop on a board with a motor: read, tick, do. It is the body of the timer's interrupt.
//!
//! Between reading and doing stands a tick over words ([`OnAxis`](crate::scene::on_axis::OnAxis)). Torque goes on after
//! the enable chain and off before it. An output that the board rejects is withdrawn in the same turn and reported to
//! the next tick, which trips.

use driveline::axis::Board;
use driveline::fault::Faults;
use driveline::number::Number;

use crate::scene::{Input, Output};

/// Requests to the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asked<N> {
    /// Whether the power stage may be on.
    pub released: bool,
    /// The speed (rad/s).
    pub speed: N,
}

/// A board in the loop, and its last outputs.
#[derive(Debug)]
pub struct Turn<B, N> {
    board: B,
    angle: u32,
    set: N,
    enabled: bool,
    refused: Faults,
}

impl<B: Board<N>, N: Number> Turn<B, N> {
    /// A board, switched off.
    pub fn new(board: B) -> Self {
        let mut turn = Turn { board, angle: 0, set: N::ZERO, enabled: false, refused: Faults::NONE };
        turn.off();
        turn
    }

    /// The board.
    pub fn board(&mut self) -> &mut B {
        &mut self.board
    }

    /// Reads the inputs, calls `tick`, writes its outputs. The watchdog is fed at the end ([`Board::alive`]), hence
    /// only where the tick has run.
    #[inline(always)]
    pub fn run(
        &mut self,
        asked: Asked<N>,
        vibration: Result<[N; 2], Faults>,
        tick: impl FnOnce(&Input, &mut Output),
    ) -> (Input, Output) {
        let mut faults = self.refused;
        let mut torque = self.set;
        match self.board.torque(self.set) {
            Ok(measured) => torque = measured,
            Err(fault) => faults |= fault,
        }
        match self.board.angle() {
            Ok(angle) => self.angle = angle,
            Err(fault) => faults |= fault,
        }
        let vibration = vibration.unwrap_or_else(|fault| {
            faults |= fault;
            [N::ZERO; 2]
        });
        let input = Input {
            angle: self.angle,
            torque: torque.to_word(),
            setpoint: asked.speed.to_word(),
            flags: faults.bits() & !Input::RELEASED | if asked.released { Input::RELEASED } else { 0 },
            vibration: vibration.map(Number::to_word),
            asked: [0; 2],
        };
        let mut output = Output::default();
        tick(&input, &mut output);
        self.act(&output);
        self.board.alive();
        (input, output)
    }

    /// Writes an output.
    #[inline(always)]
    fn act(&mut self, output: &Output) {
        if Faults::from_bits(output.faults).intersects(Faults::TRIPPED) {
            // off already, and everything has obeyed
            if self.enabled || !self.refused.is_none() {
                self.off();
            }
            return;
        }
        let torque = N::from_word(output.torque);
        let done = if self.enabled { Ok(()) } else { self.on() };
        match done.and_then(|()| self.board.set_torque(torque, self.angle)) {
            Ok(()) => {
                self.set = torque;
                self.refused = Faults::NONE;
            }
            Err(refused) => {
                self.off();
                self.refused |= refused;
            }
        }
    }

    /// No torque, then the chain.
    fn on(&mut self) -> Result<(), Faults> {
        self.board.set_torque(N::ZERO, self.angle)?;
        self.board.set_enabled(true)?;
        self.enabled = true;
        Ok(())
    }

    /// The torque away, then the chain, whatever fails of it.
    fn off(&mut self) {
        (self.set, self.enabled) = (N::ZERO, false);
        let torque = self.board.set_torque(N::ZERO, self.angle).err().unwrap_or_default();
        let enable = self.board.set_enabled(false).err().unwrap_or_default();
        self.refused = torque | enable;
    }
}
