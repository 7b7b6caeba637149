//! Adapters to `embedded-hal`: what goes over the bus, and what becomes of every fault.

mod angle;
mod axis;
mod bus;
mod enable;
mod table;
mod torque;
mod vibration;
mod wheel;
