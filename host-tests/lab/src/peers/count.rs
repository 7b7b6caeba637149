//! Cost of an observer in QEMU, over a stretch of a recording.

use std::error::Error;

use driveline_firmware::board::BOARDS;
use driveline_firmware::scene::Input;
use driveline_qemu::image::{Contents, Image, Program, build};
use driveline_qemu::link::Link;
use driveline_qemu::measure::Spread;
use driveline_report::format::grouped;
use serde::Serialize;

use super::recording::{Tick, words};
use driveline_closed_loop::units::Units;

pub const CORES: [&str; 2] = ["m4f", "m3"];

/// Cost of an observer on a core.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    pub core: &'static str,
    /// Instructions of a step with its estimates, the middle.
    pub median: u32,
    /// The most.
    pub worst: u32,
    /// Bytes of code that the step reaches.
    pub code: u64,
    /// Bytes of stack.
    pub stack: u32,
    /// Bytes of state and gains.
    pub state: u32,
}

/// The images, one a core.
pub struct Images(Vec<Image>);

impl Images {
    /// Builds them for the M4F and the M3.
    pub fn build(says: &dyn Fn(&str)) -> Result<Self, Box<dyn Error>> {
        let boards = BOARDS.iter().filter(|board| ["m4f", "m3"].contains(&board.core));
        let images = boards.map(|&board| build("peers/all", board, Program::Peers, |line| says(line.trim())));
        Ok(Images(images.collect::<Result<_, _>>()?))
    }

    /// Cost of an observer on a core; none where there is no image of that core.
    pub fn cost(
        &self,
        core: &'static str,
        [scene, peer]: [usize; 2],
        corner: f32,
        stretch: &[Tick],
        units: &Units,
    ) -> Result<Option<Cost>, Box<dyn Error>> {
        let inputs: Vec<Input> =
            stretch.iter().enumerate().map(|(index, tick)| words(tick, units, index == 0)).collect();
        let Some(image) = self.0.iter().find(|image| image.board.core == core) else { return Ok(None) };
        let mut link = Link::start(image)?;
        let key = (scene << 8 | peer) as u32;
        link.exchange(&Input { asked: [key, corner.to_bits()], ..Input::default() })?;
        let mut instructions = Vec::with_capacity(inputs.len());
        for input in &inputs {
            let output = link.exchange(input)?;
            if input.flags & Input::RELEASED != 0 {
                instructions.push(output.instructions);
            }
        }
        let summary = link.finish()?;
        let spread = Spread::of(instructions);
        Ok(Some(Cost {
            core,
            median: spread.median,
            worst: spread.max,
            code: Contents::reached_from(&image.path, summary.function.into())?,
            stack: summary.stack,
            state: summary.state,
        }))
    }
}

/// Headings of the costs on both cores.
pub fn cost_headings() -> impl Iterator<Item = String> {
    CORES.into_iter().flat_map(|core| [core, "worst", "code", "stack", "state"]).map(str::to_owned)
}

/// Cells of the costs on both cores; empty where there is none.
pub fn cost_cells(costs: &[Cost]) -> Vec<String> {
    let cells = |core: &str| match costs.iter().find(|cost| cost.core == core) {
        Some(cost) => [
            i64::from(cost.median),
            i64::from(cost.worst),
            cost.code as i64,
            i64::from(cost.stack),
            i64::from(cost.state),
        ]
        .map(grouped),
        None => Default::default(),
    };
    CORES.into_iter().flat_map(cells).collect()
}
