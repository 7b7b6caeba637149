//! Balancing: phasors on the tick, influence coefficients off it, weights, the procedure, in-run, the command.

mod by_itself;
mod disturbed_rotors;
mod holes;
mod in_run;
mod influence;
mod min_max;
mod modal;
mod never_harmful;
pub mod noise;
mod phasor;
mod polygon;
mod procedure;
mod rigid;
mod tolerance;
mod wrong_use;
