//! The scenes' machines as the observers know them.

use driveline::configure::{HasMechanism, Machine};
use driveline::design::{BacklashDesign, Disturbance, Encoder, MechanismDesign, Rate, RigidDesign, TwoMassDesign};
use driveline::machine::TwoMass;
use driveline::settings::{Bases, Gear};
use driveline_firmware::scenes::{blooming_mill, crane_travel, hoist, punch_press, spindle, strip_mill};

/// What an observer of a scene's machine is designed from.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    pub name: &'static str,
    /// Ticks a second.
    pub rate_hz: u32,
    /// Two masses for the chain.
    pub two_mass: TwoMass,
    /// Noise of the angle.
    pub encoder: Encoder,
    /// Noise of the torque, wandering of the load.
    pub disturbance: Disturbance,
    /// The observer of two masses, by the compiler: on a controller without doubles it takes seconds. None of a shaft
    /// that no observer can follow at the scene's rate.
    pub design: Option<TwoMassDesign>,
    /// The scene's observer of one mass.
    pub rigid: RigidDesign,
    /// The load's share of the inertia.
    pub load_share: f64,
    /// A gear with losses that the scene's observers deduct.
    pub gear: Option<Gear>,
    /// The observer through the gap.
    pub backlash: Option<BacklashDesign>,
    /// The observer with a crank.
    pub crank: Option<MechanismDesign>,
    /// Bases of fixed point.
    pub bases: Bases,
}

impl Scene {
    const fn of<M: Machine>(name: &'static str) -> Self {
        Scene {
            name,
            rate_hz: M::RATE_HZ,
            two_mass: M::TWO_MASS,
            encoder: M::ENCODER,
            disturbance: M::DISTURBANCE,
            design: match M::TWO_MASS.try_observer(M::RATE, M::ENCODER, M::DISTURBANCE) {
                Ok(design) => Some(design),
                Err(_) => None,
            },
            rigid: M::RIGID_OBSERVER,
            load_share: M::LOAD_SHARE,
            gear: None,
            backlash: None,
            crank: None,
            bases: M::BASES,
        }
    }

    const fn geared<M: Machine>(self) -> Self {
        Scene { gear: Some(M::GEAR), ..self }
    }

    const fn gap<M: Machine>(self) -> Self {
        Scene { backlash: Some(M::BACKLASH_OBSERVER), ..self }
    }

    const fn crank<M: HasMechanism>(self) -> Self {
        Scene { crank: Some(M::MECHANISM_OBSERVER), ..self }
    }

    /// The tick rate.
    pub const fn rate(&self) -> Rate {
        Rate::hz(self.rate_hz)
    }

    /// Time between two ticks (s).
    pub const fn period(&self) -> f64 {
        1.0 / self.rate_hz as f64
    }
}

type Hoist = hoist::Hoist<10_000>;

/// The scenes that are run against a plant.
pub static SCENES: &[Scene] = &[
    Scene::of::<Hoist>(hoist::SCENE).geared::<Hoist>(),
    Scene::of::<spindle::Spindle>(spindle::SCENE),
    Scene::of::<strip_mill::StripMill>(strip_mill::SCENE),
    Scene::of::<crane_travel::CraneTravel>(crane_travel::SCENE),
    Scene::of::<punch_press::PunchPress>(punch_press::SCENE).crank::<punch_press::PunchPress>(),
    Scene::of::<blooming_mill::BloomingMill>(blooming_mill::SCENE).gap::<blooming_mill::BloomingMill>(),
];
