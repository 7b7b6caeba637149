//! A drive and a machine, each an FMU, in a closed loop: a step is a tick of the drive.
//!
//! In each tick the drive comes first, with the angle at its beginning and the torque of the tick before; then the
//! machine takes the new torque. A machine that has no angle gives its speed, which is integrated by the trapezoidal
//! rule.

use std::f64::consts::TAU;

use clap::Args;

use super::description::{Description, Quantity, Unit, Variable};
use super::fmu::Fmu;

/// Variables of the machine that take part.
#[derive(Clone, Debug, Args)]
pub struct Names {
    /// Its input: torque of the motor
    #[arg(long, value_name = "NAME", default_value = "motor_torque")]
    pub torque: String,
    /// Its output: angle of the motor [default: encoder_angle, unless --speed is named]
    #[arg(long, value_name = "NAME")]
    pub angle: Option<String>,
    /// Its output: speed of the motor, integrated where no angle is named
    #[arg(long, value_name = "NAME")]
    pub speed: Option<String>,
    /// Its output: speed of the load, at the motor, to compare the estimate with
    #[arg(long, value_name = "NAME")]
    pub load_speed: Option<String>,
    /// Its output: torque of the shaft, at the motor, to compare the estimate with
    #[arg(long, value_name = "NAME")]
    pub shaft_torque: Option<String>,
}

/// A value from a time on.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Time (s); none before the initialisation.
    pub time: Option<f64>,
    /// Variable.
    pub name: String,
    /// Value, in the variable's own unit.
    pub value: f64,
}

/// A run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Variables of the machine.
    pub names: Names,
    /// Speed setpoints of the motor (rad/s), each from a time (s) on.
    pub setpoints: Vec<(f64, f64)>,
    /// Values of the machine's variables.
    pub changes: Vec<Change>,
    /// Length (s).
    pub time: f64,
    /// Counts of an encoder on a turn, to which the angle is rounded down.
    pub counts: Option<u32>,
}

/// A quantity over the run.
#[derive(Clone, Debug)]
pub struct Column {
    pub name: String,
    /// Unit; empty where none is declared.
    pub unit: String,
    /// A value at the beginning of each tick.
    pub values: Vec<f64>,
}

/// Error of an estimate.
#[derive(Clone, Debug)]
pub struct Deviation {
    /// Estimated quantity.
    pub name: &'static str,
    pub unit: &'static str,
    /// Estimate less truth, at the beginning of each tick.
    pub values: Vec<f64>,
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// Beginnings of the ticks (s).
    pub times: Vec<f64>,
    /// The drive: setpoint, torque to give over the tick, estimates.
    pub drive: Vec<Column>,
    /// Every output of the machine that is a scalar number, and what the loop reads.
    pub machine: Vec<Column>,
    /// Faults of each tick, as bits.
    pub faults: Vec<u32>,
    /// Errors of the estimates whose truth is known.
    pub errors: Vec<Deviation>,
}

/// Most ticks of a run: its table stays within memory.
const MOST_TICKS: f64 = 5e6;

/// Outputs of the drive, with their units.
const DRIVE: [(&str, &str); 5] = [
    ("torque_setpoint", "N m"),
    ("motor_speed", "rad/s"),
    ("shaft_torque", "N m"),
    ("load_speed", "rad/s"),
    ("load_torque", "N m"),
];

/// A variable of the machine that the loop reads or sets, in SI units.
struct Signal {
    name: String,
    reference: u32,
    unit: Option<Unit>,
}

impl Signal {
    fn of(variable: &Variable) -> Self {
        Self { name: variable.name.clone(), reference: variable.reference, unit: variable.unit.clone() }
    }

    fn to_si(&self, value: f64) -> f64 {
        self.unit.as_ref().map_or(value, |unit| unit.to_si(value))
    }

    fn of_si(&self, value: f64) -> f64 {
        self.unit.as_ref().map_or(value, |unit| unit.of_si(value))
    }
}

/// The references of a drive's variables.
struct Drive {
    inputs: [u32; 3],
    outputs: [u32; 5],
    faults: u32,
    period: f64,
    weight: f64,
}

impl Drive {
    fn of(description: &Description) -> Result<Self, String> {
        let expected = |error: String| format!("{error}; expected an FMU of `cargo driveline export fmu`");
        let of = |name: &str, causality: &str| {
            description.scalar(name, causality).map(|variable| variable.reference).map_err(expected)
        };
        let faults = description.variables.iter().find(|variable| variable.name == "faults");
        let period = description.step.ok_or_else(|| expected("it has no fixedInternalStepSize".into()))?;
        Ok(Self {
            inputs: [of("motor_angle", "input")?, of("motor_torque", "input")?, of("speed_setpoint", "input")?],
            outputs: {
                let mut outputs = [0; 5];
                for (output, (name, _)) in outputs.iter_mut().zip(DRIVE) {
                    *output = of(name, "output")?;
                }
                outputs
            },
            faults: faults.ok_or_else(|| expected("it has no variable `faults`".into()))?.reference,
            period,
            weight: description.scalar("motor_torque", "input").map_err(expected)?.start.unwrap_or(0.0),
        })
    }
}

/// The variables of both, found by their names.
struct Signals {
    drive: Drive,
    torque: Signal,
    /// The motor's angle, or its speed.
    measured: Signal,
    has_angle: bool,
    /// Estimates whose truth is known: name, unit, place among the drive's outputs, variable.
    truths: Vec<(&'static str, &'static str, usize, Signal)>,
    /// Tick, reference and value of each change; none before the initialisation.
    changes: Vec<(Option<usize>, u32, f64)>,
    ticks: usize,
}

impl Signals {
    fn of(plan: &Plan, drive: &Description, machine: &Description) -> Result<Self, String> {
        let drive = Drive::of(drive)?;
        let names = &plan.names;
        let output = |name: &Option<String>, quantity: Quantity| {
            name.as_ref().map(|name| machine.signal(name, "output", quantity).map(Signal::of)).transpose()
        };
        let angle = output(&names.angle, Quantity::Angle)?;
        let mut truths = Vec::new();
        for (name, unit, at, truth) in [
            ("motor speed", "rad/s", 1, output(&names.speed, Quantity::Speed)?),
            ("shaft torque", "N m", 2, output(&names.shaft_torque, Quantity::Torque)?),
            ("load speed", "rad/s", 3, output(&names.load_speed, Quantity::Speed)?),
        ] {
            truths.extend(truth.map(|truth| (name, unit, at, truth)));
        }
        let has_angle = angle.is_some();
        let measured = angle.map_or_else(|| output(&names.speed, Quantity::Speed), |angle| Ok(Some(angle)))?;
        let mut changes = Vec::new();
        for Change { time, name, value } in &plan.changes {
            let variable = machine.scalar(name, if time.is_some() { "input" } else { "parameter" })?;
            changes.push((time.map(|time| (time / drive.period).round() as usize), variable.reference, *value));
        }
        let ticks = (plan.time / drive.period).round();
        if !(1.0..=MOST_TICKS).contains(&ticks) {
            return Err(format!("the run has {ticks} ticks of {} s, expected 1 to {MOST_TICKS:e}", drive.period));
        }
        Ok(Self {
            torque: Signal::of(machine.signal(&names.torque, "input", Quantity::Torque)?),
            measured: measured.ok_or("neither the motor's angle nor its speed is named")?,
            has_angle,
            truths,
            changes,
            ticks: ticks as usize,
            drive,
        })
    }
}

/// Why there is no run.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Stopped {
    /// It was not begun: a variable that does not fit.
    #[error("{0}")]
    Unfit(String),
    /// It was begun: the message of an FMU.
    #[error("{0}")]
    Failed(String),
}

impl Plan {
    /// Runs a drive against a machine; `progress` is called with the share that is done.
    ///
    /// # Errors
    /// A sentence that names the variable and what was expected, or the message of an FMU.
    pub fn run(&self, drive: &mut Fmu, machine: &mut Fmu, progress: impl FnMut(f64)) -> Result<Run, Stopped> {
        let signals = Signals::of(self, &drive.description, &machine.description).map_err(Stopped::Unfit)?;
        self.advance(&signals, drive, machine, progress).map_err(Stopped::Failed)
    }

    fn advance(
        &self,
        signals: &Signals,
        drive: &mut Fmu,
        machine: &mut Fmu,
        mut progress: impl FnMut(f64),
    ) -> Result<Run, String> {
        let Signals { drive: of, torque, measured, truths, changes, .. } = signals;
        let Fmu { description, instance: machine, .. } = machine;
        let drive = &mut drive.instance;
        // what is read in each tick: all outputs, and what the loop needs
        let needed: Vec<&str> =
            truths.iter().map(|truth| &truth.3).chain([measured]).map(|signal| &*signal.name).collect();
        let is_read = |variable: &&Variable| variable.causality == "output" || needed.contains(&&*variable.name);
        let read: Vec<&Variable> = description.scalars().filter(is_read).collect();
        let references: Vec<u32> = read.iter().map(|variable| variable.reference).collect();
        let place = |signal: &Signal| references.iter().position(|reference| *reference == signal.reference);
        let place_of_measured = place(measured).unwrap_or_default();
        let column = |name: &str, unit: &str| Column { name: name.into(), unit: unit.into(), values: Vec::new() };
        let unit = |variable: &Variable| variable.unit.as_ref().map_or_else(String::new, |unit| unit.name.clone());
        let mut run = Run {
            times: Vec::new(),
            drive: [("speed_setpoint", "rad/s")].iter().chain(&DRIVE).map(|(name, unit)| column(name, unit)).collect(),
            machine: read.iter().map(|variable| column(&variable.name, &unit(variable))).collect(),
            faults: Vec::new(),
            errors: Vec::new(),
        };
        machine.set(&[torque.reference], &[torque.of_si(of.weight)])?;
        for (_, reference, value) in changes.iter().filter(|change| change.0.is_none()) {
            machine.set(&[*reference], &[*value])?;
        }
        machine.begin()?;
        machine.start()?;
        let mut values = vec![0.0; references.len()];
        let (mut applied, mut angle, mut last) = (of.weight, 0.0, None);
        let mut setpoints = self.setpoints.clone();
        setpoints.sort_by(|a, b| a.0.total_cmp(&b.0));
        for tick in 0..signals.ticks {
            let time = tick as f64 * of.period;
            machine.get(&references, &mut values)?;
            let now = measured.to_si(values[place_of_measured]);
            if !now.is_finite() {
                return Err(format!("`{}` is {now} at {time} s, expected a finite number", measured.name));
            }
            if signals.has_angle {
                angle = now;
            } else {
                angle += last.map_or(0.0, |last| 0.5 * of.period * (last + now));
                last = Some(now);
            }
            let seen = self.counts.map_or(angle, |counts| {
                let counts = f64::from(counts);
                (angle / TAU * counts).floor() / counts * TAU
            });
            if tick == 0 {
                drive.set(&of.inputs[..1], &[seen])?;
                drive.begin()?;
                drive.start()?;
            }
            let since = setpoints.iter().take_while(|(from, _)| (from / of.period).round() <= tick as f64);
            let setpoint = since.last().map_or(0.0, |(_, setpoint)| *setpoint);
            drive.set(&of.inputs, &[seen, applied, setpoint])?;
            drive.step(time, of.period)?;
            let mut given = [0.0; DRIVE.len()];
            drive.get(&of.outputs, &mut given)?;
            run.faults.push(drive.bits(of.faults)?);
            run.times.push(time);
            let row = std::iter::once(&setpoint).chain(&given);
            run.drive.iter_mut().zip(row).for_each(|(column, value)| column.values.push(*value));
            run.machine.iter_mut().zip(&values).for_each(|(column, value)| column.values.push(*value));

            for (_, reference, value) in changes.iter().filter(|change| change.0 == Some(tick)) {
                machine.set(&[*reference], &[*value])?;
            }
            applied = given[0];
            machine.set(&[torque.reference], &[torque.of_si(applied)])?;
            machine.step(time, of.period)?;
            if tick % 1000 == 0 {
                progress(tick as f64 / signals.ticks as f64);
            }
        }
        for (name, unit, at, truth) in truths {
            let pairs = run.drive[1 + at].values.iter().zip(&run.machine[place(truth).unwrap_or_default()].values);
            let values = pairs.map(|(estimate, value)| estimate - truth.to_si(*value)).collect();
            run.errors.push(Deviation { name, unit, values });
        }
        Ok(run)
    }
}
