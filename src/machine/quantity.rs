//! Quantities with their units. The number inside is public and in SI units.

macro_rules! quantity {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        pub struct $name(pub f64);
    )*};
}

quantity! {
    /// Moment of inertia (kg m2) on its own shaft.
    Inertia,
    /// Stiffness: (N m/rad) of a shaft on its own speed, (N/m) of a rope at the load.
    Stiffness,
    /// Viscous damping of a shaft (N m s/rad) on its own speed.
    Damping,
    /// Viscous damping of a rope (N s/m) along the travel of the load.
    LinearDamping,
    /// Ratio of a gear: speed of the motor's side over speed of the load's side, above 0.
    Ratio,
    /// Efficiency, above 0 and at most 1.
    Efficiency,
    /// Diameter of a drum, pinion, wheel or shaft (m).
    Diameter,
    /// Mass (kg).
    Mass,
    /// Free travel of a backlash (rad) on its own shaft: the whole gap, not half of it.
    Gap,
    /// Travel along a straight line, or length of a shaft, connecting rod or pendulum (m).
    Length,
    /// Torque (N m).
    Torque,
    /// Angular speed (rad/s).
    Speed,
    /// Shear modulus of a material (Pa).
    ShearModulus,
    /// Density of a material (kg/m3).
    Density,
}

impl Speed {
    /// From r/min.
    #[doc(alias = "r/min")]
    #[must_use]
    pub const fn rpm(speed: f64) -> Speed {
        Speed(speed * (core::f64::consts::TAU / 60.0))
    }
}

/// Falls of a rope: how many parts carry the load, at least 1. The load travels `1/falls` of the rope wound by the
/// drum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Falls(pub u32);
