//! Taylor coefficients of a quantity over a stretch, `y(t) = sum y_k s^k` with `s = t/h` from 0 to 1.
//!
//! Every operation gives one coefficient from those below it, so that a system of equations is solved order by order.

/// Coefficients kept. With the product of rate and length at most two, `2^25/25!` = 2e-18 is left out.
pub const TERMS: usize = 25;

/// Coefficients, lowest first.
pub type Series = [f64; TERMS];

/// Nothing.
pub const ZERO: Series = [0.0; TERMS];

/// Value at `s`.
pub fn value(series: &Series, s: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, c| sum * s + c)
}

/// Coefficient `k` of a product.
pub fn product(a: &Series, b: &Series, k: usize) -> f64 {
    (0..=k).map(|i| a[i] * b[k - i]).sum()
}

/// Coefficient `k` of the quotient whose lower ones stand in `quotient`.
pub fn quotient(a: &Series, b: &Series, quotient: &Series, k: usize) -> f64 {
    (a[k] - (1..=k).map(|i| b[i] * quotient[k - i]).sum::<f64>()) / b[0]
}

/// Coefficient `k` of the root whose lower ones stand in `root`.
pub fn root(a: &Series, root: &Series, k: usize) -> f64 {
    if k == 0 {
        return a[0].sqrt();
    }
    (a[k] - (1..k).map(|i| root[i] * root[k - i]).sum::<f64>()) / (2.0 * root[0])
}

/// Sine and cosine of a multiple of an angle.
#[derive(Debug, Clone, Copy)]
pub struct Turn {
    pub order: f64,
    pub sine: Series,
    pub cosine: Series,
}

impl Turn {
    pub const fn new(order: f64) -> Self {
        Self { order, sine: ZERO, cosine: ZERO }
    }

    /// Fills in coefficient `k` from the angle's coefficients up to it.
    pub fn extend(&mut self, angle: &Series, k: usize) {
        if k == 0 {
            (self.sine[0], self.cosine[0]) = (self.order * angle[0]).sin_cos();
            return;
        }
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (i, coefficient) in angle.iter().enumerate().take(k + 1).skip(1) {
            let weight = i as f64 * self.order * coefficient;
            sine += weight * self.cosine[k - i];
            cosine -= weight * self.sine[k - i];
        }
        (self.sine[k], self.cosine[k]) = (sine / k as f64, cosine / k as f64);
    }
}

/// Adds `a cos(omega t) + b sin(omega t)`, from the time `t` on over the length `h`.
pub fn add_harmonic(into: &mut Series, (a, b): (f64, f64), omega: f64, t: f64, h: f64) {
    let (sine, cosine) = (omega * t).sin_cos();
    // value and derivative over omega turn a quarter with every order
    let (mut now, mut next) = (a * cosine + b * sine, b * cosine - a * sine);
    let mut factor = 1.0;
    for (k, coefficient) in into.iter_mut().enumerate() {
        *coefficient += factor * now;
        factor *= omega * h / (k + 1) as f64;
        (now, next) = (next, -now);
    }
}

#[cfg(test)]
mod tests {
    use crate::plant::train::series::*;

    #[test]
    fn the_operations_give_the_known_series() {
        let mut angle = ZERO;
        angle[1] = 0.5;
        let mut turn = Turn::new(2.0);
        let (mut square, mut back, mut secant) = (ZERO, ZERO, ZERO);
        for k in 0..TERMS {
            turn.extend(&angle, k);
            square[k] = product(&turn.cosine, &turn.cosine, k);
            back[k] = root(&square, &back, k);
            secant[k] = quotient(&turn.sine, &turn.cosine, &secant, k);
        }
        let mut harmonic = ZERO;
        add_harmonic(&mut harmonic, (1.0, 0.0), 1.0, 0.0, 1.0);
        // at a third of the way rounding alone is left; the tangent's own series converges as (2/pi)^k / 3^k
        assert!((value(&turn.cosine, 1.0) - 1.0_f64.cos()).abs() < 1e-15);
        assert!((value(&back, 0.3) - 0.3_f64.cos()).abs() < 1e-15);
        assert!((value(&secant, 0.3) - 0.3_f64.tan()).abs() < 1e-15);
        assert!(harmonic.iter().zip(&turn.cosine).all(|(a, b)| (a - b).abs() < 1e-16));
    }
}
