//! Materials of shafts and discs.

/// A linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Density (kg/m3).
    pub density: f64,
    /// Young's modulus (Pa).
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

impl Material {
    pub const STEEL: Self = Material { density: 7850.0, young: 2.1e11, poisson: 0.3 };

    /// Shear modulus (Pa).
    #[must_use]
    pub fn shear_modulus(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }
}
