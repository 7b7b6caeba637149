//! Start and stop of a drive by its operator: a button on the board and the requests of a terminal.
//!
//! A start needs both. The terminal permits it for ten seconds, and in that time the button is pressed and let go. So
//! no sequence of bytes starts the drive, and no button that is touched by accident or stuck. Either one stops it.

use crate::scene::panel_keys::is_refusal;

/// Ticks that a permit lasts: ten seconds at 10 kHz, to get from the terminal to the button.
pub const PERMIT: u32 = 100_000;
/// Ticks after which a level of the button stands: 10 ms at 10 kHz. Contacts bounce for a few milliseconds.
pub const STANDS: u32 = 100;
/// Ticks in a millisecond.
const PER_MS: u32 = 10;
/// The longest time-out (ms): a minute.
const LONGEST_MS: u32 = 60_000;

/// The operator's side of a drive, in the tick.
#[derive(Clone, Copy, Debug)]
pub struct Operator {
    running: bool,
    /// Ticks that are left of a permit.
    permit: u32,
    /// Ticks without a request carried out that stop the drive; 0 for none.
    timeout: u32,
    /// Ticks since the last request that was carried out.
    silent: u32,
    /// The button's level at rest.
    resting: bool,
    /// The button away from rest, without the bouncing.
    pressed: bool,
    /// Ticks that it has been otherwise.
    otherwise: u32,
    /// Whether the press under way began while a start was permitted.
    begun: bool,
}

impl Operator {
    /// Stopped. The button's level now counts as released: whatever its wiring, and even if it is pressed at reset.
    pub const fn new(resting: bool) -> Self {
        Operator {
            running: false,
            permit: 0,
            timeout: 0,
            silent: 0,
            resting,
            pressed: false,
            otherwise: 0,
            begun: false,
        }
    }

    /// A tick with the button's level; whether the drive is released.
    #[inline]
    pub fn tick(&mut self, level: bool) -> bool {
        let pressed = level != self.resting;
        self.permit = self.permit.saturating_sub(1);
        self.silent = self.silent.saturating_add(1);
        // it stops when it is touched, without waiting for the bouncing to end, and where the line is dead
        let is_dead = self.timeout != 0 && self.silent > self.timeout;
        if self.running && (pressed || is_dead) {
            self.stop();
        }
        // a press belongs to the permit that it was made under
        self.begun &= self.permit != 0;
        self.otherwise = if pressed == self.pressed { 0 } else { self.otherwise.saturating_add(1) };
        if self.otherwise >= STANDS {
            (self.pressed, self.otherwise) = (pressed, 0);
            if pressed {
                self.begun = self.permit != 0;
            } else if self.begun && !is_dead {
                (self.running, self.permit) = (true, 0);
            }
        }
        self.running
    }

    /// Permits a start.
    pub fn permit(&mut self) {
        self.permit = PERMIT;
    }

    /// Stops, and withdraws a permit.
    #[inline]
    pub fn stop(&mut self) {
        (self.running, self.permit, self.begun) = (false, 0, false);
    }

    /// Sets the time without a request carried out after which a running drive stops (ms); 0 is none. Whether it can be had.
    pub fn set_timeout(&mut self, ms: u32) -> bool {
        if ms > LONGEST_MS {
            return false;
        }
        self.timeout = ms * PER_MS;
        true
    }

    /// A request has this answer. One that is refused does not keep the time-out from running: its terminal may send
    /// anything.
    pub fn answered(&mut self, answer: u32) {
        if !is_refusal(answer) {
            self.silent = 0;
        }
    }
}
