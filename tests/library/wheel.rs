//! The toothed wheel: angle, place, phase and cycles, from simulated edges and from recordings.

mod angle;
mod cam;
pub mod edges;
mod law;
mod other_teeth;
mod recordings;
