//! The plots of the report, each from its data to an `<svg>` element.

mod campbell;
mod label;
mod lines;
mod nyquist;
mod pareto;
mod polar;
mod scatter;
mod shape;
mod trajectory;

pub use campbell::{Crossing, Ray, campbell};
pub use lines::{Band, Curve, Line, Lines, over_time};
pub use nyquist::{Locus, nyquist};
use pareto::front;
pub use polar::{Arrow, polar};
pub use scatter::{Dot, fronts, scatter};
pub use shape::{Station, mode_shape};
pub use trajectory::course;
