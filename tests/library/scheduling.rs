//! Gain scheduling: the gains at the points, bumpless transfer, and the hoist from an empty hook to its largest load.

mod hoist;
mod placed;
mod points;
mod transfer;
