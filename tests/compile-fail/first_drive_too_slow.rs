use driveline::prelude::*;

struct Spindle;

impl Machine for Spindle {
    const CHAIN: Chain = Chain::motor(Inertia(0.01)).shaft(Stiffness(2.0e5), Damping(0.0)).rotor(Inertia(0.01));
    const RATING: Rating = Rating { torque: Torque(70.0), speed: Speed(300.0), torque_limit: Torque(110.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 1_000;
}

type SpindleDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
static CONFIG: ConfigOf<SpindleDrive> = SpindleDrive::configure::<Spindle>();

fn main() {
    SpindleDrive::new(&CONFIG, 0);
}
