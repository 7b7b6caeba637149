//! The fluctuation on a panel: the waveform that was kept last, and the extremes of the last turn.
//!
//! The keys stand beside those of the [balancing](crate::scene::panel_keys), whose numbers end before these. The
//! answers are the bits of `f32`, 0 where there is none yet.

use core::marker::PhantomData;

use driveline::configure::Machine;
use driveline::fluctuation::{Drivetrain, Extremes, Ranked, SpeedErrors, Summed, WaveformConfig, Window};

/// Key: keeps the waveform of the last finished turns; answers [`DONE`], or [`NOT_YET`] where there is none.
pub const TAKE: u32 = 64;
/// Key: delta of the motor by the waveform that was kept.
pub const MOTOR_DELTA: u32 = 65;
/// Key: delta of the load by the same, through the shaft.
pub const LOAD_DELTA: u32 = 66;
/// Key: cosine of the motor's order `value`, from 1 on (rad/s).
pub const COSINE: u32 = 67;
/// Key: its sine.
pub const SINE: u32 = 68;
/// Key: delta of the motor in the last finished turn, by its extremes.
pub const MOTOR_EXTREMES: u32 = 69;
/// Key: delta of the load, by the same.
pub const LOAD_EXTREMES: u32 = 70;
/// Key: mean speed of the last finished turn (rad/s).
pub const MEAN: u32 = 71;

/// Keys: standard deviations of the deltas of keys 65, 66, 69 and 70.
pub const DEVIATIONS: [u32; 4] = [72, 73, 74, 75];

/// Answer: done.
pub const DONE: u32 = 1;
/// Answer: no finished turns, or none that a waveform can be taken from.
pub const NOT_YET: u32 = 2;

/// Highest order of the waveform: loads that swing once and twice a turn. Through a shaft an error of a higher order
/// would grow with its square.
pub const HIGHEST: usize = 2;

/// The waveform that was kept, of the machine `M`.
pub struct FluctuationPanel<M> {
    /// Delta of motor and load, and their standard deviations.
    deltas: [[f32; 2]; 2],
    /// Cosine and sine of the motor's orders (rad/s).
    orders: [[f32; 2]; HIGHEST],
    machine: PhantomData<M>,
}

impl<M> Default for FluctuationPanel<M> {
    fn default() -> Self {
        FluctuationPanel { deltas: [[0.0; 2]; 2], orders: [[0.0; 2]; HIGHEST], machine: PhantomData }
    }
}

impl<M: Machine> FluctuationPanel<M> {
    /// Noise and lag of the estimated speeds of motor and load.
    const ERRORS: SpeedErrors = SpeedErrors::of(&M::OBSERVER);
    /// Shaft and masses, for the load side of the waveform.
    const DRIVETRAIN: Drivetrain = Drivetrain::of(&M::TWO_MASS);

    /// The answer to [`TAKE`]: keeps the waveform of a window.
    #[inline(never)]
    pub fn keep<N: Summed<Real = f32>, const BINS: usize>(
        &mut self,
        config: &WaveformConfig,
        window: Option<Window<N, BINS>>,
    ) -> u32 {
        let Some(window) = window else { return NOT_YET };
        let Ok(ripple) = window.ripple(config, HIGHEST) else { return NOT_YET };
        let load = ripple.load_side(&config.cycle, &Self::DRIVETRAIN, &window.motor_torque(config, HIGHEST)).load;
        self.deltas = [ripple.motor, load].map(|of| [of.delta, of.deviation]);
        for (kept, order) in self.orders.iter_mut().zip(&ripple.speed.orders) {
            *kept = [order.cos, order.sin];
        }
        DONE
    }

    /// The answer to the other keys; 0 to what is none.
    pub fn number<N: Ranked<Real = f32>>(
        &self,
        config: &WaveformConfig,
        [key, value]: [u32; 2],
        extremes: impl FnOnce() -> Extremes<N>,
    ) -> u32 {
        let [cosine, sine] = self.orders.get(value.wrapping_sub(1) as usize).copied().unwrap_or_default();
        let number = match key {
            MOTOR_DELTA => self.deltas[0][0],
            LOAD_DELTA => self.deltas[1][0],
            COSINE => cosine,
            SINE => sine,
            _ if key == DEVIATIONS[0] => self.deltas[0][1],
            _ if key == DEVIATIONS[1] => self.deltas[1][1],
            _ => {
                let [mean, deltas @ ..] = last_turn::<M, N>(config, &extremes());
                let keys = [MOTOR_EXTREMES, LOAD_EXTREMES, DEVIATIONS[2], DEVIATIONS[3]];
                match keys.iter().zip(deltas).find(|(known, _)| **known == key) {
                    Some((_, delta)) => delta,
                    None if key == MEAN => mean,
                    None => 0.0,
                }
            }
        };
        number.to_bits()
    }
}

/// The last finished turn by its extremes, without what the estimates' noise adds to them: mean speed (rad/s), delta of
/// motor and load, their standard deviations. Zeros where there is none.
#[inline(never)]
pub fn last_turn<M: Machine, N: Ranked<Real = f32>>(config: &WaveformConfig, extremes: &Extremes<N>) -> [f32; 5] {
    extremes.reading(&config.cycle).map_or([0.0; 5], |turn| {
        let turn = turn.with_errors(&config.cycle, &FluctuationPanel::<M>::ERRORS, HIGHEST);
        let [motor, load] = [turn.motor, turn.load];
        [turn.mean, motor.delta, load.delta, motor.deviation, load.deviation]
    })
}
