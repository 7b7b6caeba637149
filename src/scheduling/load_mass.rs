//! Mass of a lifted load, from the estimated load torque.

/// Constants of [`LoadMass`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadMassConfig {
    /// Mass per load torque, `1/(g r)` (kg/(N m)).
    per_torque: f32,
    /// Share of a new value in the filtered one.
    share: f32,
    /// Smallest and largest mass (kg).
    range: [f32; 2],
}

impl LoadMassConfig {
    /// A load that moves by `travel` per angle of the motor (m/rad), filtered over `time` (s) by updates in
    /// intervals of `every` (s), within a `range` (kg).
    ///
    /// # Panics
    /// At compile time in a constant, for a value that is not positive and finite, or a range that is empty.
    pub const fn new(travel: f64, time: f64, every: f64, range: [f64; 2]) -> Self {
        assert!(
            travel > 0.0 && travel.is_finite() && every > 0.0 && time >= every && time.is_finite(),
            "travel, filter time and interval of the load's mass must be positive and finite, the time at least the \
             interval"
        );
        assert!(
            range[0] >= 0.0 && range[1] > range[0] && range[1].is_finite(),
            "the smallest load must be zero or above (kg), the largest above it and finite"
        );
        /// Gravity (m/s2), the standard value of ISO 80000-3.
        const GRAVITY: f64 = 9.80665;
        LoadMassConfig {
            per_torque: (1.0 / (GRAVITY * travel)) as f32,
            share: (every / time) as f32,
            range: [range[0] as f32, range[1] as f32],
        }
    }
}

/// Mass of a lifted load (kg).
///
/// ```
/// use driveline::scheduling::{LoadMass, LoadMassConfig};
/// // 0.02 m a radian, weighed within 0.2 s, twenty times a second: 980.665 N m are 5 t
/// const CONFIG: LoadMassConfig = LoadMassConfig::new(0.02, 0.2, 0.05, [500.0, 8_000.0]);
/// let mut load = LoadMass::new(&CONFIG, 500.0);
/// (0..60).for_each(|_| { load.update(&CONFIG, 980.665); });
/// assert!((load.mass() - 5_000.0).abs() < 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadMass {
    mass: f32,
}

impl LoadMass {
    /// From a mass to begin with (kg).
    pub fn new(config: &LoadMassConfig, mass: f32) -> Self {
        let [least, most] = config.range;
        LoadMass { mass: if mass >= least { mass.min(most) } else { least } }
    }

    /// Takes an estimated load torque (N m); a value that is not finite is left out.
    pub fn update(&mut self, config: &LoadMassConfig, load_torque: f32) -> f32 {
        self.update_after(config, 1.0, load_torque)
    }

    /// [`update`](Self::update), so many times its interval after the last one.
    pub fn update_after(&mut self, config: &LoadMassConfig, elapsed: f32, load_torque: f32) -> f32 {
        let [least, most] = config.range;
        let found = load_torque * config.per_torque;
        if found.is_finite() {
            self.mass += (config.share * elapsed).min(1.0) * (found.max(least).min(most) - self.mass);
        }
        self.mass
    }

    /// The filtered mass.
    pub fn mass(&self) -> f32 {
        self.mass
    }
}
