//! Polynomials in delta = z - 1, and whether all their roots are stable.
//!
//! A loop that is sampled often has its poles close to z = 1, where the coefficients in z lose their digits. In delta
//! they keep them [Middleton and Goodwin 1990, Digital Control and Estimation]. The bilinear map `delta = 2 w/(1 - w)`
//! takes the stable disc to the left half plane, and Routh's array decides there: some hundred multiplications for a
//! loop of eleven poles, no eigenvalue.

use super::complex::Complex;

/// Coefficients that a polynomial may have: a chain of sixteen masses, an observer of five states, a governor, an
/// actuator.
const CAPACITY: usize = 56;

/// A polynomial in delta, the constant first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Polynomial {
    coefficient: [f64; CAPACITY],
    degree: usize,
}

impl Polynomial {
    pub(super) const ONE: Self = Self::new([1.0]);

    pub(super) const Z: Self = Self::new([1.0, 1.0]);

    pub(super) const fn new<const N: usize>(coefficients: [f64; N]) -> Self {
        let mut coefficient = [0.0; CAPACITY];
        each!(k, 0.., k < N && k < CAPACITY, {
            coefficient[k] = coefficients[k];
        });
        Self { coefficient, degree: N - 1 }
    }

    /// This times another. What would not fit is left out; the callers' degrees are bounded below that.
    pub(super) const fn times(&self, other: &Self) -> Self {
        let mut product = Self { coefficient: [0.0; CAPACITY], degree: self.degree + other.degree };
        each!(i, 0.., i <= self.degree && i < CAPACITY, {
            let factor = self.coefficient[i];
            each!(j, 0.., factor != 0.0 && j <= other.degree && i + j < CAPACITY, {
                product.coefficient[i + j] += factor * other.coefficient[j];
            });
        });
        product
    }

    /// This and `factor` times another.
    pub(super) const fn plus(&self, factor: f64, other: &Self) -> Self {
        let mut sum = *self;
        if other.degree > sum.degree {
            sum.degree = other.degree;
        }
        each!(k, 0.., k <= other.degree && k < CAPACITY, {
            sum.coefficient[k] += factor * other.coefficient[k];
        });
        sum
    }

    pub(super) const fn scaled(&self, factor: f64) -> Self {
        Self::new([factor]).times(self)
    }

    /// Times a power of delta.
    pub(super) const fn raised(&self, times: usize) -> Self {
        let mut raised = Self { coefficient: [0.0; CAPACITY], degree: self.degree + times };
        each!(k, 0.., k <= self.degree && k + times < CAPACITY, {
            raised.coefficient[k + times] = self.coefficient[k];
        });
        raised
    }

    /// The value at a delta.
    pub(super) const fn at(&self, delta: Complex) -> Complex {
        let mut value = (0.0, 0.0);
        let mut k = if self.degree < CAPACITY { self.degree + 1 } else { CAPACITY };
        while k > 0 {
            k -= 1;
            value =
                (value.0 * delta.0 - value.1 * delta.1 + self.coefficient[k], value.0 * delta.1 + value.1 * delta.0);
        }
        value
    }

    /// The first coefficients.
    pub(super) const fn first<const N: usize>(&self) -> [f64; N] {
        let mut first = [0.0; N];
        each!(k, 0.., k < N && k < CAPACITY, {
            first[k] = self.coefficient[k];
        });
        first
    }

    /// The degree without leading zeros.
    pub(super) const fn order(&self) -> usize {
        let mut n = if self.degree < CAPACITY { self.degree } else { CAPACITY - 1 };
        while n > 0 && self.coefficient[n] == 0.0 {
            n -= 1;
        }
        n
    }

    /// Whether every root lies within the unit circle of z, given a positive leading coefficient.
    pub(super) const fn is_stable(&self) -> bool {
        self.degree < CAPACITY && self.mapped(self.order()).is_hurwitz()
    }

    /// `(1 - w)^n` times the value at `2 w/(1 - w)`, by Horner's scheme: a polynomial in w. The degree is at most n.
    pub(super) const fn mapped(&self, n: usize) -> Self {
        let mut mapped = [0.0; CAPACITY];
        // The powers of `1 - w`.
        let mut power = [0.0; CAPACITY];
        mapped[0] = self.coefficient[n];
        power[0] = 1.0;
        let mut k = n;
        while k > 0 {
            k -= 1;
            let coefficient = self.coefficient[k];
            let mut j = n - k;
            while j > 0 {
                power[j] -= power[j - 1];
                mapped[j] = 2.0 * mapped[j - 1] + coefficient * power[j];
                j -= 1;
            }
            mapped[0] = coefficient;
        }
        Self { coefficient: mapped, degree: n }
    }

    /// Whether every root of a polynomial in w has a negative real part, given a positive leading coefficient: Routh's
    /// array in place, from the leading coefficient down.
    pub(super) const fn is_hurwitz(&self) -> bool {
        let mut mapped = self.coefficient;
        let mut i = self.degree;
        while i > 0 {
            if !(mapped[i] > 0.0 && mapped[i - 1] > 0.0 && mapped[i].is_finite()) {
                return false;
            }
            let factor = mapped[i] / mapped[i - 1];
            let mut j = i;
            while j > 2 {
                mapped[j - 2] -= factor * mapped[j - 3];
                j -= 2;
            }
            i -= 1;
        }
        mapped[0] > 0.0
    }
}
