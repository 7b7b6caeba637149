use driveline::design::{Disturbance, Encoder, Rate, TwoMassDesign};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};

const MACHINE: TwoMass = TwoMass::new(Inertia(0.6), Inertia(0.1), Stiffness(0.0), Damping(0.0));
const OBSERVER: TwoMassDesign = MACHINE.observer(
    Rate::hz(10_000),
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 0.5, load_torque_step: 50.0, within: 0.05 },
);

fn main() {
    let _ = OBSERVER;
}
