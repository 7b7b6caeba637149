//! feed axis: the machine and its controller, designed by the compiler.

use driveline::design::{Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign};
use driveline::machine::{Belt, Chain, Damping, Diameter, Efficiency, Inertia, Length, LinearDamping, Mass, Match, Section, ShearModulus, Stiffness, TwoMass};

/// The machine, from the motor to the load.
pub const FEED_AXIS: Chain = Chain::motor(Inertia(0.0045))
    .rotor(Inertia(0.0008))
    .belt(Belt { driving: Diameter(0.06), driven: Diameter(0.12), strand: Stiffness(900000.0), damping: LinearDamping(150.0), efficiency: Efficiency(0.97) })
    .rotor(Inertia(0.006))
    .shaft(Section::tapered(Length(0.08), Diameter(0.025), Diameter(0.025)).bored(Diameter(0.0)).stiffness(ShearModulus(79300000000.0)), Damping(1.0))
    .shaft(Section::tapered(Length(0.7), Diameter(0.036), Diameter(0.036)).bored(Diameter(0.012)).stiffness(ShearModulus(79300000000.0)), Damping(1.0))
    .rotor(Inertia(0.0009))
    .screw(Length(0.016))
    .driven(Mass(600.0));

/// The observer's model.
pub const FEED_AXIS_MODEL: TwoMass = FEED_AXIS.reduce(Match::ResonanceAntiresonance);

/// Ticks a second.
pub const FEED_AXIS_RATE: Rate = Rate::hz(10000);

/// The observer.
pub const FEED_AXIS_OBSERVER: TwoMassDesign = FEED_AXIS_MODEL.observer(
    FEED_AXIS_RATE,
    Encoder::lines(4096),
    Disturbance { torque_accuracy: 0.3, load_torque_step: 10.0, within: 1.0 },
);

/// The speed loop.
pub const FEED_AXIS_SPEED_LOOP: SpeedLoopDesign = FEED_AXIS_MODEL.speed_loop(FEED_AXIS_RATE, SpeedLoopTuning::of(&FEED_AXIS_MODEL));

/// Largest motor torque (N m).
pub const FEED_AXIS_TORQUE: f64 = 60.0;

/// Largest motor speed (rad/s).
pub const FEED_AXIS_SPEED: f64 = 300.0;
