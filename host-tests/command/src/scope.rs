//! A scope: the records of a running drive on a local page, with zoom, trigger, order spectrum and recording.

mod http;
mod order;
mod store;

pub use http::{Scope, serve};
pub use order::{Order, orders};
pub use store::{Store, Window};
