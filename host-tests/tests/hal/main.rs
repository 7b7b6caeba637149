//! Adapters to `embedded-hal`: what goes over the bus, and what becomes of every fault. Telemetry: what is told, and what is lost.

mod angle;
mod axis;
mod bus;
mod enable;
mod table;
mod telemetry;
mod torque;
mod vibration;
mod wheel;
