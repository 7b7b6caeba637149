//! A flywheel by the areas between driving and loading torque [Notes ch. 5].

/// Energy swing A_max over a cycle (J) from the areas between the driving and the loading torque, in their order,
/// positive where the driving torque is larger: the highest less the lowest of their running sum.
#[must_use]
pub const fn energy_swing(areas: &[f64]) -> f64 {
    let (mut sum, mut least, mut most) = (0.0, 0.0, 0.0);
    each!(k, 0..areas.len(), {
        sum += areas[k];
        if sum < least {
            least = sum;
        }
        if sum > most {
            most = sum;
        }
    });
    most - least
}

/// Inertia (kg m2) that keeps delta at `delta` where the energy swings by `swing` (J) at a mean speed (rad/s):
/// A_max/(omega_m^2 delta). Existing rotating inertia counts towards it. For a machine of constant inertia only.
///
/// ```
/// use driveline::design::{energy_swing, flywheel_inertia};
///
/// const SWING: f64 = energy_swing(&[-50.0, 550.0, -100.0, 125.0, -500.0, 25.0, -50.0]);
/// assert_eq!(SWING, 575.0);
/// let speed = 600.0 * core::f64::consts::TAU / 60.0;
/// assert!((flywheel_inertia(SWING, speed, 1.0 / 300.0) - 43.69).abs() < 0.01);
/// ```
#[must_use]
pub const fn flywheel_inertia(swing: f64, speed: f64, delta: f64) -> f64 {
    swing / (speed * speed * delta)
}
