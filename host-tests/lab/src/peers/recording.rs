//! The signals of a scene's run: what an observer gets, and what is true.

use std::error::Error;

use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::find;

use driveline_closed_loop::lockstep::{Imperfections, Moment, follow};
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::ticks::OnHost;
use driveline_closed_loop::units::Units;

#[derive(Clone, Copy, Debug)]
pub struct Tick {
    /// Angle, 2^32 to the turn.
    pub angle: u32,
    /// Torque as reported to the drive (N m).
    pub torque: f64,
    /// Whether the brake was open: a tick that is not starts an observer.
    pub released: bool,
    /// Shaft torque (N m) and load speed (rad/s).
    pub truth: [f64; 2],
}

/// A scene's counted runs, one behind the other.
#[derive(Clone, Debug)]
pub struct Recording {
    /// The ticks; each run begins with one that is not released.
    pub ticks: Vec<Tick>,
    /// Peak of the shaft torque (N m), and the rated speed (rad/s).
    pub references: [f64; 2],
}

impl Recording {
    /// Runs a machine with its chosen drive in `f32` on the host, each run for so many seconds at most.
    pub fn of(machine: &Machine, seconds: f64, imperfections: &Imperfections) -> Result<Self, Box<dyn Error>> {
        let (observer, rate_hz) = machine.chosen;
        let name = format!("{}/f32/{observer}/{rate_hz}", machine.name);
        let row = find(&name).ok_or_else(|| format!("there is no variant {name}"))?;
        let units = Units::new(Words::Single, machine.bases);
        let mut ticks = Vec::new();
        for scenario in machine.scenarios.iter().filter(|scenario| scenario.counted) {
            let mut scenario = scenario.clone();
            scenario.duration = scenario.duration.min(seconds);
            let (mut run, mut plant) = (Vec::new(), scenario.plant.unrecorded());
            let each = |moment: &Moment, (input, _): (Input, _)| run.push((moment.truth, input));
            let mut drive = OnHost(row.start());
            follow(machine, &scenario, &units, rate_hz, imperfections, &mut drive, &mut plant, each)?;
            // The last tick before the release, in which the drive holds its torque.
            let first = run.iter().position(|(_, input)| input.flags & Input::RELEASED != 0).unwrap_or(0);
            ticks.extend(run.iter().enumerate().skip(first.saturating_sub(1)).map(|(index, (truth, input))| {
                let released = index >= first.max(1);
                // A held drive gets the torque that it holds as its setpoint.
                let word = if input.flags & Input::RELEASED == 0 { input.setpoint } else { input.torque };
                Tick { angle: input.angle, torque: units.torque(word), released, truth: [truth[0], truth[1]] }
            }));
        }
        let peak = ticks.iter().fold(0.0_f64, |peak, tick| peak.max(tick.truth[0].abs()));
        Ok(Recording { ticks, references: [peak, machine.rated_speed] })
    }

    /// A stretch of so many ticks round the largest shaft torque, for counting.
    pub fn stretch(&self, length: usize) -> &[Tick] {
        let peak = self.ticks.iter().enumerate().max_by(|(_, a), (_, b)| a.truth[0].abs().total_cmp(&b.truth[0].abs()));
        let last = self.ticks.len().saturating_sub(length);
        let from = peak.map_or(0, |(index, _)| index).saturating_sub(length / 2).min(last);
        &self.ticks[from..(from + length).min(self.ticks.len())]
    }

    /// Root mean square errors of estimates, over the references; infinite where one is not a number. The tick that
    /// starts an observer has no estimate.
    pub fn errors(&self, estimates: &[[f64; 2]]) -> [f64; 2] {
        let counted = || self.ticks.iter().zip(estimates).filter(|(tick, _)| tick.released);
        let count = counted().count().max(1) as f64;
        [0, 1].map(|k| {
            let squares: f64 = counted().map(|(tick, estimate)| (estimate[k] - tick.truth[k]).powi(2)).sum();
            let error = (squares / count).sqrt() / self.references[k];
            if error.is_finite() { error } else { f64::INFINITY }
        })
    }
}

/// The words of a tick for an observer: angle, torque, flags.
pub fn words(tick: &Tick, units: &Units, starts: bool) -> Input {
    let flags = if tick.released && !starts { Input::RELEASED } else { 0 };
    Input { angle: tick.angle, torque: units.torque_word(tick.torque), flags, ..Input::default() }
}
