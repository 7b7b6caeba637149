//! Losses of a gear behind the shaft, deducted from the load torque after an observer.

use super::{Observer, Prediction, Stiction};
use crate::sample::Estimate;

/// Constants of [`LoadGearObserver`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadGearConfig<N: Stiction, C> {
    /// Constants of the observer in front of the gear.
    pub observer: C,
    /// Friction per shaft torque while the motor drives.
    pub driving: N::Coefficient,
    /// Friction per shaft torque while the load drives.
    pub driven: N::Coefficient,
    /// Stiction gain c (N m s/rad).
    pub stiction_gain: N::StictionGain,
}

/// An observer in front of a gear with losses, whose shaft lies between the motor and the gear.
///
/// A gear between the shaft and the load leaves the shaft torque T as it is: the motor feels T itself. The load's side
/// gets `eta T` while the motor drives, and gives `T / eta_back` while the load does [Wang 1989 §1-3, Huang 1987 ch. 1].
/// The observer takes the difference for load torque. Here it is deducted,
///
/// ```text
/// tau_L = tau_L' - friction,   friction = c omega_l, limited to (1 - eta) |T|  or  (1/eta_back - 1) |T|
/// ```
///
/// with the first limit while shaft torque and load speed have the same sign. The stiction gain c takes the friction
/// through zero at standstill, where the motor's angle contains nothing of it: the load torque is then the shaft torque.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::configure::Configure;
/// use driveline::observer::{LoadGearConfig, LoadGearObserver, Observer, TwoMassConfig};
/// use driveline::settings::LoadGear;
/// // between the roll and its load a gear that loses 3 %
/// const GEAR: LoadGear = LoadGear { efficiency: 0.97, back_efficiency: 0.97, inertia: 0.48 };
/// const ROLL: TwoMassConfig<f64> = <TwoMassObserver as Configure<Roll, f64>>::CONFIG;
/// const CONFIG: LoadGearConfig<f64, TwoMassConfig<f64>> =
///     LoadGearConfig::<f64, _>::new(ROLL, &GEAR, 1e-4, driveline::settings::Bases::SI);
/// // the shaft carries all of 100 N m, the load gets 97
/// let estimate = LoadGearObserver::<TwoMassObserver<f64>>::steady(&CONFIG, 0, 100.0, 100.0).estimate(&CONFIG);
/// assert!((estimate.shaft_torque - 100.0).abs() < 1e-9 && (estimate.load_torque - 97.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadGearObserver<O> {
    pub(crate) observer: O,
}

impl<N: Stiction, O: Observer<N>> Observer<N> for LoadGearObserver<O> {
    type Config = LoadGearConfig<N, O::Config>;
    type States = O::States;

    fn restart(&mut self, config: &Self::Config, angle: u32, torque: N, speed: N) {
        self.observer.restart(&config.observer, angle, torque, speed);
    }

    fn steady(config: &Self::Config, angle: u32, torque: N, speed: N) -> Self {
        LoadGearObserver { observer: O::steady(&config.observer, angle, torque, speed) }
    }

    #[inline(always)]
    fn predict(&self, config: &Self::Config, angle: u32, torque: N) -> Prediction<N, Self::States> {
        self.observer.predict(&config.observer, angle, torque)
    }

    #[inline(always)]
    fn correct(&mut self, config: &Self::Config, predicted: Prediction<N, Self::States>, angle: u32) {
        self.observer.correct(&config.observer, predicted, angle);
    }

    #[inline(always)]
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32) {
        self.observer.coast(predicted, angle);
    }

    #[inline(always)]
    fn estimate(&self, config: &Self::Config) -> Estimate<N> {
        let now = self.observer.estimate(&config.observer);
        let drives = (now.shaft_torque > N::ZERO) == (now.load_speed > N::ZERO);
        let loss = now.shaft_torque.times(if drives { config.driving } else { config.driven }).magnitude();
        let friction = now.load_speed.braked(config.stiction_gain).limited(loss);
        Estimate { load_torque: now.load_torque - friction, ..now }
    }

    passed_on!();
}
