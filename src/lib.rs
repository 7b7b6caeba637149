#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Controllers for machine drives: shaft torque, load speed and load torque estimated from the motor's side alone.

pub mod balance;
pub mod constants;
pub mod design;
pub mod drive;
pub mod fault;
pub mod fluctuation;
pub mod governor;
pub mod machine;
pub mod number;
pub mod observer;
pub mod sample;
pub mod scalar;
