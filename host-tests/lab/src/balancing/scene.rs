//! A scene whose rotor is balanced: on the host, in QEMU, and what it leaves.

use std::error::Error;
use std::io;

use driveline_firmware::Words;
use driveline_firmware::board::{BOARDS, Facts};
use driveline_firmware::scene::{Input, Output};
use driveline_firmware::scenes::{Row, VARIANTS, find};

use super::error::BalancingError;
use super::operator::Operator;
use super::outcome::{Claim, Outcome, Stage};
use super::power_cut::PowerCuts;
use driveline_closed_loop::ticks::{OnHost, Ticks};
use driveline_qemu::image::{Contents, Program, belongs, build};
use driveline_qemu::link::Link;

/// A scene that can be balanced.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// Its name.
    pub name: &'static str,
    pub(super) balance: fn(Words, &mut dyn Ticks, u64) -> Result<Outcome, BalancingError>,
}

/// Cost of a variant on a controller.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Cost {
    /// Instructions of a tick at most, and on average.
    pub instructions: (u32, f64),
    /// Most stack of a tick (bytes).
    pub stack: u32,
    /// Flash and RAM of the image (bytes).
    pub flash: u64,
    /// RAM of the image (bytes).
    pub ram: u64,
}

/// A variant that was balanced in QEMU.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Ran {
    /// Number, core, observer and rate.
    pub variant: String,
    /// Result.
    pub outcome: Outcome,
    /// Its cost.
    pub cost: Cost,
    /// Whether every word of the ticks was the same on the host, given the same inputs.
    pub same_on_host: bool,
}

impl Scene {
    /// Its variants on the boards that they belong on.
    #[must_use]
    pub fn variants(&self) -> Vec<(&'static str, Facts)> {
        let all = BOARDS.iter().flat_map(|&board| VARIANTS.iter().map(move |&variant| (variant, board)));
        all.filter(|(variant, board)| {
            variant.split('/').next() == Some(self.name)
                && belongs(variant, board)
                // a drive whose ticks alone are measured: without a panel there is nobody to balance
                && variant.split('/').nth(2) != Some("tick")
        })
        .collect()
    }

    /// Balances a variant on the host.
    ///
    /// # Errors
    /// Why it could not be.
    ///
    /// # Panics
    /// For a variant that is not in the firmware's table.
    pub fn on_host(&self, variant: &str, seed: u64) -> Result<Outcome, BalancingError> {
        let row = row(variant);
        (self.balance)(row.words(), &mut OnHost(row.start()), seed)
    }

    /// Balances a variant on the host, or on a board in QEMU, with a power cut after every entry: the outcome, the
    /// cuts, and those after which the panel went on otherwise.
    ///
    /// # Errors
    /// A build or a link that failed; why it could not be balanced.
    ///
    /// # Panics
    /// For a variant that is not in the firmware's table.
    pub fn with_power_cuts(
        &self,
        variant: &str,
        board: Option<Facts>,
        seed: u64,
    ) -> Result<(Outcome, usize, usize), Box<dyn Error>> {
        let image = board.map(|board| build(variant, board, Program::ControlLoop, |_| {})).transpose()?;
        let row = row(variant);
        let start: super::power_cut::Start<'_> = match &image {
            Some(image) => Box::new(move || Ok(Box::new(Link::start(image)?))),
            None => Box::new(|| Ok(Box::new(OnHost(row.start())))),
        };
        let mut drive = PowerCuts::new(start)?;
        let outcome = (self.balance)(row.words(), &mut drive, seed)?;
        Ok((outcome, drive.cuts, drive.differing))
    }

    /// Balances a variant in QEMU; the same scene on the host is given the same inputs beside it. `seed` is that of
    /// everything that is left to chance.
    ///
    /// # Errors
    /// A build or a link that failed; why it could not be balanced.
    ///
    /// # Panics
    /// For a variant that is not in the firmware's table.
    pub fn in_qemu(&self, variant: &str, board: Facts, seed: u64, says: &dyn Fn(&str)) -> Result<Ran, Box<dyn Error>> {
        let name = key(variant, &board);
        says(&format!("{name}: building"));
        let image = build(variant, board, Program::ControlLoop, |_| {})?;
        let sizes = Contents::read(&image.path)?.sizes;
        says(&format!("{name}: balancing in QEMU"));
        let row = row(variant);
        let mut beside = Beside { link: Link::start(&image)?, host: row.start(), same: true };
        let outcome = (self.balance)(row.words(), &mut beside, seed).map_err(|error| format!("{name}: {error}"))?;
        let stack = beside.link.finish().map_err(|error| format!("{name}: {error}"))?.stack;
        let same_on_host = beside.same;
        let cost = Cost { instructions: outcome.instructions, stack, flash: sizes.flash(), ram: sizes.ram() };
        Ok(Ran { variant: name, outcome, cost, same_on_host })
    }
}

/// A variant of the firmware's table.
fn row(variant: &str) -> &'static Row {
    find(variant).expect("a variant of the firmware's table")
}

/// Number, core, observer and rate of a variant on a board.
fn key(variant: &str, board: &Facts) -> String {
    let mut parts = variant.split('/').skip(1);
    let number = parts.next().unwrap_or_default();
    format!("{number}/{}/{}", board.core, parts.collect::<Vec<_>>().join("/"))
}

/// A scene in QEMU, and the same on the host beside it.
struct Beside {
    link: Link,
    host: Box<dyn driveline_firmware::scene::Scene>,
    same: bool,
}

impl Ticks for Beside {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        let output = self.link.tick(input)?;
        let host = self.host.exchange(input);
        // The panel's functions are not the same on host and target to the last bit; those of the tick are.
        let tick = Output { instructions: 0, answer: 0, ..output };
        self.same &= tick == Output { answer: 0, ..host };
        Ok(output)
    }
}

/// Puts an outcome together when the work is done.
pub(super) fn outcome(
    scene: &str,
    measure: &str,
    rows: Vec<String>,
    stages: Vec<Stage>,
    claims: Vec<Claim>,
    operator: Operator<'_>,
) -> Outcome {
    Outcome {
        scene: scene.to_owned(),
        measure: measure.to_owned(),
        rows,
        stages,
        claims,
        doubts: operator.doubts.iter().map(|&doubt| doubt.to_owned()).collect(),
        fingerprint: operator.machine.fingerprint(),
        instructions: operator.machine.instructions(),
        time: operator.machine.time(),
    }
}
