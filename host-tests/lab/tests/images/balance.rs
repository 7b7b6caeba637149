//! Balancing in images.

mod left_out;
mod target;
