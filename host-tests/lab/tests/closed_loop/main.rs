//! Drives in closed loop with the full solver: scenes, generator sets, balancing, commissioning, cases, extremes.

mod backlash;
mod cases;
mod commission;
mod elements;
mod extremes;
mod fluctuation;
mod generator;
mod load_sharing;
mod rotor;
mod winch;
