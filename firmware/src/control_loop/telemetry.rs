//! Telemetry of a scene per tick: eight values as in the words of the link.

use driveline::telemetry::{Channel, Kind, Ring};

use crate::Words;
use crate::scene::{Input, Output, Variant};

/// Values a record.
pub const VALUES: usize = 8;

/// The ring between the tick and the main loop: 32 records of 36 bytes.
pub type Told = Ring<VALUES, 32>;

/// The values of a tick.
#[inline(always)]
pub fn values(input: &Input, output: &Output) -> [u32; VALUES] {
    [
        input.setpoint,
        input.angle,
        output.torque,
        output.motor_speed,
        output.shaft_torque,
        output.load_speed,
        output.load_torque,
        output.faults,
    ]
}

/// The channels of variant `V`; fixed point is sent per unit of the scene's bases.
pub const fn channels<V: Variant>() -> [Channel<'static>; VALUES] {
    let (kind, torque, speed) = match const { Words::of::<V>() } {
        Words::Single => (Kind::Single, "N m", "rad/s"),
        Words::Fixed => (Kind::Integer(1.0 / 268_435_456.0), "pu", "pu"),
    };
    [
        Channel { name: "reference", unit: speed, kind },
        Channel { name: "angle", unit: "turn", kind: Kind::Integer(1.0 / 4_294_967_296.0) },
        Channel { name: "torque", unit: torque, kind },
        Channel { name: "motor speed", unit: speed, kind },
        Channel { name: "shaft torque", unit: torque, kind },
        Channel { name: "load speed", unit: speed, kind },
        Channel { name: "load torque", unit: torque, kind },
        Channel { name: "faults", unit: "", kind: Kind::Integer(1.0) },
    ]
}
