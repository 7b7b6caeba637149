//! Natural whirls over the speed, and where the unbalance meets them.

use nalgebra::{Complex, DMatrix};

use super::error::RotorError;
use super::model::{Model, entries};
use super::pencil::{Motion, Pencil};

/// Which way a whirl goes round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WhirlSense {
    /// With the spin.
    Forward,
    /// Against the spin.
    Backward,
    /// Along a line, or forward at some places and backward at others.
    Mixed,
}

/// A natural whirl at a speed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Natural {
    /// Damped frequency (rad/s).
    pub frequency: f64,
    /// Size of the eigenvalue (rad/s): the frequency without its damping.
    pub undamped: f64,
    /// Damping ratio; negative where the whirl grows.
    pub damping_ratio: f64,
    pub sense: WhirlSense,
}

/// Natural whirls at some speeds.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Campbell {
    /// Speeds (rad/s).
    pub speeds: Vec<f64>,
    /// The whirls at each speed, lowest first.
    pub whirls: Vec<Vec<Natural>>,
}

/// A critical speed without damping.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Critical {
    /// Speed (rad/s).
    pub speed: f64,
    /// Sense of the whirl. On supports that are alike in all directions unbalance excites forward whirls only.
    pub sense: WhirlSense,
}

/// Share of the larger of two circles that the smaller one may have before a motion counts as mixed.
const MIXED: f64 = 0.9;
/// Share of a critical speed within which others count as the same, far above rounding.
const ALIKE: f64 = 1e-6;

/// Damping ratio from which a motion counts as a decay: of such a one e^-140 is left after a turn.
const DECAY: f64 = 0.999;
/// Half-width of a resonance over the highest speed from which even steps find its top.
const WIDE: f64 = 0.02;

/// Deflections along `x` and `y` of a station, by coordinates.
type Station = [Vec<(usize, f64)>; 2];
type Shape = Vec<Complex<f64>>;

impl Model {
    /// Critical speeds up to a highest one (rad/s) and the first beyond, lowest first: speeds at which the undamped
    /// rotor whirls once a turn. The stiffness counts by its symmetric part.
    ///
    /// From `(K - Omega^2 (M - i G)) q = 0` of the whirl `q exp(i Omega t)`.
    #[must_use]
    pub fn criticals(&self, highest: f64) -> Vec<Critical> {
        let mut all: Vec<Critical> = self.synchronous(highest, 1).into_iter().map(|(critical, _)| critical).collect();
        let within = all.iter().take_while(|critical| critical.speed <= highest).count();
        all.truncate(within + 1);
        all
    }

    /// The lowest `count` critical speeds (rad/s) of the forward whirls, lowest first, each with the deflection at
    /// every station, the largest of which is 1: the shapes of modal balancing. On supports that are alike in all
    /// directions a whirl is round and in one plane, and these shapes are those in which unbalance bends the undamped
    /// rotor.
    #[must_use]
    pub fn forward_shapes(&self, count: usize) -> Vec<(f64, Vec<f64>)> {
        let stations = self.sparse();
        let mut beyond = 2 * count + 2;
        let forward = loop {
            let mut all = self.synchronous(0.0, beyond);
            let whole = all.len() < beyond;
            all.retain(|(critical, _)| critical.sense == WhirlSense::Forward);
            if whole || all.len() >= count {
                all.truncate(count);
                break all;
            }
            beyond *= 2;
        };
        let scaled = |(critical, shape): (Critical, Shape)| {
            let whirls: Vec<Complex<f64>> = stations.iter().map(|rows| circles(rows, &shape)[0]).collect();
            let largest = whirls.iter().copied().max_by(|a, b| a.norm().total_cmp(&b.norm()));
            let largest = largest.unwrap_or(Complex::new(1.0, 0.0));
            (critical.speed, whirls.iter().map(|whirl| (whirl / largest).re).collect())
        };
        forward.into_iter().map(scaled).collect()
    }

    /// Critical speeds up to a highest one and some beyond, lowest first, with the deflections of their whirls.
    fn synchronous(&self, highest: f64, beyond: usize) -> Vec<(Critical, Shape)> {
        let stations = self.sparse();
        // one more, of which the last may be half of a pair
        let motions = self.once_a_turn(false).motions(|values, last| {
            let order = whirling(values, |value| value.im > value.re.abs());
            let within = order.iter().take_while(|&&k| values[k].im <= highest).count();
            (last || order.len() > within + beyond).then(|| order.into_iter().take(within + beyond + 1).collect())
        });
        let values = sorted(motions.motions);
        let speeds: Vec<f64> = values.iter().map(|motion| motion.value.im).collect();
        let shapes = separated(&stations, values);
        let critical = |(speed, shape): (f64, Shape)| (Critical { speed, sense: sense(&stations, &shape) }, shape);
        speeds.into_iter().zip(shapes).map(critical).collect()
    }

    /// Speeds (rad/s) up to a highest one at which unbalance may meet a narrow resonance, each with the half-width of
    /// it: the damped whirls `q exp(i Omega t)` of `(K + i Omega C - Omega^2 (M - i G)) q = 0`, `Omega` complex.
    /// Resonances of a half-width of more than 2 % of the highest speed may be missing.
    #[must_use]
    pub fn resonances(&self, highest: f64) -> Vec<(f64, f64)> {
        let narrow = |value: Complex<f64>| value.re.abs() <= WIDE * highest && value.im <= highest * (1.0 + WIDE);
        let motions = self.once_a_turn(true).motions(|values, last| {
            let order = whirling(values, |value| value.im > value.re.abs() || narrow(value));
            let beyond = order.iter().copied().find(|&k| values[k].im > highest * (1.0 + WIDE));
            let mut wanted: Vec<usize> = order.into_iter().filter(|&k| narrow(values[k])).collect();
            wanted.extend(beyond);
            (last || beyond.is_some()).then_some(wanted)
        });
        let all = sorted(motions.motions).into_iter().filter(|motion| narrow(motion.value));
        all.map(|motion| (motion.value.im, motion.value.re.abs())).collect()
    }

    /// `K + lambda C + lambda^2 (M - i G)`, of which `lambda = i Omega` are whirls once a turn.
    fn once_a_turn(&self, damped: bool) -> Pencil<'_, Complex<f64>> {
        let stiffness = |i, j| {
            let [straight, across] = [(i, j), (j, i)].map(|at| self.stiffness[at]);
            Complex::new(if damped { straight } else { 0.5 * (straight + across) }, 0.0)
        };
        Pencil {
            stiffness: self.band(stiffness),
            damping: self.band(|i, j| Complex::new(if damped { self.damping[(i, j)] } else { 0.0 }, 0.0)),
            inertia: self.band(|i, j| Complex::new(self.mass[(i, j)], -self.gyroscopic[(i, j)])),
            strains: &self.strains,
            symmetric: !damped,
        }
    }

    /// The `count` lowest natural whirls at each of some speeds (rad/s). A motion that decays at a damping ratio of
    /// 0.999 or more is none.
    ///
    /// Every whirl is proven by its residual, and that none is missing at the first and the last speed.
    ///
    /// # Errors
    /// A speed that is not finite; [`RotorError::Unproven`].
    pub fn campbell(&self, speeds: &[f64], count: usize) -> Result<Campbell, RotorError> {
        for (index, &speed) in speeds.iter().enumerate() {
            super::error::check("speed", || format!("point {index}"), speed, true, "a finite number")?;
        }
        let stations = self.sparse();
        let ends = [0, speeds.len().saturating_sub(1)];
        let whirls = speeds.iter().enumerate().map(|(index, &speed)| {
            self.naturals(&stations, speed, count, ends.contains(&index)).ok_or(RotorError::Unproven { speed })
        });
        Ok(Campbell { speeds: speeds.to_vec(), whirls: whirls.collect::<Result<_, _>>()? })
    }

    /// The lowest natural whirls; `None` where some may be missing. They are counted if `counted`, or if not all of
    /// them are proven.
    fn naturals(&self, stations: &[Station], speed: f64, count: usize, counted: bool) -> Option<Vec<Natural>> {
        let pencil = Pencil {
            stiffness: self.band(|i, j| self.stiffness[(i, j)]),
            damping: self.band(|i, j| self.damping[(i, j)] + speed * self.gyroscopic[(i, j)]),
            inertia: self.band(|i, j| self.mass[(i, j)]),
            strains: &self.strains,
            symmetric: false,
        };
        let whirls = |value: Complex<f64>, from: f64| value.im > 0.0 && -value.re < from * value.norm();
        let found = pencil.motions(|values, last| {
            // so near to a decay, it may turn out to be none
            let order = whirling(values, |value| whirls(value, 0.5 * (1.0 + DECAY)));
            // two more: the last may be one of a pair, or a decay
            (last || order.len() >= count + 2).then(|| order.into_iter().take(count + 2).collect())
        });
        let mut motions = sorted(found.motions);
        motions.retain(|motion| whirls(motion.value, DECAY));
        if !found.whole || counted && !motions.is_empty() {
            // all that are shown, up to a gap
            let gap =
                |k: &usize| motions.get(*k).is_none_or(|next| next.value.im > motions[k - 1].value.im * (1.0 + ALIKE));
            let shown = count.min(motions.len());
            let within = (shown.max(1)..=motions.len()).find(gap)?;
            let last = motions[within - 1].value.im;
            let top = motions.get(within).map_or(last * (1.0 + ALIKE), |next| 0.5 * (last + next.value.im));
            let inside = motions[..within].iter().filter(|motion| motion.value.re < top).count();
            if pencil.count(top, DECAY, &found.values)? != inside {
                return None;
            }
        }
        let values: Vec<Complex<f64>> = motions.iter().map(|motion| motion.value).collect();
        let natural = |(value, shape): (Complex<f64>, Shape)| Natural {
            frequency: value.im,
            undamped: value.norm(),
            damping_ratio: -value.re / value.norm(),
            sense: sense(stations, &shape),
        };
        Some(values.into_iter().zip(separated(stations, motions)).take(count).map(natural).collect())
    }

    fn sparse(&self) -> Vec<Station> {
        self.stations.iter().map(|rows| [0, 1].map(|axis| entries(&rows[axis]))).collect()
    }
}

/// Indices of the values that are chosen, the lowest frequency first.
fn whirling(values: &[Complex<f64>], chosen: impl Fn(Complex<f64>) -> bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).filter(|&k| values[k].im > 0.0 && chosen(values[k])).collect();
    order.sort_by(|&a, &b| values[a].im.total_cmp(&values[b].im));
    order
}

fn sorted(mut motions: Vec<Motion>) -> Vec<Motion> {
    motions.sort_by(|a, b| a.value.im.total_cmp(&b.value.im));
    motions
}

/// The shapes, those of one frequency told apart.
fn separated(stations: &[Station], motions: Vec<Motion>) -> Vec<Shape> {
    let alike = |a: &Motion, b: &Motion| (b.value - a.value).norm() <= ALIKE * a.value.norm();
    let group = |group: &[Motion]| {
        let shapes: Vec<Shape> = group.iter().map(|motion| motion.shape.clone()).collect();
        combined(stations, shapes)
    };
    motions.chunk_by(alike).flat_map(group).collect()
}

/// Whirls of one frequency, of which any combination is one: those that go round least forward, up to the most.
fn combined(stations: &[Station], shapes: Vec<Shape>) -> Vec<Shape> {
    let m = shapes.len();
    if m == 1 {
        return shapes;
    }
    // apart from another in the coordinates, so that the combinations are, too
    let n = shapes[0].len();
    let independent = DMatrix::from_fn(n, m, |i, k| shapes[k][i]).qr().q();
    let shapes: Vec<Shape> = independent.column_iter().map(|column| column.iter().copied().collect()).collect();
    let mut forward = DMatrix::from_element(m, m, Complex::new(0.0, 0.0));
    for rows in stations {
        let all: Vec<[Complex<f64>; 2]> = shapes.iter().map(|shape| circles(rows, shape)).collect();
        for (j, k) in (0..m).flat_map(|j| (0..m).map(move |k| (j, k))) {
            forward[(j, k)] += all[j][0].conj() * all[k][0] - all[j][1].conj() * all[k][1];
        }
    }
    let turned = forward.symmetric_eigen();
    let mut order: Vec<usize> = (0..m).collect();
    order.sort_by(|&j, &k| turned.eigenvalues[j].total_cmp(&turned.eigenvalues[k]));
    let sum = |k: usize| {
        let entry = |i: usize| (0..m).map(|j| shapes[j][i] * turned.eigenvectors[(j, k)]).sum();
        (0..n).map(entry).collect()
    };
    order.into_iter().map(sum).collect()
}

/// Which way a whirl `Re(q exp(i w t))` goes round at most stations.
fn sense(stations: &[Station], shape: &[Complex<f64>]) -> WhirlSense {
    let (mut forward, mut backward) = (0.0, 0.0);
    for rows in stations {
        let [with, against] = circles(rows, shape);
        forward += with.norm_sqr();
        backward += against.norm_sqr();
    }
    if backward < MIXED * MIXED * forward {
        WhirlSense::Forward
    } else if forward < MIXED * MIXED * backward {
        WhirlSense::Backward
    } else {
        WhirlSense::Mixed
    }
}

/// The forward and the backward circle, twice each, of a station in a whirl `Re(q exp(i w t))`.
fn circles(rows: &Station, shape: &[Complex<f64>]) -> [Complex<f64>; 2] {
    let [x, y] = [0, 1].map(|axis| rows[axis].iter().map(|&(at, share)| shape[at] * share).sum::<Complex<f64>>());
    // x + i y = f exp(i w t) + b exp(-i w t), 2 f = X + i Y, 2 b* = X - i Y
    let i = Complex::new(0.0, 1.0);
    [x + i * y, x - i * y]
}
