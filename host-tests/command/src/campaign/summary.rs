//! A campaign's figures over its draws.

use std::collections::BTreeMap;

use serde::Serialize;

use super::draw::Draw;
use super::figure::{Figure, Outcome};
use super::record::Settings;
use super::statistics::{FEWEST_OF_RANGE, median_range, noise_of_largest, quantile, rank_correlation};
use crate::machine_file::factor::{Factor, Tolerance};
use driveline_report::format::{counted, percent, significant};
use driveline_report::{Fact, Section, Table, fact};

/// A figure over the draws.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Distribution {
    /// Name of the figure.
    pub name: &'static str,
    /// Unit; empty for a fraction.
    pub unit: &'static str,
    /// Of the machine that the drive was designed for; `null` where it has no such figure.
    pub nominal: Option<f64>,
    /// Draws that have no such figure, and are left out: where nothing swings there is no decay.
    pub none: u64,
    /// Median over the draws.
    pub median: f64,
    /// Range of the median with 95 % confidence; NaN of fewer than six draws.
    pub median_range: (f64, f64),
    /// Nine draws of ten are not worse.
    pub p90: f64,
    /// The worst draw's.
    pub worst: f64,
    pub worst_draw: u64,
}

/// What a factor does to a figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Influence {
    /// Name of the figure.
    pub figure: &'static str,
    /// Name of the factor.
    pub factor: &'static str,
    /// Spearman's rank correlation of the figure with the factor.
    pub with_value: f64,
    /// The same with the size of the factor's departure from nominal.
    pub with_departure: f64,
    /// Whether the larger of both exceeds that of noise, [`Summary::noise`].
    pub significant: bool,
}

impl Influence {
    /// The larger one.
    fn size(&self) -> f64 {
        f64::max(self.with_value.abs(), self.with_departure.abs())
    }
}

/// A draw whose loop did not hold.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Unstable {
    /// Its number.
    pub draw: u64,
    /// Decay of its swing (1/s).
    pub decay: f64,
    /// Swing left at the end of the run, rms of rated torque.
    pub swing: f64,
    /// Its factors.
    pub values: BTreeMap<&'static str, f64>,
}

/// A campaign's figures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The variant, as `hoist/f32/reduced/10000`.
    pub variant: String,
    /// What the loop of a machine file's drive lacks of the usual margins; `null` where it has all.
    pub lacks: Option<String>,
    /// Number of draws.
    pub draws: u64,
    /// Seed of the draws.
    pub seed: u64,
    /// The tolerances: least and greatest value.
    pub tolerances: BTreeMap<&'static str, (f64, f64)>,
    pub figures: Vec<Distribution>,
    /// Draws whose loop did not hold.
    pub unstable: Vec<Unstable>,
    /// The largest of a figure's rank correlations where no factor matters: less in 19 of 20 campaigns.
    pub noise: f64,
    /// The factors by figure, the strongest first.
    pub influences: Vec<Influence>,
    #[serde(skip)]
    pub(super) drawn: Drawn,
}

/// The draws beside their outcomes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Drawn {
    pub tolerances: Vec<Tolerance>,
    /// The draws in the order of their numbers.
    pub draws: Vec<(Draw, Outcome)>,
}

impl Drawn {
    /// The draws that have a figure, with it.
    pub fn found(&self, figure: Figure) -> Vec<(&Draw, f64)> {
        self.draws.iter().filter_map(|(draw, outcome)| Some((draw, outcome.found(figure)?))).collect()
    }
}

/// The figures that the factors are ranked by.
const RANKED: [Figure; 5] =
    [Figure::ShaftTorque, Figure::LoadSpeed, Figure::LoadTorque, Figure::DynamicPeak, Figure::RingDown];

/// Factors of a figure in the table.
const SHOWN: usize = 4;

/// Unstable draws in the table.
const LISTED: usize = 20;

impl Summary {
    /// Of a campaign that is done.
    pub fn of(settings: &Settings, outcomes: &BTreeMap<u64, Outcome>) -> Self {
        let Settings { variant, draws, seed, tolerances, nominal, lacks } = settings.clone();
        let drawn = |(&number, &outcome): (&u64, &Outcome)| (Draw::new(&tolerances, seed, number), outcome);
        let drawn = Drawn { tolerances: tolerances.clone(), draws: outcomes.iter().map(drawn).collect() };
        let unstable = drawn.draws.iter().filter(|(_, outcome)| outcome.is_unstable());
        let unstable = unstable
            .map(|(draw, outcome)| Unstable {
                draw: draw.number,
                decay: outcome.of(Figure::Decay),
                swing: outcome.of(Figure::Residual),
                values: draw.values.iter().map(|&(factor, value)| (factor.name(), value)).collect(),
            })
            .collect();
        Self {
            variant,
            lacks,
            draws,
            seed,
            tolerances: tolerances.iter().map(|t| (t.factor.name(), (t.low, t.high))).collect(),
            figures: Figure::ALL.iter().map(|&figure| distribution(&drawn, figure, &nominal)).collect(),
            unstable,
            noise: noise(&drawn),
            influences: RANKED.iter().flat_map(|&figure| influences(&drawn, figure)).collect(),
            drawn,
        }
    }

    /// The campaign in single figures.
    pub fn facts(&self) -> Vec<Fact> {
        let mut facts = vec![fact("variant", self.variant.clone())];
        facts.extend(self.lacks.iter().map(|lacks| fact("margins", lacks.clone())));
        facts.push(fact("draws", self.draws.to_string()));
        facts.push(fact("seed", self.seed.to_string()));
        facts.push(fact("unstable draws", self.unstable.len().to_string()));
        let none: u64 = self.figures.iter().map(|figure| figure.none).sum();
        if none > 0 {
            facts.push(fact("draws without a swing", none.to_string()));
        }
        for (name, (low, high)) in &self.tolerances {
            let unit = Factor::named(name).map_or("", Factor::unit);
            facts.push(fact(*name, format!("{} to {} {unit}", significant(*low), significant(*high))));
        }
        facts
    }

    /// The figures as tables.
    pub fn tables(&self) -> Vec<Section> {
        let mut figures =
            Table::new(["figure", "nominal", "median", "its range, 95 %", "90 % not worse than", "worst", "draw"]);
        for d in &self.figures {
            let text = |value: f64| if d.unit.is_empty() { percent(value) } else { significant(value) };
            let name = if d.unit.is_empty() { d.name.to_owned() } else { format!("{}, {}", d.name, d.unit) };
            let (low, high) = d.median_range;
            let found = self.drawn.draws.len() - d.none as usize;
            let is_known = found >= FEWEST_OF_RANGE;
            let range = if is_known { format!("{} to {}", text(low), text(high)) } else { "–".to_owned() };
            let nominal = d.nominal.map_or_else(String::new, text);
            if found == 0 {
                figures.row([name, nominal]);
            } else {
                figures.row([
                    name,
                    nominal,
                    text(d.median),
                    range,
                    text(d.p90),
                    text(d.worst),
                    d.worst_draw.to_string(),
                ]);
            }
        }
        let mut ranks = Table::new(["figure", "factor", "rank correlation", "with its departure's size"]);
        for figure in RANKED {
            let of_figure = |influence: &&Influence| influence.figure == figure.name() && influence.significant;
            let mut significant = self.influences.iter().filter(of_figure).peekable();
            if significant.peek().is_none() {
                ranks.row([figure.name(), "none beyond noise"]);
            }
            for influence in significant.take(SHOWN) {
                let Influence { figure, factor, with_value, with_departure, .. } = *influence;
                ranks.row([figure, factor, &format!("{with_value:+.2}"), &format!("{with_departure:+.2}")]);
            }
        }
        let mut unstable = Table::new(["draw", "decay, 1/s", "swing", "values"]);
        for u in self.unstable.iter().take(LISTED) {
            let values: Vec<String> = u.values.iter().map(|(name, v)| format!("{name} {}", significant(*v))).collect();
            unstable.row([u.draw.to_string(), significant(u.decay), percent(u.swing), values.join(", ")]);
        }
        let errors = "Torques of rated torque, speeds of rated speed, over the whole run. The median of all machines \
                      lies in its range with 95 % confidence; fewer than six draws have none. For the decay, lower \
                      is worse; below zero it may be that of noise, where no swing is sustained by the loop. Draws \
                      in which nothing swings have no decay.";
        let strongest = format!(
            "The {SHOWN} strongest factors of each figure by Spearman's rank correlation: with the value itself, and \
             with the size of its departure from nominal. Where no factor matters, the largest of a figure's is below \
             {:.2} in 19 of 20 campaigns of {}; what is below that is left out.",
            self.noise,
            counted(self.draws, "draw")
        );
        let count = self.unstable.len();
        let listed = format!(
            "{count} of {}: a swing of more than 5 % of rated torque that the loop sustains without noise and errors \
             of the encoder. `campaign SCENE --draw NUMBER` runs one again.",
            self.draws
        );
        let mut sections = vec![
            Section::new("Figures over the draws", errors, figures),
            Section::new("Factors that matter", strongest, ranks),
        ];
        if count > 0 {
            sections.push(Section::new(format!("Unstable draws: {count}"), listed, unstable));
        }
        sections
    }
}

fn distribution(drawn: &Drawn, figure: Figure, nominal: &Outcome) -> Distribution {
    let mut found = drawn.found(figure);
    // from the best to the worst; not a number is worst
    let badness = |value: f64| if value.is_nan() { f64::INFINITY } else { figure.badness(value) };
    found.sort_by(|a, b| badness(a.1).total_cmp(&badness(b.1)));
    let sorted: Vec<f64> = found.iter().map(|&(_, value)| value).collect();
    let worst = found.last();
    let (one, other) = median_range(&sorted);
    Distribution {
        name: figure.name(),
        unit: figure.unit(),
        nominal: nominal.found(figure),
        none: (drawn.draws.len() - found.len()) as u64,
        median: quantile(&sorted, 0.5),
        median_range: (one.min(other), one.max(other)),
        p90: quantile(&sorted, 0.9),
        worst: worst.map_or(f64::NAN, |&(_, value)| value),
        worst_draw: worst.map_or(0, |(draw, _)| draw.number),
    }
}

/// The factors that vary.
fn varied(drawn: &Drawn) -> impl Iterator<Item = &Tolerance> {
    drawn.tolerances.iter().filter(|tolerance| tolerance.low < tolerance.high)
}

/// The noise of a figure's largest rank correlation, of two a factor.
fn noise(drawn: &Drawn) -> f64 {
    noise_of_largest(drawn.draws.len(), 2 * varied(drawn).count())
}

fn influences(drawn: &Drawn, figure: Figure) -> Vec<Influence> {
    let found = drawn.found(figure);
    let values: Vec<f64> = found.iter().map(|&(_, value)| value).collect();
    let noise = noise_of_largest(found.len(), 2 * varied(drawn).count());
    let mut all: Vec<Influence> = varied(drawn)
        .map(|&Tolerance { factor, .. }| {
            let factors: Vec<f64> = found.iter().map(|(draw, _)| draw.value(factor)).collect();
            let departures: Vec<f64> = factors.iter().map(|value| (value - factor.nominal()).abs()).collect();
            let (with_value, with_departure) =
                (rank_correlation(&factors, &values), rank_correlation(&departures, &values));
            let significant = with_value.abs().max(with_departure.abs()) > noise;
            Influence { figure: figure.name(), factor: factor.name(), with_value, with_departure, significant }
        })
        .collect();
    all.sort_by(|a, b| b.size().total_cmp(&a.size()));
    all
}
