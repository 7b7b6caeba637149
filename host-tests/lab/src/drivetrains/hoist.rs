//! The hoist's full plant and its runs.
//!
//! Referred to the motor here once more, from the same figures as the scene but by own arithmetic
//! [Huang 1987 ch. 1, Wang 1989 §1-3], so that an error of the library's reduction would show.

use driveline::configure::Machine as _;
use driveline_firmware::scenes::hoist::{Hoist, panel};

use super::facts;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_solver::plant::{Chain, LoadProgram, Plant, PlantError, Shaft, Start};

/// Gravity (m/s2), the standard value of ISO 80000-3.
const GRAVITY: f64 = 9.80665;

const MASS: f64 = 12_000.0;
const DIAMETER: f64 = 0.8;
const FALLS: f64 = 2.0;
const RATIO: f64 = 31.5;
const ROPE: f64 = 2.9e6;
const ROPE_DAMPING: f64 = 3.6e3;
/// Of the rope with these figures (m).
const LENGTH: f64 = 12.0;
const EFFICIENCY: f64 = 0.94;
const MOTOR_SHAFT: f64 = 5.0e4;

/// Speed at which the slack rope is taken up (rad/s).
const CREEP: f64 = 10.0;

/// Travel of the load per angle of the motor (m/rad).
const TRAVEL: f64 = DIAMETER / (2.0 * FALLS * RATIO);
/// Torque of the weight at the motor (N m).
const WEIGHT: f64 = MASS * GRAVITY * TRAVEL;
/// The nodes of load and brake drum, and the rope's shaft.
const LOAD: usize = 2;
const DRUM: usize = 1;
const ROPE_SHAFT: usize = 1;

/// The chain up to the load, which hangs on a rope that comes taut at `slack` [rad of the motor].
fn chain(slack: f64, by: &Departure) -> Chain {
    let [stiffness, damping] = rope(by);
    let rope = Shaft::rope(stiffness).damping(damping);
    Chain::motor(0.62 * by.motor_inertia)
        .shaft(Shaft::elastic(MOTOR_SHAFT * by.stiffness).damping(2.0 * by.damping), 0.08)
        .efficiency(EFFICIENCY + by.efficiency)
        .shaft(rope.gap(slack), MASS * TRAVEL * TRAVEL * by.load)
}

/// Stiffness and damping of the rope at the motor.
fn rope(by: &Departure) -> [f64; 2] {
    let square = TRAVEL * TRAVEL;
    [ROPE * square * by.stiffness / by.rope, ROPE_DAMPING * square * by.damping / by.rope]
}

/// The load on its rope as the brake holds it: the rope carries the weight, and the drive is about to.
fn hanging(program: LoadProgram, by: &Departure) -> Result<Plant, PlantError> {
    let weight = WEIGHT * by.load;
    let [rope, _] = rope(by);
    chain(0.0, by)
        .load(weight)
        .program(program)
        .start(Start::Given {
            twists: vec![weight / (MOTOR_SHAFT * by.stiffness), weight / rope],
            speeds: vec![0.0; 3],
        })
        .build()
}

/// The brake opens 0.2 s after the start.
const RELEASE: [(f64, Action); 3] =
    [(0.0, Action::Brake(DRUM, 2_000.0)), (0.2, Action::Release), (0.2, Action::Brake(DRUM, 0.0))];

/// The hoist and its runs.
///
/// Half a load more is picked up within a second, as slings let it be; that it came at once is shown beside, and not
/// counted: the load would gain 10 % of rated speed before a motor on a 3 Hz rope had moved by one count of its
/// encoder, whatever the observer.
pub fn machine() -> Result<Machine, PlantError> {
    let by = &Departure::NONE;
    let hoisting = (0.2, Action::Setpoint(Hoist::<10_000>::RATING.speed.0));
    let pretensioned = Scenario {
        held: WEIGHT,
        actions: [&RELEASE[..], &[hoisting, (6.0, Action::Setpoint(-Hoist::<10_000>::RATING.speed.0))]].concat(),
        duration: 12.0,
        marks: vec![(0.2, "brake opens"), (4.0, "half a load more"), (6.0, "reversal")],
        ..Scenario::of(
            "pretensioned start, half a load more, lowering",
            hanging(LoadProgram::table(&[(4.0, 0.0), (5.0, 0.5 * WEIGHT)]), by)?,
        )
    };
    let slack = Scenario {
        // On the ground: what holds the load until the rope carries its weight, and is its weight once it is lifted.
        actions: vec![
            (0.0, Action::Setpoint(CREEP)),
            (0.1, Action::Release),
            (4.0, Action::Setpoint(Hoist::<10_000>::RATING.speed.0)),
        ],
        duration: 8.0,
        marks: vec![(0.1, "creep"), (4.0, "hoist")],
        ..Scenario::of("slack-rope start", chain(0.0, by).coulomb(WEIGHT).start(Start::Rest).build()?)
    };
    let sudden = Scenario {
        name: "half a load more at once",
        plant: hanging(LoadProgram::steps(&[(4.0, 0.5 * WEIGHT)]), by)?.into(),
        held: WEIGHT,
        actions: [&RELEASE[..], &[hoisting]].concat(),
        duration: 6.0,
        counted: false,
        marks: vec![(0.2, "brake opens"), (4.0, "half a load more")],
        law: None,
    };
    Ok(with(vec![pretensioned, slack, sudden]))
}

/// The hoist as it is: one lift with the weight on the hook held, up at rated speed and down at half of it. The rope
/// has its length at the top.
pub fn departing(by: &Departure) -> Result<Machine, PlantError> {
    let up = Hoist::<10_000>::RATING.speed.0;
    let lift = lift("a lift", by, None, &[(0.2, up), (3.0, -0.5 * up)], 8.0)?;
    Ok(with(vec![lift]))
}

/// Runs for the learners, with known loads: an empty hook and a test weight, up and down at rated speed, then steps of
/// the speed.
pub fn test_lifts(by: &Departure) -> Result<Vec<Scenario>, PlantError> {
    let up = Hoist::<10_000>::RATING.speed.0;
    let (fall, steps, lasts) = (0.45 * up, 33.5, 3.5);
    let lifts = [(0.2, up), (5.4, -up), (12.1, up), (18.8, -up), (25.5, up)];
    let changes = (0..6).map(|k| (steps + lasts * f64::from(k), if k % 2 == 0 { fall } else { up }));
    let course: Vec<(f64, f64)> = lifts.into_iter().chain(changes).collect();
    let load = |mass: f64| Departure { load: mass / MASS, rope: 1.0, ..*by };
    Ok(vec![
        lift("empty hook", &load(500.0), Some(500.0), &lifts, 31.5)?,
        lift("test weight", &load(MASS), Some(MASS), &course, steps + 6.0 * lasts)?,
    ])
}

/// A load that hangs on the brake, and its speeds from the times on that they are set at.
fn lift(
    name: &'static str,
    by: &Departure,
    named: Option<f64>,
    speeds: &[(f64, f64)],
    duration: f64,
) -> Result<Scenario, PlantError> {
    let travel = wound(speeds, duration);
    let most = travel.iter().map(|(_, way)| *way).fold(0.0, f64::max);
    let start = LENGTH * by.rope + most;
    let at = |length: f64| Departure { rope: length / LENGTH, ..*by };
    let mut actions = RELEASE.to_vec();
    actions.push((1e-4, Action::Panel(panel::ROPE, start as f32)));
    actions.push((2e-4, Action::Panel(panel::LOAD, named.unwrap_or(-1.0) as f32)));
    actions.extend(speeds.iter().map(|&(time, speed)| (time, Action::Setpoint(speed))));
    actions.extend(travel.iter().map(|&(time, way)| {
        let [stiffness, damping] = rope(&at(start - way));
        (time, Action::Rope(ROPE_SHAFT, stiffness, damping))
    }));
    actions.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    Ok(Scenario {
        held: WEIGHT * by.load,
        actions,
        duration,
        marks: vec![(0.2, "brake opens")],
        ..Scenario::of(name, hanging(LoadProgram::steps(&[]), &at(start))?)
    })
}

/// Travel of the load (m) at times 50 ms apart, by the ramped setpoint.
fn wound(speeds: &[(f64, f64)], duration: f64) -> Vec<(f64, f64)> {
    const EVERY: f64 = 0.05;
    let ramp = Hoist::<10_000>::RAMP * EVERY;
    let (mut speed, mut way) = (0.0_f64, 0.0);
    (0..(duration / EVERY) as u32)
        .map(|step| {
            let time = f64::from(step) * EVERY;
            let before = speed;
            let target = speeds.iter().rev().find(|(from, _)| *from <= time + 1e-9).map_or(0.0, |(_, speed)| *speed);
            speed += (target - speed).clamp(-ramp, ramp);
            way += 0.5 * (before + speed) * EVERY * TRAVEL;
            (time + EVERY, way)
        })
        .collect()
}

/// The machine with these runs.
fn with(scenarios: Vec<Scenario>) -> Machine {
    Machine {
        summary: "A 12 t crane hoist, observed and governed from the motor's angle and torque alone: the firmware \
                  of every variant runs in QEMU, tick by tick against a full solver of the whole machine.",
        facts: facts::of_design::<Hoist<10_000>>(8192),
        notes: vec![
            "The shaft torque is the rope's pull at the motor, behind the gear's loss.",
            "The textbook cut, the modal truncation and the match of resonance and antiresonance give equal estimates \
                of this hoist within the noise: its motor shaft is stiff and its rope soft. With shafts of similar \
                stiffness they differ; `cargo driveline modes` shows by how much.",
            "The chosen observer is that of the hoist as described. For loads of 0.5 to 13 t on 5 to 30 m of rope the \
                drive is `learnt`, on a gain schedule: its errors are not larger than those of one mass in 99.5 % of \
                200 draws or more, where one set of gains has a load speed that is not worse in 36 %.",
        ],
        chosen: ("reduced", 10_000),
        scenarios,
        load: LOAD,
        shaft_torque: |plant| plant.torque_behind_gear(ROPE_SHAFT),
        load_torque: |plant| plant.load_torque(LOAD),
        ..facts::scene::<Hoist<10_000>>(driveline_firmware::scenes::hoist::SCENE, 8192)
    }
}
