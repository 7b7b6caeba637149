use driveline::design::{Disturbance, Encoder, Rate, TwoMassDesign};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};

// 713 Hz, sampled at 1 kHz.
const MACHINE: TwoMass = TwoMass::new(Inertia(0.005), Inertia(0.005), Stiffness(50_000.0), Damping(0.01));
const OBSERVER: TwoMassDesign = MACHINE.observer(
    Rate::hz(1000),
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 0.02, load_torque_step: 14.0, within: 0.02 },
);

fn main() {
    let _ = OBSERVER;
}
