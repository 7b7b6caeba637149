//! The drives of the firmware's hoist, from the file that describes its machine.

#[path = "../../firmware/src/scenes/hoist/machine.rs"]
mod machine;

use std::marker::PhantomData;

use driveline::configure::Machine;
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::number::{Fixed, Number, Part};
use driveline::observer::{self, GearedObserver, Observer, SemiImplicitObserver};

pub use machine::{CutAtRope, Hoist, TRAVEL};

/// An observer, a speed loop and a machine.
///
/// `Any` stands for nothing. The compiler evaluates what is generic only where it is used.
pub trait Variant<Any = ()> {
    type Number: Number + 'static;
    type Observer: Part<Self::Number, State: Observer<Self::Number, Config: 'static> + Copy + PartialEq>
        + Copy
        + 'static;
    const NAME: &'static str;
    const RATE_HZ: u32;
    const CONFIG: &'static ConfigOf<Drive<Self::Number, Self::Observer, SpeedLoop>>;
}

/// The drive of a variant.
pub type DriveOf<V> = Drive<<V as Variant>::Number, <V as Variant>::Observer, SpeedLoop>;

/// A machine with the observer `O` in the number `N`.
pub struct Of<M, N, O>(PhantomData<(M, N, O)>);

pub type Rigid = GearedObserver<observer::RigidObserver>;
pub type Exact = GearedObserver<observer::TwoMassObserver>;
pub type Reduced = GearedObserver<SemiImplicitObserver>;

macro_rules! variants {
    ($($rate:literal)+) => { $(variants! { @numbers $rate, f32, Fixed })+ };
    (@numbers $rate:literal, $($number:ty),+) => { $(variants! { @impl $number:
        Hoist<$rate>, Rigid;
        CutAtRope<$rate>, Exact;
        Hoist<$rate>, Exact;
        Hoist<$rate>, Reduced;
    })+ };
    (@impl $number:ty: $($machine:ty, $observer:ty;)+) => { $(
        impl<Any> Variant<Any> for Of<$machine, $number, $observer> {
            type Number = $number;
            type Observer = $observer;
            const NAME: &'static str = stringify!($machine, $number, $observer);
            const RATE_HZ: u32 = <$machine as Machine>::RATE_HZ;
            const CONFIG: &'static ConfigOf<DriveOf<Self>> =
                const { &DriveOf::<Self>::configure::<$machine>() };
        }
    )+ };
}
variants! { 1_000 4_000 10_000 }
