//! The scenes: one file each.

pub mod composition;
pub mod empty;
pub mod generator;
pub mod hoist;
