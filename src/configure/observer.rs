//! Observers for a machine.

use super::{Configure, Machine};
use crate::constants::Bases;
use crate::design::CrankedDesign;
use crate::number::Fixed;
use crate::observer::{
    Backlash, BacklashConfig, Cranked, CrankedConfig, Geared, GearedConfig, Observer, Rigid, RigidConfig, SemiImplicit,
    SemiImplicitConfig, TwoMass, TwoMassConfig,
};

/// A machine with a crank: an inertia that depends on the angle.
pub trait HasCrank: Machine {
    /// The machine as the observer has it.
    const CRANKED: crate::machine::Cranked;
    /// The observer, from machine, rate, encoder and disturbance.
    const CRANK_OBSERVER: CrankedDesign = Self::CRANKED.observer(Self::RATE, Self::ENCODER, Self::DISTURBANCE);
}

macro_rules! observers {
    ($number:ident, $bases:expr) => {
        impl<M: Machine> Configure<M, $number> for TwoMass<$number> {
            type Config = TwoMassConfig<$number>;
            const CONFIG: Self::Config = TwoMassConfig::<$number>::new(&M::OBSERVER, $bases);
        }

        impl<M: Machine> Configure<M, $number> for SemiImplicit<$number> {
            type Config = SemiImplicitConfig<$number>;
            const CONFIG: Self::Config = SemiImplicitConfig::<$number>::new(&M::OBSERVER, $bases);
        }

        impl<M: Machine> Configure<M, $number> for Rigid<$number> {
            type Config = RigidConfig<$number>;
            const CONFIG: Self::Config = RigidConfig::<$number>::new(&M::RIGID_OBSERVER, M::LOAD_SHARE, $bases);
        }

        impl<M: Machine> Configure<M, $number> for Backlash<$number> {
            type Config = BacklashConfig<$number>;
            const CONFIG: Self::Config = BacklashConfig::<$number>::new(&M::BACKLASH_OBSERVER, $bases);
        }

        impl<M: HasCrank> Configure<M, $number> for Cranked<$number> {
            type Config = CrankedConfig<$number>;
            const CONFIG: Self::Config = CrankedConfig::<$number>::new(&M::CRANK_OBSERVER, $bases);
        }

        impl<M: Machine, O> Configure<M, $number> for Geared<O>
        where
            O: Observer<$number, Config: Copy> + Configure<M, $number, Config = <O as Observer<$number>>::Config>,
        {
            type Config = GearedConfig<$number, <O as Observer<$number>>::Config>;
            const CONFIG: Self::Config =
                GearedConfig::<$number, _>::new(<O as Configure<M, $number>>::CONFIG, &M::GEAR, M::PERIOD, $bases);
        }
    };
}

observers!(f32, Bases::SI);
observers!(f64, Bases::SI);
observers!(Fixed, M::BASES);
