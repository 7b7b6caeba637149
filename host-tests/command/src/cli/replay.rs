//! `cargo driveline replay`: the observer, the fluctuation, the toothed wheel or the phasors over a recording.

mod fluctuation;
mod phasors;
mod shown;
mod wheel;
mod windows;

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use driveline::configure::Rating;
use driveline::design::{Encoder, Rate};
use driveline::machine::{Speed, Torque};
use serde_json::json;

use self::fluctuation::FluctuationOptions;
use self::phasors::PhasorOptions;
use self::shown::Shown;
use self::wheel::WheelOptions;
use self::windows::WindowOptions;
use super::identify::slug;
use super::recorded::Recorded;
use super::results::{Destination, all, check};
use super::{Failure, Progress, say, say_json};
use crate::machine_file::{MachineFile, printable, read};
use crate::recording::{Asked, Recording, read_recording};
use crate::replay::wheel::Followed;
use crate::replay::{Between, Design, Replayed, Signals, csv, page, replay, summaries, table};
use driveline_report::fact;
use driveline_report::format::significant;

/// Replay a recording through the library: a machine's observer, the speed's fluctuation, a toothed wheel, or phasors.
///
/// The library's own code runs as on the drive. With `--machine` that is the observer, in `f32` and in fixed point,
/// designed from the machine file at the recording's rate: estimates, innovation, flags, and errors where the load was
/// measured. Columns are found by quantity and unit: torque or current and angle or speed of the motor; `load_angle`,
/// `load_speed`, `shaft_torque` and `load_torque`, at the motor's shaft, are what the estimates are compared with. With
/// `--teeth` as well the angle is that of a toothed wheel on the motor.
///
/// With `--teeth` alone it is the toothed wheel: speed and ripple from the times of its edges, given in columns of
/// `time` and of the pickup's level (`crank`, `teeth`), in one of `tooth_time`, or with a row for each edge.
///
/// With `--fluctuation` it is the speed's fluctuation over a cycle of a recorded `angle`, as a drive measures it.
///
/// With `--phasors` it is the vibration at the rotor's speed: a column of `vibration`, and the rotor's `angle` or a
/// `mark` once a turn.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("part").required(true).multiple(true)
    .args(["machine", "teeth", "fluctuation", "phasors"]))]
#[command(group = ArgGroup::new("edged").multiple(true).args(["teeth", "phasors"]))]
#[command(group = ArgGroup::new("driven").multiple(true).args(["held", "delay", "torque_constant"])
    .requires("machine").conflicts_with_all(["fluctuation", "phasors"]))]
#[command(after_help = "Examples:
  cargo driveline example bench-log > bench.csv
  cargo driveline identify bench.csv --rate 2500 --torque-constant 0.564 --to 5 --toml bench.toml
  cargo driveline replay bench.csv --machine bench.toml --rate 2500 --torque-constant 0.564 --delay 1.2e-4 --from 5
  cargo driveline replay crank.csv --teeth 60-2 --cycle 2
  cargo driveline replay motor.csv --machine bench.toml --teeth 60-2
  cargo driveline replay press.csv --fluctuation --cycles 4
  cargo driveline replay rotor.csv --phasors --rate 952")]
pub struct Replay {
    /// The recording: a CSV file
    file: PathBuf,
    /// The machine: a TOML file of elements from the motor to the load
    #[arg(long, value_name = "FILE", conflicts_with_all = ["fluctuation", "phasors"])]
    machine: Option<PathBuf>,
    #[command(flatten)]
    wheel: WheelOptions,
    #[command(flatten)]
    fluctuation: FluctuationOptions,
    #[command(flatten)]
    windows: WindowOptions,
    #[command(flatten)]
    phasors: PhasorOptions,
    /// Take the edges, or the mark, where the level falls
    #[arg(long, requires = "edged", conflicts_with = "fluctuation")]
    falling: bool,
    #[command(flatten)]
    recorded: Recorded,
    /// Keep the torque from each sample to the next, as of a command; a measured one runs straight
    #[arg(long)]
    held: bool,
    /// Time by which the torque acts after its sample (s)
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    delay: f64,
    /// Write the estimates of every tick, the windows or the readings as a table
    #[arg(long, value_name = "PATH")]
    csv: Option<PathBuf>,
    /// File of the page [default: report/NAME-replay.html]
    #[arg(long, value_name = "PATH")]
    html: Option<PathBuf>,
    /// Print JSON, and write a page only with --html
    #[arg(long)]
    pub json: bool,
}

impl Replay {
    /// Reads the recording, runs the library's part and shows what it says.
    ///
    /// # Errors
    /// A fault of a file; a machine that no observer follows at the recording's rate, a wheel that there is not.
    pub fn execute(&self) -> Result<(), Failure> {
        match (&self.machine, &self.wheel.teeth) {
            (Some(machine), _) => self.observer(machine),
            (None, Some(teeth)) => {
                let windows = self.windows.windows();
                self.show(|asked| self.wheel.shown(teeth, windows, &self.file, asked, self.falling))
            }
            (None, None) if self.fluctuation.fluctuation => {
                self.show(|asked| FluctuationOptions::shown(self.windows.windows(), &self.file, asked))
            }
            (None, None) => self.show(|asked| self.phasors.shown(&self.file, asked, self.falling)),
        }
    }

    /// Results of a wheel or a vibration.
    fn show(&self, shown: impl Fn(Asked) -> Result<Shown, Failure>) -> Result<(), Failure> {
        let sheet = Destination::page_unless(self.json, self.html.as_deref(), &format!("{}-replay", slug(&self.file)));
        let table = self.csv.as_deref().map(|path| Destination::chosen("table", path));
        check(&[&self.file], table.iter().chain(&sheet))?;
        let Shown { text, json, csv, untold, sheet: page } = shown(self.recorded.asked()?)?;
        if self.json {
            say_json(&json)?
        } else {
            say(text)
        }
        all([
            table.map_or(Ok(()), |table| table.write_and_say(&csv, self.json)),
            sheet.map_or(Ok(()), |sheet| sheet.write_and_say(&page.page(), self.json)),
        ])?;
        untold.map_or(Ok(()), |untold| Err(Failure::failed(untold)))
    }

    fn observer(&self, path: &Path) -> Result<(), Failure> {
        let asked = self.recorded.asked()?;
        if !(self.delay >= 0.0 && self.delay.is_finite()) {
            return Err(Failure::usage(format!("--delay must be zero or above and finite, not {:?}", self.delay)));
        }
        let name = slug(&self.file);
        let sheet = Destination::page_unless(self.json, self.html.as_deref(), &format!("{name}-replay"));
        let destination = self.csv.as_deref().map(|path| Destination::chosen("table", path));
        check(&[&self.file, path], destination.iter().chain(&sheet))?;
        let machine =
            read(path)?.with_dampers().map_err(|error| Failure::usage(format!("{}: {error}", path.display())))?;
        let recording = read_recording(&self.file, &asked)?;
        if recording.len() < 100 || !recording.period.is_finite() {
            let found = format!("{} samples over time", recording.len());
            return Err(recording.fault(found, "at least 100").into());
        }
        let length = recording.period * recording.len() as f64;
        if !(self.delay < length) {
            let (delay, length) = (self.delay, significant(length));
            let sentence = format!("--delay {delay:?}: expected seconds below the recording's length of {length} s");
            return Err(Failure::usage(sentence));
        }
        let teeth = self.wheel.teeth.as_deref();
        let wheel = teeth.map(|teeth| WheelOptions::followed(teeth, &recording, self.falling)).transpose()?;
        let two = machine.two_masses();
        let constant = self.recorded.torque_constant;
        let between = if self.held { Between::Held } else { Between::Straight };
        let signals = Signals::of(
            &recording,
            two.as_ref(),
            constant,
            between,
            self.delay,
            wheel.as_ref().map(|wheel| wheel.angles.clone()),
        )?;
        let gap: f64 = machine.chain.shafts().iter().map(|shaft| shaft.gap).sum();
        if gap > 0.0 && !self.json {
            let (file, gap) = (printable(&path.display().to_string(), 200), significant(gap));
            eprintln!("note: the observer of a replay knows no backlash: {file} has {gap} rad at the motor, ignored");
        }
        let progress = Progress::of(2 * recording.len() as u64);
        progress.says("observing");
        let mut done = 0_u64;
        let tick = || {
            done += 1;
            if done.is_multiple_of(4096) {
                progress.at(done);
            }
        };
        let replayed = self.run(path, &machine, &recording, signals, wheel.as_ref(), tick)?;
        drop(progress);
        if let Some(error) = replayed.no_fixed {
            eprintln!("note: there is no drive in fixed point: {error}");
        }
        if self.json {
            let predicted = replayed.predicted;
            say_json(&json!({
                "file": recording.name,
                "machine": machine.name,
                "samples": recording.len(),
                "rate_hz": 1.0 / recording.period,
                "gear_efficiency": machine.chain.efficiency(),
                "gap_ignored": gap,
                "settling": replayed.settling,
                "predicted_innovation": predicted,
                "wheel": wheel.as_ref().map(|wheel| {
                    json!({
                        "ticks_with_angle": wheel.known(),
                        "deviation": wheel.deviation,
                        "tick_deviation": wheel.in_a_tick(),
                    })
                }),
                "numbers": summaries(&replayed),
            }))?;
        } else {
            say(table(&replayed));
            if let Some(wheel) = &wheel {
                let [known, deviation] = in_words(wheel, recording.len());
                say(format!("wheel: an angle in {known} ticks, deviation {deviation}"));
            }
            if replayed.signals.floating && replayed.signals.shaft_torque.is_some() {
                say("shaft torque: against the twist of two encoders, whose zeros are not known: means apart");
            }
        }
        let table = destination.map_or(Ok(()), |table| table.write_and_say(&csv(&replayed), self.json));
        let mut facts = vec![
            fact("samples", recording.len().to_string()),
            fact("samples a second", significant(1.0 / recording.period)),
            fact("innovation predicted", format!("{} rad", significant(replayed.predicted))),
        ];
        if let Some(wheel) = &wheel {
            let [known, deviation] = in_words(wheel, recording.len());
            facts.extend([fact("ticks with an angle", known), fact("the wheel's deviation", deviation)]);
        }
        let page = |sheet: Destination| sheet.write_and_say(&page(&name, &machine.name, facts, &replayed), self.json);
        all([table, sheet.map_or(Ok(()), page)])
    }

    fn run(
        &self,
        path: &Path,
        machine: &MachineFile,
        recording: &Recording,
        signals: Signals,
        wheel: Option<&Followed>,
        tick: impl FnMut(),
    ) -> Result<Replayed, Failure> {
        let refused = |error: driveline::design::Error| {
            let file = path.display();
            Failure::usage(format!("{file}: no observer can be designed at the recording's rate: {error}"))
        };
        let (_, encoder, disturbance) = machine.tuning();
        let encoder = wheel.map_or(encoder, |wheel| Encoder::counts(u32::MAX).jitter(wheel.in_a_tick(), 1.0));
        let rate = Rate::every(recording.period);
        let (design, inertia, load_inertia) = match machine.two_masses() {
            Some(two) => {
                let design = two.try_observer(rate, encoder, disturbance).map_err(refused)?;
                (Design::TwoMass(design), two.motor_inertia, two.load_inertia)
            }
            None => {
                let rigid = machine.rigid().map_err(|error| refused(error.into()))?;
                // without a shaft there is no load behind one
                let design = rigid.try_observer(rate, encoder, disturbance).map_err(refused)?;
                (Design::Rigid(design, 0.0), rigid.inertia, rigid.inertia)
            }
        };
        let gear = if machine.chain.efficiency() < 1.0 || machine.chain.back_efficiency() < 1.0 {
            let count = encoder.resolution().map_err(refused)?;
            let count = wheel.map_or(count, |wheel| 12_f64.sqrt() * wheel.in_a_tick());
            let (gear, behind) = machine.gears([inertia, load_inertia], count);
            Some((gear, behind, recording.period))
        } else {
            None
        };
        let (torque, speed) = (machine.limits.torque, machine.limits.speed);
        let screening = Rating { torque: Torque(torque), speed: Speed(speed), torque_limit: Torque(torque) }
            .screening(encoder, rate);
        replay(signals, &design, gear.as_ref(), &screening, [torque, speed], tick)
            .map_err(|error| Failure::usage(format!("{}: {error}", path.display())))
    }
}

/// Ticks with an angle, and its deviation.
fn in_words(wheel: &Followed, ticks: usize) -> [String; 2] {
    [format!("{} of {ticks}", wheel.known()), format!("{} deg", significant(wheel.deviation.to_degrees()))]
}
