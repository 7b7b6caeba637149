//! The measurement of the rotor's vibration, of one channel and of two.

use driveline::angle::Synchronous;
use driveline::balancing::{Balancer, Phasors, PhasorsConfig};
use driveline::number::Fixed;
use driveline::settings::PhasorSettings;

use super::Bench;
use crate::board::Board;
use crate::self_test::inputs::Program;

/// A rotor behind a gear, a block every second turn so that both occur among the calls: the end of a block, and a
/// turn's end within one, which is the longest tick of a single channel.
const GEARED: PhasorSettings = PhasorSettings { rotor_turns: 31, motor_turns: 47, turns: 2, ..PhasorSettings::DIRECT };

static SINGLE: (PhasorsConfig<f32, 1>, PhasorsConfig<f32, 2>) =
    (PhasorsConfig::<f32, 1>::new(&GEARED, [7.5]), PhasorsConfig::<f32, 2>::new(&GEARED, [7.5; 2]));
static FIXED: (PhasorsConfig<Fixed, 1>, PhasorsConfig<Fixed, 2>) =
    (PhasorsConfig::<Fixed, 1>::new(&GEARED, [0.45]), PhasorsConfig::<Fixed, 2>::new(&GEARED, [0.45; 2]));

/// In `f32`.
pub fn single<B: Board>(bench: &mut Bench<'_, B>) {
    channels::<B, f32, 1>(bench, "phasor/1", &SINGLE.0);
    channels::<B, f32, 2>(bench, "phasor/2", &SINGLE.1);
}

/// In fixed point.
pub fn fixed<B: Board>(bench: &mut Bench<'_, B>) {
    channels::<B, Fixed, 1>(bench, "phasor/1", &FIXED.0);
    channels::<B, Fixed, 2>(bench, "phasor/2", &FIXED.1);
}

type State<N, const C: usize> = (&'static PhasorsConfig<N, C>, Phasors<C, 9, N>);

fn channels<B: Board, N: Synchronous + 'static, const C: usize>(
    bench: &mut Bench<'_, B>,
    name: &str,
    config: &'static PhasorsConfig<N, C>,
) {
    let input = |inputs: &mut Program| {
        let input = inputs.next_input();
        (input.angle, input.vibration.map(N::from_word))
    };
    bench.measure(name, (config, Phasors::default()), input, measure::<N, C>);
}

#[inline(never)]
fn measure<N: Synchronous, const C: usize>(state: &mut State<N, C>, input: &(u32, [N; 2]), _: &mut ()) {
    if let Some(vibration) = input.1.first_chunk() {
        state.1.measure(state.0, input.0, vibration);
    }
}
