//! The runs by which a set is judged.

use driveline_firmware::scenes::generator::RATED_SPEED;

use super::run::Program;
use super::set::Kind;

/// How a set was governed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// With the estimated load fed forward.
    FeedForward,
    /// Without.
    Plain,
}

/// The ways, as the panel's choice of constants counts them.
pub const WAYS: [Way; 2] = [Way::FeedForward, Way::Plain];

/// The loads of a set's run: time (s), share of rated power.
pub const fn loads(kind: Kind) -> &'static [(f64, f64)] {
    match kind {
        // A turbocharged engine's steps: half, then what its charge pressure allows.
        Kind::Diesel => &[(0.0, 0.0), (9.0, 0.5), (13.0, 0.8), (17.0, 1.0), (22.0, 0.0)],
        Kind::Turbine => &[(0.0, 0.0), (12.0, 0.25), (22.0, 0.5), (32.0, 0.75), (42.0, 1.0), (56.0, 0.0)],
    }
}

/// The run of a set in a way: the diesel is started from its starter's speed, the turbine found turning.
pub fn program(kind: Kind, way: Way) -> Program {
    let (speed, duration) = match kind {
        Kind::Diesel => (20.0, 27.0),
        Kind::Turbine => (RATED_SPEED, 112.0),
    };
    Program { speed, on: 0.5, constants: way as u32, loads: loads(kind).to_vec(), seizes: None, duration }
}
