//! The sweeps as the report has them.

use super::cause::{Cause, summary};
use super::error::{Outcome, STEPS, errors};
use super::grid::{Place, places};
use super::growth::{Growth, TICKS, growths};
use super::swing::free_swings;
use driveline_report::{Sweep, SweepPoint};

/// Most ticks that a place is run for: a radian at omega T = 1e-6, and a fiftieth of it in a quick sweep.
pub const fn longest(quick: bool) -> u64 {
    if quick { 20_000 } else { 1_000_000 }
}

/// Ticks of a free swing in a sweep.
const fn swinging(quick: bool) -> u64 {
    if quick { TICKS / 100 } else { TICKS }
}

/// Everything: state errors, growth by the coefficients, growth of swings. `progress` receives the number done and the
/// total.
pub fn run(quick: bool, mut progress: impl FnMut(usize, usize)) -> Vec<Sweep> {
    let places = places(quick);
    // A swing takes as long as a hundred places.
    let all = places.len() + 100 * STEPS.len();
    let mut done = 0;
    let mut outcomes = Vec::with_capacity(places.len());
    for place in &places {
        outcomes.push(errors(place, longest(quick)));
        done += 1;
        progress(done, all);
    }
    let mut sweeps = state_errors(&places, &outcomes);
    sweeps.extend(growth(&places));
    sweeps.extend(swings(swinging(quick), || {
        done += 100;
        progress(done, all);
    }));
    sweeps
}

fn state_errors(places: &[Place], outcomes: &[[Outcome; 6]]) -> Vec<Sweep> {
    table(places, |index| {
        let (_, step) = STEPS[index];
        let bound = if step == "exact" {
            "sum of independent roundings of states and coefficients, and 1 %"
        } else {
            "the 1 % by which the design chooses this step, and the sum of roundings"
        };
        let ticks = if step == "exact" {
            "over four periods, but 2000 to 1e6 ticks"
        } else {
            "over a period, at most 4096 ticks"
        };
        Table {
            suffix: "state error",
            criterion: format!(
                "Speeds (in the energy norm) and shaft torque against the exact motion in f64, relative to the largest \
                    of the run, {ticks}. Allowed: {bound}."
            ),
            rows: outcomes.iter().map(|all| (all[index].error, all[index].cause)).collect(),
        }
    })
}

/// Growth over 1e8 ticks, from the poles of the coefficients as they are stored.
pub fn growth(places: &[Place]) -> Vec<Sweep> {
    let all: Vec<[Growth; 6]> = places.iter().map(growths).collect();
    table(places, |index| Table {
        suffix: "growth over 1e8 ticks, from the stored coefficients",
        criterion:
            "Factor of a free swing over 1e8 ticks less one, by the larger pole of the coefficients as rounded. \
            Allowed: 1e-6."
                .to_owned(),
        rows: all.iter().map(|growths| (growths[index].factor_less_one, growths[index].cause)).collect(),
    })
}

/// Growth of undamped swings that were run for so many ticks; `progress` is called after every step's.
pub fn swings(ticks: u64, progress: impl FnMut()) -> Vec<Sweep> {
    let all = free_swings(ticks, progress);
    let mut sweeps = Vec::new();
    for (swings, (number, step)) in all.iter().zip(STEPS) {
        let places: Vec<Place> = swings.iter().map(|swing| swing.place).collect();
        let table = Table {
            suffix: "growth, run",
            criterion: format!(
                "Last over first swing of an undamped machine less one, after {ticks:e} ticks without correction. \
                    Allowed: 16 roundings a tick, as if independent."
            ),
            rows: swings.iter().map(|swing| (swing.change.max(0.0), swing.cause())).collect(),
        };
        sweeps.push(table.sweep(&places, number, step));
    }
    sweeps
}

struct Table {
    suffix: &'static str,
    criterion: String,
    rows: Vec<(f64, Option<Cause>)>,
}

impl Table {
    fn sweep(self, places: &[Place], number: &str, step: &str) -> Sweep {
        let point = |(place, &(error, cause)): (&Place, &(f64, Option<Cause>))| SweepPoint {
            omega_t: place.omega_t,
            inertia_ratio: place.inertia_ratio,
            damping: place.damping,
            error,
            passed: cause.is_none(),
        };
        Sweep {
            name: format!("{number} {step}: {}", self.suffix),
            criterion: self.criterion + &summary(self.rows.iter().map(|row| row.1)),
            points: places.iter().zip(&self.rows).map(point).collect(),
        }
    }
}

fn table(places: &[Place], of: impl Fn(usize) -> Table) -> Vec<Sweep> {
    STEPS.iter().enumerate().map(|(index, (number, step))| of(index).sweep(places, number, step)).collect()
}
