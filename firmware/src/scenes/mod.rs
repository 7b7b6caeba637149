//! The scenes: one file each.

pub mod empty;
pub mod hoist;
