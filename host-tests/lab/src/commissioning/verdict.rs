//! Identified and true values, as a table and as a page.

use core::f64::consts::TAU;

use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
use driveline_firmware::scenes::commission::{design, reason};
use serde::Serialize;

use super::course::Course;
use super::engine::Target;
use super::machine::Case;
use driveline_report::chart::{Curve, Lines};
use driveline_report::{Fact, Figure, Section, Sheet, Table};

/// A figure beside its true value.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name and unit.
    pub name: &'static str,
    /// True value; none where there is nothing to compare with.
    pub truth: Option<f64>,
    /// Found; none where the test refused.
    pub found: Option<f64>,
    /// Standard deviation that the test gives.
    pub standard_deviation: Option<f64>,
    /// Found over true, less one.
    pub error: Option<f64>,
    /// Largest size of the error that is aimed at.
    pub aim: Option<f64>,
}

impl Row {
    /// Whether the aim is met; none where there is none.
    pub fn met(&self) -> Option<bool> {
        self.aim.map(|aim| self.error.is_some_and(|error| error.abs() <= aim))
    }
}

/// A commissioning and what it is worth.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    pub machine: String,
    /// Duration (s).
    pub seconds: f64,
    /// Largest torque of the shaft, of rated; half is allowed.
    pub peak: f64,
    /// Errors of the commissioning test.
    pub refused: Option<&'static str>,
    /// Why no gap was identified.
    pub gap_refused: Option<&'static str>,
    pub figures: Vec<Row>,
    /// Gains designed for what was found, and error against those designed for the true machine.
    pub gains: Vec<Row>,
    /// Measurements in QEMU.
    pub target: Option<Target>,
    /// Responses upwards and downwards: frequency (rad/s), acceleration per torque (real, imaginary), standard
    /// deviation (1/(kg m2)).
    pub responses: [Vec<[f64; 4]>; 2],
    #[serde(skip)]
    summary: String,
    #[serde(skip)]
    plots: Vec<Figure>,
}

const NAMES: [(&str, Option<f64>); 14] = [
    ("total inertia, kg m²", Some(0.03)),
    ("motor's inertia, kg m²", Some(0.03)),
    ("load's inertia, kg m²", Some(0.03)),
    ("resonance, rad/s", Some(0.01)),
    ("antiresonance, rad/s", Some(0.01)),
    ("stiffness, N m/rad", None),
    ("damping, N m s/rad", None),
    ("damping ratio", None),
    ("Coulomb friction, N m", None),
    ("viscous friction, N m s/rad", None),
    ("weight, N m", None),
    ("gap, rad", Some(0.05)),
    ("eccentricity, rad", None),
    ("its phase, rad", None),
];

const GAINS: [&str; 8] = [
    "observer: angle, rad/rad",
    "observer: motor speed, 1/s",
    "observer: twist, rad/rad",
    "observer: load speed, 1/s",
    "observer: load torque, N m/rad",
    "speed loop: proportional, N m s/rad",
    "speed loop: integral, N m/rad",
    "speed loop: damping, N m s/rad",
];

/// Text for a run that reached its time limit.
const OVER: &str = "no answer within an hour at the machine: more torque, more friction where there is a gap, or a \
    finer encoder is expected";

/// Puts a course beside the truth.
pub fn verdict(case: &Case, course: &Course, target: Option<Target>) -> Verdict {
    let known = |value: f64| value.is_finite().then_some(value);
    let row = |name, aim: Option<f64>, truth: f64, found: Option<f64>, deviation: Option<f64>| {
        let truth = known(truth);
        let error = truth.zip(found).filter(|(truth, _)| *truth != 0.0).map(|(truth, found)| found / truth - 1.0);
        // A gap that is not there is not aimed at.
        let aim = aim.filter(|_| truth.is_some_and(|truth| truth != 0.0));
        Row { name, truth, found, standard_deviation: deviation, error, aim }
    };
    let mut figures = Vec::new();
    for (k, (name, aim)) in NAMES.into_iter().enumerate() {
        let found = course.figures.and_then(|figures| known(figures[k][0]));
        let deviation = course.figures.and_then(|figures| known(figures[k][1]));
        figures.push(row(name, aim, case.truth.figures[k], found, deviation));
    }
    // A phase has no size to be off by a share of.
    if let Some(phase) = figures.last_mut() {
        phase.error = None;
    }
    let [_, motor, load, .., _, _, _, _, _, _] = case.truth.figures;
    let gap = case.truth.figures[11];
    let machine = TwoMass::try_new(
        Inertia(motor),
        Inertia(load),
        Stiffness(case.truth.figures[5]),
        Damping(case.truth.figures[6]),
    );
    let machine = machine.ok().map(|machine| if gap > 0.0 { machine.with_gap(Gap(gap)) } else { machine });
    let wanted = machine.and_then(|machine| design(&machine, &case.settings));
    let mut gains = Vec::new();
    if let (Some(wanted), Some(found)) = (wanted, course.gains) {
        for ((name, wanted), found) in GAINS.into_iter().zip(wanted).zip(found) {
            gains.push(row(name, None, wanted, Some(found), None));
        }
    }
    let sentence = |number: u32| reason(number).map(|reason| reason.message());
    Verdict {
        machine: case.name.clone(),
        seconds: course.moments.last().map_or(0.0, |moment| moment.time),
        peak: course.peak / case.rated_torque,
        // A course ends with an answer, with a reason, or by its time.
        refused: sentence(course.reasons[0]).or_else(|| course.figures.is_none().then_some(OVER)),
        gap_refused: sentence(course.reasons[1]),
        figures,
        gains,
        target,
        responses: course.responses.clone(),
        summary: case.summary.clone(),
        plots: plots(case, course),
    }
}

impl Verdict {
    /// Whether there is an answer that keeps every aim, with less than half of rated torque on the shaft.
    pub fn meets(&self) -> bool {
        self.refused.is_none() && self.peak < 0.5 && self.figures.iter().all(|row| row.met() != Some(false))
    }

    /// The figures as a table.
    pub fn table(&self) -> Table {
        let mut table = Table::new(["figure", "true", "found", "standard deviation", "error", "aim", "met"]);
        let number = |value: Option<f64>| value.map_or(String::new(), driveline_report::format::significant);
        let percent = |value: Option<f64>| value.map_or(String::new(), |value| format!("{:+.2} %", 100.0 * value));
        for row in self.figures.iter().chain(&self.gains) {
            let met = row.met().map_or("", |met| if met { "yes" } else { "NO" });
            table.row([
                row.name.to_owned(),
                number(row.truth),
                number(row.found),
                number(row.standard_deviation),
                percent(row.error),
                row.aim.map_or(String::new(), |aim| format!("{:.0} %", 100.0 * aim)),
                met.to_owned(),
            ]);
        }
        let met = if self.peak < 0.5 { "yes" } else { "NO" };
        let peak = format!("{:.1} %", 100.0 * self.peak);
        table.row(["peak of the shaft's torque, of rated", "", &peak, "", "", "50 %", met].map(str::to_owned));
        table
    }

    /// Text beside the table.
    pub fn sentences(&self) -> Vec<String> {
        let mut said = vec![format!("{:.0} s at the machine", self.seconds)];
        said.extend(self.refused.map(|reason| format!("refused: {reason}")));
        said.extend(self.gap_refused.map(|reason| format!("gap: {reason}")));
        if let Some(target) = &self.target {
            let [least, mean, most] = target.instructions;
            let [flash, ram, stack] = target.bytes;
            said.push(format!(
                "in QEMU: {least} to {most} instructions a tick, {mean} on average; {flash} bytes of \
                flash, {ram} of static memory, {stack} of stack, the solving included"
            ));
            said.push(format!("the host's bits: {}", if target.bit_exact { "yes, every tick" } else { "NO" }));
        }
        said
    }

    pub fn page(&self) -> String {
        let fact = |sentence: String| match sentence.split_once(": ") {
            Some((name, value)) => Fact { name: name.into(), value: value.into() },
            None => Fact { name: "duration".into(), value: sentence },
        };
        Sheet {
            kicker: "commissioning".into(),
            name: self.machine.clone(),
            summary: self.summary.clone(),
            facts: self.sentences().into_iter().map(fact).collect(),
            tables: vec![Section::new(
                "Found and true",
                "The true values are those of the full plant, referred to the motor: the two masses that have its \
                    first resonance, its first antiresonance and its total inertia.",
                self.table(),
            )],
            figures: self.plots.clone(),
        }
        .page()
    }
}

/// The response, measured and fitted; torques and speed over time.
fn plots(case: &Case, course: &Course) -> Vec<Figure> {
    let mut plots = Vec::new();
    let size = |re: f64, im: f64| re.hypot(im);
    let mut points = Vec::new();
    for (responses, (class, way)) in course.responses.iter().zip([("s0", "upwards"), ("s1", "downwards")]) {
        for &[w, re, im, deviation] in responses.iter().filter(|response| response[0] > 0.0) {
            let title = format!("{way}, {:.3} Hz: {:.4e} ± {deviation:.1e} 1/(kg m²)", w / TAU, size(re, im));
            points.push((w / TAU, size(re, im), class.to_owned(), title));
        }
    }
    if let Some(figures) = course.figures {
        let ends = points.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), p| (low.min(p.0), high.max(p.0)));
        let places: Vec<f64> = (0..=800).map(|k| ends.0 + (ends.1 - ends.0) * f64::from(k) / 800.0).collect();
        let curve = |class: &str, [total, _, _, wr, wa, _, _, z]: [f64; 8]| {
            let c = 2.0 * z / wr;
            let value = |hertz: &f64| {
                let w = hertz * TAU;
                let over = size(1.0 - (w / wa).powi(2), c * w);
                over / size(1.0 - (w / wr).powi(2), c * w) / total
            };
            Curve { class: class.into(), values: places.iter().map(value).collect() }
        };
        let first = |all: &[f64]| [0, 1, 2, 3, 4, 5, 6, 7].map(|k| all[k]);
        let fitted = figures.map(|figure| figure[0]);
        let lines = Lines {
            label: "Acceleration per torque over frequency".into(),
            along: "frequency, Hz".into(),
            across: "acceleration per torque, 1/(kg m²)".into(),
            curves: vec![curve("truth", first(&case.truth.figures)), curve("s2", first(&fitted))],
            points,
            marks: vec![(fitted[4] / TAU, "antiresonance".into()), (fitted[3] / TAU, "resonance".into())],
            logarithmic: true,
            places,
            ..Lines::default()
        };
        let text = "Acceleration of the motor per torque: the lines of the last records upwards and downwards as \
            points, the two masses that were \
                    found, and those that have the plant's resonance, antiresonance and inertia.";
        plots.push(Figure {
            title: "Response".to_owned(),
            text: text.to_owned(),
            plots: vec![lines.draw()],
            ..Figure::default()
        });
    }
    let time: Vec<f64> = course.moments.iter().map(|moment| moment.time).collect();
    let mut marks = Vec::new();
    for pair in course.moments.windows(2) {
        if let [before, after] = pair
            && before.stage != after.stage
        {
            let names = ["holding", "friction", "encoder", "backlash", "resonance", "done", "refused"];
            let name = usize::try_from(after.stage).ok().and_then(|stage| names.get(stage)).copied();
            marks.push((after.time, name.unwrap_or_default().to_owned()));
        }
    }
    let mut over = |title: &str, across: &str, class: &str, values: Vec<f64>| {
        let lines = Lines {
            label: format!("{title} over time"),
            along: "time, s".into(),
            across: across.into(),
            places: time.clone(),
            curves: vec![Curve { class: class.into(), values }],
            marks: marks.clone(),
            ..Lines::default()
        };
        plots.push(Figure { title: title.to_owned(), plots: vec![lines.draw()], ..Figure::default() });
    };
    let moments = || course.moments.iter();
    over("Torque of the shaft", "torque, N m", "truth", moments().map(|m| m.shaft).collect());
    over("Speed of the motor", "speed, rad/s", "s0", moments().map(|m| m.speed).collect());
    over("Angle of the motor", "angle, rad", "s1", moments().map(|m| m.angle).collect());
    plots
}
