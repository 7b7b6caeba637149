//! Pseudo-random noise of sensors.

/// Normal noise, the same on every machine: xorshift64* [Vigna 2016, ACM TOMS 42(4)] and the polar method
/// [Marsaglia 1964].
#[derive(Clone, Debug)]
pub struct Noise {
    state: u64,
    spare: Option<f64>,
}

impl Noise {
    /// Noise from an odd seed. An even one gives the noise of the odd one after it: the state must not be zero.
    pub fn new(seed: u64) -> Self {
        Noise { state: seed | 1, spare: None }
    }

    /// From -1 to 1.
    pub fn uniform(&mut self) -> f64 {
        self.state ^= self.state >> 12;
        self.state ^= self.state << 25;
        self.state ^= self.state >> 27;
        let bits = self.state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11;
        bits as f64 / 4_503_599_627_370_496.0 - 1.0
    }

    /// Of mean zero and standard deviation one.
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let (x, y) = (self.uniform(), self.uniform());
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                let scale = (-2.0 * square.ln() / square).sqrt();
                self.spare = Some(y * scale);
                return x * scale;
            }
        }
    }
}
