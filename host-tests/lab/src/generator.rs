//! Full plants of the gensets, the standards' requirements, and their drives in closed loop.
//!
//! | term | meaning |
//! |---|---|
//! | rack | actuator of an engine's fuel; its position corresponds to a torque |
//! | steady band | width of the frequency's swing at constant load, of rated |
//! | drop, rise | deepest and highest frequency after a load came or went, less that before, of rated |
//! | recovery | from the load's change until the frequency stays within the band that is allowed |

pub mod diesel;
pub mod run;
pub mod set;
pub mod standard;
pub mod turbine;
