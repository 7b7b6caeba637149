//! The three-disc rotor of `data/flexible_rotor.json`, and the file.

use driveline_solver::rotor::{Bearing, Direction, Disc, FlexibleRotor, Material};
use serde_json::Value;

/// The file: influence coefficients and trial runs of a rotor by an independent program (its own elements, checked
/// with ROSS).
pub fn file() -> Value {
    serde_json::from_str(include_str!("../../../../../tests/data/flexible_rotor.json")).unwrap()
}

/// Where the discs are: nodes 3, 6 and 9 of 0 to 12.
pub const PLANES: [usize; 3] = [3, 6, 9];

/// The rotor as the file describes it, on supports of these bearings.
pub fn three_discs(bearing: Bearing) -> FlexibleRotor {
    let end = Disc::of(0.28, 0.05, 0.05, Material::STEEL);
    let middle = Disc::of(0.32, 0.05, 0.07, Material::STEEL);
    let mut rotor = FlexibleRotor::uniform(12, 1.2, 0.05, Material::STEEL)
        .disc(3, end)
        .disc(6, middle)
        .disc(9, end)
        .bearing(0, bearing)
        .bearing(12, bearing)
        .sensor(1, Direction::X)
        .sensor(11, Direction::X);
    for node in PLANES {
        rotor = rotor.station(node);
    }
    rotor
}

/// The file's bearings.
pub const BEARING: Bearing = Bearing::isotropic(4e6, 2500.0);

/// A number of the file.
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}
