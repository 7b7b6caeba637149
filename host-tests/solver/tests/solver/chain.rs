//! Chains.

mod closed_forms;
mod converge;
mod lockstep;
mod modes;
mod random;
