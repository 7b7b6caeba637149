use driveline::design::{Disturbance, Encoder, Rate, RigidDesign};
use driveline::machine::{Inertia, Rigid};

const OBSERVER: RigidDesign = Rigid::new(Inertia(0.6)).observer(
    Rate::hz(10_000),
    Encoder::lines(0),
    Disturbance { torque_accuracy: 0.5, load_torque_step: 50.0, within: 0.05 },
);

fn main() {
    let _ = OBSERVER;
}
