//! From numbers to places on an axis, linear or logarithmic, with round ticks.

use crate::format;

/// An axis: the numbers it spans and the places of its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
    logarithmic: bool,
}

impl Scale {
    /// A linear axis over the finite numbers given, widened to round ticks; without any, from 0 to 1.
    pub fn linear(values: impl IntoIterator<Item = f64>, from: f64, to: f64) -> Self {
        let (mut low, mut high) = bounds(values).unwrap_or((0.0, 1.0));
        // A flat line stands in the middle of a band of its own size.
        if high - low <= 1e-12 * high.abs().max(low.abs()) {
            let half = if high == 0.0 { 1.0 } else { high.abs() * 0.5 };
            (low, high) = (low - half, high + half);
        }
        let margin = (high - low) * 0.04;
        Self { low: low - margin, high: high + margin, from, to, logarithmic: false }
    }

    /// A linear axis with exactly these ends.
    pub fn exactly(low: f64, high: f64, from: f64, to: f64) -> Self {
        let high = if high > low { high } else { low + 1.0 };
        Self { low, high, from, to, logarithmic: false }
    }

    /// A logarithmic axis over the finite positive numbers given, with a tenth of its length as margin; without any, 1
    /// to 10.
    pub fn logarithmic(values: impl IntoIterator<Item = f64>, from: f64, to: f64) -> Self {
        let (low, high) = bounds(values.into_iter().filter(|&value| value > 0.0)).unwrap_or((1.0, 10.0));
        let (low, high) = (low.log10(), high.log10());
        // A third of a decade at least on either side of the middle, so that near points do not fill the plot.
        let margin = ((high - low) * 0.1).max(0.33 - (high - low) / 2.0).max(0.08);
        Self { low: low - margin, high: high + margin, from, to, logarithmic: true }
    }

    /// The place of a number; `None` where it has none. A value past an end is put on the end.
    pub fn place(&self, value: f64) -> Option<f64> {
        let value = if self.logarithmic { value.log10() } else { value };
        if value.is_nan() || value.is_infinite() && self.logarithmic && value < 0.0 {
            return None;
        }
        let share = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        Some(self.from + share * (self.to - self.from))
    }

    /// A logarithmic axis from one positive number to another.
    pub fn exactly_logarithmic(low: f64, high: f64, from: f64, to: f64) -> Self {
        let low = low.max(f64::MIN_POSITIVE);
        Self { logarithmic: true, ..Self::exactly(low.log10(), high.max(low).log10(), from, to) }
    }

    /// For the viewer: both ends, as logarithms where it is logarithmic, and whether it is.
    pub(super) fn ends(&self) -> String {
        format!("{},{},{}", self.low, self.high, u8::from(self.logarithmic))
    }

    /// Ticks as places and labels: about `wanted` of them on a linear axis.
    pub fn ticks(&self, wanted: f64) -> Vec<(f64, String)> {
        if self.logarithmic { self.decades(wanted) } else { self.steps(wanted) }
    }

    fn steps(&self, wanted: f64) -> Vec<(f64, String)> {
        let rough = (self.high - self.low) / wanted.max(1.0);
        let decade = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|&step| step >= rough);
        let Some(step) = step.filter(|step| step.is_finite() && *step > 0.0) else {
            return Vec::new();
        };
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        let label = |index: i64| {
            let value = index as f64 * step;
            self.place(value).map(|place| (place, format::tick(value, step)))
        };
        (first..=last.min(first.saturating_add(50))).filter_map(label).collect()
    }

    /// Powers of ten, thinned to `wanted`; over less than a decade and a half, 1, 2 and 5 of each.
    fn decades(&self, wanted: f64) -> Vec<(f64, String)> {
        let (first, last) = (self.low.floor() as i32, self.high.ceil() as i32);
        let span = self.high - self.low;
        let stride = ((span / wanted.max(1.0)).ceil() as i32).max(1);
        let factors: &[f64] = if span < 1.0 {
            &[1.0, 1.5, 2.0, 3.0, 5.0, 7.0]
        } else if span < 2.2 {
            &[1.0, 2.0, 5.0]
        } else {
            &[1.0]
        };
        let mut ticks = Vec::new();
        for exponent in (first..=last).filter(|exponent| exponent.rem_euclid(stride) == 0) {
            for &factor in factors {
                let value = factor * 10f64.powi(exponent);
                let inside = value.log10() >= self.low - 1e-9 && value.log10() <= self.high + 1e-9;
                let label = if factor == 1.0 { format::power(exponent) } else { format::significant_short(value) };
                if let (true, Some(place)) = (inside, self.place(value)) {
                    ticks.push((place, label));
                }
            }
        }
        ticks
    }
}

fn bounds(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    finite.fold(None, |bounds, value| {
        let (low, high) = bounds.unwrap_or((value, value));
        Some((f64::min(low, value), f64::max(high, value)))
    })
}

#[cfg(test)]
mod tests {
    use crate::svg::scale::*;

    #[test]
    fn any_numbers_give_an_axis() {
        for values in
            [vec![], vec![f64::NAN], vec![0.0], vec![-3.0, 1e300], vec![f64::INFINITY, 2.0], vec![1e-300, 2e-300]]
        {
            for scale in [Scale::linear(values.clone(), 0.0, 100.0), Scale::logarithmic(values.clone(), 0.0, 100.0)] {
                assert!(scale.ticks(5.0).len() <= 51);
                for value in [0.0, -1.0, 1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    assert!(scale.place(value).is_none_or(|place| (0.0..=100.0).contains(&place)));
                }
            }
        }
    }

    #[test]
    fn ticks_are_round() {
        let labels = |scale: Scale| scale.ticks(5.0).into_iter().map(|(_, label)| label).collect::<Vec<_>>();
        assert_eq!(labels(Scale::exactly(0.0, 10.0, 0.0, 1.0)), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(Scale::logarithmic([1e-6, 1e3], 0.0, 1.0)), ["10⁻⁶", "10⁻³", "1", "1000"]);
        assert_eq!(labels(Scale::logarithmic([30.0, 150.0], 0.0, 1.0)), ["30", "50", "70", "100", "150"]);
    }
}
