//! Numbers that an elimination is done in: several shifts side by side, real or complex with a derivative.

/// What an elimination needs of its numbers.
pub(super) trait Number: Copy {
    const ZERO: Self;
    /// A constant.
    fn real(value: f64) -> Self;
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    /// Times a number.
    #[inline(always)]
    fn scaled(self, by: f64) -> Self {
        self.times(Self::real(by))
    }
    /// Of a zero that of a number far below any other.
    fn inverse(self) -> Self;
}

/// Real numbers side by side.
#[derive(Clone, Copy)]
pub(super) struct Reals<const L: usize>(pub [f64; L]);

#[inline(always)]
fn each<const L: usize>(mut a: [f64; L], b: [f64; L], of: impl Fn(f64, f64) -> f64) -> [f64; L] {
    for (a, b) in a.iter_mut().zip(b) {
        *a = of(*a, b);
    }
    a
}

/// In place of a zero, whose inverse would be infinite: far below any pivot, and its square is a number.
const NOTHING: f64 = 1e-150;

#[inline(always)]
fn nonzero(value: f64) -> f64 {
    if value == 0.0 { NOTHING } else { value }
}

impl<const L: usize> Number for Reals<L> {
    const ZERO: Self = Self([0.0; L]);

    #[inline(always)]
    fn real(value: f64) -> Self {
        Self([value; L])
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self(each(self.0, other.0, |a, b| a + b))
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self(each(self.0, other.0, |a, b| a - b))
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self(each(self.0, other.0, |a, b| a * b))
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        Self(self.0.map(|value| 1.0 / nonzero(value)))
    }
}

/// Complex numbers side by side.
#[derive(Clone, Copy)]
pub(super) struct Complexes<const L: usize> {
    pub re: [f64; L],
    pub im: [f64; L],
}

impl<const L: usize> Number for Complexes<L> {
    const ZERO: Self = Self { re: [0.0; L], im: [0.0; L] };

    #[inline(always)]
    fn scaled(self, by: f64) -> Self {
        Self { re: self.re.map(|re| re * by), im: self.im.map(|im| im * by) }
    }

    #[inline(always)]
    fn real(value: f64) -> Self {
        Self { re: [value; L], im: [0.0; L] }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self { re: each(self.re, other.re, |a, b| a + b), im: each(self.im, other.im, |a, b| a + b) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self { re: each(self.re, other.re, |a, b| a - b), im: each(self.im, other.im, |a, b| a - b) }
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let mut product = Self::ZERO;
        for l in 0..L {
            product.re[l] = self.re[l] * other.re[l] - self.im[l] * other.im[l];
            product.im[l] = self.re[l] * other.im[l] + self.im[l] * other.re[l];
        }
        product
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        let mut inverse = Self::ZERO;
        for l in 0..L {
            // by the larger part, free of over- and underflow
            let (re, im) = (self.re[l], self.im[l]);
            let scale = 1.0 / nonzero(re.abs().max(im.abs()));
            let (a, b) = (re * scale, im * scale);
            let size = scale / nonzero(a * a + b * b);
            inverse.re[l] = a * size;
            inverse.im[l] = -b * size;
        }
        inverse
    }
}

/// A complex function and its derivative by the shift.
#[derive(Clone, Copy)]
pub(super) struct Dual<const L: usize> {
    pub value: Complexes<L>,
    pub slope: Complexes<L>,
}

impl<const L: usize> Number for Dual<L> {
    const ZERO: Self = Self { value: Complexes::ZERO, slope: Complexes::ZERO };

    #[inline(always)]
    fn scaled(self, by: f64) -> Self {
        Self { value: self.value.scaled(by), slope: self.slope.scaled(by) }
    }

    #[inline(always)]
    fn real(value: f64) -> Self {
        Self { value: Complexes::real(value), slope: Complexes::ZERO }
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self { value: self.value.plus(other.value), slope: self.slope.plus(other.slope) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self { value: self.value.minus(other.value), slope: self.slope.minus(other.slope) }
    }

    #[inline(always)]
    fn times(self, other: Self) -> Self {
        let slope = self.slope.times(other.value).plus(self.value.times(other.slope));
        Self { value: self.value.times(other.value), slope }
    }

    #[inline(always)]
    fn inverse(self) -> Self {
        let value = self.value.inverse();
        let slope = Complexes::ZERO.minus(self.slope.times(value).times(value));
        Self { value, slope }
    }
}
