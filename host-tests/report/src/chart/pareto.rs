//! Which variants are worth having: those that no other beats in both cost and error.

/// Indices of the points (cost, error) that no other point beats in one and equals in the other; by rising cost. A
/// point that is not finite is never on the front.
pub fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|&index| points[index].0.is_finite() && points[index].1.is_finite()).collect();
    order.sort_by(|&a, &b| points[a].0.total_cmp(&points[b].0).then(points[a].1.total_cmp(&points[b].1)));
    let mut least = f64::INFINITY;
    order.retain(|&index| {
        let better = points[index].1 < least;
        least = least.min(points[index].1);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::front;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points =
            [(3.0, 1.0), (1.0, 3.0), (2.0, 2.0), (2.5, 2.5), (1.0, 4.0), (f64::NAN, 0.0), (0.5, f64::INFINITY)];
        assert_eq!(front(&points), [1, 2, 0]);
        assert!(front(&[]).is_empty());
    }
}
