//! A short stretch of the motion as its Taylor series, with what rounding may have done to it.

use super::dense::dot;
use super::regime::Regime;

/// Terms after the first: with the product of rate and length at most one, 1/21! = 2e-20 is left out.
const ORDER: usize = 20;
/// Units in the last place that count as rounding: products of a handful of terms, taken a hundredfold.
const ROUNDING: f64 = 1024.0 * f64::EPSILON;

/// `x(t)` for `t = s length`, `s` from 0 to 1, as a polynomial in `s`.
pub(super) struct Stretch {
    pub length: f64,
    terms: Vec<Vec<f64>>,
    /// The same sums with every term taken by its magnitude: the scale of rounding.
    magnitudes: Vec<Vec<f64>>,
}

impl Stretch {
    /// From `x`, under torques `f0 + f1 t`, for `length` seconds.
    pub fn new(regime: &Regime, x: &[f64], f0: &[f64], f1: &[f64], length: f64) -> Self {
        let m = x.len();
        let mut terms = vec![x.to_vec()];
        let mut magnitudes = vec![x.iter().map(|v| v.abs()).collect::<Vec<_>>()];
        let (mut ax, mut size, mut bf, mut bf_size) = (vec![0.0; m], vec![0.0; m], vec![0.0; m], vec![0.0; m]);
        for order in 1..=ORDER {
            let factor = length / order as f64;
            regime.a.times(&terms[order - 1], &mut ax);
            regime.a.magnitude_times(&magnitudes[order - 1], &mut size);
            let force = match order {
                1 => Some((f0, 1.0)),
                2 => Some((f1, length)),
                _ => None,
            };
            if let Some((force, scale)) = force {
                let sizes: Vec<f64> = force.iter().map(|v| v.abs()).collect();
                regime.b.times(force, &mut bf);
                regime.b.magnitude_times(&sizes, &mut bf_size);
                for i in 0..m {
                    ax[i] += scale * bf[i];
                    size[i] += scale * bf_size[i];
                }
            }
            terms.push(ax.iter().map(|v| v * factor).collect());
            magnitudes.push(size.iter().map(|v| v * factor).collect());
        }
        Self { length, terms, magnitudes }
    }

    /// The state at `s`.
    pub fn at(&self, s: f64) -> Vec<f64> {
        let mut x = vec![0.0; self.terms[0].len()];
        for term in self.terms.iter().rev() {
            for (value, t) in x.iter_mut().zip(term) {
                *value = *value * s + t;
            }
        }
        x
    }

    /// The linear form `row x + constant + slope t` along the stretch: coefficients in `s`, and their rounding.
    pub fn form(&self, row: &[f64], constant: f64, slope: f64) -> (Vec<f64>, Vec<f64>) {
        let sizes: Vec<f64> = row.iter().map(|v| v.abs()).collect();
        let mut values: Vec<f64> = self.terms.iter().map(|term| dot(row, term)).collect();
        let mut rounding: Vec<f64> = self.magnitudes.iter().map(|term| dot(&sizes, term)).collect();
        values[0] += constant;
        values[1] += slope * self.length;
        rounding[0] += constant.abs();
        rounding[1] += (slope * self.length).abs();
        for value in &mut rounding {
            *value *= ROUNDING;
        }
        (values, rounding)
    }
}
