//! Departures of a plant from its scene's figures.

/// What a machine is, over what its drive was designed for. Ratios are 1 where nothing departs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    /// Ratio of the shafts' stiffnesses.
    pub stiffness: f64,
    /// Ratio of the shafts' dampings.
    pub damping: f64,
    /// Ratio of the motor's inertia.
    pub motor_inertia: f64,
    /// Ratio of the load's inertia.
    pub load_inertia: f64,
    /// Added to the gear's efficiency.
    pub efficiency: f64,
    /// Ratio of the gap.
    pub gap: f64,
    /// Ratio of the mass on the hook.
    pub load: f64,
    /// Ratio of the rope's length.
    pub rope: f64,
}

impl Departure {
    /// The machine as its drive was designed for.
    pub const NONE: Self = Self {
        stiffness: 1.0,
        damping: 1.0,
        motor_inertia: 1.0,
        load_inertia: 1.0,
        efficiency: 0.0,
        gap: 1.0,
        load: 1.0,
        rope: 1.0,
    };
}
