use driveline::machine::{Chain, Damping, Inertia, Stiffness};

const MACHINE: Chain = Chain::motor(Inertia(0.62)).shaft(Stiffness(5.0e4), Damping(2.0)).rotor(Inertia(-0.08));

fn main() {
    let _ = MACHINE;
}
