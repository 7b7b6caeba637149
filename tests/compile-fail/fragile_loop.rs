use driveline::design::SpeedLoopTuning;
use driveline::prelude::*;

struct Mill;

impl Machine for Mill {
    const CHAIN: Chain = Chain::motor(Inertia(3.0)).shaft(Stiffness(4.0e3), Damping(2.0)).rotor(Inertia(4.0));
    const RATING: Rating = Rating { torque: Torque(400.0), speed: Speed(100.0), torque_limit: Torque(800.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 4_000;
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.4, damping: 1.0, shaft_damping: 0.9 };
}

type MillDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
static CONFIG: ConfigOf<MillDrive> = MillDrive::configure::<Mill>();

fn main() {
    MillDrive::new(&CONFIG, 0);
}
