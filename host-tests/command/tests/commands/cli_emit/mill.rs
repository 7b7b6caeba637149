//! rolling mill: the machine and its controller, designed by the compiler.

use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
use driveline::machine::{Chain, Damping, Gap, Inertia, Match, Stiffness, TwoMass};

/// The machine, from the motor to the load.
pub const ROLLING_MILL: Chain = Chain::motor(Inertia(1450.0))
    .shaft(Stiffness(5900000.0), Damping(3000.0))
    .rotor(Inertia(150.0))
    .shaft(Stiffness(11000000.0), Damping(3000.0))
    .rotor(Inertia(310.0))
    .backlash(Gap(0.004))
    .shaft(Stiffness(3400000.0), Damping(2000.0))
    .rotor(Inertia(270.0));

/// The observer's model.
pub const ROLLING_MILL_MODEL: TwoMass = ROLLING_MILL.reduce(Match::ResonanceAntiresonance);

/// Ticks a second.
pub const ROLLING_MILL_RATE: Rate = Rate::hz(4000);

/// The observer.
pub const ROLLING_MILL_OBSERVER: TwoMassDesign = ROLLING_MILL_MODEL.observer(
    ROLLING_MILL_RATE,
    Encoder::lines(4096),
    Disturbance { torque_accuracy: 2000.0, load_torque_step: 100000.0, within: 0.5 },
);

/// The speed loop.
pub const ROLLING_MILL_SPEED_LOOP: SpeedLoopDesign = ROLLING_MILL_MODEL.speed_loop(ROLLING_MILL_RATE, SpeedLoopTuning::of(&ROLLING_MILL_MODEL));

/// Largest motor torque (N m).
pub const ROLLING_MILL_TORQUE: f64 = 400000.0;

/// Largest motor speed (rad/s).
pub const ROLLING_MILL_SPEED: f64 = 12.0;
