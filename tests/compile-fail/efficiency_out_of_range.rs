use driveline::machine::{Chain, Efficiency, Inertia, Ratio};

const MACHINE: Chain = Chain::motor(Inertia(0.62)).gear(Ratio(31.5), Efficiency(94.0)).rotor(Inertia(100.0));

fn main() {
    let _ = MACHINE;
}
