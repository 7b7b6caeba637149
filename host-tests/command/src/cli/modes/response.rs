//! Forced vibration of a machine: `(K - omega^2 M + i omega C) q = T`, every part referred to the motor.

use driveline::machine::Damper;
use nalgebra::{Complex, DMatrix, DVector, Schur};

use crate::machine_file::MachineFile;

/// Points of a response, evenly spread by their logarithm, beside those about its resonances.
const POINTS: usize = 400;

/// Decay over the highest frequency of the machine below which a vibration is undamped: a thousand roundings.
const UNDAMPED: f64 = 1e-12;

/// Masses and the springs with dampers between them.
#[derive(Clone)]
pub struct Response {
    /// Inertias (kg m2).
    inertia: Vec<f64>,
    /// Viscous damping of each against the ground (N m s/rad).
    viscous: Vec<f64>,
    springs: Vec<Spring>,
}

/// A spring and a damper side by side.
#[derive(Clone, Copy)]
struct Spring {
    /// Index of one mass.
    from: usize,
    /// Index of the other.
    to: usize,
    /// Stiffness (N m/rad).
    stiffness: f64,
    /// Damping (N m s/rad).
    damping: f64,
}

impl Response {
    /// Of a machine whose gaps are closed.
    pub fn of(machine: &MachineFile) -> Self {
        let joints = machine.joints().into_iter();
        let spring = joints.map(|joint| Spring {
            from: joint.from,
            to: joint.to,
            stiffness: joint.shaft.stiffness,
            damping: joint.shaft.damping,
        });
        Self { inertia: machine.masses().to_vec(), viscous: machine.viscous(), springs: spring.collect() }
    }

    /// With a damper on a mass.
    pub fn with(&self, mass: usize, damper: &Damper) -> Self {
        let mut damped = self.clone();
        let ring = damped.inertia.len();
        damped.inertia.push(damper.inertia);
        damped.viscous.push(0.0);
        damped.springs.push(Spring { from: mass, to: ring, stiffness: damper.stiffness, damping: damper.damping });
        damped
    }

    /// Angles (rad) of the masses under torques (N m) of a frequency (rad/s); none where they grow without end.
    fn angles(&self, omega: f64, torques: &[Complex<f64>]) -> Option<DVector<Complex<f64>>> {
        let parts = self.inertia.iter().zip(&self.viscous);
        let inertial = parts.map(|(inertia, viscous)| Complex::new(-inertia * omega * omega, omega * viscous));
        let mut matrix = DMatrix::from_diagonal(&DVector::from_iterator(self.inertia.len(), inertial));
        for spring in &self.springs {
            let stiffness = spring.dynamic_stiffness(omega);
            let (from, to) = (spring.from, spring.to);
            matrix[(from, from)] += stiffness;
            matrix[(to, to)] += stiffness;
            matrix[(from, to)] -= stiffness;
            matrix[(to, from)] -= stiffness;
        }
        matrix.lu().solve(&DVector::from_column_slice(torques))
    }

    /// Largest torque of a shaft (N m) under torques (N m) of a frequency (rad/s): `|(k + i omega d) dq|`; none
    /// where it grows without end.
    pub fn shaft_torque(&self, omega: f64, torques: &[Complex<f64>]) -> Option<f64> {
        let angles = self.angles(omega, torques)?;
        let torque =
            |spring: &Spring| (spring.dynamic_stiffness(omega) * (angles[spring.from] - angles[spring.to])).norm();
        Some(self.springs.iter().map(torque).fold(0.0, f64::max))
    }

    /// Angle of a mass per torque on it (rad/(N m)); infinite at an undamped resonance.
    pub fn receptance(&self, mass: usize, omega: f64) -> f64 {
        let mut torques = vec![Complex::from(0.0); self.inertia.len()];
        torques[mass] = Complex::from(1.0);
        self.angles(omega, &torques).map_or(f64::INFINITY, |angles| angles[mass].norm())
    }

    /// Largest angle of a mass per torque on it (rad/(N m)) between two frequencies (rad/s); none where an
    /// undamped resonance lies between them.
    pub fn largest(&self, mass: usize, [low, high]: [f64; 2]) -> Option<f64> {
        let at = |omega: f64| self.receptance(mass, omega);
        let even = |point: usize| low * (high / low).powf(point as f64 / POINTS as f64);
        let mut points: Vec<f64> = (0..=POINTS).map(even).collect();
        let vibrations = self.vibrations()?;
        let fastest = vibrations.iter().map(|vibration| vibration.norm()).fold(0.0, f64::max);
        for vibration in vibrations.iter().filter(|vibration| (low..=high).contains(&vibration.im)) {
            let (decay, omega) = (vibration.re.abs(), vibration.im);
            if decay > UNDAMPED * fastest {
                points.extend([-4.0, -1.0, 0.0, 1.0, 4.0].map(|widths| omega + widths * decay));
            } else if at(omega * (1.0 + 1e-7)) > 10.0 * at(omega * (1.0 + 1e-5)) {
                // a hundred times where the mass takes part, once where it is a node
                return None;
            }
        }
        points.retain(|point| (low..=high).contains(point));
        points.sort_by(f64::total_cmp);
        let sizes: Vec<f64> = points.iter().map(|&omega| at(omega)).collect();
        let mut largest = sizes.iter().copied().fold(0.0, f64::max);
        for (place, size) in points.windows(3).zip(sizes.windows(3)) {
            if size[1] >= size[0] && size[1] >= size[2] {
                largest = largest.max(peak(at, place[0], place[2]));
            }
        }
        largest.is_finite().then_some(largest)
    }

    /// Damped vibrations: the eigenvalues `-decay + i omega` (1/s) of the equations in `sqrt(J) q'` and
    /// `sqrt(k) dq`, whose rounding is that of the highest frequency and not of its square.
    fn vibrations(&self) -> Option<Vec<Complex<f64>>> {
        let masses = self.inertia.len();
        let mut state = DMatrix::zeros(masses + self.springs.len(), masses + self.springs.len());
        for (mass, viscous) in self.viscous.iter().enumerate() {
            state[(mass, mass)] -= viscous / self.inertia[mass];
        }
        for (row, spring) in self.springs.iter().enumerate() {
            let ends =
                [(spring.from, 1.0), (spring.to, -1.0)].map(|(mass, sign)| (mass, sign / self.inertia[mass].sqrt()));
            for (mass, share) in ends {
                let strain = share * spring.stiffness.sqrt();
                state[(masses + row, mass)] = strain;
                state[(mass, masses + row)] = -strain;
                for (other, their) in ends {
                    state[(mass, other)] -= share * their * spring.damping;
                }
            }
        }
        // far more steps than the two or three of an eigenvalue
        Some(Schur::try_new(state, f64::EPSILON, 10_000)?.complex_eigenvalues().iter().copied().collect())
    }
}

impl Spring {
    /// `k + i omega d` (N m/rad) at a frequency (rad/s).
    fn dynamic_stiffness(&self, omega: f64) -> Complex<f64> {
        Complex::new(self.stiffness, omega * self.damping)
    }
}

/// The largest value between two places that enclose one peak, by golden section.
fn peak(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let mut largest = 0.0;
    // 1e-8 of the width, whose square is a rounding
    for _ in 0..40 {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        let [below, above] = [of(left), of(right)];
        largest = below.max(above).max(largest);
        if below > above {
            high = right;
        } else {
            low = left;
        }
    }
    largest
}
