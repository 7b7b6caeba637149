//! The observer of a machine with a mechanism: the Kalman filter of its mean inertia, which has to hold at every other one.

use super::tuning::{Disturbance, Encoder, Rate};
use super::{Error, Matrix, RigidDesign, eigenvalues, spectral_radius};
use crate::machine::{DrivenMechanism, Inertia, Rigid};

/// The observer of a machine with a mechanism.
///
/// ```
/// use driveline::design::{Disturbance, Encoder, MechanismDesign, Rate};
/// use driveline::machine::{CrankSlider, DrivenMechanism, Inertia, Length, Mass, Mechanism};
/// const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.6), Inertia(1.0), Mass(40.0));
/// const PRESS: DrivenMechanism = DrivenMechanism::new(Inertia(2.0), &Mechanism::slider_crank(&RAM), 1, 1);
/// const LOAD: Disturbance = Disturbance { torque_accuracy: 1.0, load_torque_step: 50.0, within: 1.0 };
/// // one set of gains, stable at the lightest and at the heaviest angle
/// const DESIGN: MechanismDesign = PRESS.observer(Rate::hz(1000), Encoder::lines(2048), LOAD);
/// assert!(DESIGN.spectral_radii.iter().all(|radius| *radius < 1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MechanismDesign {
    /// The machine it is for.
    pub machine: DrivenMechanism,
    /// The observer of the mean inertia, whose gains stand at every angle.
    pub rigid: RigidDesign,
    /// Largest pole magnitude at the smallest and the largest inertia.
    pub spectral_radii: [f64; 2],
}

impl DrivenMechanism {
    stops! {
        /// Designs the observer.
        pub const fn observer(
            &self,
            rate: Rate,
            encoder: Encoder,
            disturbance: Disturbance,
        ) -> MechanismDesign = try_observer
    }

    /// [`observer`](Self::observer), with an error instead of a panic.
    ///
    /// # Errors
    /// As [`Rigid::try_observer`], and [`Error::MechanismNotStabilising`] where the gains of the mean inertia leave a
    /// pole on or outside the unit circle at the least or the largest one.
    pub const fn try_observer(
        &self,
        rate: Rate,
        encoder: Encoder,
        disturbance: Disturbance,
    ) -> Result<MechanismDesign, Error> {
        let mean = get!(Rigid::try_new(Inertia(self.mean_inertia())), Error::Machine);
        let rigid = get!(mean.try_observer(rate, encoder, disturbance));
        let [least, most] = self.extremes();
        let spectral_radii = [held_at(&rigid, least), held_at(&rigid, most)];
        if !(spectral_radii[0] < 1.0 && spectral_radii[1] < 1.0) {
            return Err(Error::MechanismNotStabilising);
        }
        Ok(MechanismDesign { machine: *self, rigid, spectral_radii })
    }
}

/// Largest size of a pole of `(I - K C) F` with the gains of the mean inertia and this one.
const fn held_at(design: &RigidDesign, inertia: f64) -> f64 {
    let t = design.period;
    let (jump, glide) = (t / inertia, 0.5 * t * t / inertia);
    let transition = Matrix([[1.0, t, -glide], [0.0, 1.0, -jump], [0.0, 0.0, 1.0]]);
    let [a, b, c] = design.gains;
    let left = Matrix([[1.0 - a, 0.0, 0.0], [-b, 1.0, 0.0], [-c, 0.0, 1.0]]);
    // Each state in its own unit, as the gains have them: the poles are the same, and none is lost beside a large one.
    let units = [1.0, unit(b), unit(c)];
    let per = [1.0, 1.0 / units[1], 1.0 / units[2]];
    spectral_radius(&eigenvalues(&left.times(&transition).scaled(&per, &per)))
}

const fn unit(gain: f64) -> f64 {
    if gain.abs() > 0.0 { gain.abs() } else { 1.0 }
}
