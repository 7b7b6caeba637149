//! Designs against closed forms and high-precision arithmetic.

mod closed_loop;
mod draws;
mod encoder;
