//! Machines and the elementary functions of their constants.

mod chain;
mod scalar;
