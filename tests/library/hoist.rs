//! The drives of the firmware's hoist, from the file that describes its machine.

#[path = "../../firmware/src/scenes/hoist/machine.rs"]
mod machine;

use std::marker::PhantomData;

use driveline::configure::Machine;
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::number::{Fixed, Number};
use driveline::observer::{self, GearedObserver, Observer, SemiImplicitObserver};

pub use machine::{CutAtRope, Hoist, TRAVEL};

/// An observer, a speed loop and a machine.
///
/// `Any` stands for nothing. The compiler evaluates what is generic only where it is used.
pub trait Variant<Any = ()> {
    type Number: Number + 'static;
    type Observer: Observer<Self::Number, Config: 'static> + 'static;
    const NAME: &'static str;
    const RATE_HZ: u32;
    const CONFIG: &'static ConfigOf<Drive<Self::Number, Self::Observer, (), SpeedLoop<Self::Number>>>;
}

/// The drive of a variant.
pub type DriveOf<V> = Drive<<V as Variant>::Number, <V as Variant>::Observer, (), SpeedLoop<<V as Variant>::Number>>;

/// A machine with the observer `O`.
pub struct Of<M, O>(PhantomData<(M, O)>);

pub type Rigid<N> = GearedObserver<observer::RigidObserver<N>>;
pub type Exact<N> = GearedObserver<observer::TwoMassObserver<N>>;
pub type Reduced<N> = GearedObserver<SemiImplicitObserver<N>>;

macro_rules! variants {
    ($($rate:literal)+) => { $(variants! { @numbers $rate, f32, Fixed })+ };
    (@numbers $rate:literal, $($number:ty),+) => { $(variants! { @impl $number:
        Hoist<$rate>, Rigid<$number>;
        CutAtRope<$rate>, Exact<$number>;
        Hoist<$rate>, Exact<$number>;
        Hoist<$rate>, Reduced<$number>;
    })+ };
    (@impl $number:ty: $($machine:ty, $observer:ty;)+) => { $(
        impl<Any> Variant<Any> for Of<$machine, $observer> {
            type Number = $number;
            type Observer = $observer;
            const NAME: &'static str = stringify!($machine, $observer);
            const RATE_HZ: u32 = <$machine as Machine>::RATE_HZ;
            const CONFIG: &'static ConfigOf<Drive<$number, $observer, (), SpeedLoop<$number>>> =
                const { &Drive::<$number, $observer, (), SpeedLoop<$number>>::configure::<$machine>() };
        }
    )+ };
}
variants! { 1_000 4_000 10_000 }
