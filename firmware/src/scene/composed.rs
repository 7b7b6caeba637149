//! A composed scene: the words of the link on one side, a drive of any parts on the other.

use driveline::drive::{Composition, ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::number::{Number, Part};
use driveline::observer::Observer;
use driveline::sample::{Command, Estimate, Sample};
use driveline::telemetry::Channel;

use super::{Constants, FromConfig, Input, Of, Output, Scene, Variant};

/// A drive over words, whatever its parts.
pub trait OverWords: Composition {
    /// One tick: at work where it is released, else held, with the setpoint's word as the torque.
    #[inline(always)]
    fn advance(&mut self, config: &ConfigOf<Self>, input: &Input) -> Output {
        let sample: Sample<Self::Number> = sample(input);
        let command = if input.flags & Input::RELEASED != 0 {
            self.tick(config, &sample)
        } else {
            self.hold(config, sample.angle, sample.setpoint)
        };
        output(&command, &self.estimate(config))
    }

    /// Makes up ticks that did not run before the one with this input. Returns the bits of the faults.
    #[cfg(not(target_os = "none"))]
    fn make_up_before(&mut self, config: &ConfigOf<Self>, input: &Input, ticks: u32) -> u32 {
        let faults = self.make_up(config, Self::Number::from_word(input.torque), ticks);
        if ticks > driveline::drive::MADE_UP {
            self.observer_mut().resync(input.angle);
        }
        faults.bits()
    }
}

impl<D: Composition> OverWords for D {}

/// What stands beside a drive: a panel between the ticks, or what comes before and after a tick. `()` for nothing.
pub trait Beside<D: OverWords>: Sized {
    /// The constants at the start: of a drive whose panel chooses between several, the first of them.
    fn constants(config: &'static ConfigOf<D>) -> &'static ConfigOf<D> {
        config
    }

    /// At the start, with the drive at rest.
    fn start(drive: &mut D, config: &ConfigOf<D>) -> Self;

    /// One tick.
    #[inline(always)]
    fn tick(&mut self, drive: &mut D, config: &ConfigOf<D>, input: &Input) -> Output {
        drive.advance(config, input)
    }

    /// What a panel or a terminal does between two ticks, as [`Scene::panel`]; it may choose other constants.
    fn panel(&mut self, _drive: &mut D, _config: &mut &'static ConfigOf<D>, _asked: [u32; 2]) -> u32 {
        0
    }

    /// As [`Variant::CHANNELS`].
    const CHANNELS: &'static [Channel<'static>] = &[];

    /// As [`Scene::channel`].
    fn channel(&self, _index: usize) -> u32 {
        0
    }

    /// A copy, as [`Scene::copy`].
    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<Self> {
        None
    }
}

impl<D: OverWords> Beside<D> for () {
    fn start(_: &mut D, _: &ConfigOf<D>) -> Self {}

    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<Self> {
        Some(())
    }
}

/// A drive with its constants, and what stands beside it.
///
/// While the governor is not released, `Input::reference` is the torque that the drive holds.
pub struct Composed<D: Composition<Config: 'static>, B = ()> {
    // By reference: folded into the code, the constants cost more instructions than loaded from a table.
    config: &'static ConfigOf<D>,
    drive: D,
    beside: B,
}

/// A drive with an observer and a speed loop.
pub type Governed<N, O> = Composed<Drive<N, O, SpeedLoop>>;

/// A drive with an observer and any governor.
pub type GovernedBy<N, O, G> = Composed<Drive<N, O, G>>;

impl<D: Composition<Config: 'static>, B> Composed<D, B> {
    /// The drive, to look at.
    pub fn drive(&self) -> &D {
        &self.drive
    }
}

impl<D, B> FromConfig for Composed<D, B>
where
    D: OverWords + Composition<Config: 'static> + Clone + 'static,
    B: Beside<D> + 'static,
{
    type Drive = D;
    const CHANNELS: &'static [Channel<'static>] = B::CHANNELS;

    fn from_config(config: &'static ConfigOf<D>) -> Self {
        let config = B::constants(config);
        // an incremental encoder counts from where it was switched on
        let mut drive = D::new(config, 0);
        let beside = B::start(&mut drive, config);
        Composed { config, drive, beside }
    }
}

impl<D, B> Scene for Composed<D, B>
where
    D: OverWords + Composition<Config: 'static> + Clone + 'static,
    B: Beside<D> + 'static,
{
    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        self.beside.tick(&mut self.drive, self.config, input)
    }

    fn panel(&mut self, asked: [u32; 2]) -> u32 {
        self.beside.panel(&mut self.drive, &mut self.config, asked)
    }

    #[cfg(not(target_os = "none"))]
    fn missed(&mut self, input: &Input, ticks: u32) -> u32 {
        self.drive.make_up_before(self.config, input, ticks)
    }

    fn channel(&self, index: usize) -> u32 {
        self.beside.channel(index)
    }

    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<alloc::boxed::Box<dyn Scene>> {
        let beside = self.beside.copy()?;
        Some(alloc::boxed::Box::new(Composed { config: self.config, drive: self.drive.clone(), beside }))
    }
}

/// A variant whose drive is an observer and a speed loop, for whom it is enough to know its parts.
pub trait GovernedVariant: 'static {
    /// Its number type.
    type Number: Number + 'static;
    /// Its observer.
    type Observer: Part<Self::Number, State: Observer<Self::Number>>;
    /// As [`Variant::NAME`].
    const NAME: &'static str;
    /// As [`Variant::RATE_HZ`].
    const RATE_HZ: u32;
    /// The drive's constants.
    const CONFIG: &'static ConfigOf<Drive<Self::Number, Self::Observer, SpeedLoop>>;
}

impl<M, N, O> GovernedVariant for Of<M, Governed<N, O>>
where
    M: 'static,
    N: Number + 'static,
    O: Part<N, State: Observer<N, Config: 'static>> + 'static,
    Governed<N, O>: FromConfig<Drive = Drive<N, O, SpeedLoop>>,
    Of<M, Governed<N, O>>: Constants<Scene = Governed<N, O>>,
{
    type Number = N;
    type Observer = O;
    const NAME: &'static str = <Self as Variant>::NAME;
    const RATE_HZ: u32 = <Self as Variant>::RATE_HZ;
    const CONFIG: &'static ConfigOf<Drive<N, O, SpeedLoop>> = <Self as Constants>::CONFIG;
}

/// Angle, torque and setpoint from words.
#[inline(always)]
pub(crate) fn sample<N: Number>(input: &Input) -> Sample<N> {
    Sample { angle: input.angle, torque: N::from_word(input.torque), setpoint: N::from_word(input.setpoint) }
}

/// A command and the estimates behind it as words.
#[inline(always)]
pub(crate) fn output<N: Number>(command: &Command<N>, estimate: &Estimate<N>) -> Output {
    Output {
        torque: command.torque.to_word(),
        motor_speed: estimate.motor_speed.to_word(),
        shaft_torque: estimate.shaft_torque.to_word(),
        load_speed: estimate.load_speed.to_word(),
        load_torque: estimate.load_torque.to_word(),
        faults: command.faults.bits(),
        instructions: 0,
        answer: 0,
    }
}
