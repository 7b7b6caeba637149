//! The equations of a rotor, and its vibration at a constant speed.

use nalgebra::{Complex, DMatrix, DVector, RowDVector};

use super::bearing::Bearing;
use super::error::RotorError;

/// The direction of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// Along `x`.
    X,
    /// Along `y`.
    Y,
    /// At this angle from `x` towards `y` (rad).
    At(f64),
}

impl Direction {
    fn components(self) -> [f64; 2] {
        match self {
            Direction::X => [1.0, 0.0],
            Direction::Y => [0.0, 1.0],
            Direction::At(angle) => [angle.cos(), angle.sin()],
        }
    }
}

/// `M q'' + (C + Omega G) q' + K q = f`, where unbalance enters, and what the sensors see.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) mass: DMatrix<f64>,
    pub(super) damping: DMatrix<f64>,
    pub(super) gyroscopic: DMatrix<f64>,
    pub(super) stiffness: DMatrix<f64>,
    /// Deflection along `x` and along `y` of each station, as rows over the coordinates.
    pub(super) stations: Vec<[RowDVector<f64>; 2]>,
    /// Each sensor's share of the coordinates.
    pub(super) sensors: Vec<RowDVector<f64>>,
}

impl Model {
    pub(super) fn empty(coordinates: usize) -> Self {
        let zeros = || DMatrix::zeros(coordinates, coordinates);
        Model {
            mass: zeros(),
            damping: zeros(),
            gyroscopic: zeros(),
            stiffness: zeros(),
            stations: Vec::new(),
            sensors: Vec::new(),
        }
    }

    /// Adds a bearing where the shaft's deflections are these rows.
    pub(super) fn support(&mut self, at: &[RowDVector<f64>; 2], bearing: &Bearing) {
        for (row, force) in at.iter().enumerate() {
            for (column, motion) in at.iter().enumerate() {
                self.stiffness += force.transpose() * motion * bearing.stiffness[row][column];
                self.damping += force.transpose() * motion * bearing.damping[row][column];
            }
        }
    }

    pub(super) fn watch(&mut self, at: &[RowDVector<f64>; 2], direction: Direction) {
        let [x, y] = direction.components();
        self.sensors.push(&at[0] * x + &at[1] * y);
    }

    /// Coordinates: twice the planes.
    #[must_use]
    pub fn coordinates(&self) -> usize {
        self.mass.nrows()
    }

    /// Number of stations.
    #[must_use]
    pub fn stations(&self) -> usize {
        self.stations.len()
    }

    /// Number of sensors.
    #[must_use]
    pub fn sensors(&self) -> usize {
        self.sensors.len()
    }

    /// Displacement at each sensor (m), as complex amplitudes of `Re(X exp(i phi))`, at a constant speed (rad/s) with
    /// an unbalance (kg m) at each station.
    ///
    /// # Errors
    /// Another number of unbalances than of stations; an undamped rotor on a critical speed.
    pub fn response(&self, speed: f64, unbalance: &[Complex<f64>]) -> Result<Vec<Complex<f64>>, RotorError> {
        if unbalance.len() != self.stations() {
            return Err(RotorError::Count { name: "unbalances", found: unbalance.len(), expected: self.stations() });
        }
        let influence = self.influence(speed)?;
        Ok((influence * DVector::from_column_slice(unbalance)).iter().copied().collect())
    }

    /// Influence coefficients (m/(kg m)) at a speed (rad/s): a row a sensor, a column a station.
    ///
    /// # Errors
    /// An undamped rotor on a critical speed.
    pub fn influence(&self, speed: f64) -> Result<DMatrix<Complex<f64>>, RotorError> {
        let q = self.deflections(speed)?;
        Ok(DMatrix::from_fn(self.sensors(), self.stations(), |sensor, station| {
            self.sensors[sensor].iter().zip(q.column(station).iter()).map(|(&s, &q)| q * s).sum()
        }))
    }

    /// Amplitudes of all coordinates per unbalance, a column a station.
    fn deflections(&self, speed: f64) -> Result<DMatrix<Complex<f64>>, RotorError> {
        let square = speed * speed;
        let n = self.coordinates();
        let system = DMatrix::from_fn(n, n, |r, c| {
            Complex::new(
                self.stiffness[(r, c)] - square * self.mass[(r, c)],
                speed * (self.damping[(r, c)] + speed * self.gyroscopic[(r, c)]),
            )
        });
        // Re(u Omega^2 exp(i phi)) along x; Im(...) = Re(-i ...) along y
        let force = DMatrix::from_fn(n, self.stations(), |r, station| {
            let [x, y] = &self.stations[station];
            Complex::new(x[r], -y[r]) * square
        });
        let solved = system.lu().solve(&force).filter(|q| q.iter().all(|q| q.re.is_finite() && q.im.is_finite()));
        solved.ok_or(RotorError::Unbounded { speed })
    }
}
