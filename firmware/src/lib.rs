#![no_std]
#![warn(missing_docs)]
//! Scenes as a portable library, and the boards they are flashed onto.

pub mod scene;
