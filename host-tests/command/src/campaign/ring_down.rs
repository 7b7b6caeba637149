//! Decay of the slowest swing of a signal: a sum of exponentials.
//!
//! Their poles are found by the rotation of the signal's subspace, ESPRIT [Roy and Kailath 1989, IEEE Trans. Acoust.
//! Speech Signal Process. 37(7)]. Means over equal intervals of a sum of exponentials have the same poles.

use nalgebra::{Complex, DMatrix, DVector, SymmetricEigen};

/// A part `amplitude exp(-decay t) cos(frequency t + phase)` of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Decay (1/s).
    pub decay: f64,
    /// Frequency (rad/s).
    pub frequency: f64,
    /// Amplitude at the first sample, in the signal's unit.
    pub amplitude: f64,
}

impl Part {
    /// Whether it swings: a damping ratio below the root of one half, so that it has a resonance.
    pub fn swings(&self) -> bool {
        self.frequency > self.decay
    }
}

/// Columns of the signal's matrix: the longest order that is looked for, several times.
const COLUMNS: usize = 60;
/// Largest number of poles: three swings and what settles beside them.
const MOST_POLES: usize = 10;
/// Singular value, over the largest, from which on a direction belongs to the signal and not to the encoder's steps.
const SIGNAL: f64 = 0.02;
/// Amplitude, over the largest of a swing, from which on a swing counts: above what the encoder's steps leave.
const COUNTS: f64 = 0.2;

/// The parts of a signal that is sampled every so many seconds, each pair of poles once; no part of one that is zero.
/// None where there is no answer: a signal that is not finite or shorter than twice `COLUMNS`, poles that fit it not.
pub fn parts(signal: &[f64], every: f64) -> Option<Vec<Part>> {
    if signal.len() < 2 * COLUMNS || signal.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let rows = DMatrix::from_fn(signal.len() - COLUMNS, COLUMNS + 1, |row, column| signal[row + column]);
    let directions = SymmetricEigen::new(rows.tr_mul(&rows));
    let mut order: Vec<usize> = (0..=COLUMNS).collect();
    order.sort_by(|&a, &b| directions.eigenvalues[b].total_cmp(&directions.eigenvalues[a]));
    let largest = directions.eigenvalues[order[0]];
    let of_signal = |&&at: &&usize| directions.eigenvalues[at] > SIGNAL * SIGNAL * largest;
    let basis: Vec<_> = order.iter().take(MOST_POLES).take_while(of_signal).collect();
    if basis.is_empty() {
        return Some(Vec::new());
    }
    let basis = DMatrix::from_fn(COLUMNS + 1, basis.len(), |row, k| directions.eigenvectors[(row, *basis[k])]);
    let (upper, lower) = (basis.rows(0, COLUMNS), basis.rows(1, COLUMNS));
    let rotation = upper.clone_owned().svd(true, true).solve(&lower.clone_owned(), 1e-12).ok()?;
    let poles = rotation.complex_eigenvalues();
    let amplitudes = amplitudes(signal, &poles)?;
    let part = |(pole, amplitude): (&Complex<f64>, &Complex<f64>)| {
        let rate = pole.ln() / every;
        // of a pair the one above, for both; a real pole below zero is one at half of the sampling frequency
        let pair = if pole.im == 0.0 { 1.0 } else { 2.0 };
        (rate.im >= 0.0).then(|| Part { decay: -rate.re, frequency: rate.im, amplitude: pair * amplitude.norm() })
    };
    Some(poles.iter().zip(&amplitudes).filter_map(part).collect())
}

/// The amplitudes that fit a signal best by least squares; none where a power of a pole overflows.
fn amplitudes(signal: &[f64], poles: &DVector<Complex<f64>>) -> Option<DVector<Complex<f64>>> {
    let mut powers = DMatrix::from_element(signal.len(), poles.len(), Complex::new(1.0, 0.0));
    for row in 1..signal.len() {
        for (column, pole) in poles.iter().enumerate() {
            powers[(row, column)] = powers[(row - 1, column)] * pole;
        }
    }
    let signal = DVector::from_iterator(signal.len(), signal.iter().map(|value| Complex::new(*value, 0.0)));
    if powers.iter().any(|power| !power.re.is_finite() || !power.im.is_finite()) {
        return None;
    }
    powers.svd(true, true).solve(&signal, 1e-12).ok()
}

/// Decay (1/s) of the slowest swing of a signal, negative where it grows; NaN where its parts are not found. None
/// where nothing swings with an amplitude above `floor`, in the signal's unit.
pub fn slowest(signal: &[f64], every: f64, floor: f64) -> Option<f64> {
    let Some(parts) = parts(signal, every) else {
        return Some(f64::NAN);
    };
    let swings: Vec<Part> = parts.into_iter().filter(|part| part.swings() && part.amplitude > floor).collect();
    let largest = swings.iter().map(|swing| swing.amplitude).fold(0.0, f64::max);
    let counted = swings.iter().filter(|swing| swing.amplitude >= COUNTS * largest);
    counted.map(|swing| swing.decay).reduce(f64::min)
}
