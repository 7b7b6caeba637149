//! Constants at the points of a grid, and between them.

use crate::number::{Interpolate, Weight};

const RISING: &str = "an axis of a gain schedule needs two points or more, each above the last and finite";

/// Values of a scheduling variable at the points of a grid.
///
/// ```
/// use driveline::scheduling::{Breakpoints, Schedule};
/// // gains at two loads and two lengths of rope, and in the middle of the four
/// const LOAD: Breakpoints<2> = Breakpoints::new([1.0, 3.0]);
/// const ROPE: Breakpoints<2> = Breakpoints::new([10.0, 20.0]);
/// const GAIN: Schedule<f64, 2, 2> = Schedule::new(LOAD, ROPE, [[1.0, 2.0], [3.0, 8.0]]);
/// assert_eq!((GAIN.at(2.0, 15.0), GAIN.at(9.0, 20.0)), (14.0 / 4.0, 8.0)); // beyond an end as at the end
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Breakpoints<const K: usize> {
    points: [f32; K],
}

impl<const K: usize> Breakpoints<K> {
    /// Two points or more, rising.
    ///
    /// # Panics
    /// At compile time in a constant, for points that do not rise or are not finite; [`try_new`](Self::try_new) returns
    /// the sentence.
    pub const fn new(points: [f64; K]) -> Self {
        match Self::try_new(points) {
            Ok(axis) => axis,
            Err(sentence) => panic!("{}", sentence),
        }
    }

    /// [`new`](Self::new), with the sentence instead of a panic.
    ///
    /// # Errors
    /// For fewer than two points, and for points that do not rise or are not finite.
    pub const fn try_new(points: [f64; K]) -> Result<Self, &'static str> {
        let mut single = [0.0; K];
        each!(k, 0..K, {
            single[k] = points[k] as f32;
            if !single[k].is_finite() || (k > 0 && !(single[k] > single[k - 1])) {
                return Err(RISING);
            }
        });
        if K < 2 { Err(RISING) } else { Ok(Breakpoints { points: single }) }
    }

    /// The point below a value and the weight of the next. A value beyond an end is taken to be at the end, NaN at the
    /// first point.
    pub(super) fn place(&self, value: f32) -> (usize, Weight) {
        let mut below = 0;
        let mut ends = [0.0, 1.0];
        for (k, pair) in self.points.windows(2).enumerate() {
            if let [low, high] = *pair
                && (k == 0 || value >= low)
            {
                (below, ends) = (k, [low, high]);
            }
        }
        let [low, high] = ends;
        (below, Weight::share((value - low) / (high - low)))
    }
}

/// Constants over two scheduling variables.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias = "gain scheduling")]
pub struct Schedule<C, const A: usize, const B: usize> {
    first: Breakpoints<A>,
    second: Breakpoints<B>,
    cells: [[C; B]; A],
}

impl<C: Interpolate, const A: usize, const B: usize> Schedule<C, A, B> {
    /// Constants at the points of two axes.
    pub const fn new(first: Breakpoints<A>, second: Breakpoints<B>, cells: [[C; B]; A]) -> Self {
        const { assert!(A >= 2 && B >= 2, "a gain schedule needs two points or more on each axis") };
        Schedule { first, second, cells }
    }

    /// The constants at these values, by bilinear interpolation; at the edge for values beyond it.
    ///
    /// To be called between two ticks. At a point of the grid they are those of the point, to the bit.
    #[must_use]
    pub fn at(&self, first: f32, second: f32) -> C {
        let (row, down) = self.first.place(first);
        let (column, along) = self.second.place(second);
        let cell = |row: usize, column: usize| &self.cells[row.min(A - 1)][column.min(B - 1)];
        let near = cell(row, column).between(cell(row, column + 1), along);
        let far = cell(row + 1, column).between(cell(row + 1, column + 1), along);
        near.between(&far, down)
    }
}

#[cfg(test)]
mod tests {
    use super::{Breakpoints, Schedule};

    /// `2 + 3 x + 5 y + 7 x y` at the points: bilinear, so that interpolation is exact but for the weights' 2^-16.
    fn law(x: f64, y: f64) -> f64 {
        2.0 + 3.0 * x + 5.0 * y + 7.0 * x * y
    }

    #[test]
    fn a_bilinear_law_comes_back_between_its_points_and_stays_at_its_edges() {
        let (xs, ys) = ([0.5, 1.0, 4.0], [-1.0, 2.0]);
        let cells = xs.map(|x| ys.map(|y| law(x, y)));
        let schedule = Schedule::new(Breakpoints::new(xs), Breakpoints::new(ys), cells);
        for x in [0.5, 0.7, 1.0, 2.5, 3.9, 4.0] {
            for y in [-1.0, 0.3, 2.0] {
                // 2^-16 of a cell in each direction, of at most 3 by 17 and 3 by 33
                let limit = (3.0 * 17.0 + 3.0 * 33.0) / 65_536.0;
                assert!((schedule.at(x as f32, y as f32) - law(x, y)).abs() <= limit, "{x}, {y}");
            }
        }
        assert_eq!(schedule.at(f32::NEG_INFINITY, f32::INFINITY), law(0.5, 2.0));
        assert_eq!(schedule.at(100.0, -7.0), law(4.0, -1.0));
        assert_eq!(schedule.at(f32::NAN, f32::NAN), law(0.5, -1.0));
    }

    #[test]
    fn points_that_do_not_rise_are_refused() {
        for points in [[1.0, 1.0, 2.0], [3.0, 2.0, 4.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::INFINITY]] {
            assert!(Breakpoints::try_new(points).is_err(), "{points:?}");
        }
        assert!(Breakpoints::try_new([1.0]).is_err());
    }
}
