//! Speed loops in closed loop with the strip mill, and what they cost.

use std::error::Error;
use std::io::{self, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout};

use driveline_firmware::Words;
use driveline_firmware::scene::{Input, Output};
use driveline_firmware::scenes::strip_mill;
use driveline_report::Table;
use driveline_report::format::percent;
use serde::Serialize;

use super::count::{CORES, Cost, Images, cost_cells, cost_headings};
use super::replay::Replay;
use driveline_closed_loop::lockstep::{self, Moment};
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;

/// A speed loop.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Governor {
    pub name: String,
    /// Deviation of the motor's speed from its setpoint from the first strip on, rms and largest, of rated.
    pub deviation: [f64; 2],
    /// Peak of the shaft torque over the rolling torque.
    pub peak: f64,
    /// Cost by core.
    pub costs: Vec<Cost>,
}

/// When the first strip comes (s), and its torque (N m).
const BITE: f64 = 4.0;
const ROLLING: f64 = 1.2e5;
/// Ticks that are counted in QEMU, from the strip on.
const COUNTED: usize = 1_000;
/// Number of the first speed loop among the observers, as the crate has it.
const FIRST: usize = 100;

/// The program as a drive.
pub struct Piped {
    child: Child,
    to: ChildStdin,
    from: ChildStdout,
}

impl Piped {
    /// A program that was started with both pipes.
    pub fn new(mut child: Child) -> Option<Self> {
        Some(Piped { to: child.stdin.take()?, from: child.stdout.take()?, child })
    }
}

impl Ticks for Piped {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        let mut bytes = Vec::with_capacity(16);
        for word in [input.angle, input.torque, input.setpoint, input.flags] {
            bytes.extend(word.to_le_bytes());
        }
        self.to.write_all(&bytes)?;
        let mut torque = [0; 4];
        self.from.read_exact(&mut torque)?;
        Ok(Output { torque: u32::from_le_bytes(torque), ..Output::default() })
    }
}

impl Drop for Piped {
    fn drop(&mut self) {
        // it has nothing to lose
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// All speed loops.
pub fn governors(replay: &Replay, images: &Images, says: &dyn Fn(&str)) -> Result<Vec<Governor>, Box<dyn Error>> {
    let machine = crate::drivetrains::strip_mill::machine()?;
    let scenario = machine.scenarios.first().ok_or("the strip mill has no run")?;
    let listed = replay.list()?;
    let place = listed.scenes.iter().position(|name| name == strip_mill::SCENE).ok_or("no strip mill")?;
    let mut governors = Vec::new();
    for (number, name) in listed.governors.iter().enumerate() {
        says(&format!("speed loop: {name}"));
        let words = if name.ends_with("fixed") { Words::Fixed } else { Words::Single };
        let units = Units::new(words, machine.bases);
        let rate_hz = machine.chosen.1;
        let mut drive = Piped::new(replay.govern([place, number])?).ok_or("no pipes")?;
        let trace = lockstep::run(&machine, scenario, &units, rate_hz, &mut drive, |_| {})?;
        let first = trace.moments.iter().position(|moment| moment.time >= BITE).unwrap_or(0);
        let after = &trace.moments[first..];
        let deviation = |moment: &Moment| (moment.motor_speed - machine.rated_speed).abs() / machine.rated_speed;
        let squares: f64 = after.iter().map(|moment| deviation(moment).powi(2)).sum();
        let peak = after.iter().map(|moment| moment.truth[0].abs()).fold(0.0, f64::max) / ROLLING;
        let largest = after.iter().map(deviation).fold(0.0, f64::max);
        let mut inputs = vec![Input { flags: 0, ..trace.words[first.saturating_sub(1)].0 }];
        inputs.extend(trace.words[first..].iter().take(COUNTED).map(|(input, _)| *input));
        let mut costs = Vec::new();
        for core in CORES {
            if name.starts_with("driveline") && (words == Words::Single) != (core == "m4f") {
                continue;
            }
            costs.extend(images.net_cost(core, [place, FIRST + number], 0.0, &inputs)?);
        }
        governors.push(Governor {
            name: name.clone(),
            deviation: [(squares / after.len().max(1) as f64).sqrt(), largest],
            peak,
            costs,
        });
    }
    Ok(governors)
}

/// A row a speed loop.
pub fn governors_table(governors: &[Governor]) -> Table {
    let mut table = Table::new(
        ["speed loop", "speed, rms", "largest", "shaft torque's peak"]
            .map(str::to_owned)
            .into_iter()
            .chain(cost_headings()),
    );
    for governor in governors {
        let mut row = vec![governor.name.clone()];
        row.extend(governor.deviation.map(percent));
        row.push(format!("{:.2}", governor.peak));
        row.extend(cost_cells(&governor.costs));
        table.row(row);
    }
    table
}
