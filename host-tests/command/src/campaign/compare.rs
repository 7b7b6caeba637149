//! Two campaigns over the same draws, beside each other.

use std::collections::BTreeMap;

use serde::Serialize;

use super::figure::{Figure, Outcome};
use super::record::Settings;
use super::statistics::quantile;
use driveline_report::format::{counted, percent, significant};
use driveline_report::{Section, Table};

/// A figure of a first drive over that of a second, draw by draw.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ratio {
    /// Name of the figure.
    pub name: &'static str,
    /// Unit of the figure; empty for a fraction.
    pub unit: &'static str,
    /// The first drive's figure: median, and what nine draws of ten are not worse than.
    pub first: (f64, f64),
    /// The second's.
    pub second: (f64, f64),
    /// Median of the ratios.
    pub median: f64,
    /// Nine ratios of ten are not worse.
    pub p90: f64,
    pub worst: f64,
    pub worst_draw: u64,
    /// Share of the draws with a ratio in which the first drive is not worse than the second.
    pub not_worse: f64,
    /// Draws without a ratio: where nothing swings, or where the peak has no dynamic part.
    pub none: u64,
}

/// Two campaigns over the same draws.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The first variant.
    pub first: String,
    pub second: String,
    /// Number of draws.
    pub draws: u64,
    /// The figures that both have.
    pub ratios: Vec<Ratio>,
}

const COMPARED: [Figure; 7] = [
    Figure::ShaftTorque,
    Figure::LoadSpeed,
    Figure::LoadTorque,
    Figure::Peak,
    Figure::DynamicPeak,
    Figure::RingDown,
    Figure::Residual,
];

/// A campaign that is done.
type Done = (Settings, BTreeMap<u64, Outcome>);

/// Compares two campaigns that are done.
///
/// # Errors
/// A sentence: they have other draws, or not all; or they are of one drive.
pub fn compare(first: &Done, second: &Done) -> Result<Comparison, String> {
    let [a, b] = [&first.0, &second.0];
    if (a.scene(), a.draws, a.seed, &a.tolerances) != (b.scene(), b.draws, b.seed, &b.tolerances) {
        return Err("the two files have other draws: expected one scene, one seed, one number of draws and the same \
                    tolerances, and two drives"
            .to_owned());
    }
    // another version of the drive has another nominal run
    if a.variant == b.variant && a.nominal.is_same(&b.nominal) {
        return Err(format!("both files are of one drive, {}: expected those of two drives", a.variant));
    }
    let ratio = |figure: Figure| {
        let found =
            |(number, one): (&u64, &Outcome)| Some((*number, one.found(figure)?, second.1.get(number)?.found(figure)?));
        // a part of a peak that is not there has no ratio; beside a swing that does not decay any decay is better
        let pairs = first.1.iter().filter_map(found).filter(|(_, _, other)| figure.is_decay() || !(*other <= 0.0));
        let over = |one: f64, other: f64| match one / other {
            _ if figure.is_decay() && other <= 0.0 => {
                if one >= other {
                    f64::INFINITY
                } else {
                    0.0
                }
            }
            ratio => ratio,
        };
        let mut ratios: Vec<(f64, u64)> = pairs.map(|(number, one, other)| (over(one, other), number)).collect();
        // not a number is worst
        let badness = |ratio: f64| if ratio.is_nan() { f64::INFINITY } else { figure.badness(ratio) };
        ratios.sort_by(|x, y| badness(x.0).total_cmp(&badness(y.0)));
        let sorted: Vec<f64> = ratios.iter().map(|(ratio, _)| *ratio).collect();
        let good = sorted.iter().filter(|ratio| badness(**ratio) <= figure.badness(1.0)).count();
        let worst = ratios.last().copied().unwrap_or((f64::NAN, 0));
        let spread = |outcomes: &BTreeMap<u64, Outcome>| {
            let mut values: Vec<f64> = outcomes.values().filter_map(|outcome| outcome.found(figure)).collect();
            values.sort_by(|x, y| badness(*x).total_cmp(&badness(*y)));
            (quantile(&values, 0.5), quantile(&values, 0.9))
        };
        Ratio {
            name: figure.name(),
            unit: figure.unit(),
            first: spread(&first.1),
            second: spread(&second.1),
            median: quantile(&sorted, 0.5),
            p90: quantile(&sorted, 0.9),
            worst: worst.0,
            worst_draw: worst.1,
            not_worse: good as f64 / sorted.len().max(1) as f64,
            none: a.draws - sorted.len() as u64,
        }
    };
    Ok(Comparison {
        first: a.variant.clone(),
        second: b.variant.clone(),
        draws: a.draws,
        ratios: COMPARED.into_iter().map(ratio).collect(),
    })
}

impl Comparison {
    pub fn table(&self) -> Section {
        let mut table = Table::new([
            "figure",
            "first: median, 90 %",
            "second: median, 90 %",
            "ratio: median",
            "90 % not worse than",
            "worst",
            "draw",
            "first not worse in",
            "no ratio",
        ]);
        for r in &self.ratios {
            // of a decay beside a swing that does not decay
            let ratio = |ratio: f64| if ratio == f64::INFINITY { "infinite".to_owned() } else { significant(ratio) };
            let [median, p90, worst] = [r.median, r.p90, r.worst].map(ratio);
            let text = |value: f64| if r.unit.is_empty() { percent(value) } else { significant(value) };
            let [first, second] = [r.first, r.second].map(|(median, p90)| format!("{}, {}", text(median), text(p90)));
            let draw = r.worst_draw.to_string();
            table.row([
                r.name.to_owned(),
                first,
                second,
                median,
                p90,
                worst,
                draw,
                percent(r.not_worse),
                r.none.to_string(),
            ]);
        }
        let title = format!("{} over {}, {}", self.first, self.second, counted(self.draws, "draw"));
        let text = "Ratios of the same draw. For the decay, lower is worse. A draw has no ratio where nothing swings, \
                    or where the peak has no dynamic part.";
        Section::new(title, text, table)
    }
}
