#![no_std]
#![forbid(unsafe_code)]
#![warn(missing_docs)]
//! Controllers for machine drives.

pub mod design;
pub mod machine;
pub mod scalar;
