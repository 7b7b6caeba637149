//! Every approach over every course.

use serde::Serialize;

use super::approach::Approach;
use super::case::{Case, GAP, RATE_HZ, cases};
use super::run::{Course, Kind};
use super::score::Score;
use driveline_report::Table;
use driveline_report::format::percent;
use driveline_solver::plant::PlantError;

/// Score of an approach over all runs.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The approach.
    pub approach: &'static str,
    /// Mean over the courses of the shaft torque's rms error over its peak.
    pub shaft_torque: f64,
    /// The worst run's.
    pub worst: f64,
    /// Mean of the load speed's rms error over its highest.
    pub load_speed: f64,
    /// The shaft torque's, course by course, in the order of [`Comparison::courses`].
    pub each: Vec<f64>,
}

/// A stretch of one course as some approaches see it.
#[derive(Clone, Debug, Serialize)]
pub struct Stretch {
    /// Which course.
    pub course: String,
    /// Time (s).
    pub time: Vec<f64>,
    /// The true shaft torque (N m).
    pub truth: Vec<f64>,
    /// The approaches' model of it, by name.
    pub estimates: Vec<(&'static str, Vec<f64>)>,
}

/// The comparison.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Ticks a second.
    pub rate_hz: u32,
    /// The gap (rad).
    pub gap: f64,
    /// Seconds of each course.
    pub seconds: f64,
    /// The courses' names.
    pub courses: Vec<String>,
    /// A row an approach.
    pub rows: Vec<Row>,
    /// Half a second to look at.
    pub stretch: Stretch,
}

/// Approaches that the plot over time shows.
const SHOWN: [Approach; 4] = [Approach::Ignore, Approach::Switch, Approach::Keep, Approach::Library];

impl Comparison {
    /// Runs it, each course so many seconds, and says how far it is, in courses of [`Comparison::COURSES`].
    ///
    /// # Errors
    /// A figure of a case that is out of range, which only a changed case can bring.
    pub fn run(seconds: f64, seed: u64, mut progress: impl FnMut(&str)) -> Result<Self, PlantError> {
        let of = |case: Case| Kind::ALL.map(|kind| (case, kind, seed, format!("{}, {}", case.name, kind.name())));
        let courses: Vec<_> = cases().into_iter().flat_map(of).collect();
        let shown = courses.iter().position(|(_, kind, ..)| *kind == Kind::Rattling).unwrap_or(0);
        Comparison::over(&courses, shown, seconds, &mut progress)
    }

    /// The mill's bites instead, so many random courses from seed on.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    pub fn bites(
        mill: Case,
        courses: u32,
        seconds: f64,
        seed: u64,
        mut progress: impl FnMut(&str),
    ) -> Result<Self, PlantError> {
        let of = |number: u32| {
            let seed = seed.wrapping_add(number.into());
            (mill, Kind::Bites, seed, format!("{}, {}, seed {seed}", mill.name, Kind::Bites.name()))
        };
        let courses: Vec<_> = (0..courses).map(of).collect();
        Comparison::over(&courses, 0, seconds, &mut progress)
    }

    fn over(
        all: &[(Case, Kind, u64, String)],
        shown: usize,
        seconds: f64,
        progress: &mut dyn FnMut(&str),
    ) -> Result<Self, PlantError> {
        let mut rows: Vec<Row> = Approach::ALL
            .map(|approach| Row {
                approach: approach.name(),
                shaft_torque: 0.0,
                worst: 0.0,
                load_speed: 0.0,
                each: Vec::new(),
            })
            .into();
        let nothing = || Stretch { course: String::new(), time: vec![], truth: vec![], estimates: vec![] };
        let mut stretch = nothing();
        for (index, (case, kind, seed, name)) in all.iter().enumerate() {
            progress(name);
            let course = Course::record(case, *kind, *seed, seconds)?;
            for (row, approach) in rows.iter_mut().zip(Approach::ALL) {
                let score = Score::of(&course, &mut *approach.estimator(case));
                row.shaft_torque += score.shaft_torque / all.len() as f64;
                row.load_speed += score.load_speed / all.len() as f64;
                row.worst = row.worst.max(score.shaft_torque);
                row.each.push(score.shaft_torque);
            }
            if index == shown {
                stretch = Stretch::of(case, &course, name, seconds);
            }
        }
        let courses = all.iter().map(|(.., name)| name.clone()).collect();
        Ok(Comparison { rate_hz: RATE_HZ, gap: GAP, seconds, courses, rows, stretch })
    }

    /// How many courses there are.
    pub const COURSES: usize = 6 * Kind::ALL.len();

    /// The table of approaches.
    pub fn table(&self) -> Table {
        let mut table = Table::new(["approach", "shaft torque rms", "worst run", "load speed rms"]);
        for row in &self.rows {
            table.row([
                row.approach.to_owned(),
                percent(row.shaft_torque),
                percent(row.worst),
                percent(row.load_speed),
            ]);
        }
        table
    }

    /// The table of courses: a row a course, a column an approach, by number.
    pub fn by_course(&self) -> Table {
        let headings = (1..=self.rows.len()).map(|number| number.to_string());
        let mut table = Table::new(["course".to_owned()].into_iter().chain(headings));
        for (index, course) in self.courses.iter().enumerate() {
            let cells = self.rows.iter().map(|row| percent(row.each.get(index).copied().unwrap_or(f64::NAN)));
            table.row([course.clone()].into_iter().chain(cells));
        }
        table
    }
}

impl Stretch {
    fn of(case: &Case, course: &Course, name: &str, seconds: f64) -> Self {
        let rate = f64::from(RATE_HZ);
        let (from, to) = ((0.5 * seconds * rate) as usize, ((0.5 * seconds + 0.5) * rate) as usize);
        let inside = |tick: usize| (from..to).contains(&tick) && tick.is_multiple_of(5);
        let ticks: Vec<usize> = (0..course.truth.len()).filter(|&tick| inside(tick)).collect();
        let estimates = SHOWN.map(|approach| {
            let mut seen = Vec::new();
            Score::watched(course, &mut *approach.estimator(case), |tick, [torque, _]| {
                if inside(tick) {
                    seen.push(torque);
                }
            });
            (approach.name(), seen)
        });
        Stretch {
            course: name.to_owned(),
            time: ticks.iter().map(|&tick| tick as f64 / rate).collect(),
            truth: ticks.iter().map(|&tick| course.truth[tick][0]).collect(),
            estimates: estimates.into(),
        }
    }
}
