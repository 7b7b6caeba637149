//! Firmware images: built, read and run in QEMU.

mod balance;
mod export;
mod fmu;
mod hal;
mod image;
mod leave_out;
mod link;
mod link_log;
mod new_project;
mod panic;
