//! The scenes: one file each.

pub mod blooming_mill;
pub mod composition;
pub mod converter;
pub mod empty;
pub mod hoist;
