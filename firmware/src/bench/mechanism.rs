//! The step of the observer of a machine with a mechanism, on a press with a small flywheel.

use driveline::design::{Disturbance, Encoder, MechanismDesign, Rate};
use driveline::machine::{CrankSlider, DrivenMechanism, Inertia, Length, Mass, Mechanism};
use driveline::number::Fixed;
use driveline::observer::{self, MechanismConfig};
use driveline::settings::Bases;

use super::{Bench, steps};
use crate::board::Board;

const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.5), Inertia(4.0), Mass(4_000.0));
const PRESS: DrivenMechanism = DrivenMechanism::new(Inertia(0.5), &Mechanism::slider_crank(&RAM), 1, 11);
const DESIGN: MechanismDesign = PRESS.observer(
    Rate::hz(10_000),
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 1.0, load_torque_step: 60.0, within: 0.05 },
);
static SINGLE: MechanismConfig<f32> = MechanismConfig::<f32>::new(&DESIGN, Bases::SI);
static FIXED: MechanismConfig<Fixed> = MechanismConfig::<Fixed>::new(&DESIGN, Bases::rigid(1_200.0, 200.0));

/// The step in `f32`.
pub fn single<B: Board>(bench: &mut Bench<'_, B>) {
    steps::observer::<B, f32, observer::MechanismObserver<f32>>(bench, "step/mechanism", &SINGLE);
}

/// The step in fixed point.
pub fn fixed<B: Board>(bench: &mut Bench<'_, B>) {
    steps::observer::<B, Fixed, observer::MechanismObserver<Fixed>>(bench, "step/mechanism", &FIXED);
}
