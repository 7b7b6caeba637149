//! Dampers and absorbers of torsional vibration, with their best sizes [derived; heading: Pfützner 1980 §1.5].

mod friction;
mod pendulum;

pub use friction::FrictionDamper;
pub use pendulum::CentrifugalPendulum;

use super::{Inertia, Mode};
use crate::math::{hypot, sqrt};

/// A natural vibration as the mass and spring that stand for it at one of the machine's masses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Resonance {
    /// Inertia (kg m2).
    pub inertia: f64,
    /// Natural frequency (rad/s).
    pub frequency: f64,
}

/// A ring on a spring and a viscous damper beside one of the machine's masses.
///
/// A damper is a ring beside one of the machine's masses. Near a natural frequency the machine is one mass on one
/// spring there, a [`Resonance`], and the ring's inertia over that of the resonance is the mass ratio mu. Amplitudes
/// are over the static angle, torque over stiffness.
///
/// - **[`tuned`](Resonance::tuned_damper)** (Den Hartog): frequency `omega/(1 + mu)`, damping ratio `sqrt(3 mu/(8 (1 +
///   mu)))`; largest amplitude `sqrt(1 + 2/mu)`
/// - **[`viscous`](Resonance::viscous_damper)** (Lanchester): `d = 2 J_d omega/sqrt(2 (1 + mu) (2 + mu))`; largest
///   amplitude `(2 + mu)/mu`
/// - **[`friction`](FrictionDamper)**: torque `sqrt(2)/pi J_d omega^2 phi`; largest amplitude `pi^2/(4 mu)`
/// - **[`absorber`](Damper::absorber)**: frequency that of the excitation; no amplitude there
/// - **[`pendulum`](CentrifugalPendulum)**: order `sqrt(R/L)`; no amplitude at that order, at every speed
///
/// The first two hold for a machine without damping of its own.
///
/// ```
/// use driveline::machine::{Chain, Damping, Inertia, Resonance, Stiffness};
///
/// const CHAIN: Chain =
///     Chain::motor(Inertia(2.0)).shaft(Stiffness(4.0e5), Damping(0.0)).rotor(Inertia(1.0));
/// // the first mode at the second mass, with a ring of a tenth of its inertia
/// const MAIN: Resonance = Resonance::of(&CHAIN.modes().resonances()[0], 1);
/// let damper = MAIN.tuned_damper(Inertia(0.1 * MAIN.inertia));
/// let worst = (500..1500).map(|k| MAIN.amplitude(&damper, k as f64 * 1e-3 * MAIN.frequency)).fold(0.0, f64::max);
/// // the best damping leaves the fixed points as the highest, to a few parts in a thousand
/// assert!((worst / Resonance::tuned_amplitude(0.1) - 1.0).abs() < 5e-3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("torsional vibration damper", "tuned mass damper"))]
pub struct Damper {
    /// Inertia of the ring (kg m2).
    pub inertia: f64,
    /// Stiffness of its spring (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
}

impl Damper {
    /// An undamped absorber: a mass that vibrates at `frequency` (rad/s) stands still where it is attached, and the
    /// ring swings by torque over stiffness.
    #[must_use]
    pub const fn absorber(inertia: Inertia, frequency: f64) -> Self {
        Self { inertia: inertia.0, stiffness: inertia.0 * frequency * frequency, damping: 0.0 }
    }

    /// Torque that it takes per angle of the mass it is attached to, as real and imaginary part (N m/rad), at a
    /// frequency (rad/s): `-J_d omega^2 (k + i d omega)/(k - J_d omega^2 + i d omega)`; infinite at the frequency of
    /// an absorber.
    #[must_use]
    pub const fn dynamic_stiffness(&self, frequency: f64) -> [f64; 2] {
        let inertial = self.inertia * frequency * frequency;
        let (k, d) = (self.stiffness, self.damping * frequency);
        let left = k - inertial;
        let square = left * left + d * d;
        if square == 0.0 {
            return [if inertial > 0.0 { f64::NEG_INFINITY } else { 0.0 }, 0.0];
        }
        [-inertial * (k * left + d * d) / square, inertial * inertial * d / square]
    }
}

impl Resonance {
    /// A mode at one of the masses, counted from 0 at the motor: inertia `1/psi^2` of the mass-normalised shape;
    /// infinite in a node and beyond the masses.
    #[must_use]
    pub const fn of(mode: &Mode, mass: usize) -> Self {
        let psi = if mass < mode.shape.len() { mode.shape[mass] } else { 0.0 };
        Self { inertia: 1.0 / (psi * psi), frequency: mode.frequency }
    }

    /// Stiffness (N m/rad).
    #[must_use]
    pub const fn stiffness(&self) -> f64 {
        self.inertia * self.frequency * self.frequency
    }

    /// The tuned damper of a ring: both fixed points equally high, and the mean square of the two damping ratios with
    /// which the response is level in one of them.
    #[must_use]
    pub const fn tuned_damper(&self, ring: Inertia) -> Damper {
        let mu = ring.0 / self.inertia;
        let tuned = self.frequency / (1.0 + mu);
        let ratio = sqrt(3.0 * mu / (8.0 * (1.0 + mu)));
        Damper { inertia: ring.0, stiffness: ring.0 * tuned * tuned, damping: 2.0 * ratio * ring.0 * tuned }
    }

    /// The viscous damper of a ring without a spring (Lanchester damper): the response is level in its fixed point.
    #[must_use]
    pub const fn viscous_damper(&self, ring: Inertia) -> Damper {
        let mu = ring.0 / self.inertia;
        let damping = 2.0 * ring.0 * self.frequency / sqrt(2.0 * (1.0 + mu) * (2.0 + mu));
        Damper { inertia: ring.0, stiffness: 0.0, damping }
    }

    /// Amplitude over the static angle in the fixed points of the best tuned damper.
    #[must_use]
    pub const fn tuned_amplitude(mass_ratio: f64) -> f64 {
        sqrt(1.0 + 2.0 / mass_ratio)
    }

    /// Amplitude over the static angle in the fixed point of a viscous damper, with the best damping the largest.
    #[must_use]
    pub const fn viscous_amplitude(mass_ratio: f64) -> f64 {
        (2.0 + mass_ratio) / mass_ratio
    }

    /// Amplitude over the static angle at a frequency (rad/s) of the torque, with a damper.
    #[must_use]
    pub const fn amplitude(&self, damper: &Damper, frequency: f64) -> f64 {
        let k = self.stiffness();
        let [real, imaginary] = damper.dynamic_stiffness(frequency);
        k / hypot(k - self.inertia * frequency * frequency + real, imaginary)
    }
}
