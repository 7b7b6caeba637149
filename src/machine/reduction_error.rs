//! Errors of a reduction.

/// Errors of two masses against their chain.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ReductionError {
    /// Lowest natural frequency left out that is observable at the motor (rad/s); infinite where none is. It lies below
    /// the resonance where that is not the first mode.
    pub next_mode: f64,
    /// Its share at the motor: residue times total inertia. At 1 it moves the motor as much as the rigid turning does.
    pub next_share: f64,
    /// Relative error of the main mode's resonance, signed.
    pub resonance: f64,
    /// Relative error of the antiresonance below it, the nearest of them, signed.
    pub antiresonance: f64,
    /// Relative error of the static compliance at the motor (its twist against the mean angle under a steady torque),
    /// signed.
    pub compliance: f64,
    /// Worst case: bound of the error of the motor's speed after a blow to the motor, at any time, over its first jump.
    ///
    /// The undamped answer to an impulse is `1/J + sum r_i cos(w_i t)`; the bound adds the residues that differ or are
    /// missing.
    pub worst: f64,
    /// Share of the total inertia that slips in the main mode, in dampers' rings: it is in the two masses, but not in
    /// the vibration.
    pub slipping: f64,
}

impl ReductionError {
    /// Nothing left out.
    pub const NONE: Self = Self {
        next_mode: f64::INFINITY,
        next_share: 0.0,
        resonance: 0.0,
        antiresonance: 0.0,
        compliance: 0.0,
        worst: 0.0,
        slipping: 0.0,
    };

    /// Whether each is a number.
    pub(super) const fn is_sound(&self) -> bool {
        let Self { next_mode, next_share, resonance, antiresonance, compliance, worst, slipping: _ } = self;
        !next_mode.is_nan() && (*next_share + *resonance + *antiresonance + *compliance + *worst).is_finite()
    }
}
