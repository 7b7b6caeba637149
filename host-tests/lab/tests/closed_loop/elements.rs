//! Elements of machines in closed loop.

mod scenes;
