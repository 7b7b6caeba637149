//! The library with the firmware's scenes: what needs the firmware, its host runs or the command.

mod backlash;
mod design;
mod fatigue;
mod fuzz;
mod governor;
mod hal;
mod logged;
mod proof;
mod tick;
