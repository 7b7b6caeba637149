//! The machines of the trial.

use core::f64::consts::TAU;

use driveline::design::{BacklashDesign, BacklashTuning, Disturbance, Encoder, Rate};
use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
use driveline::settings::Bases;

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;
/// Lines of the encoder.
const LINES: u32 = 2048;
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
    pub machine: TwoMass,
    /// Rated torque (N m).
    pub rated: f64,
    /// Lines of the encoder.
    pub lines: u32,
    /// Base of the speed in fixed point (rad/s).
    pub fastest: f64,
    /// Time in which the load wanders by [`load_step`](Self::load_step) (s), for the observers.
    pub within: f64,
    /// How far the load wanders, as a share of rated torque.
    pub load_step: f64,
    /// How the library's observer looks for the flank.
    pub tuning: BacklashTuning,
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
        Case {
            name,
            machine: machine.with_gap(Gap(GAP)),
            rated,
            lines: LINES,
            fastest: 100.0,
            within: 0.5,
            load_step: 0.3,
            tuning: BacklashTuning::USUAL,
        }
    }

    /// A reversing mill as the scene `blooming-mill` has it: motor 5.5 times as heavy as the rolls, 17 Hz, the gap of
    /// the trial.
    ///
    /// The motor outweighs the rolls, so an impact moves it little, and searching gains as lively as
    /// [`BacklashTuning::USUAL`] follow noise. These are the best of a search on other courses of this kind, with gaps
    /// of 3 to 20 mrad, bites within 20 to 200 ms, and passes of a quarter to twice the speed.
    pub fn mill() -> Self {
        let machine = TwoMass::new(Inertia(1.2e5), Inertia(2.2e4), Stiffness(2.2e8), Damping(1.0e5));
        Case {
            name: "mill",
            machine: machine.with_gap(Gap(GAP)),
            rated: 1.34e6,
            lines: 8192,
            fastest: 20.0,
            within: 5.0,
            load_step: 1.0,
            tuning: BacklashTuning { wander: 0.08, speed_wander: 0.12, torque_wander: 0.45, hold: 0.42 },
        }
    }

    /// How the observers are tuned: torque to 1 % of rated; of the six machines the load wanders by 0.3 of rated in
    /// half a second.
    pub fn disturbance(&self) -> Disturbance {
        let load_torque_step = self.load_step * self.rated;
        Disturbance { torque_accuracy: 0.01 * self.rated, load_torque_step, within: self.within }
    }

    /// Noise of the angle.
    pub fn encoder(&self) -> Encoder {
        Encoder::lines(self.lines)
    }

    /// The library's design.
    ///
    /// # Panics
    /// A tuning that is out of range.
    pub fn design(&self) -> BacklashDesign {
        self.machine.backlash_observer(Rate::hz(RATE_HZ), self.encoder(), self.disturbance(), self.tuning)
    }

    /// Bases of fixed point: shaft torques reach four times rated in an impact.
    pub fn bases(&self) -> Bases {
        Bases::new(&self.machine, 4.0 * self.rated, self.fastest)
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
