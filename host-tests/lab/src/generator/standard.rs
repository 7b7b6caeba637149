//! Measurement of a run against the standards.
//!
//! ISO 8528-5:2013 table 4, reciprocating sets: frequency droop, width of the steady-state frequency band, drop on a
//! sudden increase of power, rise on its sudden decrease from 100 %, recovery time to the tolerance band. The
//! steady-state frequency lies between the rated one and the droop above it, half the band aside. Class G3 with what is
//! usual where class G4 is agreed: +-0.10 % at constant load, and back within that in 1.5 s.
//!
//! NEMA SM 23, class D, of steam turbines' governors: regulation 0.5 %, variation 0.25 %, rise 7 % on the loss of the
//! rated load [Bloch and Singh 2009, Steam Turbines, table 8.1].

use super::run::Moment;

/// Half the width of the band that counts as recovered, of the rated frequency.
const TOLERANCE: f64 = 0.001;

/// The figures of a run, of the rated frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// Load, and mean frequency at the end of its stretch.
    pub steady: Vec<[f64; 2]>,
    /// Widest band at constant load.
    pub band: f64,
    /// Deepest fall below the frequency before, where a load came.
    pub drop: f64,
    /// Highest rise above it.
    pub rise: f64,
    /// Longest time until it stays within +-0.10 % (s).
    pub recovery: f64,
}

/// How much of a stretch's end counts as steady (s).
const SETTLED: f64 = 2.0;

impl Figures {
    /// Of a run whose loads changed at these times, the first of them the load it had before.
    pub fn of(moments: &[Moment], loads: &[(f64, f64)], end: f64) -> Self {
        let within = |from: f64, to: f64| moments.iter().filter(move |moment| moment.time >= from && moment.time < to);
        let mut figures = Figures::default();
        for (index, &(time, load)) in loads.iter().enumerate() {
            let next = loads.get(index + 1).map_or(end, |(time, _)| *time);
            let extremes = |from: f64| {
                let all = within(from, next).map(|moment| moment.frequency);
                all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
            };
            let steady = || within(next - SETTLED, next);
            // none gives no number, which no verdict passes
            let mean = steady().map(|moment| moment.frequency).sum::<f64>() / steady().count() as f64;
            let (low, high) = extremes(next - SETTLED);
            figures.band = figures.band.max(high - low);
            if let Some(&[before, was]) = figures.steady.last() {
                let (low, high) = extremes(time);
                if load > before {
                    figures.drop = figures.drop.max(was - low);
                }
                figures.rise = figures.rise.max(high - was);
                let outside = |moment: &&Moment| (moment.frequency - mean).abs() > TOLERANCE;
                let back = within(time, next).rfind(outside).map_or(0.0, |moment| moment.time - time);
                figures.recovery = figures.recovery.max(back);
            }
            figures.steady.push([load, mean]);
        }
        figures
    }

    fn means(&self) -> impl Iterator<Item = f64> {
        self.steady.iter().map(|[_, mean]| *mean)
    }

    /// Whether G3 is met, and precise power within it.
    pub fn is_precise(&self) -> bool {
        let by_load = |a: &&[f64; 2], b: &&[f64; 2]| a[0].total_cmp(&b[0]);
        let (least, most) = (self.steady.iter().min_by(by_load), self.steady.iter().max_by(by_load));
        let droop = least.zip(most).map_or(f64::NAN, |(least, most)| least[1] - most[1]);
        droop <= 0.03
            && self.means().all(|mean| (-TOLERANCE..=0.03 + TOLERANCE).contains(&(mean - 1.0)))
            && self.band <= 2.0 * TOLERANCE
            && self.drop <= 0.07
            && self.rise <= 0.10
            && self.recovery <= 1.5
    }

    /// Whether NEMA SM 23 class D is met; half the band is the variation either way.
    pub fn is_of_class_d(&self) -> bool {
        let regulation = self.means().fold(f64::NEG_INFINITY, f64::max) - self.means().fold(f64::INFINITY, f64::min);
        self.means().all(f64::is_finite) && regulation <= 0.005 && 0.5 * self.band <= 0.0025 && self.rise <= 0.07
    }
}
