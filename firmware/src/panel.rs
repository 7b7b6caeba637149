//! The panels: what a terminal asks between two ticks, and what answers it.

pub mod balancing_head;
pub mod flash_model;
pub mod serial_request;
pub mod trial_weights;
