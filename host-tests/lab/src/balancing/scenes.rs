//! The scenes by name.

use super::scene::Scene;
use super::{fan, grinder};

/// The scenes.
#[must_use]
pub const fn scenes() -> [Scene; 2] {
    [
        // A fan of 180 kg at 1480 r/min, found in grade G 16, balanced in two planes with trial weights. Its sensors are
        // off by 5 % and 10 degrees, its noise is 20 dB below the vibration, weights are set to 3 % and 2 degrees.
        Scene { name: "balanced-fan", balance: fan::run },
        // A surface grinder whose drive has all four parts: it observes coupling and wheel, measures the fluctuation
        // that a wheel out of round makes, governs, and balances the wheel by itself while it cuts.
        Scene { name: "surface-grinder", balance: grinder::run },
    ]
}

impl Scene {
    /// The scene of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        scenes().into_iter().find(|scene| scene.name == name)
    }
}
