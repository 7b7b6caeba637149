//! Dampers and absorbers on a train.

use super::error::positive;
use super::main_mode::MainMode;
use super::{Chain, Damper, Damping, Error, Inertia, Ratio, Stiffness, Train};

/// Passes by which the coupling of a ring and the main mode's frequency agree: each gains a factor of about the ring's
/// share of the inertia.
const PASSES: usize = 4;

impl Train {
    /// A damper on the mass of index `at`, with its ring on a shaft that turns `ratio` times slower than the motor; 1
    /// for one that has been sized from the train's own modes.
    ///
    /// A ring on a spring is a mass of its own, the last so far. A ring without a spring (a viscous damper) takes part
    /// in the main mode with `J d^2/(d^2 + J^2 omega^2)`, and damps it with the rest of `d`; what slips counts in the
    /// total inertia alone. So it comes after all other masses, and a later ring does not renew its share. Losses on
    /// its way are left out. A friction damper's ring sticks to its mass while the vibration is small: a branch of one
    /// inertia.
    ///
    /// Refused: [`Error::DamperRing`], as [`branch`](Self::branch).
    #[must_use]
    pub const fn damper(mut self, at: usize, ratio: Ratio, damper: Damper) -> Self {
        let Damper { inertia, stiffness, damping } = damper;
        if !(positive(inertia) && stiffness >= 0.0 && damping >= 0.0 && positive(stiffness + damping)) {
            return self.refuse(Error::DamperRing);
        }
        let hub = Chain::motor(Inertia(f64::MIN_POSITIVE));
        if stiffness > 0.0 {
            return self.branch(at, ratio, hub.shaft(Stiffness(stiffness), Damping(damping)).rotor(Inertia(inertia)));
        }
        self = self.branch(at, ratio, hub);
        if self.error().is_some() {
            return self;
        }
        let square = ratio.0 * ratio.0;
        let (ring, coupling) = (inertia / square, damping / square);
        if !positive(ring) || !positive(coupling) {
            return self.refuse(Error::DamperRing);
        }
        let bare = self.inertia[at];
        // a rigid train carries the whole ring
        let (mut carried, mut drag) = (ring, 0.0);
        each!(pass, 0.., pass < PASSES && self.masses().len() > 1, {
            self.inertia[at] = bare + carried;
            let modes = self.modes();
            let main = modes.resonances()[MainMode::of(&modes, self.total_inertia()).index];
            let inertial = ring * main.frequency;
            let slip = inertial * inertial / (coupling * coupling + inertial * inertial);
            (carried, drag) = (ring * (1.0 - slip), coupling * slip);
        });
        self.inertia[at] = bare + carried;
        self.slipping += ring - carried;
        self.drag[at] += drag;
        self
    }
}
