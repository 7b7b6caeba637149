//! The machine `hoist`, as `machine.toml` described it when this project was written.

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder};
use driveline::machine::{Chain, Damping, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Ratio, Speed, Stiffness, Torque};

/// The machine, from the motor to the load. The other constants of `Machine` follow from these; name one to override
/// it.
pub struct Hoist;

impl Machine for Hoist {
    const CHAIN: Chain = Chain::motor(Inertia(0.62))
        .shaft(Stiffness(50000.0), Damping(2.0))
        .rotor(Inertia(0.08))
        .gear(Ratio(31.5), Efficiency(0.94))
        .drum(Diameter(0.8))
        .damped_rope(Falls(2), Stiffness(2900000.0), LinearDamping(3600.0))
        .lifted(Mass(12000.0));
    /// Rated torque, largest speed and largest torque of the file.
    const RATING: Rating =
        Rating { torque: Torque(675.0), speed: Speed(155.0), torque_limit: Torque(1350.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10000;
    const DISTURBANCE: Disturbance =
        Disturbance { torque_accuracy: 7.5, load_torque_step: 300.0, within: 50.0 };
}
