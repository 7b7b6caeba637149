//! The toothed wheel: the interrupt of a tooth, with the times of a cycle recorded and without, and the angle in the
//! tick. A 60-2 wheel whose speed swings and whose edges jitter by some hundredths of a pitch.

use driveline::settings::{Teeth, ToothClock};
use driveline::wheel::{CycleTimes, ToothRecord, ToothedWheel, ToothedWheelConfig};

use super::Bench;
use crate::Words;
use crate::board::Board;
use crate::self_test::fingerprint::SEED;
use crate::self_test::inputs::Program;

static WHEEL: ToothedWheelConfig<58> =
    ToothedWheelConfig::new(&Teeth::gap(60, 2), ToothClock { turns: 1, clock: 1e6, lowest_speed: 1.0 });

/// All of it.
pub fn all<B: Board>(bench: &mut Bench<'_, B>) {
    part::<B, ()>(bench, "wheel/tooth", tooth);
    part::<B, CycleTimes<58>>(bench, "wheel/recorded", tooth);
    part::<B, ()>(bench, "wheel/angle", angle);
}

fn part<B: Board, R: ToothRecord + Default + 'static>(
    bench: &mut Bench<'_, B>,
    name: &str,
    measured: fn(&mut ToothedWheel<R>, &u32, &mut u32),
) {
    let (mut place, mut time) = (0_u32, 0_u32);
    let mut wheel = ToothedWheel::<R>::default();
    let mut input = move |inputs: &mut Program| {
        // Up for half a turn and down for the other.
        let swing = if place < 30 { place } else { 60 - place };
        time = time.wrapping_add(if place == 57 { 3 } else { 1 } * (2_000 + 4 * swing));
        place = if place == 57 { 0 } else { place + 1 };
        time.wrapping_add(inputs.next_word() & 63)
    };
    // Three turns: the place is known from then on.
    let mut inputs = Program::new(SEED, Words::Fixed);
    for _ in 0..180 {
        wheel.tooth(&WHEEL, input(&mut inputs));
    }
    bench.measure(name, wheel, input, measured);
}

#[inline(never)]
fn tooth<R: ToothRecord>(wheel: &mut ToothedWheel<R>, time: &u32, _: &mut u32) {
    wheel.tooth(&WHEEL, *time);
}

#[inline(never)]
fn angle<R: ToothRecord>(wheel: &mut ToothedWheel<R>, time: &u32, angle: &mut u32) {
    *angle = wheel.at(&WHEEL, *time).map_or(0, |angle| angle.angle);
}
