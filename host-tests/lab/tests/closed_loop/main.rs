//! Drives in closed loop with the full solver: scenes, generator sets, balancing, commissioning, stiff steps, cases.

mod backlash;
mod cases;
mod commission;
mod elements;
mod fluctuation;
mod generator;
mod load_sharing;
mod rotor;
mod stiff;
