//! The step of the observer of a cranked machine, on a press with a small flywheel.

use driveline::design::{CrankedDesign, Disturbance, Encoder, Rate};
use driveline::machine::{CrankSlider, Cranked, Inertia, Length, Mass};
use driveline::number::Fixed;
use driveline::observer::{self, CrankConfig};
use driveline::settings::Bases;

use super::{Bench, steps};
use crate::board::Board;

const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.5), Inertia(4.0), Mass(4_000.0));
const PRESS: Cranked = Cranked::new(Inertia(0.5), &RAM, 1, 11);
const DESIGN: CrankedDesign = PRESS.observer(
    Rate::hz(10_000),
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 1.0, load_torque_step: 60.0, within: 0.05 },
);
static SINGLE: CrankConfig<f32> = CrankConfig::<f32>::new(&DESIGN, Bases::SI);
static FIXED: CrankConfig<Fixed> = CrankConfig::<Fixed>::new(&DESIGN, Bases::rigid(1_200.0, 200.0));

/// The step in `f32`.
pub fn single<B: Board>(bench: &mut Bench<'_, B>) {
    steps::observer::<B, f32, observer::CrankObserver<f32>>(bench, "step/cranked", &SINGLE);
}

/// The step in fixed point.
pub fn fixed<B: Board>(bench: &mut Bench<'_, B>) {
    steps::observer::<B, Fixed, observer::CrankObserver<Fixed>>(bench, "step/cranked", &FIXED);
}
