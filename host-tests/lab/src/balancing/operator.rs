//! Who operates the machine: starts it, waits, presses keys on its panel, stops it; and the hand that sets a weight,
//! never quite as much and never quite there.

use driveline_firmware::scene::balanced::DOUBTS;
use driveline_firmware::scene::panel_keys::{DONE, Key, MEASURING, REFUSED};
use driveline_solver::noise::Noise;
use nalgebra::Complex;

use super::error::BalancingError;
use super::machine::Machine;
use driveline_closed_loop::ticks::Ticks;

/// Share of the setpoint within which the speed counts as reached.
const REACHED: f64 = 2e-3;
/// Longest wait for a speed (s).
const PATIENCE: f64 = 60.0;
/// Readings that are tried at a speed.
const READINGS: usize = 12;

/// The wires of a balancing head, as a watcher reads them: the weights beside the unbalance that was found.
struct Wires {
    found: Complex<f64>,
    at: Complex<f64>,
    /// Read last, while the other part is still to come.
    real: Option<f64>,
    /// Where it has stopped, and when (s), the start first.
    stops: Vec<(f64, Complex<f64>)>,
}

/// A machine, its drive, and what the panel refused on the way.
pub struct Operator<'a> {
    /// The machine.
    pub machine: Machine,
    drive: &'a mut dyn Ticks,
    /// Readings rejected by the panel, by reason.
    pub doubts: Vec<&'static str>,
    head: Option<Wires>,
}

impl<'a> Operator<'a> {
    /// At a machine with a drive.
    pub fn new(machine: Machine, drive: &'a mut dyn Ticks) -> Self {
        Operator { machine, drive, doubts: Vec::new(), head: None }
    }

    /// The same with a balancing head on a rotor with the unbalance `found` (kg m): its weights follow the drive's.
    #[must_use]
    pub fn with_head(mut self, found: Complex<f64>) -> Self {
        let at = Complex::new(0.0, 0.0);
        self.head = Some(Wires { found, at, real: None, stops: vec![(0.0, at)] });
        self
    }

    /// Where the head has stopped (kg m), and when (s), the start first.
    #[must_use]
    pub fn stops(&self) -> &[(f64, Complex<f64>)] {
        self.head.as_ref().map_or(&[], |head| &head.stops)
    }

    /// A tick; the wires of the head carry its weights, the real part and the imaginary part in turn.
    fn pass(&mut self) -> Result<(), BalancingError> {
        let Some(head) = &mut self.head else {
            self.machine.tick(self.drive, [0, 0])?;
            return Ok(());
        };
        let key = if head.real.is_none() { Key::HeadRe } else { Key::HeadIm };
        let part = f64::from(f32::from_bits(self.machine.tick(self.drive, [key as u32, 0])?.answer));
        let Some(real) = head.real.take() else {
            head.real = Some(part);
            return Ok(());
        };
        let at = Complex::new(real, part);
        if at != head.at {
            head.at = at;
            self.machine.whirl().set_unbalance(&[head.found + at])?;
        } else if head.stops.last().is_none_or(|(_, stop)| *stop != at) {
            head.stops.push((self.machine.time(), at));
        }
        Ok(())
    }

    /// Sends a request to the panel.
    ///
    /// # Errors
    /// What the link says.
    pub fn ask(&mut self, key: Key, value: u32) -> Result<u32, BalancingError> {
        self.ask_word(key as u32, value)
    }

    /// Sends a request to the panel by the number of its key.
    ///
    /// # Errors
    /// What the link says.
    pub fn ask_word(&mut self, key: u32, value: u32) -> Result<u32, BalancingError> {
        Ok(self.machine.tick(self.drive, [key, value])?.answer)
    }

    /// Requests an action of the panel.
    ///
    /// # Errors
    /// What the link says; what the panel refuses.
    pub fn press(&mut self, key: Key, value: u32) -> Result<(), BalancingError> {
        match self.ask(key, value)? {
            DONE => Ok(()),
            answer => Err(BalancingError::Refused { key, answer }),
        }
    }

    /// A complex number of the panel: real part by one key, imaginary part by the other.
    ///
    /// # Errors
    /// What the link says.
    pub fn complex(&mut self, keys: [Key; 2], value: u32) -> Result<Complex<f64>, BalancingError> {
        let part = |bits: u32| f64::from(f32::from_bits(bits));
        Ok(Complex::new(part(self.ask(keys[0], value)?), part(self.ask(keys[1], value)?)))
    }

    /// Sends a weight to the panel (kg m).
    ///
    /// # Errors
    /// What the link says; what the panel refuses.
    pub fn tell_weight(&mut self, weight: Complex<f64>) -> Result<(), BalancingError> {
        self.press(Key::WeightRe, (weight.re as f32).to_bits())?;
        self.press(Key::WeightIm, (weight.im as f32).to_bits())
    }

    /// Lets time pass (s).
    ///
    /// # Errors
    /// What the link says.
    pub fn wait(&mut self, time: f64) -> Result<(), BalancingError> {
        let ticks = (time / self.machine.period()).round() as u64;
        for _ in 0..ticks {
            self.pass()?;
        }
        Ok(())
    }

    /// Brings the machine to a speed (rad/s) and lets it settle for a time (s).
    ///
    /// # Errors
    /// What the link says; a speed that is not reached.
    pub fn bring_to(&mut self, speed: f64, settle: f64) -> Result<(), BalancingError> {
        self.machine.set_setpoint(speed);
        let near = REACHED * speed.abs().max(10.0);
        let end = self.machine.time() + PATIENCE;
        while (self.machine.speed() - speed).abs() > near {
            if self.machine.time() > end {
                let reached = self.machine.speed();
                return Err(BalancingError::NotReached { speed, time: PATIENCE, reached });
            }
            self.pass()?;
        }
        self.wait(settle)
    }

    /// Takes readings until the panel accepts one.
    ///
    /// # Errors
    /// What the link says; no good reading.
    pub fn read(&mut self) -> Result<(), BalancingError> {
        let mut doubts = Vec::new();
        for _ in 0..READINGS {
            self.press(Key::Begin, 0)?;
            let answer = loop {
                match self.ask(Key::State, 0)? {
                    MEASURING => {}
                    answer => break answer,
                }
            };
            if answer == DONE {
                return Ok(());
            }
            doubts.push(DOUBTS.get((answer - REFUSED) as usize).copied().unwrap_or("unknown"));
            self.doubts.extend(doubts.last());
        }
        Err(BalancingError::NoReading { speed: self.machine.setpoint(), doubts: doubts.join(", ") })
    }
}

/// Sets weights with errors of this standard deviation.
pub struct Hand {
    /// Of the amount, as a share.
    amount: f64,
    /// Of the angle (rad).
    angle: f64,
    source: Noise,
}

impl Hand {
    /// A hand with errors of the amount, as a share, and of the angle (degrees); `seed` is that of its errors.
    #[must_use]
    pub fn new(amount: f64, degrees: f64, seed: u64) -> Self {
        Hand { amount, angle: degrees.to_radians(), source: Noise::new(seed) }
    }

    /// A weight as it is set.
    pub fn set(&mut self, wanted: Complex<f64>) -> Complex<f64> {
        let (amount, angle) = (1.0 + self.amount * self.source.normal(), self.angle * self.source.normal());
        wanted * Complex::from_polar(amount, angle)
    }
}
