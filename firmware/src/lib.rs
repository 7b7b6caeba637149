#![no_std]
#![warn(missing_docs)]
//! Scenes as a portable library, and the boards they are flashed onto.
//!
//! The same scenes build for the host, where the tests drive them, and for the target, where feature `target` adds
//! the start-up code, the board and the panic handler. [`scenes`] lists the variants; a binary holds the one that
//! `DRIVELINE_VARIANT` names.

#[cfg(not(target_os = "none"))]
extern crate alloc;

pub mod board;
pub mod control_loop;
pub mod panel;
pub mod scene;
pub mod scenes;
pub mod self_test;

#[cfg(all(feature = "target", target_arch = "arm"))]
pub mod bench;
#[cfg(all(feature = "target", target_arch = "arm"))]
pub mod measure;

pub use scene::table::Words;
