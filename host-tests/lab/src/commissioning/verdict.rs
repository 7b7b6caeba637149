//! Identified values beside true ones.

use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
use driveline_firmware::scenes::commission::{design, reason};

use super::course::Course;
use super::machine::Case;

/// A figure beside its true value.
#[derive(Clone, Debug)]
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
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Largest torque of the shaft, of rated; half is allowed.
    pub peak: f64,
    /// Errors of the commissioning test.
    pub refused: Option<&'static str>,
    pub figures: Vec<Row>,
    /// Gains designed for what was found, and error against those designed for the true machine.
    pub gains: Vec<Row>,
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
pub fn verdict(case: &Case, course: &Course) -> Verdict {
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
        peak: course.peak / case.rated_torque,
        // A course ends with an answer, with a reason, or by its time.
        refused: sentence(course.reasons[0]).or_else(|| course.figures.is_none().then_some(OVER)),
        figures,
        gains,
    }
}

impl Verdict {
    /// Whether there is an answer that keeps every aim, with less than half of rated torque on the shaft.
    pub fn meets(&self) -> bool {
        self.refused.is_none() && self.peak < 0.5 && self.figures.iter().all(|row| row.met() != Some(false))
    }
}
