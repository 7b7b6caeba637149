//! Starting time of a run, and that of the rigid machine in closed form.

use serde::Serialize;

use crate::machine_file::TrainFile;
use driveline::machine::{Characteristic, Induction, Inertia, Parabola, Rigid, Series, Speed};
use driveline_solver::plant::train::{Motion, RigidPart, Signal, Source};

/// Halvings of a line of the run: to 1e-15 of it.
const HALVINGS: u32 = 50;

/// Share of a speed by which the parts of a rigid machine may differ at the start.
const ALIKE: f64 = 1e-9;

/// The time in which a coordinate reaches a speed.
#[derive(Clone, Debug, Serialize)]
pub struct StartingTime {
    /// Name of the coordinate.
    pub name: String,
    /// The speed (rad/s or m/s).
    pub speed: f64,
    /// When it is first reached (s); `null` where the run ends before.
    pub time: Option<f64>,
    /// The same of the machine with rigid shafts, in closed form (s); `null` where it has none, or never reaches it.
    pub rigid: Option<f64>,
}

impl StartingTime {
    /// Of a run whose lines have been looked at `looks` times each; `before` is the run some lines before the first one
    /// in which the speed is reached, and how many.
    pub fn of(file: &TrainFile, (at, speed): (usize, f64), looks: u64, before: Option<(Motion, u64)>) -> Self {
        let time = before.map(|(mut motion, lines)| {
            for _ in 0..lines * looks {
                motion.advance(file.step / looks as f64);
            }
            let (mut before, mut after) = (0.0, file.step);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (before + after);
                let mut trial = motion.clone();
                trial.advance(middle);
                *(if is_reached(file, &trial, (at, speed)) { &mut after } else { &mut before }) = middle;
            }
            motion.time() + after
        });
        let rigid = (0..file.coordinates.len()).find_map(|driving| rigid(file, driving, (at, speed)));
        Self { name: file.coordinates[at].clone(), speed, time, rigid: rigid.filter(|time| time.is_finite()) }
    }
}

/// Whether the coordinate has had this speed, above or below that at the start.
pub fn is_reached(file: &TrainFile, motion: &Motion, (at, speed): (usize, f64)) -> bool {
    let is_rise = speed > file.motion.speed(at);
    let extremes = motion.extremes(Signal::Speed(at));
    extremes.is_some_and(|extremes| if is_rise { extremes.peak >= speed } else { extremes.least <= speed })
}

/// A torque against speed that has a closed form.
enum Curve<'a> {
    /// From the constant on.
    Polynomial([f64; 3]),
    Motor(Characteristic),
    Pieces(&'a [f64], &'a [[f64; 3]]),
}

impl<'a> Curve<'a> {
    fn of(source: &'a Source) -> Option<Self> {
        Some(match source {
            Source::Constant(torque) => Self::Polynomial([*torque, 0.0, 0.0]),
            Source::Line { stall, slope } => Self::Polynomial([*stall, -slope, 0.0]),
            Source::Parabola(a, b, c) => Self::Polynomial([*a, *b, *c]),
            Source::Kloss { breakdown, slip, synchronous } => {
                let (breakdown, breakdown_slip, synchronous) = (*breakdown, *slip, *synchronous);
                Self::Motor(Characteristic::Induction(Induction { synchronous, breakdown, breakdown_slip }))
            }
            Source::Series { voltage, resistance, flux } => {
                let (voltage, resistance, flux) = (*voltage, *resistance, *flux);
                Self::Motor(Characteristic::Series(Series { voltage, resistance, flux }))
            }
            Source::Pieces { ends, torques } => Self::Pieces(ends, torques),
            _ => return None,
        })
    }

    fn torque(&self, speed: f64) -> f64 {
        let polynomial = |[a, b, c]: [f64; 3]| a + speed * (b + c * speed);
        match self {
            Self::Polynomial(torque) => polynomial(*torque),
            Self::Motor(motor) => motor.torque(Speed(speed)).0,
            Self::Pieces(ends, torques) => {
                let mut pieces = ends.windows(2).zip(*torques);
                let piece = pieces.find(|(ends, _)| ends[0] <= speed && speed < ends[1]);
                piece.map_or(0.0, |(_, torque)| polynomial(*torque))
            }
        }
    }
}

/// The starting time where this coordinate alone drives, and everything has a closed form; infinite where its torque
/// does not suffice.
fn rigid(file: &TrainFile, driving: usize, (at, speed): (usize, f64)) -> Option<f64> {
    let parts = file.train.rigid(driving)?;
    let (from, to) = (parts[driving].speed, speed / parts[at].ratio);
    let alike = |part: &RigidPart| (part.speed - part.ratio * from).abs() <= ALIKE * part.speed.abs();
    if !(parts.iter().all(alike) && 0.0 <= from && from < to) {
        return None;
    }
    let (mut inertia, mut load, mut motor, mut drives, mut at_rest) = (0.0, [0.0; 3], None, false, 0.0);
    for (j, RigidPart { ratio, efficiency, inertia: own, torques, breakaway, .. }) in parts.iter().enumerate() {
        inertia += own * ratio * ratio / efficiency;
        at_rest -= breakaway * ratio.abs() / efficiency;
        for source in torques {
            let curve = Curve::of(source)?;
            let driven = |speed: f64| ratio * curve.torque(ratio * speed);
            // where a parabola has its extreme, within the run
            let bend = match curve {
                Curve::Polynomial([_, b, c]) => (-b / (2.0 * c * ratio)).clamp(from, to),
                _ => from,
            };
            if j == driving {
                drives |= driven(from) > 0.0;
            } else if [from, bend, to].into_iter().any(|speed| driven(speed) > 0.0) {
                return None;
            }
            at_rest += driven(0.0) / efficiency;
            match curve {
                Curve::Polynomial(torque) => {
                    let mut share = -ratio / efficiency;
                    for (sum, term) in load.iter_mut().zip(torque) {
                        *sum += share * term;
                        share *= ratio;
                    }
                }
                curve if j == driving && motor.is_none() => motor = Some(curve),
                _ => return None,
            }
        }
    }
    if from == 0.0 && at_rest <= 0.0 {
        return None;
    }
    let machine = Rigid::try_new(Inertia(inertia)).ok()?;
    let [constant, linear, square] = load;
    let load = Parabola { constant, linear, square };
    let time = |mover: Characteristic, from: f64, to: f64| mover.time_to(&machine, &load, Speed(from), Speed(to));
    let curve = |[constant, linear, square]: [f64; 3]| Characteristic::Parabola(Parabola { constant, linear, square });
    drives.then(|| match motor {
        Some(Curve::Motor(motor)) => time(motor, from, to),
        Some(Curve::Pieces(ends, torques)) => {
            let [first, .., last] = ends else { return f64::INFINITY };
            let is_within = *first <= from && to <= *last;
            let piece = |(ends, torque): (&[f64], &[f64; 3])| time(curve(*torque), from.max(ends[0]), to.min(ends[1]));
            if is_within { ends.windows(2).zip(torques).map(piece).sum() } else { f64::INFINITY }
        }
        _ => time(curve([0.0; 3]), from, to),
    })
}
