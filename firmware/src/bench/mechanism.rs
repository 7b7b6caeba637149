//! The step of the observer of a machine with a mechanism, on a press with a small flywheel, and the limit of the force
//! at its tool.

use driveline::design::{Disturbance, Encoder, MechanismDesign, Rate};
use driveline::machine::{CrankSlider, DrivenMechanism, Inertia, Length, Mass, Mechanism};
use driveline::number::{Fixed, Number};
use driveline::observer::{self, ForceLimit, ForceLimitConfig, MechanismConfig};
use driveline::sample::Estimate;
use driveline::settings::Bases;

use super::{Bench, steps};
use crate::board::Board;
use crate::self_test::inputs::Program;

const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.5), Inertia(4.0), Mass(4_000.0));
const PRESS: DrivenMechanism = DrivenMechanism::new(Inertia(0.5), &Mechanism::slider_crank(&RAM), 1, 11);
const DESIGN: MechanismDesign = PRESS.observer(
    Rate::hz(10_000),
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 1.0, load_torque_step: 60.0, within: 0.05 },
);
const BASES: Bases = Bases::rigid(1_200.0, 200.0);
static SINGLE: MechanismConfig<f32> = MechanismConfig::<f32>::new(&DESIGN, Bases::SI);
static FIXED: MechanismConfig<Fixed> = MechanismConfig::<Fixed>::new(&DESIGN, BASES);
static SINGLE_LIMIT: ForceLimitConfig<f32> = ForceLimitConfig::<f32>::new(&DESIGN, 100e3, 20.0, 0.25, Bases::SI);
static FIXED_LIMIT: ForceLimitConfig<Fixed> = ForceLimitConfig::<Fixed>::new(&DESIGN, 100e3, 20.0, 0.25, BASES);

/// The step in `f32`.
pub fn single<B: Board>(bench: &mut Bench<'_, B>) {
    steps::observer::<B, f32, observer::MechanismObserver<f32>>(bench, "step/mechanism", &SINGLE);
    limit(bench, &SINGLE_LIMIT);
}

/// The step in fixed point.
pub fn fixed<B: Board>(bench: &mut Bench<'_, B>) {
    steps::observer::<B, Fixed, observer::MechanismObserver<Fixed>>(bench, "step/mechanism", &FIXED);
    limit(bench, &FIXED_LIMIT);
}

type State<N> = (&'static ForceLimitConfig<N>, ForceLimit<N>);

fn limit<B: Board, N: Number + 'static>(bench: &mut Bench<'_, B>, config: &'static ForceLimitConfig<N>) {
    let input = |inputs: &mut Program| {
        let [leverage, load_torque] = [inputs.next_word(), inputs.next_word()].map(N::fraction);
        (leverage, Estimate { load_torque, ..Estimate::default() })
    };
    bench.measure("step/force-limit", (config, ForceLimit::default()), input, judge::<N>);
}

#[inline(never)]
fn judge<N: Number>((config, limit): &mut State<N>, (leverage, estimate): &(N, Estimate<N>), beyond: &mut bool) {
    *beyond = limit.is_exceeded(config, *leverage, estimate);
}
