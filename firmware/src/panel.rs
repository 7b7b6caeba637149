//! Operator panels: requests of a terminal between two ticks, and their answers.

pub mod axis_panel;
pub mod balancing_head;
pub mod flash_model;
pub mod fluctuation;
pub mod life;
pub mod operator;
pub mod serial_request;
pub mod trial_weights;
