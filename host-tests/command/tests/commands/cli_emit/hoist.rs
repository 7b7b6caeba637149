//! hoist: the machine and its controller, designed by the compiler.

use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
use driveline::machine::{Chain, Damping, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Match, Ratio, Stiffness, TwoMass};

/// The machine, from the motor to the load.
pub const HOIST: Chain = Chain::motor(Inertia(0.62))
    .shaft(Stiffness(50000.0), Damping(2.0))
    .rotor(Inertia(0.08))
    .gear(Ratio(31.5), Efficiency(0.94))
    .drum(Diameter(0.8))
    .damped_rope(Falls(2), Stiffness(2900000.0), LinearDamping(3600.0))
    .lifted(Mass(12000.0));

/// The observer's model.
pub const HOIST_MODEL: TwoMass = HOIST.reduce(Match::ResonanceAntiresonance);

/// Ticks a second.
pub const HOIST_RATE: Rate = Rate::hz(10000);

/// The observer.
pub const HOIST_OBSERVER: TwoMassDesign = HOIST_MODEL.observer(
    HOIST_RATE,
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 7.5, load_torque_step: 300.0, within: 50.0 },
);

/// The speed loop.
pub const HOIST_SPEED_LOOP: SpeedLoopDesign = HOIST_MODEL.speed_loop(HOIST_RATE, SpeedLoopTuning::of(&HOIST_MODEL));

/// Largest motor torque (N m).
pub const HOIST_TORQUE: f64 = 1350.0;

/// Largest motor speed (rad/s).
pub const HOIST_SPEED: f64 = 155.0;
