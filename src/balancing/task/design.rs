//! The rotor and its head, as the balancing task needs them.

use crate::balancing::in_run::InRunConfig;
use crate::balancing::tolerance::BalanceTolerance;

/// Rotor, tolerance and balancing head.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BalancingDesign<const PLANES: usize = 1> {
    /// Rotor with its balance quality grade and its highest service speed. It is balanced from half of this speed on.
    pub rotor: BalanceTolerance<f32>,
    /// Largest weight that the head can set in each plane (kg m).
    pub capacity: [f32; PLANES],
    /// Longest time of a move (s).
    pub travel: f32,
    /// Time after a move until the vibration is steady (s).
    pub settle: f32,
    /// Vibration below which the head stays where it is (unit of the sensors); 0 for none.
    pub quiet: f32,
}

sentences! {
    /// A value of a [`BalancingDesign`] out of its range.
    BalancingDesignError:
    Rotor => "grade, mass and service speed of the rotor must be positive numbers",
    Capacity => "the capacity of each plane's head must be a positive number of kg m",
    Travel => "the time of a move must be positive, and at most 1000 s",
    Settle => "the time to settle must be zero or positive, and at most 1000 s",
    Quiet => "the quiet vibration must be zero or a positive number",
}

impl<const PLANES: usize> BalancingDesign<PLANES> {
    /// The limits of the moves.
    ///
    /// The first one is a fiftieth of the least capacity, and less than a sixth of the permissible unbalance. From an
    /// unbalance of half of what is permissible on, it raises the vibration by less than a third.
    pub(super) fn moves(&self) -> Result<InRunConfig<f32, PLANES>, BalancingDesignError> {
        let positive = |value: f32, most: f32| value > 0.0 && value <= most;
        let permissible = self.rotor.permissible().map_err(|_| BalancingDesignError::Rotor)?;
        let (mut least, mut most) = (f32::INFINITY, 0.0_f32);
        for capacity in self.capacity {
            if !positive(capacity, f32::MAX) {
                return Err(BalancingDesignError::Capacity);
            }
            (least, most) = (least.min(capacity), most.max(capacity));
        }
        let sound = [
            (positive(self.travel, 1000.0), BalancingDesignError::Travel),
            (self.settle == 0.0 || positive(self.settle, 1000.0), BalancingDesignError::Settle),
            (self.quiet == 0.0 || positive(self.quiet, f32::MAX), BalancingDesignError::Quiet),
        ];
        if let Some((_, error)) = sound.iter().find(|(sound, _)| !sound) {
            return Err(*error);
        }
        Ok(InRunConfig {
            probe: (0.02 * least).min(0.15 * permissible),
            limits: self.capacity,
            step: 2.0 * most,
            bound: 1.3,
            target: 0.01,
            forgetting: 0.7,
            noise: 0.005,
        })
    }
}
