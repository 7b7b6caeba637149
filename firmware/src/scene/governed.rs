//! A governed drive as a scene: the words of the link on one side, the library on the other.

use driveline::balancing::Balancer;
use driveline::drive::{ConfigOf, Drive};
use driveline::fluctuation::Fluctuation;
use driveline::governor::{Governor, SpeedLoop};
use driveline::number::Number;
use driveline::observer::Observer;
use driveline::sample::{Command, Estimate, Sample};

use crate::scene::expected::Expected;
use crate::scene::{Input, Output, Scene};

/// The parts and constants of one variant of a scene.
pub trait Variant: 'static {
    /// What it calculates with.
    type Number: Number + 'static;
    /// What it estimates with.
    type Observer: Observer<Self::Number>;
    /// Scene, number, observer and rate.
    const NAME: &'static str;
    /// Ticks a second.
    const RATE_HZ: u32;
    /// The drive's constants.
    const CONFIG: &'static ConfigOf<Drive<Self::Number, Self::Observer, (), SpeedLoop<Self::Number>>>;

    /// What the observer's design says of its errors, as [`Scene::expected`].
    fn expected() -> Option<Expected> {
        None
    }
}

/// Implements [`Variant`] for a scene, in `f32` and in fixed point, with each of the observers that are named.
///
/// The scene's module has `SCREENING`, `LOOP` (the speed loop's design), `SETTINGS`, `BASES` and `RATE_HZ`; `behind GEAR` puts each observer behind a gear
/// with losses.
macro_rules! governed {
    ($scene:ident, $name:literal, $rate:literal; $($text:literal: $observer:ident, $config:ident($($design:expr),+);)+) => {
        $(
            $crate::scene::governed::governed!(@variant $scene, $name, $rate, $text, "f32", f32,
                observer::$observer<f32>, $config::<f32>::new($($design),+, Bases::SI); $($design),+; Bases::SI);
            $crate::scene::governed::governed!(@variant $scene, $name, $rate, $text, "fixed", Fixed,
                observer::$observer<Fixed>, $config::<Fixed>::new($($design),+, BASES); $($design),+; BASES);
        )+
    };
    ($scene:ident, $name:literal, $rate:literal, behind $gear:ident;
     $($text:literal: $observer:ident, $config:ident($($design:expr),+);)+) => {
        $(
            $crate::scene::governed::governed!(@variant $scene, $name, $rate, $text, "f32", f32,
                observer::GearedObserver<observer::$observer<f32>>,
                GearedConfig::<f32, _>::new($config::<f32>::new($($design),+, Bases::SI), &$gear, 1.0 / $rate as f64, Bases::SI);
                $($design),+; Bases::SI);
            $crate::scene::governed::governed!(@variant $scene, $name, $rate, $text, "fixed", Fixed,
                observer::GearedObserver<observer::$observer<Fixed>>,
                GearedConfig::<Fixed, _>::new($config::<Fixed>::new($($design),+, BASES), &$gear, 1.0 / $rate as f64, BASES);
                $($design),+; BASES);
        )+
    };
    (@variant $scene:ident, $name:literal, $rate:literal, $text:literal, $words:literal, $number:ident,
     $observer:ty, $config:expr; $first:expr $(, $more:expr)*; $bases:expr) => {
        impl $crate::scene::governed::Variant for $scene<$number, $observer> {
            type Number = $number;
            type Observer = $observer;
            const NAME: &'static str = concat!($name, "/", $words, "/", $text, "/", $rate);
            const RATE_HZ: u32 = $rate;
            const CONFIG: &'static ConfigOf<driveline::drive::Drive<$number, $observer, (), SpeedLoop<$number>>> = &Config {
                limits: Limits::<$number>::new(&SCREENING, $bases),
                observer: $config,
                fluctuation: (),
                governor: SpeedLoopConfig::<$number>::new(&LOOP, SETTINGS, $bases),
                balancer: (),
            };

            fn expected() -> Option<$crate::scene::expected::Expected> {
                Some($crate::scene::expected::Expects::expected($first))
            }
        }
    };
}
pub(crate) use governed;

/// A drive with its constants.
///
/// While the governor is not released, [`Input::reference`] is the torque that the drive holds.
pub struct Governed<V: Variant> {
    // By reference: folded into the code, the constants cost more instructions than loaded from a table.
    config: &'static ConfigOf<Drive<V::Number, V::Observer, (), SpeedLoop<V::Number>>>,
    drive: Drive<V::Number, V::Observer, (), SpeedLoop<V::Number>>,
}

impl<V: Variant> Scene for Governed<V> {
    const NAME: &'static str = V::NAME;
    const RATE_HZ: u32 = V::RATE_HZ;

    fn expected() -> Option<Expected> {
        V::expected()
    }

    fn new() -> Self {
        // An incremental encoder counts from where it was switched on.
        Governed { config: V::CONFIG, drive: Drive::new(V::CONFIG, 0) }
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        advance(&mut self.drive, self.config, input)
    }
}

/// One tick of a drive, whatever its parts: at work where it is released, else held, with the setpoint's word as the torque.
#[inline(always)]
pub(crate) fn advance<N, O, F, G, B>(
    drive: &mut Drive<N, O, F, G, B>,
    config: &ConfigOf<Drive<N, O, F, G, B>>,
    input: &Input,
) -> Output
where
    N: Number,
    O: Observer<N>,
    F: Fluctuation<N>,
    G: Governor<N>,
    B: Balancer<N>,
{
    let setpoint = N::from_word(input.setpoint);
    let command = if input.flags & Input::RELEASED != 0 {
        drive.tick(config, &Sample { angle: input.angle, torque: N::from_word(input.torque), setpoint })
    } else {
        drive.hold(config, input.angle, setpoint)
    };
    output(&command, &drive.estimate(config))
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
