//! Observers for a machine.

use super::{Configure, LoopPart, Machine, Needs};
use crate::design::MechanismDesign;
use crate::learning::{EccentricityNumber, EccentricityObserver};
use crate::number::Fixed;
use crate::observer::{
    BacklashConfig, BacklashObserver, GearedConfig, GearedObserver, LoadGearConfig, LoadGearObserver, MechanismConfig,
    MechanismObserver, RigidConfig, RigidObserver, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig,
    TwoMassObserver,
};
use crate::settings::Bases;

/// A machine with a mechanism: an inertia that depends on the angle.
pub trait HasMechanism: Machine {
    /// The machine as the observer has it.
    const DRIVEN: crate::machine::DrivenMechanism;
    /// The observer, from machine, rate, encoder and disturbance.
    const MECHANISM_OBSERVER: MechanismDesign = Self::DRIVEN.observer(Self::RATE, Self::ENCODER, Self::DISTURBANCE);
}

impl<M: Machine, N: EccentricityNumber, O: Configure<M, N>> Configure<M, N> for EccentricityObserver<O> {
    type Config = O::Config;
    const CONFIG: Self::Config = O::CONFIG;
    const LOOP: LoopPart = O::LOOP;
    const NEEDS: Needs = O::NEEDS;
}

macro_rules! observers {
    ($number:ident, $bases:expr) => {
        impl<M: Machine> Configure<M, $number> for TwoMassObserver {
            type Config = TwoMassConfig<$number>;
            const CONFIG: Self::Config = TwoMassConfig::<$number>::new(&M::OBSERVER, $bases);
            const LOOP: LoopPart = LoopPart { two_mass: Some(M::OBSERVER), ..LoopPart::NONE };
            const NEEDS: Needs = Needs::SHAFT;
        }

        impl<M: Machine> Configure<M, $number> for SemiImplicitObserver {
            type Config = SemiImplicitConfig<$number>;
            const CONFIG: Self::Config = SemiImplicitConfig::<$number>::new(&M::OBSERVER, $bases);
            const LOOP: LoopPart = LoopPart { two_mass: Some(M::OBSERVER), ..LoopPart::NONE };
            const NEEDS: Needs = Needs::SHAFT;
        }

        impl<M: Machine> Configure<M, $number> for RigidObserver {
            type Config = RigidConfig<$number>;
            const CONFIG: Self::Config = RigidConfig::<$number>::new(&M::RIGID_OBSERVER, M::LOAD_SHARE, $bases);
            const LOOP: LoopPart = LoopPart { rigid: Some(M::RIGID_OBSERVER), ..LoopPart::NONE };
        }

        impl<M: Machine> Configure<M, $number> for BacklashObserver {
            type Config = BacklashConfig<$number>;
            const CONFIG: Self::Config = BacklashConfig::<$number>::new(&M::BACKLASH_OBSERVER, $bases);
            const LOOP: LoopPart = LoopPart { two_mass: Some(M::BACKLASH_OBSERVER.contact), ..LoopPart::NONE };
            const NEEDS: Needs = Needs::SHAFT;
        }

        impl<M: HasMechanism, const TOOLS: usize> Configure<M, $number> for MechanismObserver<f32, TOOLS> {
            type Config = MechanismConfig<$number, TOOLS>;
            const CONFIG: Self::Config = MechanismConfig::<$number, TOOLS>::new(&M::MECHANISM_OBSERVER, $bases);
            const LOOP: LoopPart = LoopPart { rigid: Some(M::MECHANISM_OBSERVER.rigid), ..LoopPart::NONE };
        }

        impl<M: Machine, O: Configure<M, $number, Config: Copy>> Configure<M, $number> for GearedObserver<O> {
            type Config = GearedConfig<$number, O::Config>;
            const CONFIG: Self::Config = GearedConfig::<$number, _>::new(O::CONFIG, &M::GEAR, M::PERIOD, $bases);
            const LOOP: LoopPart = LoopPart { friction: M::GEAR.friction(), ..O::LOOP };
            const NEEDS: Needs = O::NEEDS.with_losses();
        }

        impl<M: Machine, O: Configure<M, $number, Config: Copy>> Configure<M, $number> for LoadGearObserver<O> {
            type Config = LoadGearConfig<$number, O::Config>;
            const CONFIG: Self::Config = LoadGearConfig::<$number, _>::new(O::CONFIG, &M::LOAD_GEAR, M::PERIOD, $bases);
            const LOOP: LoopPart = LoopPart { losses_behind: true, ..O::LOOP };
            const NEEDS: Needs = O::NEEDS;
        }
    };
}

observers!(f32, Bases::SI);
observers!(f64, Bases::SI);
observers!(Fixed, M::BASES);
