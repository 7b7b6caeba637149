//! Errors of an encoder, and of the instant at which it is sampled.

/// Departures of the angle that is read from the true one. The default has none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EncoderErrors {
    /// Amplitude of the error once a turn, from the eccentricity of the disc (rad).
    pub eccentricity: f64,
    /// Its phase (rad).
    pub eccentricity_phase: f64,
    /// Amplitude of the error once a line, from the interpolation (rad).
    pub interpolation: f64,
    /// Its phase (rad).
    pub interpolation_phase: f64,
    /// Lines of a turn.
    pub lines: f64,
    /// Standard deviation of the instant of sampling (s).
    pub jitter: f64,
}

impl EncoderErrors {
    /// The angle that is seen of a shaft at `angle` (rad) that turns at `speed` (rad/s), sampled `late` standard
    /// deviations of the instant after the tick.
    pub fn seen(&self, angle: f64, speed: f64, late: f64) -> f64 {
        // a microsecond is short: the speed does not change in it
        let angle = angle + speed * self.jitter * late;
        angle
            + self.eccentricity * (angle + self.eccentricity_phase).sin()
            + self.interpolation * (self.lines * angle + self.interpolation_phase).sin()
    }
}
