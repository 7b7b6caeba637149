//! What a chain comes to: its masses and shafts, sums and ratios.

use super::{Chain, Error, Shaft};

impl Chain {
    /// Referred inertias (kg m2), the motor first.
    #[must_use]
    pub const fn masses(&self) -> &[f64] {
        self.inertia.split_at(self.count).0
    }

    /// Referred shafts and ropes; the one of index `j` joins the masses `j` and `j + 1`.
    #[must_use]
    pub const fn shafts(&self) -> &[Shaft] {
        self.shaft.split_at(self.count - 1).0
    }

    /// Sum of the referred inertias (kg m2).
    #[must_use]
    pub const fn total_inertia(&self) -> f64 {
        let mut sum = 0.0;
        each!(j, 0..self.count, {
            sum += self.inertia[j];
        });
        sum
    }

    /// Sum of the gaps (rad), at the motor.
    #[must_use]
    pub const fn total_gap(&self) -> f64 {
        let mut sum = 0.0;
        each!(j, 0.., j + 1 < self.count, {
            sum += self.shaft[j].gap;
        });
        sum
    }

    /// Torque of the lifted weights at the motor (N m), without losses; positive where it decelerates hoisting.
    #[must_use]
    pub const fn gravity_torque(&self) -> f64 {
        self.gravity
    }

    /// Motor turns per turn of the last shaft.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        self.ratio
    }

    /// Travel of the load per motor angle (m/rad); 0 without a drum.
    #[must_use]
    pub const fn travel_per_angle(&self) -> f64 {
        self.travel
    }

    /// Product of the efficiencies while the motor drives.
    #[must_use]
    pub const fn efficiency(&self) -> f64 {
        self.efficiency
    }

    /// Product of the efficiencies while the load drives.
    #[must_use]
    pub const fn back_efficiency(&self) -> f64 {
        self.back_efficiency
    }

    /// Whether the chain is complete: no element was refused, it ends in a mass, and every backlash has its shaft.
    ///
    /// # Errors
    /// That of the first refused element, [`Error::OpenEnd`], [`Error::BacklashAlone`].
    pub const fn check(&self) -> Result<(), Error> {
        if let Some(error) = self.error {
            return Err(error);
        }
        if self.inertia[self.count - 1] == 0.0 {
            return Err(Error::OpenEnd);
        }
        if self.gap != 0.0 {
            return Err(Error::BacklashAlone);
        }
        Ok(())
    }
}
