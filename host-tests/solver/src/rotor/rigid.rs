//! A rigid rotor on springs: a body that moves and tilts, corrected in planes beside its centre of gravity.

use nalgebra::RowDVector;

use super::bearing::Bearing;
use super::error::{RotorError, check, positive};
use super::flexible::validate_bearing;
use super::model::{Direction, Model};

/// A rigid rotor under construction. Places along the shaft are distances (m) from the centre of gravity.
#[derive(Clone, Debug)]
pub struct RigidRotor {
    mass: f64,
    polar: f64,
    diametral: f64,
    bearings: Vec<(f64, Bearing)>,
    stations: Vec<f64>,
    sensors: Vec<(f64, Direction)>,
}

impl RigidRotor {
    /// A rotor of a mass (kg) and moments of inertia about its axis and about a diameter through its centre of gravity
    /// (kg m2).
    #[must_use]
    pub const fn new(mass: f64, polar: f64, diametral: f64) -> Self {
        RigidRotor { mass, polar, diametral, bearings: Vec::new(), stations: Vec::new(), sensors: Vec::new() }
    }

    /// Puts a bearing under a place.
    #[must_use]
    pub fn bearing(mut self, place: f64, bearing: Bearing) -> Self {
        self.bearings.push((place, bearing));
        self
    }

    /// Makes a place a station: unbalance acts there.
    #[must_use]
    pub fn station(mut self, place: f64) -> Self {
        self.stations.push(place);
        self
    }

    /// Watches a place.
    #[must_use]
    pub fn sensor(mut self, place: f64, direction: Direction) -> Self {
        self.sensors.push((place, direction));
        self
    }

    /// The equations: coordinates `x`, `y` of the centre of gravity and the slopes `dx/dz`, `dy/dz`.
    ///
    /// # Errors
    /// A number out of its range.
    pub fn build(&self) -> Result<Model, RotorError> {
        let rotor = || "the rotor".to_owned();
        positive("mass", rotor, self.mass)?;
        positive("polar moment of inertia", rotor, self.polar)?;
        positive("diametral moment of inertia", rotor, self.diametral)?;
        let mut model = Model::empty(4, 3);
        for plane in 0..2 {
            model.mass[(plane, plane)] = self.mass;
            model.mass[(2 + plane, 2 + plane)] = self.diametral;
        }
        model.gyroscopic[(2, 3)] = self.polar;
        model.gyroscopic[(3, 2)] = -self.polar;
        let deflections = |place: f64| {
            [RowDVector::from_row_slice(&[1.0, 0.0, place, 0.0]), RowDVector::from_row_slice(&[0.0, 1.0, 0.0, place])]
        };
        let finite = |what: &str, index: usize, place: f64| {
            check("place", || format!("{what} {index}"), place, true, "a finite number")
        };
        for (index, (place, bearing)) in self.bearings.iter().enumerate() {
            finite("bearing", index, *place)?;
            validate_bearing(index, bearing)?;
            model.support(&deflections(*place), bearing);
        }
        for (index, &place) in self.stations.iter().enumerate() {
            finite("station", index, place)?;
            model.stations.push(deflections(place));
        }
        for (index, &(place, direction)) in self.sensors.iter().enumerate() {
            finite("sensor", index, place)?;
            model.watch(&deflections(place), direction);
        }
        Ok(model)
    }
}
