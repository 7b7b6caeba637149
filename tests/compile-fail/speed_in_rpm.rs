use driveline::prelude::*;

struct Roll;

impl Machine for Roll {
    const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
    const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(1_480.0), torque_limit: Torque(550.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
}

type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();

fn main() {
    RollDrive::new(&CONFIG, 0);
}
