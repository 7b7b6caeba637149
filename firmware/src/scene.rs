//! Interface of loop, bench and self-test to a scene, in words of 32 bits.
//!
//! A scene is a drive composed from parts, with its constants; a variant has a name in the table of scenes. Every word
//! is the bit pattern of the scene's own number type: `f32` in SI units, or fixed point per unit of the scene's limits.
//! So host and target can be compared bit for bit, and the link needs no conversion.

pub mod balanced;
pub mod composed;
pub mod no_load;
pub mod on_axis;
pub mod panel_keys;
pub mod table;

use core::marker::PhantomData;

use driveline::drive::{Composition, ConfigOf};
use driveline::telemetry::Channel;

/// Input of a tick: eight words, as on the link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Input {
    /// Motor angle, 2^32 per turn.
    pub angle: u32,
    /// Motor torque applied during the tick that has just ended, as bits of the scene's number.
    pub torque: u32,
    /// Speed setpoint, as bits of the scene's number.
    pub setpoint: u32,
    /// Bits for the drive: [`Input::RELEASED`].
    pub flags: u32,
    /// Vibration samples, as bits of the scene's number.
    pub vibration: [u32; 2],
    /// Request of the panel: a key and a value, defined by the scene; zeros are no request.
    pub asked: [u32; 2],
}

impl Input {
    /// Flag: the brake is open and the governor at work; without it the scene holds, and [`Input::setpoint`] is the
    /// torque that it holds with.
    pub const RELEASED: u32 = 1;
}

/// Output of a tick: eight words, as on the link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Output {
    /// Torque command for the next tick.
    pub torque: u32,
    /// Estimated motor speed.
    pub motor_speed: u32,
    /// Estimated shaft torque.
    pub shaft_torque: u32,
    /// Estimated load speed.
    pub load_speed: u32,
    /// Estimated load torque.
    pub load_torque: u32,
    /// Fault flags, bits of `driveline::fault`.
    pub faults: u32,
    /// Instructions that the tick took; filled in by the board, zero on the host.
    pub instructions: u32,
    /// The answer to the panel's request; zero from the tick itself.
    pub answer: u32,
}

/// A drive of a scene, ready to tick.
pub trait Scene {
    /// One tick. Pure: no clock, no allocation, no panic.
    fn tick(&mut self, input: &Input) -> Output;

    /// Panel or terminal between two ticks: sets a value, requests one. It may take longer than a tick,
    /// and a scene without a panel has nothing of it.
    fn panel(&mut self, _asked: [u32; 2]) -> u32 {
        0
    }

    /// A tick and the panel's turn after it, as the control loop runs them.
    fn exchange(&mut self, input: &Input) -> Output {
        let output = self.tick(input);
        Output { answer: self.panel(input.asked), ..output }
    }

    /// So many ticks did not run before the one with this input. Returns the faults to add to those of that tick.
    #[cfg(not(target_os = "none"))]
    fn missed(&mut self, _input: &Input, _ticks: u32) -> u32 {
        0
    }

    /// The value of a channel of [`Variant::CHANNELS`], by its index, as a word.
    fn channel(&self, _index: usize) -> u32 {
        0
    }

    /// A copy that goes on from the same state; none of a scene that cannot be copied.
    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<alloc::boxed::Box<dyn Scene>> {
        None
    }
}

#[cfg(not(target_os = "none"))]
impl<S: Scene + ?Sized> Scene for alloc::boxed::Box<S> {
    fn tick(&mut self, input: &Input) -> Output {
        (**self).tick(input)
    }

    fn panel(&mut self, asked: [u32; 2]) -> u32 {
        (**self).panel(asked)
    }

    fn missed(&mut self, input: &Input, ticks: u32) -> u32 {
        (**self).missed(input, ticks)
    }

    fn channel(&self, index: usize) -> u32 {
        (**self).channel(index)
    }

    fn copy(&self) -> Option<alloc::boxed::Box<dyn Scene>> {
        (**self).copy()
    }
}

/// One variant of a scene.
pub trait Variant: 'static {
    /// Its drive.
    type Scene: Scene;
    /// Scene, number, observer and rate, as `hoist/f32/reduced/10000`.
    const NAME: &'static str;
    /// Ticks a second.
    const RATE_HZ: u32;
    /// Channels of its telemetry beside the words of the link.
    const CHANNELS: &'static [Channel<'static>] = &[];
    /// The drive at rest.
    fn start() -> Self::Scene;
}

/// A scene that its drive's constants are all that is needed of.
pub trait FromConfig: Scene {
    /// The drive.
    type Drive: Composition;
    /// As [`Variant::CHANNELS`].
    const CHANNELS: &'static [Channel<'static>] = &[];
    /// The drive at rest.
    fn from_config(config: &'static ConfigOf<Self::Drive>) -> Self;
}

/// The variant of a scene for a machine, with the constants that follow from the machine.
pub struct Of<M, S>(PhantomData<(M, S)>);

/// A variant's drive at rest; generic for the reason given at [`Constants`], and called through a constant pointer for
/// the same: inlined, it would be evaluated for all variants.
#[inline]
pub fn at_rest<V: Constants>() -> V::Scene {
    V::Scene::from_config(V::CONFIG)
}

/// The constants of a variant's drive.
///
/// `Any` stands for nothing. The compiler evaluates what is generic where it is used: the designs of one variant for
/// an image, not those of all variants in each check and each build of this crate.
pub trait Constants<Any = ()>: Variant<Scene: FromConfig> {
    /// The constants.
    const CONFIG: &'static ConfigOf<<Self::Scene as FromConfig>::Drive>;
}
