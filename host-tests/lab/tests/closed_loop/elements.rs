//! Elements of machines in closed loop.

mod eased;
mod excited;
mod scenes;
mod stepped;
