//! The same test on the host, and in QEMU with the host beside it.

use std::error::Error;
use std::io;

use driveline::commissioning::TestConfig;
use driveline_firmware::board::Facts;
use driveline_firmware::scene::{Input, Output, Scene, Variant};
use driveline_firmware::scenes::commission::{Commission, panel};

use super::course::{Course, run};
use super::machine::Case;
use driveline_closed_loop::ticks::{OnHost, Ticks};
use driveline_qemu::image::{Contents, Program, build};
use driveline_qemu::link::Link;

/// The variant whose image is run.
pub const VARIANT: &str = Commission::NAME;

/// Measurements of an image in QEMU.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Target {
    /// Instructions of a tick: least, mean, most.
    pub instructions: [u64; 3],
    /// Bytes of flash, of static memory, and of stack, the panel's solving included.
    pub bytes: [u64; 3],
    /// Whether every tick and every answer had the host's bits.
    pub bit_exact: bool,
}

/// Runs a case on the host.
pub fn on_host(case: &Case, seed: u64, mut seen: impl FnMut(u64, u32)) -> Result<Course, Box<dyn Error>> {
    // It lives as long as the program: there are a few.
    let config: &'static TestConfig = Box::leak(Box::new(TestConfig::try_new(&case.settings)?));
    let mut scene = OnHost(Commission::of(config));
    Ok(run(case, seed, &mut scene, |tick, stage, _, _| seen(tick, stage))?)
}

/// An image with the host beside it, tick by tick.
struct Beside {
    link: Link,
    host: Commission,
    exact: bool,
}

impl Ticks for Beside {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        let output = self.link.exchange(input)?;
        self.exact &= self.host.exchange(input) == Output { instructions: 0, ..output };
        Ok(output)
    }
}

/// Runs a case in QEMU on a board.
pub fn in_qemu(
    case: &Case,
    board: Facts,
    seed: u64,
    says: impl FnMut(&str),
    mut seen: impl FnMut(u64, u32),
) -> Result<(Course, Target), Box<dyn Error>> {
    let image = build(VARIANT, board, Program::ControlLoop, says)?;
    let mut drive = Beside { link: Link::start(&image)?, host: Commission::start(), exact: true };
    // Against the closed brake: which machine it is.
    drive.tick(&Input { asked: [panel::MACHINE, case.number], ..Input::default() })?;
    let course = run(case, seed, &mut drive, |tick, stage, _, _| seen(tick, stage))?;
    let summary = drive.link.finish()?;
    let sizes = Contents::read(&image.path)?.sizes;
    let [least, sum, most] = course.instructions;
    let target = Target {
        instructions: [least, sum / course.ticks.max(1), most],
        bytes: [sizes.flash(), sizes.ram(), u64::from(summary.stack)],
        bit_exact: drive.exact,
    };
    Ok((course, target))
}
