//! Between SI units and the words of a scene's number.

use driveline::number::Fixed;
use driveline::settings::Bases;
use driveline_firmware::Words;

/// The units of a scene's words.
#[derive(Clone, Copy, Debug)]
pub struct Units {
    words: Words,
    bases: Bases,
}

impl Units {
    /// The units of words of this kind with these bases; floats are in SI units whatever the bases.
    pub fn new(words: Words, bases: Bases) -> Self {
        Units { words, bases }
    }

    /// A torque (N m) as a word.
    pub fn torque_word(&self, torque: f64) -> u32 {
        self.word(torque, self.bases.torque)
    }

    /// A speed (rad/s) as a word.
    pub fn speed_word(&self, speed: f64) -> u32 {
        self.word(speed, self.bases.speed)
    }

    /// A word as a torque (N m).
    pub fn torque(&self, word: u32) -> f64 {
        self.value(word, self.bases.torque)
    }

    /// A word as a speed (rad/s).
    pub fn speed(&self, word: u32) -> f64 {
        self.value(word, self.bases.speed)
    }

    /// A quantity with a base of its own as a word; floats leave the base alone.
    pub fn word(&self, value: f64, base: f64) -> u32 {
        match self.words {
            Words::Single => (value as f32).to_bits(),
            Words::Fixed => Fixed::from_f64(value / base).to_bits() as u32,
        }
    }

    /// A word as a quantity with a base of its own.
    pub fn value(&self, word: u32, base: f64) -> f64 {
        match self.words {
            Words::Single => f64::from(f32::from_bits(word)),
            Words::Fixed => Fixed::from_bits(word as i32).to_f64() * base,
        }
    }
}
