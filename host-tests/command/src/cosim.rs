//! FMUs for co-simulation: unpacked, read, and run in a closed loop with a drive.
//!
//! `description` reads `modelDescription.xml`, `fmi` calls the functions of FMI 2.0 and 3.0, `fmu` opens a file, and
//! `closed_loop` runs a drive against a machine. All `unsafe` code is in `fmi`.

pub mod closed_loop;
pub mod description;
#[allow(unsafe_code)]
mod fmi;
pub mod fmu;
