//! `cargo driveline rotor`: critical speeds, Campbell diagram and unbalance response of a rotor.

mod balancing;
mod peak;

use std::f64::consts::TAU;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::results::{Destination, check};
use super::{Failure, Progress, say, say_json};
use crate::machine_file::{RotorFile, read_rotor, slug};
use driveline_report::chart::{Curve, Lines};
use driveline_report::format::{percent, significant};
use driveline_report::{Figure, Key, Section, Sheet, Table, fact};
use driveline_solver::rotor::{Critical, Natural, Polar, RotorError, WhirlSense};
use nalgebra::Complex;

use balancing::Balanced;
use peak::{Peak, highest, peaks, rpm};

/// Find critical speeds of a rotor, its natural whirls over the speed, its vibration by unbalance, and the weights of
/// modal balancing.
///
/// The page with the Campbell diagram opens in any browser.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline example three-discs > three_discs.toml
  cargo driveline rotor three_discs.toml
  cargo driveline rotor my.toml --html my.html
  cargo driveline rotor my.toml --json")]
pub struct Rotor {
    /// The rotor: a TOML file of shaft, discs, bearings, unbalance and sensors
    file: PathBuf,
    /// File of the page [default: report/NAME-rotor.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

/// Speeds of the Campbell diagram, standstill included.
const SPEEDS: usize = 61;
/// Speeds of the response: 0.2 % of the highest apart.
const POINTS: usize = 501;
/// Whirls that are followed.
const WHIRLS: usize = 8;

/// Result of the command.
#[derive(Debug, Serialize)]
struct Found {
    name: String,
    /// Undamped critical speeds up to the highest speed and the first beyond, rad/s.
    critical_speeds: Vec<Critical>,
    /// Speeds of the diagram, rad/s.
    speeds: Vec<f64>,
    /// The lowest natural whirls at each speed.
    whirls: Vec<Vec<Natural>>,
    /// Largest vibration of each sensor by the unbalance.
    peaks: Vec<Peak>,
    /// Weights of modal balancing.
    #[serde(skip_serializing_if = "Option::is_none")]
    balancing: Option<Balanced>,
}

/// Amplitudes over the speed, a curve a sensor.
struct Response {
    speeds: Vec<f64>,
    amplitudes: Vec<Vec<f64>>,
}

impl Rotor {
    /// Reads the rotor and shows its speeds.
    ///
    /// # Errors
    /// A rotor file with a fault; a page that cannot be written.
    pub fn execute(&self) -> Result<(), Failure> {
        let place = self.file.display();
        let rotor = Progress::during(|| read_rotor(&self.file), &format!("{place}: critical speeds"))?;
        let file = Destination::page_unless(self.json, self.html.as_deref(), &format!("{}-rotor", slug(&rotor.name)));
        check(&[&self.file], &file)?;
        let (found, responses) =
            Progress::during(|| self.found(&rotor), &format!("{place}: whirls and vibration over the speed"))?;
        if self.json {
            say_json(&found)?;
        } else {
            tables(&found).into_iter().for_each(say);
            unstable(&found).into_iter().for_each(|text| say(format_args!("warning: {text}")));
        }
        file.map_or(Ok(()), |file| file.write_and_say(&page(&rotor, &found, &responses), self.json))
    }

    /// What is shown, with the vibration as it is and with the weights.
    fn found(&self, rotor: &RotorFile) -> Result<(Found, Vec<Response>), Failure> {
        let failed = |error: RotorError| Failure::failed(error.to_string());
        let own = rotor.unbalances();
        let speeds = steps(rotor);
        let (response, peaks) = response(rotor, &speeds, &own, &own).map_err(failed)?;
        let mut found = find(rotor, peaks).map_err(failed)?;
        let mut responses = vec![response];
        if let Some(plan) = &rotor.balancing {
            let fault = |fault| Failure::failed(format!("{}: {fault}", self.file.display()));
            let (mut balanced, unbalance) = Balanced::of(rotor, plan).map_err(fault)?;
            let (with_weights, peaks) = self::response(rotor, &speeds, &unbalance, &own).map_err(failed)?;
            balanced.peaks = peaks;
            found.balancing = Some(balanced);
            responses.push(with_weights);
        }
        Ok((found, responses))
    }
}

fn find(rotor: &RotorFile, peaks: Vec<Peak>) -> Result<Found, RotorError> {
    let speeds: Vec<f64> = (0..SPEEDS).map(|k| rotor.highest * k as f64 / (SPEEDS - 1) as f64).collect();
    let mut campbell = rotor.model.campbell(&speeds, WHIRLS)?;
    if rotor.conservative {
        // roundings, half of which would read as instability
        campbell.whirls.iter_mut().flatten().for_each(|whirl| whirl.damping_ratio = 0.0);
    }
    Ok(Found {
        name: rotor.name.clone(),
        critical_speeds: rotor.model.criticals(rotor.highest),
        speeds,
        whirls: campbell.whirls,
        peaks,
        balancing: None,
    })
}

/// Half-width over its speed below which a resonance is one without damping: rounding.
const UNDAMPED: f64 = 1e-9;
/// How far beside a resonance without damping the vibration is taken, above rounding of many elements.
const BESIDE: f64 = 1e-6;

/// Vibration with this unbalance at every node (kg m) of a rotor that has its own.
fn response(
    rotor: &RotorFile,
    (speeds, undamped): &(Vec<f64>, Vec<f64>),
    unbalance: &[Complex<f64>],
    own: &[Complex<f64>],
) -> Result<(Response, Vec<Peak>), RotorError> {
    let at = |speed| rotor.model.response(speed, unbalance);
    let mut all = speeds.iter().map(|&speed| Ok((speed, at(speed)?))).collect::<Result<Vec<_>, RotorError>>()?;
    // where the vibration has no bound: it grows with the nearness of the speed, 300 times but for rounding
    let mut unbounded = vec![None; rotor.sensors.len()];
    for &speed in undamped {
        let [near, far] = [at(speed * (1.0 + BESIDE))?, at(speed * (1.0 + 3e2 * BESIDE))?];
        if unbalance != own {
            // of an undamped whirl that was balanced the rounding of its shape, below 1e-6, would be left
            let own = rotor.model.response(speed * (1.0 + BESIDE), own)?;
            if near.iter().zip(&own).all(|(now, own)| now.norm() <= 1e-5 * own.norm()) {
                continue;
            }
        }
        for (sensor, highest) in unbounded.iter_mut().enumerate() {
            let larger = highest.is_none_or(|(_, amplitude)| near[sensor].norm() > amplitude);
            if near[sensor].norm() > 10.0 * far[sensor].norm() && larger {
                *highest = Some((speed, near[sensor].norm()));
            }
        }
        all.push((speed * (1.0 + BESIDE), near));
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut peaks = Vec::with_capacity(rotor.sensors.len());
    for (sensor, &(node, angle)) in rotor.sensors.iter().enumerate() {
        let (speed, vibration) = match unbounded[sensor] {
            Some((speed, _)) => (speed, Complex::new(f64::INFINITY, 0.0)),
            None => highest(&all, sensor, at)?,
        };
        let (amplitude, phase) = Polar::of(vibration);
        peaks.push(Peak { node, angle, speed, amplitude, phase });
    }
    let amplitudes =
        (0..rotor.sensors.len()).map(|sensor| all.iter().map(|(_, at)| at[sensor].norm()).collect()).collect();
    Ok((Response { speeds: all.into_iter().map(|(speed, _)| speed).collect(), amplitudes }, peaks))
}

/// The speeds of the response up to the highest, which rounding does not pass, with those across each resonance that
/// damping leaves narrow; and resonances without damping.
fn steps(rotor: &RotorFile) -> (Vec<f64>, Vec<f64>) {
    let (undamped, damped): (Vec<_>, Vec<_>) = rotor
        .model
        .resonances(rotor.highest)
        .into_iter()
        .partition(|&(speed, width)| rotor.conservative || width <= UNDAMPED * speed);
    let mut speeds = even(rotor.highest);
    for (speed, width) in damped {
        // a quarter of a half-width beside its top it has lost 3 %
        speeds.extend((-12..=12).map(|k| speed + width * 0.25 * f64::from(k)));
    }
    speeds.retain(|&speed| speed > 0.0 && speed <= rotor.highest);
    speeds.sort_by(f64::total_cmp);
    speeds.dedup();
    let undamped = undamped.into_iter().map(|(speed, _)| speed).filter(|&at| at * (1.0 + BESIDE) <= rotor.highest);
    (speeds, undamped.collect())
}

fn even(highest: f64) -> Vec<f64> {
    (1..POINTS).map(|k| (highest * k as f64 / (POINTS - 1) as f64).min(highest)).collect()
}

const fn word(sense: WhirlSense) -> &'static str {
    match sense {
        WhirlSense::Forward => "forward",
        WhirlSense::Backward => "backward",
        WhirlSense::Mixed => "mixed",
    }
}

const fn class(sense: WhirlSense) -> &'static str {
    match sense {
        WhirlSense::Forward => "s0",
        WhirlSense::Backward => "s1",
        WhirlSense::Mixed => "s5",
    }
}

/// The tables as title, explanation and table: for the terminal and the page alike.
fn tables(found: &Found) -> Vec<Section> {
    let mut criticals = Table::new(["critical speed", "r/min", "rad/s", "Hz", "whirl"]);
    for (index, critical) in found.critical_speeds.iter().enumerate() {
        let numbers = [rpm(critical.speed), critical.speed, critical.speed / TAU].map(|value| format!("{value:.2}"));
        let row = [(index + 1).to_string()].into_iter().chain(numbers);
        let beyond =
            if found.speeds.last().is_some_and(|&last| critical.speed > last) { ", beyond the highest" } else { "" };
        criticals.row(row.chain([format!("{}{beyond}", word(critical.sense))]));
    }
    let text =
        "Without damping. Where the supports are alike in all directions, unbalance excites the forward ones only.";
    let mut all = vec![Section::new("Critical speeds", text, criticals)];
    // the order changes with the speed, so a row of both would pair different whirls
    for (title, whirls) in
        [("Natural whirls at rest", found.whirls.first()), ("Natural whirls at the highest speed", found.whirls.last())]
    {
        let mut table = Table::new(["whirl", "Hz", "damping", "sense"]);
        for (index, whirl) in whirls.into_iter().flatten().enumerate() {
            table.row([
                (index + 1).to_string(),
                format!("{:.3}", whirl.frequency / TAU),
                percent(whirl.damping_ratio),
                word(whirl.sense).to_owned(),
            ]);
        }
        let text = "Damped frequencies, lowest first; a negative damping grows.";
        all.push(Section::new(title, text, table));
    }
    if !found.peaks.is_empty() {
        let text = "Amplitude of the displacement by the unbalance of the file, up to the highest speed.";
        let text = unstable(found).map_or(text.to_owned(), |warning| format!("{text} Warning: {warning}."));
        all.push(Section::new("Vibration by unbalance", &text, peaks(&found.peaks)));
    }
    all.extend(found.balancing.iter().flat_map(Balanced::tables));
    all
}

/// Damping ratio below which a whirl grows: a whirl that no damper moves has some 1e-12 of either sign by rounding.
const GROWS: f64 = -1e-6;

/// The first speed of the diagram at which a whirl grows.
fn unstable(found: &Found) -> Option<String> {
    let growing = |whirls: &[Natural]| whirls.iter().find(|whirl| whirl.damping_ratio < GROWS).copied();
    let mut speeds = found.speeds.iter().zip(&found.whirls);
    let (&speed, whirl) = speeds.find_map(|(speed, whirls)| Some((speed, growing(whirls)?)))?;
    let (rpm, hertz) = (rpm(speed), significant(whirl.frequency / TAU));
    Some(format!("unstable at {rpm:.0} r/min: a whirl of {hertz} Hz grows, and no vibration settles"))
}

/// The page, with the vibration as it is and with the weights.
fn page(rotor: &RotorFile, found: &Found, responses: &[Response]) -> String {
    let length = rotor.places.last().copied().unwrap_or(0.0);
    let discs: f64 = rotor.discs.iter().map(|disc| disc.1).sum();
    let mut facts = vec![
        fact("length", format!("{} m", significant(length))),
        fact("elements", (rotor.places.len() - 1).to_string()),
        fact("discs", format!("{}, {} kg", rotor.discs.len(), significant(discs))),
        fact("bearings", rotor.bearings.len().to_string()),
    ];
    let forward = found.critical_speeds.iter().find(|critical| critical.sense == WhirlSense::Forward);
    if let Some(first) = forward {
        facts.push(fact("first forward critical", format!("{:.0} r/min", rpm(first.speed))));
    }
    let text = "Natural frequencies over the speed of rotation. Where the straight line, once a turn, meets a forward \
                whirl, unbalance meets it too.";
    let legend = [("forward", "s0"), ("backward", "s1"), ("mixed", "s5"), ("once a turn", "truth")];
    let legend = legend.map(|(name, class)| Key::curve(name, class)).to_vec();
    let mut figures = vec![Figure::new("Campbell diagram", text, legend, vec![campbell(found).draw()])];
    let vibration = [
        ("Vibration by unbalance", "Displacement at the sensors, steady at each speed."),
        ("Vibration with the weights", "The same with the weights of modal balancing."),
    ];
    for (response, (title, text)) in
        responses.iter().zip(vibration).filter(|(response, _)| !response.amplitudes.is_empty())
    {
        let named = |(index, (node, angle)): (usize, &(usize, f64))| {
            Key::curve(format!("node {node}, {}°", significant(*angle)), format!("s{}", index % 6))
        };
        let legend: Vec<Key> = rotor.sensors.iter().enumerate().map(named).collect();
        let curve = |(values, key): (&Vec<f64>, &Key)| Curve {
            class: key.class.clone(),
            values: values.iter().map(|value| value * 1e6).collect(),
        };
        let lines = Lines {
            label: "Amplitude over the speed".to_owned(),
            along: "speed, r/min".to_owned(),
            across: "amplitude, µm".to_owned(),
            places: response.speeds.iter().map(|&speed| rpm(speed)).collect(),
            curves: response.amplitudes.iter().zip(&legend).map(curve).collect(),
            marks: marks(found),
            logarithmic: true,
            ..Lines::default()
        };
        figures.push(Figure::new(title, text, legend, vec![lines.draw()]));
    }
    let summary = "Natural whirls of the rotor on its bearings, and where its unbalance meets them.".to_owned();
    Sheet {
        name: rotor.name.clone(),
        kicker: "critical speeds".to_owned(),
        summary,
        facts,
        figures,
        tables: tables(found),
    }
    .page()
}

fn marks(found: &Found) -> Vec<(f64, String)> {
    let last = found.speeds.last().copied().unwrap_or(0.0);
    let forward = found.critical_speeds.iter().filter(|c| c.sense != WhirlSense::Backward && c.speed <= last);
    forward.map(|c| (rpm(c.speed), format!("{:.0} r/min", rpm(c.speed)))).collect()
}

/// Each whirl by its rank; a curve is drawn where the whirl has its sense, so that colours follow.
fn campbell(found: &Found) -> Lines {
    let mut curves =
        vec![Curve { class: "truth".to_owned(), values: found.speeds.iter().map(|speed| speed / TAU).collect() }];
    for rank in 0..WHIRLS {
        for sense in [WhirlSense::Forward, WhirlSense::Backward, WhirlSense::Mixed] {
            let at = |k: usize| found.whirls.get(k).and_then(|whirls| whirls.get(rank));
            let of_sense = |k: usize| at(k).is_some_and(|natural| natural.sense == sense);
            let value = |k: usize| {
                // joined to a neighbour of its sense, so that a change of sense leaves no gap
                let joined = of_sense(k) || k > 0 && of_sense(k - 1);
                at(k).filter(|_| joined).map_or(f64::NAN, |natural| natural.frequency / TAU)
            };
            let values: Vec<f64> = (0..found.speeds.len()).map(value).collect();
            if values.iter().any(|value| value.is_finite()) {
                curves.push(Curve { class: class(sense).to_owned(), values });
            }
        }
    }
    Lines {
        label: "Natural frequencies over the speed".to_owned(),
        along: "speed, r/min".to_owned(),
        across: "natural frequency, Hz".to_owned(),
        places: found.speeds.iter().map(|&speed| rpm(speed)).collect(),
        curves,
        marks: marks(found),
        points: found
            .critical_speeds
            .iter()
            .filter(|critical| critical.speed <= found.speeds.last().copied().unwrap_or(0.0))
            .map(|c| {
                let title = format!("{:.1} r/min, {}", rpm(c.speed), word(c.sense));
                (rpm(c.speed), c.speed / TAU, class(c.sense).to_owned(), title)
            })
            .collect(),
        ..Lines::default()
    }
}

#[cfg(test)]
mod tests {
    use super::{POINTS, even};

    #[test]
    fn the_highest_speed_is_the_last_step() {
        for number in 1..20_000 {
            let highest = f64::from(number) * 0.037;
            let speeds = even(highest);
            let last = speeds[POINTS - 2];
            // one rounding below at most, and never above: what is above is left out
            assert!(last <= highest && last >= highest.next_down(), "{last} {highest}");
        }
    }
}
