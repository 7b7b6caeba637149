//! Firmware images: built, read and run in QEMU.

/// Each test is called by this name too: `check` runs them beside all others.
#[path = "."]
mod images {
    mod balance;
    mod cosim;
    mod export;
    mod fmu;
    mod hal;
    mod image;
    mod leave_out;
    mod link;
    mod link_log;
    mod new_project;
    mod packages;
    mod panic;
    mod python;
}
