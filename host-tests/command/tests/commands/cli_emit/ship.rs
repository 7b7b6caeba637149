//! twin screw ship: the machine and its controller, designed by the compiler.

use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
use driveline::machine::{Chain, Damping, Efficiency, Inertia, Match, Ratio, Stiffness, Train, TwoMass};

/// The machine, from the motor to the load.
pub const TWIN_SCREW_SHIP: Train = Train::of(
    Chain::motor(Inertia(3200.0))
        .shaft(Stiffness(4272566.008882118), Damping(0.0))
        .rotor(Inertia(400.0))
)
.branch(
    1,
    Ratio(1.0),
    Chain::motor(Inertia(f64::MIN_POSITIVE))
        .gear(Ratio(1.6), Efficiency(1.0))
        .rotor(Inertia(800.0))
        .shaft(Stiffness(7450763.826873114), Damping(0.0))
        .rotor(Inertia(450.0)),
)
.branch(
    1,
    Ratio(1.0),
    Chain::motor(Inertia(f64::MIN_POSITIVE))
        .gear(Ratio(1.6), Efficiency(1.0))
        .rotor(Inertia(800.0))
        .shaft(Stiffness(7450763.826873114), Damping(0.0))
        .rotor(Inertia(450.0)),
);

/// The observer's model.
pub const TWIN_SCREW_SHIP_MODEL: TwoMass = TWIN_SCREW_SHIP.reduce(Match::ResonanceAntiresonance);

/// Ticks a second.
pub const TWIN_SCREW_SHIP_RATE: Rate = Rate::hz(2000);

/// The observer.
pub const TWIN_SCREW_SHIP_OBSERVER: TwoMassDesign = TWIN_SCREW_SHIP_MODEL.observer(
    TWIN_SCREW_SHIP_RATE,
    Encoder::lines(2048),
    Disturbance { torque_accuracy: 500.0, load_torque_step: 20000.0, within: 1.0 },
);

/// The speed loop.
pub const TWIN_SCREW_SHIP_SPEED_LOOP: SpeedLoopDesign = TWIN_SCREW_SHIP_MODEL.speed_loop(TWIN_SCREW_SHIP_RATE, SpeedLoopTuning::of(&TWIN_SCREW_SHIP_MODEL));

/// Largest motor torque (N m).
pub const TWIN_SCREW_SHIP_TORQUE: f64 = 100000.0;

/// Largest motor speed (rad/s).
pub const TWIN_SCREW_SHIP_SPEED: f64 = 60.0;
