//! The scenes: one file each.

pub mod composition;
pub mod empty;
pub mod fan;
pub mod flexible;
pub mod hoist;
pub mod spindle;
