//! The scenes: one file each.

pub mod balanced_fan;
pub mod composition;
pub mod empty;
pub mod flexible;
pub mod grinding_spindle;
pub mod hoist;
