//! Balancing: phasors on the tick, influence coefficients off it, weights, the procedure, in-run, the command.

mod command;
mod holes;
mod in_run;
mod influence;
mod left_out;
mod noise;
mod phasor;
mod procedure;
mod target;
mod tolerance;
mod wrong_use;
