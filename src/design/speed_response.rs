//! Periodic speeds as an observer shows them.
//!
//! A load torque of the frequency w moves motor and load: `theta_m (J_m s^2 + d s + k) = (d s + k) theta_l`, s = j w.
//! The estimates follow the motor's angle. Their ratio to the true speeds is 1 far below the observer's bandwidth; near
//! it they swing too far, beyond it too little.

use super::LoopObserver;
use super::complex::{Complex, over, times};
use super::predicted_error::Linear;
use crate::machine::{Damping, Inertia, Stiffness, TwoMass};
use crate::math::{hypot, sin_cos};

/// Frequencies to an octave.
const STEPS: usize = 4;
/// 2^(1/4).
const STEP: f64 = 1.189_207_115_002_721;

/// Estimated over true speed of motor and load at a frequency of the load torque (rad/s).
const fn speed_response(linear: &Linear, machine: Option<&TwoMass>, frequency: f64) -> [Complex; 2] {
    let (sin, cos) = sin_cos(frequency * linear.period);
    let states = linear.states((cos, sin));
    let motor = over(states[1], (0.0, frequency));
    let Some(machine) = machine else { return [motor, motor] };
    let shaft = (machine.stiffness, machine.damping * frequency);
    let forced = (shaft.0 - machine.motor_inertia * frequency * frequency, shaft.1);
    [motor, over(times(states[3], shaft), times(forced, (0.0, frequency)))]
}

impl LoopObserver<'_> {
    /// Largest errors of the speeds of motor and load that a load torque up to a frequency brings about, over what the
    /// observer shows of them: at pi/2^0 rad in a tick, pi/2^1 ...
    pub(crate) const fn speed_lag<const OCTAVES: usize>(&self) -> [[f32; OCTAVES]; 2] {
        let machine = match self {
            LoopObserver::TwoMass(design) => Some(&design.machine),
            LoopObserver::Placed(design) => Some(&design.machine),
            LoopObserver::Rigid(_) => None,
        };
        // the speeds of one mass do not depend on where it is
        let whole = TwoMass::new(Inertia(1.0), Inertia(1.0), Stiffness(0.0), Damping(0.0));
        let linear = Linear::of(*self, if let Some(machine) = machine { machine } else { &whole });
        let mut lag = [[0.0_f32; OCTAVES]; 2];
        let mut frequency = core::f64::consts::PI / linear.period;
        let mut octave = 0;
        while octave < OCTAVES {
            each!(step, 0..STEPS, {
                let shown = speed_response(&linear, machine, frequency);
                each!(side, 0..2, {
                    let missing = (1.0 - shown[side].0, -shown[side].1);
                    let share = over(missing, shown[side]);
                    let share = hypot(share.0, share.1) as f32;
                    // a NaN counts as no knowledge at all
                    if !(lag[side][octave] >= share) {
                        lag[side][octave] = if share.is_nan() { f32::INFINITY } else { share };
                    }
                });
                frequency /= STEP;
            });
            octave += 1;
        }
        // up to a frequency: of the octaves below it too
        while octave > 1 {
            octave -= 1;
            each!(side, 0..2, {
                lag[side][octave - 1] = lag[side][octave - 1].max(lag[side][octave]);
            });
        }
        lag
    }
}
