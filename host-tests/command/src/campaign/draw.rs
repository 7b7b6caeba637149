//! One machine drawn from within the tolerances.

use core::f64::consts::TAU;

use crate::machine_file::factor::{Factor, Tolerance};
use driveline_closed_loop::actuator::ActuatorErrors;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::encoder_errors::EncoderErrors;
use driveline_closed_loop::lockstep::Imperfections;

/// Periods of the cogging torque on a turn of the motor: slots of a machine of three pole pairs and 12 slots.
const COGGING_ORDER: f64 = 12.0;

/// One machine drawn from within the tolerances.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    pub number: u64,
    /// Values of the factors that have a tolerance.
    pub values: Vec<(Factor, f64)>,
    /// Seed of its phases and noises.
    seed: u64,
}

impl Draw {
    /// Draw `number` of a campaign with this seed. A factor's value does not depend on the other tolerances.
    pub fn new(tolerances: &[Tolerance], seed: u64, number: u64) -> Self {
        let seed = mixed(mixed(seed) ^ number);
        let value = |tolerance: &Tolerance| {
            let share = share(mixed(seed ^ tolerance.factor as u64));
            (tolerance.factor, tolerance.low + share * (tolerance.high - tolerance.low))
        };
        Self { number, values: tolerances.iter().map(value).collect(), seed }
    }

    /// The machine that the drive was designed for, with ideal sensors and torque.
    pub const fn nominal() -> Self {
        Self { number: 0, values: Vec::new(), seed: 0 }
    }

    /// The value of a factor: nominal where it has no tolerance.
    pub fn value(&self, factor: Factor) -> f64 {
        let found = self.values.iter().find(|(known, _)| *known == factor);
        found.map_or(factor.nominal(), |(_, value)| *value)
    }

    /// Its plant.
    pub fn departure(&self) -> Departure {
        Departure {
            stiffness: self.value(Factor::Stiffness),
            damping: self.value(Factor::Damping),
            motor_inertia: self.value(Factor::MotorInertia),
            load_inertia: self.value(Factor::LoadInertia),
            efficiency: self.value(Factor::Efficiency),
            gap: self.value(Factor::Gap),
            load: self.value(Factor::Load),
            rope: self.value(Factor::Rope),
        }
    }

    /// Its encoder of so many lines, its inverter and its timing, for a motor of this rated torque (N m).
    pub fn imperfections(&self, lines: f64, rated_torque: f64) -> Imperfections {
        let phase = |stream: u64| TAU * share(mixed(self.seed ^ stream));
        Imperfections {
            encoder: EncoderErrors {
                eccentricity: self.value(Factor::Eccentricity),
                eccentricity_phase: phase(101),
                interpolation: self.value(Factor::Interpolation) * TAU / lines,
                interpolation_phase: phase(102),
                lines,
                jitter: self.value(Factor::Jitter),
            },
            actuator: ActuatorErrors {
                gain: self.value(Factor::TorqueConstant) - 1.0,
                offset: self.value(Factor::TorqueOffset) * rated_torque,
                delay: self.value(Factor::Delay),
                lag: self.value(Factor::Lag),
                cogging: self.value(Factor::Cogging) * rated_torque,
                cogging_order: COGGING_ORDER,
                cogging_phase: phase(103),
            },
            missed_ticks: self.value(Factor::MissedTicks),
            seed: self.seed,
        }
    }
}

/// SplitMix64's output function [Steele 2014, OOPSLA]: neighbouring numbers give independent ones.
const fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// From 0 to 1, without 1.
const fn share(bits: u64) -> f64 {
    (bits >> 11) as f64 / 9_007_199_254_740_992.0
}
