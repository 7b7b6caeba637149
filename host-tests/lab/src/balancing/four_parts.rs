//! A drive with all four parts against its plant: what is claimed of each, from every tick of a run.

use std::f64::consts::TAU;

use driveline_firmware::panel::fluctuation as panel;
use nalgebra::Complex;

use super::error::BalancingError;
use super::machine::Seen;
use super::operator::Operator;
use super::outcome::Claim;

pub(super) fn claim(name: &str, measured: f64, limit: f64) -> Claim {
    Claim { name: name.to_owned(), measured, limit }
}

/// Root mean square of the drive's errors of motor speed, load speed (rad/s) and shaft torque (N m).
pub(super) fn deviations(seen: &[Seen]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let squares: f64 = seen.iter().map(|tick| (tick.estimate[k] - tick.truth[k]).powi(2)).sum();
        (squares / seen.len() as f64).sqrt()
    })
}

/// The whole turns of the motor among these ticks.
pub(super) fn whole_turns(seen: &[Seen]) -> Vec<&[Seen]> {
    let turns: Vec<&[Seen]> = seen.chunk_by(|a, b| (a.angle / TAU).floor() == (b.angle / TAU).floor()).collect();
    // the first and the last are pieces
    turns[1..turns.len() - 1].to_vec()
}

/// The mean of a speed over ticks.
pub(super) fn mean(ticks: &[Seen], which: usize) -> f64 {
    ticks.iter().map(|tick| tick.truth[which]).sum::<f64>() / ticks.len() as f64
}

/// What is claimed of the observer, over the whole run, beside its shaft torque; `speed` is the rated one (rad/s). The
/// limit is that which the report holds every drivetrain with a tight shaft to.
pub(super) fn observed(seen: &[Seen], speed: f64) -> Vec<Claim> {
    let faults = seen.iter().filter(|tick| tick.faults != 0).count();
    vec![
        claim("error of the load speed, rms, as a share of rated", deviations(seen)[1] / speed, 0.003),
        claim("ticks with a fault", faults as f64, 0.0),
    ]
}

/// The fluctuation as the panel shows it, and the ticks of the window.
pub(super) struct Told {
    pub from: usize,
    pub to: usize,
    /// Delta of motor and load by the waveform, and of the last turn by its extremes; and their standard deviations.
    deltas: [[f64; 2]; 2],
    deviations: [f64; 4],
    /// Mean speed of the last turn (rad/s).
    mean: f64,
    /// Orders 1 and 2 of the motor's speed (rad/s).
    orders: [Complex<f64>; 2],
}

impl Told {
    /// Asks for the next window of turns, which is there after `patience` at the latest (s).
    pub fn ask(operator: &mut Operator<'_>, patience: f64) -> Result<Self, BalancingError> {
        // the window before began while the speed was settling
        Told::take(operator, patience)?;
        let from = operator.machine.seen().len();
        Told::take(operator, patience)?;
        let to = operator.machine.seen().len();
        let mut number = |key: u32, value: u32| -> Result<f64, BalancingError> {
            Ok(f64::from(f32::from_bits(operator.ask_word(key, value)?)))
        };
        let deltas = [
            [number(panel::MOTOR_DELTA, 0)?, number(panel::LOAD_DELTA, 0)?],
            [number(panel::MOTOR_EXTREMES, 0)?, number(panel::LOAD_EXTREMES, 0)?],
        ];
        let mut deviations = [0.0; 4];
        for (to, key) in deviations.iter_mut().zip(panel::DEVIATIONS) {
            *to = number(key, 0)?;
        }
        let mean = number(panel::MEAN, 0)?;
        let mut order = |n| -> Result<Complex<f64>, BalancingError> {
            Ok(Complex::new(number(panel::COSINE, n)?, number(panel::SINE, n)?))
        };
        let orders = [order(1)?, order(2)?];
        Ok(Told { from, to, deltas, deviations, mean, orders })
    }

    /// Waits for a window of turns.
    fn take(operator: &mut Operator<'_>, patience: f64) -> Result<(), BalancingError> {
        let end = operator.machine.time() + patience;
        while operator.ask_word(panel::TAKE, 0)? != panel::DONE {
            if operator.machine.time() > end {
                return Err(BalancingError::NoWaveform { time: patience });
            }
            // the head's wires
            operator.wait(10.0 * operator.machine.period())?;
        }
        Ok(())
    }

    /// What is claimed of it, against the plant in all `seen` ticks of `period` (s). The load swings `ratio` of the
    /// motor at the first order.
    ///
    /// A delta by a turn's extremes is within three of the standard deviations that are beside it.
    pub fn claims(&self, seen: &[Seen], period: f64, ratio: f64) -> Vec<Claim> {
        let turns = whole_turns(&seen[self.from..self.to]);
        let ticks = turns.iter().map(|turn| turn.len()).sum::<usize>() as f64;
        let mean_speed = TAU * turns.len() as f64 / (ticks * period);
        let order = |n: f64| {
            // over the angle, as the waveform: d phi = omega dt
            let of = |tick: &Seen| {
                let [speed, ..] = tick.truth;
                Complex::from_polar((speed - mean_speed) * speed * period, n * tick.angle)
            };
            let sum: Complex<f64> = turns.iter().flat_map(|turn| turn.iter()).map(of).sum();
            sum * 2.0 / (TAU * turns.len() as f64)
        };
        let swing = |speeds: &mut dyn Iterator<Item = f64>| {
            let (least, most) = speeds.fold((f64::INFINITY, 0.0_f64), |(a, b), speed| (a.min(speed), b.max(speed)));
            (most - least) / mean_speed
        };
        // Of the last turn; and of the mean of all turns from the window on, in which the load swings alike, without
        // the jitter by the governor's noise.
        let of_turn = |which: usize| swing(&mut turns[turns.len() - 1].iter().map(|tick| tick.truth[which]));
        let of_waveform = |which: usize| {
            let mut bins = [(0.0, 0.0); 64];
            for tick in whole_turns(&seen[self.from..]).into_iter().flatten() {
                let (sum, ticks) = &mut bins[((tick.angle / TAU).rem_euclid(1.0) * 64.0) as usize & 63];
                (*sum, *ticks) = (*sum + tick.truth[which], *ticks + 1.0);
            }
            swing(&mut bins.iter().map(|(sum, ticks)| sum / ticks))
        };
        let [first, second] = [order(1.0), order(2.0)];
        let [waveform, turn] = self.deltas;
        let off = |told: f64, truth: f64| (told / truth - 1.0).abs();
        let within = |which: usize| (turn[which] - of_turn(which)).abs() / self.deviations[2 + which];
        vec![
            // A count of the encoder at either end of the turn, of 10,000 at least, and what the governor leaves.
            claim("mean speed of a turn, off as a share", off(self.mean, mean_speed), 3e-4),
            // As the punch press's delta.
            claim("delta of the motor by the waveform, off as a share", off(waveform[0], of_waveform(0)), 0.01),
            // The same error is a larger share of a smaller swing.
            claim("delta of the load by the waveform, off as a share", off(waveform[1], of_waveform(1)), 0.01 / ratio),
            claim("first order, off as a share", (self.orders[0] - first).norm() / first.norm(), 0.01),
            claim("second order, off as a share of the first", (self.orders[1] - second).norm() / first.norm(), 0.01),
            claim("delta of the motor by a turn's extremes, off in deviations", within(0), 3.0),
            claim("delta of the load by a turn's extremes, off in deviations", within(1), 3.0),
            // Noise of a twentieth of the swing, as the designs have it, widens it by a quarter, known to a third. The
            // observers of both machines lag at the second order by a ninth of the motor's speed at most, and by 0.42
            // of the load's, of which 0.7 count.
            claim("deviation of the motor's delta, as a share", self.deviations[2] / turn[0], 0.22),
            claim("deviation of the load's delta, as a share", self.deviations[3] / turn[1], 0.36),
        ]
    }
}
