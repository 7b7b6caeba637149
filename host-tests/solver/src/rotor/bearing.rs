//! A bearing: what it takes to move the shaft in it.

/// Stiffness and damping of a support, forces along `x` and `y` by motions along `x` and `y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bearing {
    /// Stiffness (N/m), rows the force.
    pub stiffness: [[f64; 2]; 2],
    /// Damping (N s/m), rows the force.
    pub damping: [[f64; 2]; 2],
}

impl Bearing {
    /// The same in all directions.
    #[must_use]
    pub const fn isotropic(stiffness: f64, damping: f64) -> Self {
        Self::anisotropic([stiffness, stiffness], [damping, damping])
    }

    /// Stiffness and damping along `x` and along `y`.
    #[must_use]
    pub const fn anisotropic(stiffness: [f64; 2], damping: [f64; 2]) -> Self {
        Bearing {
            stiffness: [[stiffness[0], 0.0], [0.0, stiffness[1]]],
            damping: [[damping[0], 0.0], [0.0, damping[1]]],
        }
    }
}
