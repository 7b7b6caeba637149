//! How wrong the estimates of some traces are.

use crate::lockstep::{Moment, Trace};
use driveline_report::Deviation;

/// Peaks of the true shaft torque, load speed and load torque over some traces.
pub fn peaks<'t>(traces: impl Iterator<Item = &'t Trace>) -> [f64; 3] {
    traces.flat_map(|trace| &trace.moments).fold([0.0; 3], |mut peaks, moment| {
        for (peak, truth) in peaks.iter_mut().zip(moment.truth) {
            *peak = f64::max(*peak, truth.abs());
        }
        peaks
    })
}

/// Errors of shaft torque, load speed and load torque over some traces, as fractions of these references.
pub fn deviations<'t>(traces: impl Iterator<Item = &'t Trace>, references: [f64; 3]) -> [Deviation; 3] {
    of_errors(traces.flat_map(|trace| &trace.moments).map(Moment::error), references)
}

/// The same from errors in SI units.
pub fn of_errors(errors: impl Iterator<Item = [f64; 3]>, references: [f64; 3]) -> [Deviation; 3] {
    let (mut squares, mut largest, mut count) = ([0.0; 3], [0.0_f64; 3], 0_u64);
    for error in errors {
        count += 1;
        for k in 0..3 {
            squares[k] += error[k] * error[k];
            // `max` would drop a NaN.
            largest[k] = if error[k].abs() > largest[k] || error[k].is_nan() { error[k].abs() } else { largest[k] };
        }
    }
    let deviation = |k: usize| Deviation {
        rms: (squares[k] / count.max(1) as f64).sqrt() / references[k],
        max: largest[k] / references[k],
    };
    [deviation(0), deviation(1), deviation(2)]
}
