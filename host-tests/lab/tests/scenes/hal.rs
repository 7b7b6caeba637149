//! Adapters to `embedded-hal`: what goes over the bus, and what becomes of every fault. Telemetry: what is told, and
//! what is lost. Parameters: what a power cut leaves.

mod nucleo;
mod turn;
