//! The full solver, the link to QEMU, the report.

pub mod plant;
