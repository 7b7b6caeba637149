//! The machines of the trial.

use core::f64::consts::TAU;

use driveline::design::{BacklashDesign, BacklashTuning, Disturbance, Encoder, Rate};
use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
use driveline::settings::Bases;

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;
/// Lines of the encoder.
pub const LINES: u32 = 2048;
/// Whole free travel of the gap (rad).
pub const GAP: f64 = 0.01;

/// First resonance (Hz).
const RESONANCE: f64 = 15.0;
/// Damping ratio of the resonance, of the size of steel shafts with couplings.
const DAMPING_RATIO: f64 = 0.02;

/// A machine of the trial.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// Inertias, and the twist under rated torque as a share of the gap.
    pub name: &'static str,
    /// The machine.
    pub machine: TwoMass,
    /// Rated torque (N m).
    pub rated: f64,
}

impl Case {
    fn new(name: &'static str, motor: f64, load: f64, rated: f64) -> Self {
        let reduced = motor * load / (motor + load);
        let w = TAU * RESONANCE;
        let machine = TwoMass::new(
            Inertia(motor),
            Inertia(load),
            Stiffness(w * w * reduced),
            Damping(2.0 * DAMPING_RATIO * w * reduced),
        );
        Case { name, machine: machine.with_gap(Gap(GAP)), rated }
    }

    /// How the observers are tuned: torque to 1 % of rated, the load wanders by 0.3 of rated in half a second.
    pub fn disturbance(&self) -> Disturbance {
        Disturbance { torque_accuracy: 0.01 * self.rated, load_torque_step: 0.3 * self.rated, within: 0.5 }
    }

    /// The library's design.
    pub fn design(&self) -> BacklashDesign {
        self.machine.backlash_observer(
            Rate::hz(RATE_HZ),
            Encoder::lines(LINES),
            self.disturbance(),
            BacklashTuning::USUAL,
        )
    }

    /// Bases of fixed point: shaft torques reach four times rated in an impact.
    pub fn bases(&self) -> Bases {
        Bases::new(&self.machine, 4.0 * self.rated, 100.0)
    }
}

/// Equal inertias, a light load and a heavy one, each with shafts that a rated torque twists by some two gaps and by
/// about one.
pub fn cases() -> [Case; 6] {
    [
        Case::new("1 : 1, 2.3 gaps", 0.6, 0.6, 60.0),
        Case::new("3 : 1, 3.0 gaps", 0.9, 0.3, 60.0),
        Case::new("1 : 4, 2.1 gaps", 0.4, 1.6, 60.0),
        Case::new("1 : 1, 0.9 gaps", 0.6, 0.6, 25.0),
        Case::new("3 : 1, 1.3 gaps", 0.9, 0.3, 25.0),
        Case::new("1 : 4, 0.9 gaps", 0.4, 1.6, 25.0),
    ]
}
