//! The steps of the observers and the whole tick, on the hoist's constants.

use driveline::configure::Machine;
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::number::{Fixed, Number};
use driveline::observer::{
    BacklashObserver, Gap, GearedObserver, Observer, RigidObserver, SemiImplicitObserver, Stiction, TwoMassObserver,
};
use driveline::sample::{Command, Sample};

use super::Bench;
use crate::board::Board;
use crate::control_loop::telemetry::{Told, VALUES};
use crate::measure::count::Measured;
use crate::scene::Of;
use crate::scene::composed::GovernedVariant;
use crate::scenes::blooming_mill::{Backlash, BloomingMill};
use crate::scenes::hoist::{Exact, Hoist, Reduced, Rigid};
use crate::self_test::backlash_inputs::Rattle;
use crate::self_test::inputs::Program;

/// The steps in `f32`.
pub fn single<B: Board>(bench: &mut Bench<'_, B>) {
    all::<B, f32, AtTenKilohertz<Exact<f32>>, AtTenKilohertz<Reduced<f32>>, AtTenKilohertz<Rigid<f32>>>(bench);
    backlash::<B, f32, Of<BloomingMill, Backlash<f32>>>(bench, |torque| torque);
}

/// The steps in fixed point.
pub fn fixed<B: Board>(bench: &mut Bench<'_, B>) {
    all::<B, Fixed, AtTenKilohertz<Exact<Fixed>>, AtTenKilohertz<Reduced<Fixed>>, AtTenKilohertz<Rigid<Fixed>>>(bench);
    // To 2^-24 of the base.
    let word =
        |torque: f32| Fixed::from_bits(((torque * (16_777_216.0 / BloomingMill::BASES.torque as f32)) as i32) << 4);
    backlash::<B, Fixed, Of<BloomingMill, Backlash<Fixed>>>(bench, word);
}

/// The hoist at 10 kHz.
type AtTenKilohertz<S> = Of<Hoist<10_000>, S>;

/// The observer of backlash on a machine that rattles through its gap: every regime, every crossing.
fn backlash<B: Board, N: Gap + 'static, V: GovernedVariant<Number = N, Observer = BacklashObserver>>(
    bench: &mut Bench<'_, B>,
    number: impl Fn(f32) -> N,
) {
    let config = &V::CONFIG.observer;
    let mut rattle = Rattle::new();
    let input = |_: &mut Program| {
        let (angle, torque) = rattle.next_input();
        (angle, number(torque))
    };
    bench.measure_step(
        "step/backlash",
        config,
        BacklashObserver::at_rest(config, 0, N::ZERO),
        input,
        step::<N, BacklashObserver<N>>,
    );
    let mut rattle = Rattle::new();
    let input = |inputs: &mut Program| {
        let (angle, torque) = rattle.next_input();
        // A bad sample now and then, as the other drives have.
        let bad = inputs.next_input();
        let setpoint = V::Number::from_word(bad.setpoint);
        Sample {
            angle: if bad.torque.is_multiple_of(64) { bad.angle } else { angle },
            torque: number(torque),
            setpoint,
        }
    };
    bench.measure("drive/backlash", (V::CONFIG, Drive::new(V::CONFIG, 0)), input, tick::<V>);
}

fn all<B, N, E, R, G>(bench: &mut Bench<'_, B>)
where
    B: Board,
    N: Stiction + 'static,
    E: GovernedVariant<Number = N, Observer = GearedObserver<TwoMassObserver>>,
    R: GovernedVariant<Number = N, Observer = GearedObserver<SemiImplicitObserver>>,
    G: GovernedVariant<Number = N, Observer = GearedObserver<RigidObserver>>,
{
    observer::<B, N, TwoMassObserver<N>>(bench, "step/exact", &E::CONFIG.observer.observer);
    observer::<B, N, SemiImplicitObserver<N>>(bench, "step/semi-implicit", &R::CONFIG.observer.observer);
    observer::<B, N, RigidObserver<N>>(bench, "step/rigid", &G::CONFIG.observer.observer);
    drive::<B, E>(bench, "drive/exact", tick::<E>);
    drive::<B, R>(bench, "drive/semi-implicit", tick::<R>);
    drive::<B, G>(bench, "drive/rigid", tick::<G>);
    drive::<B, E>(bench, "drive/exact/static", tick_of_static::<E>);
    drive::<B, R>(bench, "drive/semi-implicit/static", tick_of_static::<R>);
    // emptied after every hundredth record: kept and dropped ones alike
    let emptied = |inputs: &mut Program| {
        let input = inputs.next_input();
        if inputs.ticks().is_multiple_of(100) {
            while TOLD.take().is_some() {}
        }
        [input.angle, input.torque, input.setpoint, input.flags, 1, 2, 3, 4]
    };
    bench.measure("telemetry/record", (), emptied, told);
}

static TOLD: Told = Told::new();

#[inline(never)]
fn told(_: &mut (), values: &[u32; VALUES], _: &mut ()) {
    TOLD.record(values);
}

/// An observer's step: predict and correct, without the checks that the drive makes.
pub(super) fn observer<B: Board, N: Number, O: Observer<N>>(bench: &mut Bench<'_, B>, name: &str, config: &O::Config) {
    let input = |inputs: &mut Program| {
        let input = inputs.next_input();
        (input.angle, N::from_word(input.torque))
    };
    bench.measure_step(name, config, O::at_rest(config, 0, N::ZERO), input, step::<N, O>);
}

#[inline(never)]
fn step<N: Number, O: Observer<N>>(config: &O::Config, observer: &mut O, angle: u32, torque: N) {
    observer.step(config, angle, torque);
}

type Whole<V> = Drive<<V as GovernedVariant>::Number, <V as GovernedVariant>::Observer, SpeedLoop>;
type Constants<V> = ConfigOf<Whole<V>>;

/// A drive beside the constants that it refers to.
type Referring<'a, V> = (&'a Constants<V>, Whole<V>);

/// The whole tick, checks and flags included, good and bad samples alike.
fn drive<B: Board, V: GovernedVariant>(
    bench: &mut Bench<'_, B>,
    name: &str,
    tick: Measured<Referring<'static, V>, Sample<V::Number>, Command<V::Number>>,
) {
    let input = |inputs: &mut Program| {
        let input = inputs.next_input();
        let number = V::Number::from_word;
        Sample { angle: input.angle, torque: number(input.torque), setpoint: number(input.setpoint) }
    };
    bench.measure(name, (V::CONFIG, Drive::new(V::CONFIG, 0)), input, tick);
}

#[inline(never)]
fn tick<V: GovernedVariant>(
    drive: &mut Referring<'static, V>,
    sample: &Sample<V::Number>,
    command: &mut Command<V::Number>,
) {
    *command = drive.1.tick(drive.0, sample);
}

/// The same with constants that the compiler knows, which it writes into the code.
#[inline(never)]
fn tick_of_static<V: GovernedVariant>(
    drive: &mut Referring<'static, V>,
    sample: &Sample<V::Number>,
    command: &mut Command<V::Number>,
) {
    *command = drive.1.tick(V::CONFIG, sample);
}
