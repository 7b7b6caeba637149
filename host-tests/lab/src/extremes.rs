//! Stiff and extreme cases of every subject, each beside a reference that is not the code under test: a closed form,
//! arithmetic of 40 digits and more, or an integration of this module's own.
//!
//! | term | meaning |
//! |---|---|
//! | right | the error is within the limit of the subject |
//! | refused | the code gives no result, and a sentence that says why |
//! | wrong | a result beyond the limit without a word: a fault |

mod balance;
mod loops;
mod mechanism;
mod solver;
mod steps;
pub mod waveform;

use std::fmt;
use std::time::Instant;

use driveline_report::Table;
use driveline_report::format::significant;

/// An error beside the largest that counts as right; both in the unit of the subject.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    pub error: f64,
    pub limit: f64,
}

/// What came of a case.
#[derive(Clone, Debug)]
pub enum Outcome {
    Right(Found),
    Refused(String),
    Wrong(Found),
}

/// A case.
#[derive(Clone, Debug)]
pub struct Case {
    pub subject: &'static str,
    pub name: String,
    pub outcome: Outcome,
    /// Time on the host (s).
    pub time: f64,
}

/// A subject: its name, what the errors are of, the reference.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    pub name: &'static str,
    pub error: &'static str,
    pub reference: &'static str,
}

/// The cases under way.
#[derive(Default)]
pub struct Cases {
    pub subjects: Vec<Subject>,
    pub cases: Vec<Case>,
}

impl Cases {
    /// Every case.
    pub fn all() -> Self {
        let mut all = Self::default();
        solver::add(&mut all);
        steps::add(&mut all);
        mechanism::add(&mut all);
        balance::add(&mut all);
        waveform::add(&mut all);
        loops::add(&mut all);
        all
    }

    fn subject(&mut self, name: &'static str, error: &'static str, reference: &'static str) {
        self.subjects.push(Subject { name, error, reference });
    }

    /// Runs a case of the last subject: its error and limit, or the sentence of a refusal.
    fn case(&mut self, name: String, run: impl FnOnce() -> Result<Found, String>) {
        let begun = Instant::now();
        let outcome = match run() {
            Ok(found) if found.error <= found.limit => Outcome::Right(found),
            // not a number is wrong too
            Ok(found) => Outcome::Wrong(found),
            Err(sentence) => Outcome::Refused(sentence),
        };
        let subject = self.subjects.last().map_or("", |subject| subject.name);
        self.cases.push(Case { subject, name, outcome, time: begun.elapsed().as_secs_f64() });
    }

    /// The cases that are wrong without a word.
    pub fn wrong(&self) -> impl Iterator<Item = &Case> {
        self.cases.iter().filter(|case| matches!(case.outcome, Outcome::Wrong(_)))
    }

    /// A row for each subject.
    pub fn summary(&self) -> Table {
        let mut table = Table::new(["subject", "cases", "right", "refused", "wrong", "error of", "reference"]);
        for subject in &self.subjects {
            let own = || self.cases.iter().filter(|case| case.subject == subject.name);
            let count = |of: fn(&Outcome) -> bool| own().filter(|case| of(&case.outcome)).count().to_string();
            table.row([
                subject.name.to_owned(),
                own().count().to_string(),
                count(|outcome| matches!(outcome, Outcome::Right(_))),
                count(|outcome| matches!(outcome, Outcome::Refused(_))),
                count(|outcome| matches!(outcome, Outcome::Wrong(_))),
                subject.error.to_owned(),
                subject.reference.to_owned(),
            ]);
        }
        table
    }

    /// A row for each case.
    pub fn table(&self) -> Table {
        let mut table = Table::new(["subject", "case", "error", "limit", "time, ms", "outcome"]);
        for case in &self.cases {
            let (found, outcome) = match &case.outcome {
                Outcome::Right(found) => (Some(found), "right".to_owned()),
                Outcome::Wrong(found) => (Some(found), "**wrong**".to_owned()),
                Outcome::Refused(sentence) => (None, format!("refused: {sentence}")),
            };
            let number = |of: fn(&Found) -> f64| found.map_or_else(String::new, |found| format!("{:.1e}", of(found)));
            let time = significant((1e3 * case.time).max(0.001));
            let (error, limit) = (number(|found| found.error), number(|found| found.limit));
            table.row([case.subject, &case.name, &error, &limit, &time, &outcome]);
        }
        table
    }
}

impl fmt::Display for Cases {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n{}", self.summary(), self.table())
    }
}
