//! Elements of machines in closed loop.

mod excited;
mod scenes;
