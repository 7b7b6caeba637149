//! Machines, designs, observers, governors, measurement, learners, balancing and the axis, each against closed forms,
//! published tables or the full solver. Neither firmware nor QEMU is needed.

mod actuated;
mod adaptive;
mod axis;
mod backlash;
mod balance;
mod citations;
mod design;
mod elements;
mod fatigue;
mod flash;
mod fluctuation;
mod governor;
mod hoist;
mod learning;
mod lift;
mod machine;
mod mechanism;
mod noise;
mod parameters;
mod recordings;
mod references;
mod runge_kutta;
mod scheduling;
mod tick;
mod wheel;
