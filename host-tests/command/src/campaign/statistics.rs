//! Order statistics and rank correlation.

/// The value that a share of the values does not exceed: the one of rank `ceil(share n)` in a sorted list; NaN of an
/// empty one. No value is made up between two.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let rank = (share * sorted.len() as f64).ceil().max(1.0) as usize;
    sorted.get(rank.min(sorted.len()).wrapping_sub(1)).copied().unwrap_or(f64::NAN)
}

/// Values below which there is no range of the median with a confidence of 95 %.
pub const FEWEST_OF_RANGE: usize = 6;

/// The range that the median of the population lies in with a confidence of about 95 %, from order statistics: ranks
/// `n/2 -+ 0.98 sqrt n` of the sorted values, by the normal approximation of the binomial distribution
/// [Conover 1999, 3.2]. NaN of fewer than six values: five lie all on one side of the median in 2/2^5 or 6 % of all
/// cases, six in 3 %.
pub fn median_range(sorted: &[f64]) -> (f64, f64) {
    if sorted.len() < FEWEST_OF_RANGE {
        return (f64::NAN, f64::NAN);
    }
    let count = sorted.len() as f64;
    let half = 0.98 / count.sqrt();
    (quantile(sorted, (0.5 - half).max(0.0)), quantile(sorted, (0.5 + half + 1.0 / count).min(1.0)))
}

/// Spearman's rank correlation, ties by their mean rank; 0 where one of the lists does not vary.
pub fn rank_correlation(x: &[f64], y: &[f64]) -> f64 {
    let (x, y) = (ranks(x), ranks(y));
    let mean = (x.len() as f64 + 1.0) / 2.0;
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>();
    let size = (sum(&x, &x) * sum(&y, &y)).sqrt();
    if size > 0.0 { sum(&x, &y) / size } else { 0.0 }
}

/// The size that the largest of so many rank correlations exceeds in one of twenty campaigns of so many draws in which
/// no factor matters: the normal approximation `z/sqrt(n - 1)` [Conover 1999, 5.4], z for the share `0.05/many` in both
/// tails, which bounds the largest by the sum of all.
pub fn noise_of_largest(draws: usize, many: usize) -> f64 {
    let tail = 0.5 * 0.05 / many.max(1) as f64;
    deviate(tail) / (draws as f64 - 1.0).max(1.0).sqrt()
}

/// The standard normal deviate that is exceeded with this probability of at most one half, to 4.5e-4 [Abramowitz and
/// Stegun 1964, 26.2.23].
fn deviate(probability: f64) -> f64 {
    let t = (-2.0 * probability.ln()).sqrt();
    let above = 2.515_517 + t * (0.802_853 + t * 0.010_328);
    t - above / (1.0 + t * (1.432_788 + t * (0.189_269 + t * 0.001_308)))
}

/// Ranks from 1; ties have their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    while first < order.len() {
        let tied = order[first..].iter().take_while(|&&at| values[at].total_cmp(&values[order[first]]).is_eq()).count();
        for &at in &order[first..first + tied] {
            ranks[at] = first as f64 + (tied as f64 + 1.0) / 2.0;
        }
        first += tied;
    }
    ranks
}
