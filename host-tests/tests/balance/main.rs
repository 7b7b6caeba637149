//! Balancing: phasors on the tick, influence coefficients off it, weights, the procedure, in-run, the command.

mod influence;
mod noise;
mod phasor;
