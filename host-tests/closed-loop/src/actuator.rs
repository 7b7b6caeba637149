//! Inverter and motor between the torque that a drive commands and the torque at the shaft.

/// Departures of the torque from the commanded one. The default has none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ActuatorErrors {
    /// Torque constant over the one that the inverter has, less one.
    pub gain: f64,
    /// Torque at the shaft that is not reported (N m).
    pub offset: f64,
    /// From the command to the current's setpoint (ticks), at most [`MAX_DELAY`].
    pub delay: f64,
    /// Time constant of the current loop (s); `1/(2 pi f)` of its bandwidth `f`.
    pub lag: f64,
    /// Amplitude of the cogging torque (N m).
    pub cogging: f64,
    /// Its periods on a turn.
    pub cogging_order: f64,
    /// Its phase (rad).
    pub cogging_phase: f64,
}

/// The longest delay (ticks).
pub const MAX_DELAY: f64 = 3.0;

/// An inverter at work.
#[derive(Clone, Copy, Debug)]
pub struct Actuator {
    errors: ActuatorErrors,
    /// Commands of the last ticks (N m), the latest first.
    commands: [f64; MAX_DELAY as usize + 2],
    /// Torque of the current at the start of the tick (N m).
    now: f64,
    /// Of the lag over a tick: what is left of a step at its end, and on its mean.
    left: (f64, f64),
}

impl Actuator {
    /// An inverter without current, for ticks of `period` (s).
    pub fn new(errors: ActuatorErrors, period: f64) -> Self {
        let ticks = period / errors.lag;
        let left = if errors.lag > 0.0 { ((-ticks).exp(), (1.0 - (-ticks).exp()) / ticks) } else { (0.0, 0.0) };
        Self { errors, commands: [0.0; MAX_DELAY as usize + 2], now: 0.0, left }
    }

    /// Mean torque over the next tick under a new command (N m) with the shaft at `angle` (rad): at the shaft, and as
    /// the inverter reports it from its current.
    pub fn torques(&mut self, command: f64, angle: f64) -> (f64, f64) {
        let ActuatorErrors { gain, offset, delay, cogging, cogging_order, cogging_phase, .. } = self.errors;
        self.commands.rotate_right(1);
        self.commands[0] = command;
        let delay = delay.clamp(0.0, MAX_DELAY);
        let (whole, share) = (delay as usize, delay.fract());
        let delayed = if share > 0.0 {
            share * self.commands[whole + 1] + (1.0 - share) * self.commands[whole]
        } else {
            self.commands[whole]
        };
        let step = self.now - delayed;
        self.now = delayed + step * self.left.0;
        let reported = delayed + step * self.left.1;
        let cogging = cogging * (cogging_order * angle + cogging_phase).sin();
        (reported * (1.0 + gain) + offset + cogging, reported)
    }
}
