//! Machines, designs, observers, governors, measurement, learners, balancing and adapters, each against closed forms,
//! published tables or the full solver. Neither firmware nor QEMU is needed.

mod backlash;
mod balance;
mod cranked;
mod design;
mod elements;
mod fatigue;
mod fluctuation;
mod governor;
mod hal;
mod hoist;
mod learning;
mod lift;
mod machine;
mod recordings;
mod references;
mod scheduling;
mod tick;
mod wheel;
