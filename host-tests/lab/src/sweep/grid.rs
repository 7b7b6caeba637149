//! The machines and rates of a sweep.

use driveline::design::{ExactStep, Matrix, SemiImplicitStep, StandardDeviation, StepChoice, TwoMassDesign};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};

/// Period of every tick (s): 10 kHz. Only omega T enters the step; the period sets the scale of the speeds.
pub const PERIOD: f64 = 1e-4;

/// One machine at one rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Natural frequency times the tick (rad).
    pub omega_t: f64,
    /// Load inertia over motor inertia.
    pub inertia_ratio: f64,
    /// Damping as a share of the critical.
    pub damping: f64,
}

impl Place {
    /// A machine whose shaft is twisted by some hundredths of a radian by torques of some N m, and whose motor turns by
    /// no more than some radians in a tick, whatever omega T: fixed point scales the angle by the turn, not by a base.
    pub fn machine(&self) -> TwoMass {
        let omega = self.omega();
        let stiffness = 200.0 * (self.omega_t * self.omega_t).max(1.0);
        let reduced = stiffness / (omega * omega);
        TwoMass::new(
            Inertia(reduced * (1.0 + 1.0 / self.inertia_ratio)),
            Inertia(reduced * (1.0 + self.inertia_ratio)),
            Stiffness(stiffness),
            Damping(2.0 * self.damping * omega * reduced),
        )
    }

    /// Natural frequency (rad/s).
    pub fn omega(&self) -> f64 {
        self.omega_t / PERIOD
    }

    /// Motion of the slower of the pair in a tick: the angle turned (rad), or the share that decays where the
    /// shaft is overdamped.
    pub fn slowest(&self) -> f64 {
        let zeta = self.damping;
        if zeta <= 1.0 { self.omega_t } else { self.omega_t / (zeta + ((zeta - 1.0) * (zeta + 1.0)).sqrt()) }
    }

    /// Ticks in a period of the natural frequency, rounded up.
    pub fn ticks_in_a_period(&self) -> u64 {
        (core::f64::consts::TAU / self.omega_t).ceil() as u64
    }
}

/// The steps of a machine over a tick, without correction: the run is the model alone.
///
/// By hand, because the design refuses what it cannot observe (a resonance above half the rate), and the step must hold
/// there too.
pub fn open_loop(machine: &TwoMass, period: f64) -> TwoMassDesign {
    let semi_implicit = SemiImplicitStep::new(machine, period);
    TwoMassDesign {
        period,
        machine: *machine,
        step: ExactStep::new(machine, period),
        semi_implicit,
        chosen: StepChoice::choose(&semi_implicit, StepChoice::THRESHOLD),
        transition: Matrix::IDENTITY,
        input: [0.0; 5],
        gains: [0.0; 5],
        poles: [(1.0, 0.0); 5],
        spectral_radius: 1.0,
        standard_deviation: StandardDeviation {
            motor_angle: f64::INFINITY,
            motor_speed: f64::INFINITY,
            twist: f64::INFINITY,
            shaft_torque: f64::INFINITY,
            load_speed: f64::INFINITY,
            load_torque: f64::INFINITY,
        },
        innovation: f64::INFINITY,
        posterior: Matrix::ZERO,
    }
}

/// The places of a sweep: omega T from 1e-6 to 1e3, inertia ratio from 1e-6 to 1e6, damping from none to 100 times the
/// critical.
pub fn places() -> Vec<Place> {
    let mut places = Vec::new();
    for damping in [0.0, 1.0, 100.0] {
        for omega_t in (-6..4).map(|decade| 10f64.powi(decade)) {
            places.extend([1e-6, 1e-3, 1.0, 1e3, 1e6].map(|inertia_ratio| Place { omega_t, inertia_ratio, damping }));
        }
    }
    places
}
