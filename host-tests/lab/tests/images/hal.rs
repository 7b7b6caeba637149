//! Boards and telemetry in images.

mod boards;
mod telemetry;
