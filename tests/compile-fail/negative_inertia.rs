use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness, TwoMass};

const MACHINE: TwoMass = Chain::motor(Inertia(0.62)).shaft(Stiffness(5.0e4), Damping(2.0)).rotor(Inertia(-0.08)).reduce(Match::ResonanceAntiresonance);

fn main() {
    let _ = MACHINE;
}
