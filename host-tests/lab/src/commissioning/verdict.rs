//! Identified values beside true ones.

use driveline::commissioning::Error;
use driveline::machine::{Damping, Gap, Inertia, Stiffness, TwoMass};
use driveline_firmware::scenes::commission::{design, reason};

use super::course::Course;
use super::machine::Case;

/// A figure beside its true value.
#[derive(Clone, Debug)]
pub struct Row {
    /// Name and unit.
    pub name: &'static str,
    /// True value, found one and its standard deviation; none where there is none.
    pub truth: Option<f64>,
    pub found: Option<f64>,
    pub standard_deviation: Option<f64>,
    /// Largest size of the error that is aimed at, as a share.
    pub aim: Option<f64>,
}

impl Row {
    /// Found over true, less one.
    pub fn error(&self) -> Option<f64> {
        Some(self.found? / self.truth.filter(|truth| *truth != 0.0)? - 1.0)
    }
}

/// A commissioning and what it is worth.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Largest torque of the shaft, of rated; half is allowed.
    pub peak: f64,
    pub refused: Option<Error>,
    pub figures: Vec<Row>,
    /// Speed loop's gains designed for what was found, over those for the true machine, less one.
    pub gains: Vec<f64>,
}

const NAMES: [(&str, Option<f64>); 14] = [
    ("total inertia", Some(0.03)),
    ("motor's inertia", Some(0.03)),
    ("load's inertia", Some(0.03)),
    ("resonance", Some(0.01)),
    ("antiresonance", Some(0.01)),
    ("stiffness", None),
    ("damping", None),
    ("damping ratio", None),
    ("Coulomb friction", None),
    ("viscous friction", None),
    ("weight", None),
    ("gap", Some(0.05)),
    ("eccentricity", None),
    ("its phase", None),
];

/// Puts a course beside the truth.
pub fn verdict(case: &Case, course: &Course) -> Verdict {
    let known = |value: f64| value.is_finite().then_some(value);
    let figures = NAMES.into_iter().enumerate().map(|(k, (name, aim))| {
        let truth = known(case.truth.figures[k]);
        let [found, standard_deviation] = [0, 1].map(|of| course.figures.and_then(|figures| known(figures[k][of])));
        // what is not there is not aimed at
        let aim = aim.filter(|_| truth.is_some_and(|truth| truth != 0.0));
        Row { name, truth, found, standard_deviation, aim }
    });
    let [_, motor, load, _, _, stiffness, damping, _, _, _, _, gap, ..] = case.truth.figures;
    let machine = TwoMass::try_new(Inertia(motor), Inertia(load), Stiffness(stiffness), Damping(damping));
    let machine = machine.ok().map(|machine| if gap > 0.0 { machine.with_gap(Gap(gap)) } else { machine });
    let wanted = machine.and_then(|machine| design(&machine, &case.settings));
    // the first five are the observer's
    let gains = course.gains.zip(wanted).map_or(Vec::new(), |(found, wanted)| {
        found.iter().zip(wanted).skip(5).map(|(found, wanted)| found / wanted - 1.0).collect()
    });
    let peak = course.peak / case.rated_torque;
    Verdict { peak, refused: reason(course.reasons[0]), figures: figures.collect(), gains }
}

impl Verdict {
    /// Whether there is an answer that keeps every aim, with less than half of rated torque on the shaft.
    pub fn meets(&self) -> bool {
        let met = |row: &Row| row.aim.is_none_or(|aim| row.error().is_some_and(|error| error.abs() <= aim));
        self.refused.is_none() && self.peak < 0.5 && self.figures.iter().all(met)
    }
}
