use driveline::fluctuation::Extremes;
use driveline::prelude::*;

struct Fan;

impl Machine for Fan {
    const CHAIN: Chain = Chain::motor(Inertia(0.2)).shaft(Stiffness(2.0e3), Damping(0.0)).rotor(Inertia(0.5));
    const RATING: Rating = Rating { torque: Torque(70.0), speed: Speed(150.0), torque_limit: Torque(110.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 2_000;
}

// 84 ticks on a turn
type FanDrive = Drive<f32, TwoMassObserver, SpeedLoop, Extremes>;
static CONFIG: ConfigOf<FanDrive> = FanDrive::configure::<Fan>();

fn main() {
    FanDrive::new(&CONFIG, 0);
}
