//! Firmware images of `driveline`: built, linked to the host in QEMU, measured; and the set-up of a machine for that.

pub mod cache;
pub mod children;
pub mod clone;
pub mod image;
pub mod link;
pub mod measure;
pub mod setup;
