//! A scene's predicted observer errors, at compile time.
//!
//! For the host, which compares it with the measured errors. No image contains it: the tick does not use it.

use driveline::adaptive::Adaptive;
use driveline::configure::Machine;
use driveline::design::TwoMassDesign;
use driveline::drive::{Actuated, Composition, Drive};
use driveline::learning::EccentricityObserver;
use driveline::machine;
use driveline::number::Part;
use driveline::observer::{
    BacklashObserver, GearedObserver, MechanismObserver, RigidObserver, SemiImplicitObserver, TwoMassObserver,
};

/// A design's prediction for its observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Standard deviation of the shaft torque's estimate (N m); none where the design does not follow the shaft.
    pub shaft_torque: Option<f64>,
    /// Standard deviation of the load speed's estimate (rad/s).
    pub load_speed: f64,
    /// The observer's model of the machine, with its reduction error; none for one mass.
    pub machine: Option<machine::TwoMass>,
}

impl Expected {
    const fn of_two_masses(design: &TwoMassDesign) -> Self {
        Expected {
            shaft_torque: Some(design.standard_deviation.shaft_torque),
            load_speed: design.standard_deviation.load_speed,
            machine: Some(design.machine),
        }
    }
}

/// A drive whose design for a machine says what is to be expected.
pub trait Expects<M> {
    /// What it says; none of what no design predicts.
    fn expected() -> Option<Expected> {
        None
    }
}

impl<M, N, O, G, F, B> Expects<M> for Drive<N, O, G, F, B>
where
    O: Expects<M> + Part<N>,
    G: Part<N>,
    F: Part<N>,
    B: Part<N>,
{
    fn expected() -> Option<Expected> {
        O::expected()
    }
}

/// As the drive inside.
impl<M, D, S, L> Expects<M> for Adaptive<M, D, S, L>
where
    D: Composition + Expects<M>,
    S: Part<D::Number>,
    L: Part<D::Number>,
{
    fn expected() -> Option<Expected> {
        D::expected()
    }
}

/// As the drive inside.
impl<M, D: Composition + Expects<M>, const LAGS: usize, const RING: usize> Expects<M> for Actuated<D, LAGS, RING> {
    fn expected() -> Option<Expected> {
        D::expected()
    }
}

impl<M: Machine> Expects<M> for TwoMassObserver {
    fn expected() -> Option<Expected> {
        Some(Expected::of_two_masses(&M::OBSERVER))
    }
}

impl<M: Machine> Expects<M> for SemiImplicitObserver {
    fn expected() -> Option<Expected> {
        Some(Expected::of_two_masses(&M::OBSERVER))
    }
}

/// The shaft in contact: of the gap itself the design predicts nothing.
impl<M: Machine> Expects<M> for BacklashObserver {
    fn expected() -> Option<Expected> {
        Some(Expected::of_two_masses(&M::BACKLASH_OBSERVER.contact))
    }
}

impl<M: Machine> Expects<M> for RigidObserver {
    fn expected() -> Option<Expected> {
        let [_, load_speed, ..] = M::RIGID_OBSERVER.standard_deviation;
        Some(Expected { shaft_torque: None, load_speed, machine: None })
    }
}

impl<M> Expects<M> for MechanismObserver {}

impl<M, O: Expects<M>> Expects<M> for GearedObserver<O> {
    fn expected() -> Option<Expected> {
        O::expected()
    }
}

impl<M, O: Expects<M>> Expects<M> for EccentricityObserver<O> {
    fn expected() -> Option<Expected> {
        O::expected()
    }
}
