//! Readings as people write them: amplitude and phase in degrees.

use super::error::Error;
use super::scalar::{Complex, Scalar, real};

/// Turns amplitudes and phases into complex numbers, and watches whether the phases are in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Entry {
    phases: u32,
    beyond: bool,
    fractions: u32,
}

impl Entry {
    /// Fewest phases that can be judged.
    const ENOUGH: u32 = 3;

    /// Nothing entered yet.
    pub const fn new() -> Self {
        Entry { phases: 0, beyond: false, fractions: 0 }
    }

    /// An amplitude at a phase in degrees.
    pub fn polar<T: Scalar>(&mut self, amplitude: T, degrees: T) -> Complex<T> {
        self.phases = self.phases.saturating_add(1);
        self.beyond |= degrees.abs() > T::two_pi();
        if degrees != degrees.round() {
            self.fractions = self.fractions.saturating_add(1);
        }
        let (sine, cosine) = (degrees * (T::pi() / real(180.0))).sin_cos();
        Complex { re: amplitude * cosine, im: amplitude * sine }
    }

    /// Whether the phases can be in degrees.
    ///
    /// # Errors
    /// [`Error::PhasesInRadians`] where there are three or more, none is beyond 2 pi, and most have fractions.
    pub const fn check(&self) -> Result<(), Error> {
        if self.phases >= Entry::ENOUGH && !self.beyond && 2 * self.fractions > self.phases {
            return Err(Error::PhasesInRadians);
        }
        Ok(())
    }
}

/// Amplitude and phase in degrees, 0 to 360.
pub fn degrees<T: Scalar>(z: Complex<T>) -> (T, T) {
    let phase = z.im.atan2(z.re) * (real::<T>(180.0) / T::pi());
    (super::scalar::size(z), if phase < T::zero() { phase + real(360.0) } else { phase })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entered(phases: &[f64]) -> Result<(), Error> {
        let mut entry = Entry::new();
        for phase in phases {
            entry.polar(1.0, *phase);
        }
        entry.check()
    }

    /// Two at 30 degrees is (root of 3, 1), and back; a phase of zero is zero, not a turn.
    #[test]
    fn amplitude_and_phase_are_a_complex_number() {
        let z = Entry::new().polar(2.0, 30.0_f64);
        // some units in the last place, of degrees some hundred
        assert!((z.re - 3.0_f64.sqrt()).abs() < 1e-15 && (z.im - 1.0).abs() < 1e-15, "{z}");
        let (amplitude, phase) = degrees(z);
        assert!((amplitude - 2.0).abs() < 1e-15 && (phase - 30.0).abs() < 1e-13);
        assert_eq!(degrees(Complex { re: 1.0, im: 0.0 }), (1.0, 0.0));
        assert_eq!(degrees(Complex { re: 0.0, im: -1.0 }), (1.0, 270.0));
    }

    /// Most of them have fractions, from three phases on, and none is beyond a turn in radians.
    #[test]
    fn phases_in_radians() {
        assert_eq!(entered(&[0.5, 1.5]), Ok(()));
        assert_eq!(entered(&[0.5, 1.5, 3.0]), Err(Error::PhasesInRadians));
        assert_eq!(entered(&[0.5, 1.5, 3.0, 4.0]), Ok(()));
        assert_eq!(entered(&[0.5, 1.5, 2.5, 3.5, 4.0, 5.0]), Err(Error::PhasesInRadians));
        assert_eq!(entered(&[0.5, 1.5, core::f64::consts::TAU]), Err(Error::PhasesInRadians));
        assert_eq!(entered(&[0.5, 1.5, 6.5]), Ok(()));
    }
}
