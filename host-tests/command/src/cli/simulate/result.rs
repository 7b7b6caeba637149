//! Result of `simulate`: a run line by line, its extremes, its events, and whether it is proven.

use std::time::{Duration, Instant};

use serde::Serialize;

use super::starting_time::{StartingTime, is_reached};
use super::swing::Swing;
use crate::cli::{Failure, Progress};
use crate::machine_file::{PinForces, TrainFile};
use driveline_report::format::{counted, significant};
use driveline_solver::plant::train::converge::{BOUND, Recording, Sensitive, prove, prove_in_pieces};
use driveline_solver::plant::train::{Cycle, Motion, Signal};
use driveline_solver::plant::{EventKind, Place};

/// Product of the fastest rate and the time between two looks at the progress, at most.
const BETWEEN_LOOKS: f64 = 1e4;

/// Cycles after which a machine that has not settled is given up.
const CYCLES: usize = 2000;

/// A speed or force that no machine reaches.
const OVERFLOW: f64 = 1e30;

/// A finished run.
#[derive(Clone, Debug, Serialize)]
pub struct Simulation {
    /// The machine's name.
    pub name: String,
    /// Whether all coordinates are angles.
    #[serde(skip)]
    pub turns: bool,
    /// Length of the run (s).
    pub time: f64,
    /// Extremes of the speeds.
    pub coordinates: Vec<Moved>,
    /// Extremes of the forces.
    pub links: Vec<Carried>,
    /// What the dry frictions slid, and their heat.
    pub frictions: Vec<Rubbed>,
    /// Forces in the pins of cranks.
    pub pin_forces: Vec<PinForces>,
    /// The event.
    pub events: Vec<Happened>,
    /// Deviation of the second integrator as a share of the peaks, and of the solver with events located ten times
    /// closer: `null` without an event. None where the proof was left out or did not succeed.
    pub proof: Option<(f64, Option<f64>)>,
    /// Where roundings grow beyond the bound of the proof; `null` of a run that is proven as a whole.
    pub sensitive: Option<Pieces>,
    /// Why the run is not proven.
    pub not_proven: Option<String>,
    /// The steady cycle; `null` where the file asks for none.
    pub cycle: Option<Steady>,
    /// The starting time; `null` where the file asks for none.
    pub starting: Option<StartingTime>,
    /// The same run without the dampers; `null` of a machine that has none.
    pub without_dampers: Option<Box<Self>>,
    /// Times of the lines (s).
    #[serde(skip)]
    pub times: Vec<f64>,
    /// Of each coordinate, its speed at those times.
    #[serde(skip)]
    pub speeds: Vec<Vec<f64>>,
    /// Of each link, its force at those times.
    #[serde(skip)]
    pub forces: Vec<Vec<f64>>,
}

/// How a sensitive run is proven: in pieces, each from the state that the run has where it begins.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Pieces {
    /// Up to here the run follows from its start (s).
    pub from: f64,
    /// Pieces after it.
    pub pieces: usize,
    /// The shortest time in which a rounding grew beyond the bound (s).
    pub shortest: f64,
}

impl From<Sensitive> for Pieces {
    fn from(sensitive: Sensitive) -> Self {
        Self { from: sensitive.from, pieces: sensitive.restarts, shortest: sensitive.shortest }
    }
}

/// The cycle that a coordinate settles to.
#[derive(Clone, Debug, Serialize)]
pub struct Steady {
    /// Name.
    pub name: String,
    /// Coefficient of speed fluctuation: greatest less least speed over the mean.
    pub delta: f64,
    /// Greatest speed (rad/s).
    pub greatest: f64,
    /// Least speed (rad/s).
    pub least: f64,
    /// Mean speed over the time (rad/s).
    pub mean: f64,
    /// Length of a cycle (s).
    pub time: f64,
    /// Cycles after the run until they repeated.
    pub cycles: usize,
    /// Largest share of a peak by which a speed or an elongation does not come back after the cycle, and the deviation
    /// of the second integrator over it; `null` where the proof was left out or did not succeed.
    pub proof: Option<(f64, f64)>,
    /// Why the cycle is not proven.
    pub not_proven: Option<String>,
    /// Swing of the kinetic energy over the cycle, and the flywheel for each class of machine.
    pub swing: Swing,
}

/// Extremes of a speed (rad/s or m/s).
#[derive(Clone, Debug, Serialize)]
pub struct Moved {
    /// Name.
    pub name: String,
    /// Least.
    pub least: f64,
    /// Greatest.
    pub greatest: f64,
    /// At the end.
    pub last: f64,
}

/// Extremes of the force of a link (N m or N).
#[derive(Clone, Debug, Serialize)]
pub struct Carried {
    /// Name.
    pub name: String,
    /// Least.
    pub least: f64,
    /// When (s).
    pub least_time: f64,
    /// Greatest.
    pub greatest: f64,
    /// When (s).
    pub greatest_time: f64,
    /// The static force that the dynamic factor is reckoned from.
    pub static_force: f64,
    /// Where that comes from: `file`, or `mean` of the second half of the run.
    pub static_from: &'static str,
    /// Dynamic factor: the greatest size over the static force; none where that is nothing.
    pub dynamic_factor: Option<f64>,
    /// The same of its spring alone, without its damper.
    pub elastic_factor: Option<f64>,
    /// Least elongation (rad or m), such as a girder's deflection; of a shaft its twist.
    pub least_elongation: f64,
    /// Greatest elongation (rad or m).
    pub greatest_elongation: f64,
    /// How often it came into contact or left it.
    pub contacts: usize,
}

/// How far a dry friction slid: a brake, a slip clutch between two coordinates.
#[derive(Clone, Debug, Serialize)]
pub struct Rubbed {
    /// Its coordinates by name.
    pub name: String,
    /// To and fro (rad or m).
    pub slid: f64,
    /// Heat (J): its torque times that.
    pub heat: f64,
    /// Largest power (W), the mean over a step of the run.
    pub power: f64,
}

/// An event.
#[derive(Clone, Debug, Serialize)]
pub struct Happened {
    /// When (s).
    pub time: f64,
    /// What, in a word or two.
    pub what: String,
    /// Where, by name.
    pub place: String,
}

/// How far a run has come, and how long the rest takes at this rate.
fn so_far(file: &TrainFile, share: f64, took: Duration) -> String {
    let left = took.as_secs_f64() * (1.0 - share) / share;
    let left = match left {
        left if left < 100.0 => format!("{left:.0} s"),
        left if left < 6_000.0 => format!("{:.0} min", left / 60.0),
        left if left < 360_000.0 => format!("{:.0} h", left / 3_600.0),
        left => format!("{:.0} days", left / 86_400.0),
    };
    let (solved, time) = (share * file.time, significant(file.time));
    format!("{}: {solved:.1e} of {time} s solved, at this rate the rest takes {left}", file.name)
}

impl Simulation {
    /// Runs a train and proves the run.
    ///
    /// # Errors
    /// A train too stiff for the length of the run, with the parameter that makes it so. More than a thousand events
    /// in one step: the machine rattles without end there. A speed or force that grows without bound. A mechanism with
    /// friction that turns backwards.
    pub fn of(file: &TrainFile, proven: bool) -> Result<Self, Failure> {
        if let Some(refusal) = &file.too_stiff {
            return Err(refusal.clone().into());
        }
        let steps = (file.time / file.step).round().max(1.0) as u64;
        let progress = Progress::of(200);
        progress.says("solving");
        let mut start = file.motion.clone();
        let (n, links) = (start.coordinates(), start.links());
        let signals: Vec<Signal> = (0..n).map(Signal::Speed).chain((0..links).map(Signal::Force)).collect();
        let extremes_alone = (0..links).flat_map(|link| [Signal::Elastic(link), Signal::Elongation(link)]);
        signals.iter().copied().chain(extremes_alone).for_each(|signal| start.watch(signal));
        let mut times = vec![0.0];
        let mut rows: Vec<Vec<f64>> = start.read_all(&signals).into_iter().map(|value| vec![value]).collect();
        let mut rubbed: Vec<(Rubbed, f64)> = start
            .slides()
            .map(|(terms, _, along)| {
                let names: Vec<_> = terms.iter().map(|term| file.coordinates[term.0].as_str()).collect();
                (Rubbed { name: names.join(" on "), slid: 0.0, heat: 0.0, power: 0.0 }, along)
            })
            .collect();
        let mut run = Recording::new(start);
        // a stiff train's step is divided, so that the bar moves within it
        let looks = (file.motion.rate() * file.step / BETWEEN_LOOKS).ceil().max(1.0) as u64;
        let (mut reached, mut kept) = (None, None);
        let begun = Instant::now();
        for step in 0..steps {
            // so that little of a long run is repeated to find when the speed is reached
            if file.starting.is_some() && reached.is_none() && step % (steps / 100 + 1) == 0 {
                kept = Some((run.motion().clone(), step));
            }
            for look in 0..looks {
                run.advance(file.step / looks as f64);
                let (done, all) = (step * looks + look + 1, steps * looks);
                progress.at(done * 100 / all);
                progress.says_when_due(|| so_far(file, done as f64 / all as f64, begun.elapsed()));
            }
            let motion = run.motion();
            if let Some(wanted) = file.starting.filter(|_| reached.is_none()) {
                reached = is_reached(file, motion, wanted).then_some(step);
            }
            if motion.events().last().is_some_and(|event| event.kind == EventKind::Unresolved) {
                let at = motion.time();
                let mut before = motion.events().iter().rev().filter(|event| event.kind != EventKind::Unresolved);
                let last = before.next().map_or_else(String::new, |event| {
                    let Happened { what, place, .. } = happened(file, event);
                    format!(", the last of them at \"{place}\" ({what})")
                });
                return Err(Failure::failed(format!(
                    "more than a thousand events in the step that ends at {at} s{last}: the run cannot be resolved; \
                     expected damping or friction that ends them"
                )));
            }
            for ((rubbed, before), (_, torque, along)) in rubbed.iter_mut().zip(motion.slides()) {
                let slid = (along - *before).abs();
                *before = along;
                rubbed.slid += slid;
                rubbed.heat += torque * slid;
                rubbed.power = rubbed.power.max(torque * slid / file.step);
            }
            let values = motion.read_all(&signals);
            if let Some((signal, value)) = signals.iter().zip(&values).find(|(_, value)| !(value.abs() < OVERFLOW)) {
                let name = match *signal {
                    Signal::Speed(j) => format!("the speed of \"{}\"", file.coordinates[j]),
                    Signal::Force(l) => format!("the force of \"{}\"", file.links[l]),
                    _ => "the run".to_owned(),
                };
                return Err(Failure::failed(format!(
                    "{name} grows without bound: {value:.1e} at {} s; expected torques, dampings and slopes that let \
                     the machine settle, or a shorter run",
                    motion.time()
                )));
            }
            times.push(motion.time());
            rows.iter_mut().zip(values).for_each(|(row, value)| row.push(value));
        }
        progress.says("proving by the second integrator");
        let (proof, not_proven) = if proven {
            match prove_in_pieces(&run, |share| progress.at(100 + (100.0 * share) as u64)) {
                Ok(proof) => (Some(proof), None),
                Err(error) => (None, Some(error.to_string())),
            }
        } else {
            (None, Some("the proof was left out".to_owned()))
        };
        let motion = run.motion();
        let says = |cycle| {
            progress.says_when_due(|| format!("{}: cycle {cycle} of at most {CYCLES}, until they repeat", file.name));
        };
        let cycle = file.cycle.map(|(at, turns)| steady(file, motion.clone(), at, turns, proven, says)).transpose()?;
        let before = kept.zip(reached).map(|((motion, at), line)| (motion, line - at));
        let starting = file.starting.map(|wanted| StartingTime::of(file, wanted, looks, before));
        let moved = |j: usize| {
            let extremes = motion.extremes(Signal::Speed(j));
            let (least, greatest) = extremes.map_or((f64::NAN, f64::NAN), |e| (e.least, e.peak));
            Moved { name: file.coordinates[j].clone(), least, greatest, last: motion.speed(j) }
        };
        let backwards = |j: &&usize| motion.extremes(Signal::Speed(**j)).is_some_and(|e| e.least < 0.0);
        if let Some(&j) = file.forwards.iter().find(backwards) {
            let name = &file.coordinates[j];
            return Err(Failure::failed(if file.motion.speed(j) > 0.0 {
                format!(
                    "\"{name}\" turns backwards, where the friction of its mechanism would drive it; expected torques \
                     that keep it turning forwards, or neither `friction` nor `pins`"
                )
            } else {
                format!(
                    "\"{name}\" starts at rest, where the friction of its mechanism, that of forward motion, drives it \
                     backwards; expected a `speed` above zero, a torque from the start, or neither \
                     `friction` nor `pins`"
                )
            }));
        }
        let without_dampers =
            file.without_dampers.as_deref().map(|bare| Self::of(bare, proven)).transpose()?.map(Box::new);
        let bare = without_dampers.as_ref().and_then(|bare| bare.not_proven.as_ref());
        let not_proven = not_proven.or(bare.map(|reason| format!("without its dampers: {reason}")));
        let forces = rows.split_off(n);
        let carried = |l: usize| {
            let row = &forces[l];
            let half = &row[row.len() / 2..];
            let mean = half.iter().sum::<f64>() / half.len() as f64;
            let (static_force, static_from) = file.static_force[l].map_or((mean, "mean"), |force| (force, "file"));
            let e = motion.extremes(Signal::Force(l));
            let e = e.unwrap_or(driveline_solver::plant::Extremes {
                peak: 0.0,
                peak_time: 0.0,
                least: 0.0,
                least_time: 0.0,
            });
            let size = e.peak.abs().max(e.least.abs());
            let elastic = motion.extremes(Signal::Elastic(l)).map_or(0.0, |e| e.peak.abs().max(e.least.abs()));
            let factor =
                |greatest: f64| (static_force.abs() > 1e-9 * size && size > 0.0).then(|| greatest / static_force.abs());
            let [least_elongation, greatest_elongation] =
                motion.extremes(Signal::Elongation(l)).map_or([0.0; 2], |e| [e.least, e.peak]);
            let contacts = motion.events().iter().filter(|event| event.kind == EventKind::Contact);
            Carried {
                name: file.links[l].clone(),
                least: e.least,
                least_time: e.least_time,
                greatest: e.peak,
                greatest_time: e.peak_time,
                static_force,
                static_from,
                dynamic_factor: factor(size),
                elastic_factor: factor(elastic),
                least_elongation,
                greatest_elongation,
                contacts: contacts.filter(|event| event.place == Place::Shaft(l)).count(),
            }
        };
        Ok(Self {
            name: file.name.clone(),
            turns: file.turns,
            time: motion.time(),
            coordinates: (0..n).map(moved).collect(),
            links: (0..links).map(carried).collect(),
            frictions: rubbed.into_iter().map(|(rubbed, _)| rubbed).filter(|rubbed| rubbed.heat > 0.0).collect(),
            pin_forces: file.pin_forces.clone(),
            events: motion.events().iter().map(|event| happened(file, event)).collect(),
            proof: proof.map(|proof| (proof.integrator.largest, proof.tightened.map(|tightened| tightened.largest))),
            sensitive: proof.and_then(|proof| proof.sensitive).map(Pieces::from),
            not_proven,
            cycle,
            starting,
            without_dampers,
            times,
            speeds: rows,
            forces,
        })
    }

    /// The run as a table with a heading, numbers to their last digit.
    pub fn csv(&self) -> String {
        use std::fmt::Write;
        let quoted = |name: &str, unit: &str| format!("\"{} {unit}\"", name.replace('"', "\"\""));
        let speeds = self.coordinates.iter().map(|c| quoted(&c.name, "speed"));
        let forces = self.links.iter().map(|l| quoted(&l.name, "force"));
        let mut text = ["time".to_owned()].into_iter().chain(speeds).chain(forces).collect::<Vec<_>>().join(",");
        text.push('\n');
        for (row, time) in self.times.iter().enumerate() {
            // writing to a `String` cannot fail
            let _ = write!(text, "{time}");
            for column in self.speeds.iter().chain(&self.forces) {
                let _ = write!(text, ",{}", column[row]);
            }
            text.push('\n');
        }
        text
    }
}

/// Steps of a cycle that the second integrator is compared at.
const STEPS: u32 = 100;

/// The steady cycle after the run.
fn steady(
    file: &TrainFile,
    mut motion: Motion,
    at: usize,
    turns: u32,
    proven: bool,
    says: impl Fn(usize) + Copy,
) -> Result<Steady, Failure> {
    let name = file.coordinates[at].clone();
    let Some(cycle) = motion.steady_cycle(at, turns, CYCLES, says) else {
        return Err(Failure::failed(format!(
            "\"{name}\" does not settle to a cycle of {} within {CYCLES} of them after the run; expected torques that \
             keep it turning forwards at a speed that settles, and a run up to near that speed",
            counted(turns.into(), "turn")
        )));
    };
    let Cycle { greatest, least, time, mean, cycles } = cycle;
    let swing = Swing::of(motion.clone(), at, &cycle);
    let proof = if proven { closed(motion, at, turns, says) } else { Err("the proof was left out".to_owned()) };
    let (proof, not_proven) = proof.map_or_else(|reason| (None, Some(reason)), |proof| (Some(proof), None));
    Ok(Steady { name, delta: cycle.delta(), greatest, least, mean, time, cycles, proof, not_proven, swing })
}

/// Proves a cycle: it comes back to 1e-8 of the peaks, and a second integrator runs it alike.
fn closed(motion: Motion, at: usize, turns: u32, says: impl Fn(usize)) -> Result<(f64, f64), String> {
    let closed = motion.closed_cycle(at, turns, CYCLES, STEPS, says);
    let (run, residual) = closed.ok_or("it does not turn on evenly")?;
    if residual > BOUND {
        return Err(format!("a speed or an elongation is {residual:.1e} of its peak off after a cycle"));
    }
    let proof = prove(&run).map_err(|error| error.to_string())?;
    Ok((residual, proof.largest()))
}

fn happened(file: &TrainFile, event: &driveline_solver::plant::Event) -> Happened {
    let place = match event.place {
        Place::Node(j) | Place::Pins(j) => &file.coordinates[j],
        Place::Shaft(l) => &file.links[l],
    };
    let what = match (event.kind, event.new) {
        (EventKind::Contact, 1) => "contact",
        (EventKind::Contact, 0) => "separation",
        (EventKind::Contact, _) => "contact on the back",
        (EventKind::Stop, _) => "comes to rest",
        (EventKind::Slip, _) => "breaks loose",
        (EventKind::Reversal, _) => "passes through rest",
        (EventKind::Flow, _) => "power turns round",
        (EventKind::Unresolved, _) => "not resolved",
    };
    Happened { time: event.time, what: what.to_owned(), place: place.clone() }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::so_far;
    use crate::machine_file::parse_train;

    #[test]
    fn a_long_run_says_how_far_it_has_come_and_how_long_the_rest_takes() {
        let text = "name = \"mill\"\n[[coordinate]]\nname = \"motor\"\ninertia = 1.0\n[run]\ntime = 1e9\nstep = 1e3\n";
        let file = parse_train("mill", text).unwrap();
        let said = |share, seconds| so_far(&file, share, Duration::from_secs(seconds));
        assert_eq!(said(0.25, 10), "mill: 2.5e8 of 1.00e9 s solved, at this rate the rest takes 30 s");
        assert!(said(0.5, 3_000).ends_with("takes 50 min"));
        assert!(said(0.1, 3_600).ends_with("takes 9 h"));
        assert!(said(1e-5, 5).ends_with("takes 6 days"));
    }
}
