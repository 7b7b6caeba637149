//! Enable lines of the power stage and the trip line of its contactor.
//!
//! A line is *on* at the level that permits torque; choose it such that a wire that breaks is off. Lines go on one
//! after the other, the last one only where all before it did, and off in the reverse order, each one whether or not
//! the others obey.

use driveline::axis::Enabling;
use driveline::fault::Faults;
use embedded_hal::digital::{OutputPin, PinState};

/// A pin and the level at which it permits torque.
#[derive(Clone, Copy, Debug)]
// Not logged: holds the parts of a board.
pub struct EnableLine<P> {
    pin: P,
    on: PinState,
}

impl<P: OutputPin> EnableLine<P> {
    /// Permits torque while high.
    pub const fn high(pin: P) -> Self {
        EnableLine { pin, on: PinState::High }
    }

    /// Permits torque while low.
    pub const fn low(pin: P) -> Self {
        EnableLine { pin, on: PinState::Low }
    }

    /// The pin again.
    pub fn release(self) -> P {
        self.pin
    }

    fn set(&mut self, on: bool) -> Result<(), Faults> {
        let level = if on { self.on } else { !self.on };
        self.pin.set_state(level).map_err(|_| Faults::ENABLE)
    }
}

/// Lines that go on in order and off in the reverse order: contactor, gate driver, brake, say. Pins of different types
/// go in as `&mut dyn OutputPin<Error = _>`.
#[derive(Clone, Copy, Debug)]
// Not logged: holds the parts of a board.
pub struct EnableChain<P, const LINES: usize> {
    lines: [EnableLine<P>; LINES],
}

impl<P: OutputPin, const LINES: usize> EnableChain<P, LINES> {
    /// A chain; it is not switched here.
    pub const fn new(lines: [EnableLine<P>; LINES]) -> Self {
        EnableChain { lines }
    }

    /// The lines again.
    pub fn release(self) -> [EnableLine<P>; LINES] {
        self.lines
    }

    fn off(&mut self) -> Result<(), Faults> {
        let mut all = Ok(());
        for line in self.lines.iter_mut().rev() {
            all = line.set(false).and(all);
        }
        all
    }
}

impl<P: OutputPin, const LINES: usize> Enabling for EnableChain<P, LINES> {
    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
        if !enabled {
            return self.off();
        }
        let on = self.lines.iter_mut().try_for_each(|line| line.set(true));
        if on.is_err() {
            // lines already on go off again, and so does the one that failed
            let _ = self.off();
        }
        on
    }
}

/// A trip output: a pin that is on while the axis is healthy, and off to trip a contactor or a superior control.
#[derive(Clone, Copy, Debug)]
// Not logged: holds the parts of a board.
pub struct TripLine<P>(EnableLine<P>);

impl<P: OutputPin> TripLine<P> {
    /// A trip output, tripped at once.
    ///
    /// # Errors
    /// [`Faults::ENABLE`] and the line where it did not obey.
    pub fn new(line: EnableLine<P>) -> Result<Self, (Faults, EnableLine<P>)> {
        let mut line = line;
        match line.set(false) {
            Ok(()) => Ok(TripLine(line)),
            Err(faults) => Err((faults, line)),
        }
    }

    /// The line again.
    pub fn release(self) -> EnableLine<P> {
        self.0
    }
}

impl<P: OutputPin> Enabling for TripLine<P> {
    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
        let set = self.0.set(enabled);
        if set.is_err() && enabled {
            let _ = self.0.set(false);
        }
        set
    }
}
