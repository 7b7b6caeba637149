//! Limits of the standards, and measurement of a run against them.
//!
//! ISO 8528-5:2013 table 4, performance classes of reciprocating sets: frequency droop, width of the steady-state
//! frequency band, drop on a sudden increase of power, rise on its sudden decrease from 100 %, recovery time to the
//! tolerance band. The steady-state frequency lies between the rated one and the droop above it, half the band aside.
//! "Precise" is no class of the standard, but a usual requirement where class G4 is agreed: +-0.10 % at constant load,
//! and back within that in 1.5 s.
//!
//! NEMA SM 23, class D, of steam turbines' governors: regulation 0.5 %, variation 0.25 %, rise 7 % on the loss of the
//! rated load, trip at 110 % [Bloch and Singh 2009, Steam Turbines, table 8.1].

use super::run::Moment;

/// Limits of a class, as fractions of the rated frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Class {
    pub name: &'static str,
    /// Droop: frequency without load less that at full load.
    pub droop: f64,
    /// Width of the steady-state band.
    pub band: f64,
    /// Drop on a load step up.
    pub drop: f64,
    /// Rise on the loss of the whole load.
    pub rise: f64,
    /// Recovery time (s).
    pub recovery: f64,
    /// Width of the band that counts as recovered.
    pub tolerance: f64,
}

/// The classes of ISO 8528-5 that have figures, the best last, and precise power beyond them.
pub const CLASSES: [Class; 4] = [
    Class { name: "G1", droop: 0.08, band: 0.025, drop: 0.15, rise: 0.18, recovery: 10.0, tolerance: 0.035 },
    Class { name: "G2", droop: 0.05, band: 0.015, drop: 0.10, rise: 0.12, recovery: 5.0, tolerance: 0.02 },
    Class { name: "G3", droop: 0.03, band: 0.005, drop: 0.07, rise: 0.10, recovery: 3.0, tolerance: 0.02 },
    Class { name: "precise", droop: 0.03, band: 0.002, drop: 0.07, rise: 0.10, recovery: 1.5, tolerance: 0.002 },
];

/// NEMA SM 23 class D, of the rated speed: steady-state regulation, variation either way, rise on the loss of the rated
/// load.
pub const CLASS_D: [f64; 3] = [0.005, 0.0025, 0.07];

/// The speed at which both standards' protection trips, of rated.
pub const TRIP: f64 = 1.1;

/// A load that came or went.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// When (s).
    pub time: f64,
    /// Load before and after, of rated.
    pub load: [f64; 2],
    /// How far the frequency fell below what it was, of rated.
    pub drop: f64,
    /// How far it rose above.
    pub rise: f64,
    /// Time until it stays within +-1.75 % of rated (s), the band of class G1.
    pub coarse: f64,
    /// Time until it stays within +-1 % of rated (s), the band of classes G2 and G3.
    pub recovery: f64,
    /// Time until it stays within +-0.10 % of rated (s).
    pub precise: f64,
}

/// Measurement of a run at constant load.
#[derive(Clone, Debug, PartialEq)]
pub struct Steady {
    /// Load, of rated.
    pub load: f64,
    /// Mean frequency, of rated.
    pub mean: f64,
    /// Width of the frequency's swing, of rated.
    pub band: f64,
    /// Largest deviation from the mean of the flywheel's speed within a turn, of rated: its swing by the firing, for
    /// comparison.
    pub swing: f64,
}

/// The figures of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// Every load step.
    pub steps: Vec<Step>,
    /// The end of every stretch of constant load.
    pub steady: Vec<Steady>,
}

impl Figures {
    /// The largest of the steps' figures.
    fn largest(&self, of: impl Fn(&Step) -> f64) -> f64 {
        self.steps.iter().map(of).fold(0.0, f64::max)
    }

    /// The largest drop on a load that came.
    pub fn drop(&self) -> f64 {
        self.steps.iter().filter(|step| step.load[1] > step.load[0]).map(|step| step.drop).fold(0.0, f64::max)
    }

    /// The rise on the largest load that went.
    pub fn rise(&self) -> f64 {
        self.largest(|step| step.rise)
    }

    /// The longest recovery, to a band of that width.
    pub fn recovery(&self, tolerance: f64) -> f64 {
        match tolerance {
            ..0.01 => self.largest(|step| step.precise),
            ..0.03 => self.largest(|step| step.recovery),
            _ => self.largest(|step| step.coarse),
        }
    }

    /// The widest band at constant load.
    pub fn band(&self) -> f64 {
        self.steady.iter().map(|steady| steady.band).fold(0.0, f64::max)
    }

    /// Difference of the steady frequencies without load and at full load.
    pub fn regulation(&self) -> f64 {
        let means = || self.steady.iter().map(|steady| steady.mean);
        means().fold(f64::NEG_INFINITY, f64::max) - means().fold(f64::INFINITY, f64::min)
    }

    /// Whether there is something to judge: load steps, steady stretches, and numbers in all of them.
    fn complete(&self) -> bool {
        let step =
            |step: &Step| [step.drop, step.rise, step.coarse, step.recovery, step.precise, step.load[0], step.load[1]];
        let steady = |steady: &Steady| [steady.load, steady.mean, steady.band];
        !self.steps.is_empty()
            && !self.steady.is_empty()
            && self.steps.iter().flat_map(step).chain(self.steady.iter().flat_map(steady)).all(f64::is_finite)
    }

    /// Mean frequency at the least load less that at the largest.
    pub fn droop(&self) -> f64 {
        let by_load = |a: &&Steady, b: &&Steady| a.load.total_cmp(&b.load);
        let (least, largest) = (self.steady.iter().min_by(by_load), self.steady.iter().max_by(by_load));
        least.zip(largest).map_or(f64::NAN, |(least, largest)| least.mean - largest.mean)
    }

    /// Whether a class is met.
    pub fn meets(&self, class: &Class) -> bool {
        let frequencies = -0.5 * class.band..=class.droop + 0.5 * class.band;
        self.complete()
            && within(self.droop(), class.droop)
            && self.steady.iter().all(|steady| {
                within(frequencies.start() - (steady.mean - 1.0), 0.0) && within(steady.mean - 1.0, *frequencies.end())
            })
            && within(self.band(), class.band)
            && within(self.drop(), class.drop)
            && within(self.rise(), class.rise)
            && self.recovery(class.tolerance) <= class.recovery
    }

    /// The best class that is met with all below it.
    pub fn class(&self) -> Option<&'static str> {
        CLASSES.iter().take_while(|class| self.meets(class)).last().map(|class| class.name)
    }

    /// Whether NEMA SM 23 class D is met; half the band is the variation either way.
    pub fn meets_class_d(&self) -> bool {
        let [regulation, variation, rise] = CLASS_D;
        self.complete()
            && within(self.regulation(), regulation)
            && within(0.5 * self.band(), variation)
            && within(self.rise(), rise)
    }
}

/// Whether a difference of frequencies, of rated, is within a limit: one unit in the last place of the rated frequency
/// is the rounding of the difference.
fn within(difference: f64, limit: f64) -> bool {
    difference <= limit + f64::EPSILON
}

/// How much of a stretch's end counts as steady (s).
const SETTLED: f64 = 2.0;

/// The figures of a run whose loads changed at these times, the first of them the load it had before.
pub fn figures(moments: &[Moment], loads: &[(f64, f64)], end: f64) -> Figures {
    let within = |from: f64, to: f64| moments.iter().filter(move |moment| moment.time >= from && moment.time < to);
    let mut figures = Figures::default();
    for (index, &(time, load)) in loads.iter().enumerate() {
        let next = loads.get(index + 1).map_or(end, |(time, _)| *time);
        let steady = || within(next - SETTLED, next);
        // none gives no number, which no verdict passes
        let count = steady().count() as f64;
        let mean = steady().map(|moment| moment.frequency).sum::<f64>() / count;
        let extremes = |of: &dyn Fn(&Moment) -> f64, from: f64| {
            within(from, next)
                .map(of)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
        };
        let (low, high) = extremes(&|moment| moment.frequency, next - SETTLED);
        let (least, most) = extremes(&|moment| moment.speed, next - SETTLED);
        figures.steady.push(Steady { load, mean, band: high - low, swing: 0.5 * (most - least) });
        let Some(before) = index.checked_sub(1) else { continue };
        let was = figures.steady[before].mean;
        let (low, high) = extremes(&|moment| moment.frequency, time);
        let back = |tolerance: f64| {
            let outside = |moment: &&Moment| (moment.frequency - mean).abs() > tolerance;
            within(time, next).rfind(outside).map_or(0.0, |moment| moment.time - time)
        };
        figures.steps.push(Step {
            time,
            load: [loads[before].1, load],
            drop: (was - low).max(0.0),
            rise: (high - was).max(0.0),
            coarse: back(0.0175),
            recovery: back(0.01),
            precise: back(0.001),
        });
    }
    figures
}
