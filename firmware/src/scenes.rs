//! The scenes: one file each.

pub mod balanced_fan;
pub mod blooming_mill;
pub mod commission;
pub mod composition;
pub mod converter;
pub mod crane_travel;
pub mod empty;
pub mod fan;
pub mod flexible;
pub mod gear_drive;
pub mod generator;
pub mod grinding_spindle;
pub mod hoist;
pub mod planetary_drive;
pub mod punch_press;
pub mod skip_winch;
pub mod spindle;
pub mod strip_mill;
pub mod test_rig;
pub mod vibrating_screen;
