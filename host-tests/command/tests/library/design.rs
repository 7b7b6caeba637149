//! Designs against closed forms and high-precision arithmetic.

mod approximate;
mod closed_loop;
mod defaults;
mod encoder;
mod kalman;
mod matrix;
mod observer;
mod speed_loop;
mod step;
