//! The full solver against closed forms, published numbers and itself by other means.

mod chain;
mod rotor;
mod train;
mod vibration;
