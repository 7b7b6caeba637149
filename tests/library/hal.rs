//! Adapters to `embedded-hal`: what goes over the bus, and what becomes of every fault. Telemetry: what is told, and
//! what is lost. Parameters: what a power cut leaves.

mod angle;
mod awaited;
mod axis;
mod bus;
mod chips;
mod enable;
mod missed;
mod parameters;
mod table;
mod torque;
mod vibration;
