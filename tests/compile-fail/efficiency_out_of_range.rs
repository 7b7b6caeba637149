use driveline::machine::{Chain, Efficiency, Inertia, Match, Ratio, TwoMass};

const MACHINE: TwoMass = Chain::motor(Inertia(0.62)).gear(Ratio(31.5), Efficiency(94.0)).rotor(Inertia(100.0)).reduce(Match::ResonanceAntiresonance);

fn main() {
    let _ = MACHINE;
}
