//! The control loop round a scene's tick: one step on a board, the watch over the main loop, the records that it sends.

pub mod main_loop_watch;
pub mod step;
pub mod telemetry;
