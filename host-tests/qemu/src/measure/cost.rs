//! Cost of a variant on a board: instructions a tick and stack, counted and bounded; flash and RAM.

use std::error::Error;
use std::time::Duration;

use driveline_firmware::board::Facts;
use driveline_firmware::scene::{Input, Output};
use driveline_firmware::scenes::{Row, find};
use driveline_firmware::self_test::fingerprint::SEED;
use driveline_firmware::self_test::inputs::Program as Inputs;
use serde::Serialize;

use crate::image::{Contents, Image, Program, Sizes, build};
use crate::link::{Link, Summary};

use super::bound::MachineCode;
use super::{Bound, Loops, Refusal};

/// Least, middle and most of a set of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Spread {
    /// The least.
    pub min: u32,
    /// The middle one, the smaller of two.
    pub median: u32,
    /// The most.
    pub max: u32,
}

impl Spread {
    /// Of some numbers; zero of none.
    pub fn of(mut numbers: Vec<u32>) -> Self {
        numbers.sort_unstable();
        let at = |index: usize| numbers.get(index).copied().unwrap_or(0);
        let last = numbers.len().saturating_sub(1);
        Spread { min: at(0), median: at(last / 2), max: at(last) }
    }
}

/// Cost of a variant on a board.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Instructions a tick, counted.
    pub instructions: Spread,
    /// Upper bounds of a tick's instructions and stack, or why there are none.
    pub bound: Result<Bound, Refusal>,
    /// Bytes of the control loop's image, by section.
    pub sizes: Sizes,
    /// Bytes of code that a tick reaches.
    pub tick_code: u64,
    /// Bytes of the drive's state and constants in RAM, part of the image's RAM.
    pub state: u32,
    /// Most bytes of stack that a tick used.
    pub stack: u32,
}

impl Cost {
    /// Ticks in open loop, over the built-in inputs: the governor's release and every sign of speed and torque occur.
    const TICKS: usize = 4096;

    /// Builds the control loop of `variant` for `board` and runs it.
    pub fn measure(variant: &str, board: Facts, progress: impl FnMut(&str)) -> Result<Self, Box<dyn Error>> {
        let image = build(variant, board, Program::ControlLoop, progress)?;
        Cost::of(&image)
    }

    /// Runs the image of a control loop in open loop, and compares every output with the host's.
    pub fn of(image: &Image) -> Result<Self, Box<dyn Error>> {
        let mut exchanged = Vec::with_capacity(Cost::TICKS);
        let (instructions, summary) = run(image, Cost::TICKS, |input, output| {
            exchanged.push((input, Output { instructions: 0, ..output }));
        })?;
        if !variant(image)?.gives(&exchanged) {
            return Err(format!("{} on {} and on the host have different bits", image.variant, image.board.name).into());
        }
        let Contents { sizes, tick_code, .. } = Contents::read(&image.path)?;
        let code = MachineCode::read(&image.path, Loops::default())?;
        let tick = code.find("driveline_tick").ok_or_else(|| format!("{} has no tick", image.path.display()))?;
        let bound = code.bound(tick);
        let cost = Cost { instructions, bound, sizes, tick_code, state: summary.state, stack: summary.stack };
        cost.within_bound(&image.variant)
    }

    /// The cost, unless a call took more than its bound: the analysis would be wrong then.
    fn within_bound(self, name: &str) -> Result<Self, Box<dyn Error>> {
        let (instructions, stack) = (u64::from(self.instructions.max), self.stack);
        match &self.bound {
            Ok(bound) if instructions > bound.instructions || stack > bound.stack => {
                let Bound { instructions: longest, stack: deepest } = bound;
                Err(format!(
                    "{name} took {instructions} instructions and {stack} bytes of stack, but its machine code allows \
                     {longest} and {deepest}; one of the two measurements is wrong"
                )
                .into())
            }
            _ => Ok(self),
        }
    }
}

/// Runs an image over the built-in inputs and hands on each input with its output.
fn run(image: &Image, ticks: usize, mut each: impl FnMut(Input, Output)) -> Result<(Spread, Summary), Box<dyn Error>> {
    let mut inputs = Inputs::new(SEED, variant(image)?.words());
    let mut link = Link::start(image)?;
    let mut instructions = Vec::with_capacity(ticks);
    for _ in 0..ticks {
        let input = inputs.next_input();
        let output = link.exchange(&input)?;
        instructions.push(output.instructions);
        each(input, output);
    }
    Ok((Spread::of(instructions), link.finish()?))
}

pub(super) fn variant(image: &Image) -> Result<&'static Row, Box<dyn Error>> {
    Ok(find(&image.variant).ok_or_else(|| format!("no variant is called `{}`", image.variant))?)
}

/// Functions that the bench measures and `budgets.toml` may name.
pub const BENCHES: &[&str] = &[
    "bench/step/exact",
    "bench/step/semi-implicit",
    "bench/step/rigid",
    "bench/drive/exact",
    "bench/drive/semi-implicit",
    "bench/drive/rigid",
    "bench/drive/exact/static",
    "bench/drive/semi-implicit/static",
    "bench/phasor/1",
    "bench/phasor/2",
    "bench/step/mechanism",
    "bench/step/force-limit",
    "bench/step/backlash",
    "bench/drive/backlash",
    "bench/balance/least-squares",
    "bench/balance/min-max",
    "bench/balance/in-run",
    "bench/balance/holes",
    "bench/balance/amplitudes",
    "bench/balance/procedure",
    "bench/balance/grade",
    "bench/fluctuation/extremes",
    "bench/fluctuation/waveform",
    "bench/fluctuation/both",
    "bench/fluctuation/cycle-mean",
    "bench/fluctuation/gear-mesh",
    "bench/governor/core",
    "bench/governor/whole",
    "bench/telemetry/record",
    "bench/wheel/tooth",
    "bench/wheel/recorded",
    "bench/wheel/angle",
];

impl Cost {
    /// Instructions of the functions in [`BENCHES`] on a board, in the number that its core is for.
    ///
    /// # Errors
    /// What the build or QEMU says, or that a function was not measured.
    pub fn benches(board: Facts) -> Result<Vec<(String, Self)>, Box<dyn Error>> {
        let number = if board.target.ends_with("hf") { "f32" } else { "fixed" };
        let image = build(&format!("hoist/{number}/reduced/10000"), board, Program::Bench, |_| {})?;
        // it takes a second; this is for a QEMU that hangs
        let lines = crate::link::run(&image, Duration::from_secs(60))?.lines;
        let code = MachineCode::read(&image.path, Loops::default())?;
        let cost = |name: &str| -> Result<_, Box<dyn Error>> {
            let line = lines.iter().find(|line| line["bench"].as_str().is_some_and(|bench| name.ends_with(bench)));
            let figure =
                |key: &str| line.and_then(|line| line[key].as_u64()).and_then(|value| u32::try_from(value).ok());
            let [Some(min), Some(median), Some(max), Some(function)] = ["min", "median", "max", "function"].map(figure)
            else {
                return Err(format!("{name} was not measured on {}", board.name).into());
            };
            let instructions = Spread { min, median, max };
            let (bound, stack) = (code.bound(function), figure("stack").unwrap_or(0));
            let cost = Cost { instructions, bound, sizes: Sizes::default(), tick_code: 0, state: 0, stack };
            Ok((name.into(), cost.within_bound(name)?))
        };
        BENCHES.iter().map(|name| cost(name)).collect()
    }
}
