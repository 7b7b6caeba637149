//! What goes over the bus, and what becomes of every fault.

mod angle;
mod awaited;
mod balancing_head;
mod bus;
mod chips;
mod enable;
#[allow(dead_code, reason = "the firmware's file describes two machines")]
#[path = "../../../firmware/src/scenes/hoist/machine.rs"]
mod hoist;
#[allow(dead_code, reason = "the tests of the axis use more of it")]
#[path = "../../../tests/library/axis/scripted.rs"]
mod scripted;
mod torque;
mod vibration;
