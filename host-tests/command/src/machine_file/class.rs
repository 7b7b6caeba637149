//! Classes of machines, with the tolerances that are usual in each.
//!
//! Inertias, stiffness and torque constant have the tolerances for which speed loops are designed,
//! [`driveline::design::Tolerance::USUAL`]; nothing is calibrated.

use core::f64::consts::PI;

use driveline::design::{Spread, Tolerance as Usual};

use super::factor::{Factor, Tolerance};

/// A class of machines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Class {
    /// By its drawings and data sheets, no more.
    #[default]
    General,
    /// Cranes: the encoder's disc is centred to 3 arc minutes and read by software.
    Crane,
    /// Mills: rolls are ground and changed, a timer latches the encoder, the torque follows with 200 Hz at least.
    Mill,
    /// Machine tools: tools are changed, the encoder's disc is centred to 20 arc seconds and latched by a timer.
    MachineTool,
}

/// A minute of arc (rad).
const ARCMINUTE: f64 = PI / 10_800.0;

/// The range of a ratio for which a loop is designed.
pub const fn usual(factor: Factor, spread: Spread) -> Tolerance {
    Tolerance::new(factor, spread.min, spread.max)
}

/// A machine by its drawings, a motor and an inverter by their data sheets.
const DRAWINGS: [Tolerance; 6] = [
    usual(Factor::MotorInertia, Usual::USUAL.motor_inertia),
    usual(Factor::TorqueConstant, Usual::USUAL.torque),
    Factor::TorqueOffset.about(Usual::USUAL.offset),
    Factor::Cogging.about(0.005),
    Factor::Delay.about(Usual::USUAL.late as f64),
    Factor::Interpolation.about(0.01),
];

impl Class {
    /// All, with their names in a machine file.
    pub const ALL: [(&'static str, Self); 4] =
        [("general", Self::General), ("crane", Self::Crane), ("mill", Self::Mill), ("machine-tool", Self::MachineTool)];

    /// The tolerances of motor, inverter and encoder.
    pub fn drive(self) -> Vec<Tolerance> {
        let (lag, eccentricity, jitter) = match self {
            Self::General => (Usual::USUAL.lag, ARCMINUTE, 2e-7),
            Self::Crane => (Usual::USUAL.lag, 3.0 * ARCMINUTE, 1e-6),
            Self::Mill => (1.0 / (2.0 * PI * 200.0), ARCMINUTE, 2e-7),
            Self::MachineTool => (Usual::USUAL.lag, ARCMINUTE / 3.0, 2e-7),
        };
        let of_class = [Factor::Lag.about(lag), Factor::Eccentricity.about(eccentricity), Factor::Jitter.about(jitter)];
        DRAWINGS.into_iter().chain(of_class).collect()
    }

    /// Those of a machine as well: stiffness and inertia of the load, a gear's efficiency, a gap.
    pub fn machine(self, lossy: bool, gap: bool) -> Vec<Tolerance> {
        let mut all = self.drive();
        all.push(usual(Factor::Stiffness, Usual::USUAL.stiffness));
        all.push(usual(Factor::LoadInertia, Usual::USUAL.load_inertia));
        if lossy {
            all.push(Factor::Efficiency.about(Usual::USUAL.efficiency));
        }
        if gap {
            all.push(usual(Factor::Gap, Usual::USUAL.gap));
        }
        all
    }
}
