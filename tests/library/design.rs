//! Designs against closed forms and high-precision arithmetic.

mod approximate;
mod kalman;
mod matrix;
mod nodes;
mod observer;
mod predicted;
mod speed_loop;
mod step;
mod undescribed;
