//! The library on the host: machines, designs, observers, governors, balancing, adapters, the tick.

mod backlash;
mod balance;
mod cranked;
mod design;
mod elements;
mod fatigue;
mod fluctuation;
mod fuzz;
mod governor;
mod hal;
mod learning;
mod lift;
mod logged;
mod machine;
mod recordings;
#[path = "../references/mod.rs"]
mod references;
mod scheduling;
mod tick;
mod wheel;
