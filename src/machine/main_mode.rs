//! The vibration that two masses stand for.

use super::Modes;

/// Modal share at the motor (residue times total inertia) below which a mode is unobservable at the motor, such as two
/// equal branches in opposition.
pub(super) const UNSEEN: f64 = 1e-6;

/// The mode that two masses keep: of a chain its first, of a train the one with the largest share of the static
/// compliance at the motor, `r/omega^2`.
///
/// A lower mode of a train, such as nearly equal branches in opposition, lies between two antiresonances that nearly
/// cancel it. It is left out with one of them: the product of the antiresonances up to the main mode, over the modes
/// below it, takes their place. So the total inertia and the inertia above the main mode are kept.
pub(super) struct MainMode {
    /// Its index.
    pub index: usize,
    /// Index of the lowest other mode, of a train one that is observable; the number of modes where there is none.
    pub next: usize,
    /// Antiresonance that belongs to it (rad/s).
    pub antiresonance: f64,
    /// The machine's own antiresonance that lies nearest (rad/s).
    pub nearest: f64,
}

impl MainMode {
    /// That of a chain, which has one mode at least.
    pub(super) const fn first(modes: &Modes) -> Self {
        let antiresonance = modes.antiresonances()[0];
        Self { index: 0, next: 1, antiresonance, nearest: antiresonance }
    }

    /// That of a train of this total inertia, which has one mode at least.
    pub(super) const fn of(modes: &Modes, total: f64) -> Self {
        let (all, held) = (modes.resonances(), modes.antiresonances());
        let (mut index, mut largest) = (0, 0.0);
        each!(i, 0..all.len(), {
            let compliance = all[i].residue / (all[i].frequency * all[i].frequency);
            if compliance > largest {
                (index, largest) = (i, compliance);
            }
        });
        let mut next = 0;
        while next < all.len() && (next == index || all[next].residue * total < UNSEEN) {
            next += 1;
        }
        let mut antiresonance = held[0];
        each!(i, 0..index, {
            antiresonance *= held[i + 1] / all[i].frequency;
        });
        let mut nearest = held[0];
        each!(i, 1.., i <= index, {
            if (held[i] - antiresonance).abs() < (nearest - antiresonance).abs() {
                nearest = held[i];
            }
        });
        Self { index, next, antiresonance, nearest }
    }
}
