//! Long series as short paths: the smallest and the largest of each stretch are kept, so that no peak is lost.

use std::fmt::Write;

use super::Scale;

/// A series as SVG path data in tenths of a unit, with relative moves.
///
/// The series is cut into `stretches` equal parts; of each the first, smallest, largest and last points are drawn, in
/// the order of the series. A value that is not finite breaks the line.
pub fn trace(time: &[f64], values: &[f64], x: Scale, y: Scale, stretches: usize) -> String {
    let count = time.len().min(values.len());
    let mut data = String::new();
    let mut last: Option<(i64, i64)> = None;
    for index in kept(&values[..count], stretches.max(1)) {
        let place = if values[index].is_finite() && time[index].is_finite() {
            x.place(time[index]).zip(y.place(values[index]))
        } else {
            None
        };
        let Some((px, py)) = place else {
            last = None;
            continue;
        };
        let point = ((px * 10.0).round() as i64, (py * 10.0).round() as i64);
        match last {
            None => drop(write!(data, "M{} {}", point.0, point.1)),
            Some(before) if before != point => drop(write!(data, "l{} {}", point.0 - before.0, point.1 - before.1)),
            Some(_) => {}
        }
        last = Some(point);
    }
    data
}

/// Indices of the points that are drawn.
fn kept(values: &[f64], stretches: usize) -> Vec<usize> {
    if values.len() <= 4 * stretches {
        return (0..values.len()).collect();
    }
    let mut indices = Vec::with_capacity(4 * stretches);
    for stretch in 0..stretches {
        let (start, end) = (stretch * values.len() / stretches, (stretch + 1) * values.len() / stretches);
        let (mut least, mut most) = (start, start);
        let mut broken = None;
        for index in start..end {
            let value = values[index];
            if !value.is_finite() {
                broken = Some(index);
            } else {
                // A comparison with what is not finite is replaced by the first finite value.
                if !values[least].is_finite() || value < values[least] {
                    least = index;
                }
                if !values[most].is_finite() || value > values[most] {
                    most = index;
                }
            }
        }
        let mut points = [start, least, most, broken.unwrap_or(start), end - 1];
        points.sort_unstable();
        for point in points {
            if indices.last() != Some(&point) {
                indices.push(point);
            }
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use crate::svg::trace::*;

    #[test]
    fn the_extremes_of_a_long_series_are_kept() {
        let mut values: Vec<f64> = (0..100_000).map(|n| (f64::from(n) * 0.37).sin()).collect();
        values[31_415] = 9.0;
        values[92_653] = -7.0;
        let kept = kept(&values, 500);
        assert!(kept.contains(&31_415) && kept.contains(&92_653));
        assert!(kept.len() <= 5 * 500 && kept.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn what_is_not_finite_breaks_the_line() {
        let scale = Scale::exactly(0.0, 4.0, 0.0, 40.0);
        let time = [0.0, 1.0, 2.0, 3.0, 4.0];
        assert_eq!(trace(&time, &[0.0, 1.0, f64::NAN, 3.0, 4.0], scale, scale, 10), "M0 0l100 100M300 300l100 100");
        assert_eq!(trace(&time, &[f64::INFINITY; 5], scale, scale, 1), "");
        assert_eq!(trace(&[], &[], scale, scale, 1), "");
    }
}
