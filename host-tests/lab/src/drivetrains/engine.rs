//! Builds the variants, runs them in QEMU against the plant, and puts together what there is to report.

use std::error::Error;

use driveline_firmware::board::Facts;
use driveline_firmware::scenes::find;

use crate::candidates::Candidate;
use driveline_closed_loop::figures::{deviations, peaks};
use driveline_closed_loop::lockstep;
use driveline_closed_loop::lockstep::Trace;
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::units::Units;
use driveline_qemu::image::{Contents, Image, Program, build};
use driveline_qemu::link::Link;
use driveline_qemu::measure::{Core, Cycles, Flash, Loops, MachineCode, Spread};
use driveline_report::{Instructions, Mark, Signal, Trajectory, Variant};

/// A variant that has run.
pub struct Ran {
    /// Its name and cost.
    pub variant: Variant,
    /// One trace a scenario.
    pub traces: Vec<Trace>,
}

/// Purpose of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// The first scenario's first seconds only, and no proof.
    pub quick: bool,
}

/// How long a quick run is (s).
const QUICK: f64 = 2.0;

/// Flash and RAM of the image that holds no drive, on a board.
pub fn empty(board: Facts, says: &dyn Fn(&str)) -> Result<(u64, u64), Box<dyn Error>> {
    let building = |line: &str| says(&format!("no drive, {}: building: {}", board.core, line.trim()));
    let image = build("empty/f32/none/10000", board, Program::ControlLoop, building)?;
    let sizes = Contents::read(&image.path)?.sizes;
    Ok((sizes.flash(), sizes.ram()))
}

/// Runs a variant through every scenario of its machine: in QEMU, then on the host over the same inputs.
///
/// # Errors
/// A build, link or proof that failed, with the variant's name.
pub fn run(
    machine: &Machine,
    candidate: &Candidate,
    base: (u64, u64),
    options: Options,
    says: &dyn Fn(&str),
) -> Result<Ran, Box<dyn Error>> {
    let name = candidate.key();
    says(&format!("{name}: building"));
    let building = |line: &str| says(&format!("{name}: building: {}", line.trim()));
    let image = build(candidate.variant, candidate.board, Program::ControlLoop, building)?;
    let units = Units::new(candidate.words(), machine.bases);
    let (mut traces, mut stack, mut bit_exact) = (Vec::new(), 0, true);
    for scenario in &machine.scenarios {
        let mut scenario = scenario.clone();
        if options.quick {
            scenario.duration = scenario.duration.min(QUICK);
        }
        says(&format!("{name}: {} in QEMU", scenario.name));
        let mut link = Link::start(&image)?;
        let trace = lockstep::run(machine, &scenario, &units, candidate.rate_hz(), &mut link, |_| {})?;
        stack = stack.max(link.finish()?.stack);
        bit_exact &= find(candidate.variant).is_some_and(|row| row.gives(&trace.words));
        if !options.quick {
            says(&format!("{name}: proving the solver's run"));
            trace.recording.prove().map_err(|error| format!("{name}, {}: {error}", scenario.name))?;
        }
        traces.push(trace);
        if options.quick {
            break;
        }
    }
    let contents = Contents::read(&image.path)?;
    let counted = || traces.iter().zip(&machine.scenarios).filter(|(_, scenario)| scenario.counted).map(|(t, _)| t);
    let [torque_peak, _, load_peak] = peaks(counted());
    let [shaft_torque, load_speed, load_torque] = deviations(counted(), [torque_peak, machine.rated_speed, load_peak]);
    let moments = || traces.iter().flat_map(|trace| &trace.moments);
    let spread = Spread::of(moments().map(|moment| moment.instructions).collect());
    let variant = Variant {
        number: candidate.part(1).into(),
        core: candidate.board.core.into(),
        observer: candidate.part(2).into(),
        rate_hz: candidate.rate_hz(),
        shaft_torque,
        load_speed,
        load_torque,
        instructions: Instructions { min: spread.min.into(), median: spread.median.into(), max: spread.max.into() },
        cycles: cycles(&image)?,
        flash_bytes: contents.sizes.flash().saturating_sub(base.0),
        ram_bytes: contents.sizes.ram().saturating_sub(base.1),
        stack_bytes: stack.into(),
        bit_exact,
        ticks: moments().count() as u64,
    };
    Ok(Ran { variant, traces })
}

/// Least and most cycles of the tick on the path that has the most.
fn cycles(image: &Image) -> Result<Option<[u64; 2]>, Box<dyn Error>> {
    let core = if image.board.core == "m3" { Core::M3 } else { Core::M4 };
    let code = MachineCode::read(&image.path, Loops::default())?;
    let found = code.find("driveline_tick").and_then(|tick| code.cycles(tick, core, Flash::IDEAL).ok());
    Ok(found.map(|Cycles { least, most }| [least, most]))
}

/// Traces as the page draws them.
pub fn trajectories(machine: &Machine, ran: &Ran) -> Vec<Trajectory> {
    let signal = |trace: &Trace, k: usize| Signal {
        truth: trace.moments.iter().map(|moment| moment.truth[k]).collect(),
        estimate: trace.moments.iter().map(|moment| moment.estimate[k]).collect(),
    };
    let one = |(trace, scenario): (&Trace, &driveline_closed_loop::scenario::Scenario)| Trajectory {
        variant: ran.variant.label(),
        situation: scenario.name.into(),
        time: trace.moments.iter().map(|moment| moment.time).collect(),
        shaft_torque: signal(trace, 0),
        load_speed: signal(trace, 1),
        load_torque: signal(trace, 2),
        marks: scenario.marks.iter().map(|(time, label)| Mark { time: *time, label: (*label).into() }).collect(),
    };
    ran.traces.iter().zip(&machine.scenarios).map(one).collect()
}
