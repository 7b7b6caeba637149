//! Starts, reversal and loss of load of a two-mass drive with a gap, against runs made with 40-digit matrix
//! exponentials (`backlash_transients.json`; its header has the equations).

use serde::Deserialize;

use driveline_solver::plant::converge::{NotProven, Proof, Recording, prove};
use driveline_solver::plant::{Chain, MotorLaw, Plant, Shaft, Start};

const FILE: &str = include_str!("../../../../tests/data/backlash_transients.json");

#[derive(Deserialize)]
struct Cases {
    cases: Vec<Transient>,
}

/// A case of the file; its names and units are the file's.
#[derive(Deserialize)]
#[allow(non_snake_case, missing_docs)]
pub struct Transient {
    pub id: String,
    pub J1_kg_m2: f64,
    pub J2_kg_m2: f64,
    pub c_Nm_rad: f64,
    pub d_Nms_rad: f64,
    pub gap_total_rad: f64,
    pub load_law: String,
    pub M2_Nm: f64,
    pub motor: (String, f64),
    pub initial_theta_w1_w2: [f64; 3],
    pub t_end_s: f64,
    pub events: Vec<Expected>,
    pub peak_torque_Nm: f64,
    pub t_peak_s: f64,
    pub min_torque_Nm: f64,
    pub t_min_s: f64,
    pub rel_tol_peak: f64,
    pub trajectory: Vec<[f64; 4]>,
}

/// An event of the file.
#[derive(Deserialize)]
#[allow(missing_docs)]
pub struct Expected {
    pub t_s: f64,
    pub kind: String,
    pub new: i8,
}

/// Ticks of a run that is to be proven.
const TICKS: u32 = 2000;

/// The cases of the file.
pub fn transients() -> Result<Vec<Transient>, String> {
    Ok(serde_json::from_str::<Cases>(FILE).map_err(|error| error.to_string())?.cases)
}

impl Transient {
    /// The machine at its start.
    ///
    /// # Errors
    /// A law that is not known, a figure out of range.
    pub fn plant(&self) -> Result<Plant, String> {
        let shaft = Shaft::elastic(self.c_Nm_rad).damping(self.d_Nms_rad).gap(self.gap_total_rad);
        let chain = Chain::motor(self.J1_kg_m2).shaft(shaft, self.J2_kg_m2);
        let chain = match self.load_law.as_str() {
            "active" => chain.load(self.M2_Nm),
            "coulomb" => chain.coulomb(self.M2_Nm),
            "none" => chain,
            other => return Err(format!("{}: load law `{other}`", self.id)),
        };
        if self.motor.0 != "const" {
            return Err(format!("{}: motor `{}`", self.id, self.motor.0));
        }
        let [theta, w1, w2] = self.initial_theta_w1_w2;
        chain
            .start(Start::Given { twists: vec![theta], speeds: vec![w1, w2] })
            .motor_law(MotorLaw::Constant(self.motor.1))
            .build()
            .map_err(|error| format!("{}: {error}", self.id))
    }

    /// The largest size of the shaft torque.
    pub fn peak(&self) -> f64 {
        self.peak_torque_Nm.abs().max(self.min_torque_Nm.abs())
    }

    /// Largest deviations of both speeds and of the torque from the reference, of their peaks.
    pub fn deviations(&self) -> Result<[f64; 3], String> {
        let mut plant = self.plant()?;
        let mut worst = [0.0_f64; 3];
        let top_speed = self.trajectory.iter().flat_map(|p| [p[1].abs(), p[2].abs()]).fold(0.0, f64::max);
        for &[t, w1, w2, torque] in &self.trajectory {
            // uneven ticks on purpose: the grid of the reference is not the solver's
            plant.advance(0.0, t - plant.time());
            let found = [plant.speed(0), plant.speed(1), plant.shaft_torque(0)];
            let expected = [(w1, top_speed), (w2, top_speed), (torque, self.peak())];
            for ((worst, found), (expected, scale)) in worst.iter_mut().zip(found).zip(expected) {
                let error = (found - expected).abs() / scale;
                // what is not a number is without bound
                *worst = worst.max(if error.is_nan() { f64::INFINITY } else { error });
            }
        }
        Ok(worst)
    }

    /// The run's proof of its own convergence.
    pub fn proof(&self) -> Result<Result<Proof, NotProven>, String> {
        let mut run = Recording::new(self.plant()?);
        for _ in 0..TICKS {
            run.advance(0.0, self.t_end_s / f64::from(TICKS));
        }
        Ok(prove(&run))
    }
}
