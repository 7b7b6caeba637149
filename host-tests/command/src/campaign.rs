//! Campaigns: a scene's drive in closed loop with many machines drawn from its tolerances.
//!
//! | term | meaning |
//! |---|---|
//! | factor | a quantity in which machines of one design differ |
//! | tolerance | the range of a factor; draws are uniform over it |
//! | draw | one machine: a number, and the values of the factors that follow from it and the seed |
//! | outcome | figures of the run of a draw |
//! | shard | draws `K`, `K + N`, `K + 2 N`, ... of a campaign, run apart and merged |
//!
//! A draw depends on its number and the seed alone, so that neither threads nor shards change a result.

mod blow;
pub mod compare;
mod draw;
pub mod drive;
mod figure;
pub mod file;
pub mod file_drive;
pub mod merge;
mod page;
mod plain;
pub mod record;
pub mod ring_down;
pub mod run;
pub mod scenes;
mod statistics;
mod summary;
pub mod tune;
mod work;

pub use crate::machine_file::factor::{Factor, Tolerance};
pub use draw::Draw;
pub use figure::{Figure, Outcome, decay};
pub use plain::PlainLoop;
pub use statistics::{median_range, noise_of_largest, quantile, rank_correlation};
pub use summary::Summary;
pub use work::{outcomes, work};
