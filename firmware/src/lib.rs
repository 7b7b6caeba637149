#![no_std]
#![warn(missing_docs)]
//! Scenes as a portable library, and the boards they are flashed onto.
//!
//! The same scenes build for the host, where the tests drive them, and for the target, where feature `target` adds
//! the start-up code, the board and the panic handler. [`selected`] lists the variants; a binary holds the one that `DRIVELINE_VARIANT` names.

pub mod asking;
pub mod assembled;
pub mod attended;
pub mod balanced;
pub mod board;
pub mod expected;
pub mod fingerprint;
pub mod governed;
pub mod head;
pub mod on_axis;
pub mod pages;
pub mod panel;
pub mod program;
pub mod rattle;
pub mod report;
pub mod scene;
pub mod scenes;
pub mod selected;
pub mod told;
pub mod trial_weights;
pub mod turn;
pub mod variants;

#[cfg(all(feature = "target", target_os = "none"))]
pub mod bench;
#[cfg(all(feature = "target", feature = "defmt", target_os = "none"))]
mod logger;
#[cfg(all(feature = "target", target_os = "none"))]
pub mod measure;
#[cfg(all(feature = "target", target_os = "none"))]
mod panic;

pub use variants::{Visitor, Words};
