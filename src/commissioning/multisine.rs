//! A sum of sines as excitation, and the correlation of angle and torque with each of them.
//!
//! Every line is a phasor that turns by the same angle each block, a whole number of turns over the record; a rotation
//! by a rounded angle is off by 1e-7 of itself, which moves the line's frequency by as little and both correlations
//! alike.

/// One line: its phasor, its amplitude, its sums.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Line {
    /// Frequency (rad/s).
    pub frequency: f64,
    /// Cosine and sine of its rotation in a block.
    pub turn: [f32; 2],
    /// Where it is.
    pub phasor: [f32; 2],
    /// Amplitude and start (N m): the torque is the real part of this times the phasor.
    pub amplitude: [f32; 2],
    /// Sums of the angle's increase over a block, and of the torque, with the phasor turned back.
    pub angle: [f32; 2],
    /// See `angle`.
    pub torque: [f32; 2],
}

impl Line {
    pub(crate) const NONE: Self = Self {
        frequency: 0.0,
        turn: [1.0, 0.0],
        phasor: [1.0, 0.0],
        amplitude: [0.0; 2],
        angle: [0.0; 2],
        torque: [0.0; 2],
    };

    /// Takes in a block (weighed by `window`), turns on, and gives the torque of the next block.
    #[inline(always)]
    pub(crate) fn step(&mut self, window: f32, angle: f32, torque: f32) -> f32 {
        let [re, im] = self.phasor;
        let (cosine, sine) = (window * re, -window * im);
        self.angle = [self.angle[0] + angle * cosine, self.angle[1] + angle * sine];
        self.torque = [self.torque[0] + torque * cosine, self.torque[1] + torque * sine];
        let [c, s] = self.turn;
        let (re, im) = (re * c - im * s, re * s + im * c);
        self.phasor = [re, im];
        self.amplitude[0] * re - self.amplitude[1] * im
    }
}

/// A Hann window over a record, one value a block: 1 - cos.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Window {
    turn: [f32; 2],
    phasor: [f32; 2],
}

impl Window {
    pub(crate) const NONE: Self = Self { turn: [1.0, 0.0], phasor: [1.0, 0.0] };

    /// A window over so many blocks.
    pub(crate) fn over(blocks: u32) -> Self {
        let (sine, cosine) = crate::math::sin_cos(core::f64::consts::TAU / f64::from(blocks.max(1)));
        Self { turn: [cosine as f32, sine as f32], phasor: [1.0, 0.0] }
    }

    /// The value for this block; moves on.
    #[inline(always)]
    pub(crate) fn step(&mut self) -> f32 {
        let ([re, im], [c, s]) = (self.phasor, self.turn);
        self.phasor = [re * c - im * s, re * s + im * c];
        1.0 - re
    }
}
