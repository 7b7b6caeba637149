//! The equations of a rotor, and its vibration at a constant speed.

use nalgebra::{Complex, ComplexField, DMatrix, RowDVector};

use super::band::{Band, Factors};
use super::bearing::Bearing;
use super::error::RotorError;
use super::pencil::Strain;

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
    /// The stiffness part by part.
    pub(super) strains: Vec<Strain>,
    /// Places beside the diagonal up to which the matrices have entries.
    pub(super) half: usize,
    /// Deflection along `x` and along `y` of each station, as rows over the coordinates.
    pub(super) stations: Vec<[RowDVector<f64>; 2]>,
    /// Each sensor's share of the coordinates.
    pub(super) sensors: Vec<RowDVector<f64>>,
}

impl Model {
    pub(super) fn empty(coordinates: usize, half: usize) -> Self {
        let zeros = || DMatrix::zeros(coordinates, coordinates);
        Model {
            mass: zeros(),
            damping: zeros(),
            gyroscopic: zeros(),
            stiffness: zeros(),
            strains: Vec::new(),
            half,
            stations: Vec::new(),
            sensors: Vec::new(),
        }
    }

    /// Adds a bearing where the shaft's deflections are these rows.
    pub(super) fn support(&mut self, at: &[RowDVector<f64>; 2], bearing: &Bearing) {
        for (row, force) in at.iter().enumerate() {
            for (column, motion) in at.iter().enumerate() {
                let (force, motion) = (entries(force), entries(motion));
                for (&(i, a), &(j, b)) in force.iter().flat_map(|a| motion.iter().map(move |b| (a, b))) {
                    self.stiffness[(i, j)] += a * b * bearing.stiffness[row][column];
                    self.damping[(i, j)] += a * b * bearing.damping[row][column];
                }
                self.strains.push(Strain { stiffness: bearing.stiffness[row][column], force, motion });
            }
        }
    }

    /// A matrix with these entries up to where the model has some.
    pub(super) fn band<T: ComplexField<RealField = f64> + Copy>(&self, entry: impl Fn(usize, usize) -> T) -> Band<T> {
        Band::new(self.coordinates(), self.half, entry)
    }

    /// Passes a rotor of which every motion meets a stiffness.
    ///
    /// Over the stiffness of each coordinate alone, rounding leaves a free motion with some 1e-16 for each coordinate;
    /// the softest one of a held shaft of 64 elements has 1e-7 of it.
    ///
    /// # Errors
    /// [`RotorError::NotHeld`].
    pub fn held(&self) -> Result<(), RotorError> {
        let own = self.stiffness.diagonal().map(f64::sqrt);
        let scaled = |i, j| 0.5 * (self.stiffness[(i, j)] + self.stiffness[(j, i)]) / (own[i] * own[j]);
        let factors = self.band(scaled).positive().ok_or(RotorError::NotHeld)?;
        // the softest motion grows the most; one that begins without a pattern holds some of it
        let mut x: Vec<f64> = (0..self.coordinates()).map(|k| (0.618 * (k + 1) as f64).fract() + 0.1).collect();
        let mut softest = f64::INFINITY;
        for _ in 0..8 {
            x = factors.solve(x);
            let grown = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            softest = grown.recip();
            x.iter_mut().for_each(|x| *x /= grown);
        }
        if softest > 1e-13 { Ok(()) } else { Err(RotorError::NotHeld) }
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
        let factors = self.steady(speed);
        let mut force = vec![Complex::new(0.0, 0.0); self.coordinates()];
        for (station, &unbalance) in self.stations.iter().zip(unbalance) {
            if unbalance != Complex::new(0.0, 0.0) {
                push(&mut force, station, unbalance * speed * speed);
            }
        }
        let q = bounded(factors.solve(force), speed)?;
        Ok(self.sensors.iter().map(|sensor| seen(sensor, &q)).collect())
    }

    /// Influence coefficients (m/(kg m)) at a speed (rad/s): a row a sensor, a column a station.
    ///
    /// # Errors
    /// An undamped rotor on a critical speed.
    pub fn influence(&self, speed: f64) -> Result<DMatrix<Complex<f64>>, RotorError> {
        let factors = self.steady(speed);
        let mut influence = DMatrix::from_element(self.sensors(), self.stations(), Complex::new(0.0, 0.0));
        for (index, station) in self.stations.iter().enumerate() {
            let mut force = vec![Complex::new(0.0, 0.0); self.coordinates()];
            push(&mut force, station, Complex::new(speed * speed, 0.0));
            let q = bounded(factors.solve(force), speed)?;
            for (sensor, row) in self.sensors.iter().enumerate() {
                influence[(sensor, index)] = seen(row, &q);
            }
        }
        Ok(influence)
    }

    /// The factors of the equations of a whirl once a turn.
    fn steady(&self, speed: f64) -> Factors<Complex<f64>> {
        let entry = |r, c| {
            Complex::new(
                self.stiffness[(r, c)] - speed * speed * self.mass[(r, c)],
                speed * (self.damping[(r, c)] + speed * self.gyroscopic[(r, c)]),
            )
        };
        self.band(entry).factors()
    }
}

/// Adds a force that goes round: `Re(f exp(i phi))` along `x`, `Im(...) = Re(-i ...)` along `y`.
fn push(force: &mut [Complex<f64>], [x, y]: &[RowDVector<f64>; 2], turning: Complex<f64>) {
    for ((sum, &x), &y) in force.iter_mut().zip(x.iter()).zip(y.iter()) {
        *sum += turning * Complex::new(x, -y);
    }
}

fn seen(sensor: &RowDVector<f64>, q: &[Complex<f64>]) -> Complex<f64> {
    sensor.iter().zip(q).map(|(&share, q)| q * share).sum()
}

fn bounded(q: Vec<Complex<f64>>, speed: f64) -> Result<Vec<Complex<f64>>, RotorError> {
    let finite = q.iter().all(|q| q.re.is_finite() && q.im.is_finite());
    if finite { Ok(q) } else { Err(RotorError::Unbounded { speed }) }
}

/// What is not zero of a row.
pub(super) fn entries(row: &RowDVector<f64>) -> Vec<(usize, f64)> {
    row.iter().copied().enumerate().filter(|&(_, share)| share != 0.0).collect()
}
