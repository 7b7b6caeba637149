//! Designs against closed forms and high-precision arithmetic.

mod approximate;
mod encoder;
mod kalman;
mod matrix;
mod observer;
mod speed_loop;
mod step;
