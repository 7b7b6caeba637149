//! The punch press's full plant: motor with flywheel, eccentric shaft, crank with its slider, and strokes that blank
//! plate.

use std::f64::consts::{PI, TAU};

use driveline::configure::HasMechanism as _;
use driveline::configure::Machine as _;
use driveline_firmware::scenes::punch_press::{self as scene, PunchPress};

use super::facts::{self, fact};
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Law, Machine, Scenario};
use driveline_solver::plant::PlantError;
use driveline_solver::plant::train::{Coordinate, Crank, Link, Train};

/// Turns of the motor to one of the crank.
const RATIO: f64 = 14.0;
/// The crank's coordinate.
pub const CRANK: usize = 1;
/// The eccentric shaft's link, its stiffness (N m/rad) and its damping (N m s/rad) at the motor.
const SHAFT: usize = 0;
const STIFFNESS: f64 = 1.6e7 / (RATIO * RATIO);
const DAMPING: f64 = 2_100.0 / (RATIO * RATIO);
/// Friction of bearings and gibs at the crank (N m s/rad): 20 N m at the motor at rated speed, a tenth of rated torque.
const FRICTION: f64 = 20.0 * RATIO * RATIO / PunchPress::RATING.speed.0;
/// Torque of the punch at the crank (N m), and the angles before the bottom between which it acts (rad): 800 kN at the
/// middle of them.
const PUNCH: f64 = 25_800.0;
const FROM: f64 = 44.0 / 360.0 * TAU;
const OVER: f64 = 40.0 / 360.0 * TAU;
/// The strokes that there is plate for, counted from 0 at the start: at rated speed from the fourth on, then none
/// again.
const PLATE: std::ops::Range<f64> = 3.0..7.0;
/// About when that is (s).
const SECONDS: [f64; 2] = [4.0, 7.6];

/// Torque of the punch on the crank (N m) at an angle of it (rad): a die with shear takes it up and lets it go
/// smoothly.
fn punch(angle: f64) -> f64 {
    let way = (angle + FROM).rem_euclid(TAU) / OVER;
    if way < 1.0 { PUNCH * (PI * way).sin().powi(2) } else { 0.0 }
}

/// The crank's angle, and the strokes that it has made.
fn made(press: &Body) -> (f64, f64) {
    let angle = press.motion().map_or(0.0, |motion| motion.angle(CRANK));
    (angle, (angle - PI) / TAU)
}

/// Torque of the punch at the motor, while there is plate.
fn blanking(press: &Body) -> f64 {
    let (angle, strokes) = made(press);
    if PLATE.contains(&strokes) { punch(angle) / RATIO } else { 0.0 }
}

/// The same with plate in every stroke from the third on, without an end.
pub fn stamping(press: &Body) -> f64 {
    let (angle, strokes) = made(press);
    if strokes >= 2.0 { punch(angle) / RATIO } else { 0.0 }
}

/// Everything that acts on the crank from outside, at the motor.
fn load(press: &Body) -> f64 {
    blanking(press) + FRICTION / (RATIO * RATIO) * press.speed(CRANK)
}

/// Torque of the eccentric shaft at the motor: the link's force, for much less than by its series.
fn shaft(press: &Body) -> f64 {
    STIFFNESS * press.twist(SHAFT) + DAMPING * (press.motor_speed() - press.speed(CRANK))
}

/// The press at its top, with an inertia more on the flywheel (kg m2).
pub fn press(added: f64) -> Result<Body, PlantError> {
    let motion = Train::new()
        .coordinate(Coordinate::new(4.8 + added))
        .coordinate(Coordinate::new(40.0).angle(PI).viscous(FRICTION).crank(Crank::new(0.08, 0.7, 2_500.0)))
        .link(Link::geared(0, CRANK, RATIO, STIFFNESS).damping(DAMPING))
        .build()?;
    Ok(Body::train(motion, &[(CRANK, RATIO)]))
}

/// The press and its run.
pub fn machine() -> Result<Machine, PlantError> {
    let torque_noise = 0.01 * PunchPress::RATING.torque.0;
    let [least, most] = PunchPress::DRIVEN.extremes();
    let sd = PunchPress::MECHANISM_OBSERVER.rigid.standard_deviation;
    Ok(Machine {
        summary: "An eccentric punch press with a flywheel: run-up, continuous strokes, and on without plate.",
        facts: vec![
            fact("inertia at the motor", format!("{least:.3} to {most:.3} kg m² over a turn of the crank")),
            fact("punch", format!("{:.0} N m at the motor over 40° of the crank", PUNCH / RATIO)),
            fact("predicted standard deviations", format!("speed {:.4} rad/s, load torque {:.1} N m", sd[1], sd[2])),
            fact("torque noise", format!("{torque_noise:.2} N m rms in every tick, white")),
            fact("encoder", format!("{} counts a turn: 2048 sine periods, interpolated", scene::COUNTS)),
        ],
        notes: vec![
            "The shaft torque is the eccentric shaft's, referred to the motor: from flywheel to crank.",
            "Both variants have the same observer. `plain` governs the unfiltered speed; `mean` the speed without the \
                ripple of the strokes.",
        ],
        chosen: ("mean", PunchPress::RATE_HZ),
        scenarios: vec![Scenario {
            name: "run-up, strokes, idling",
            plant: press(0.0)?,
            held: 0.0,
            actions: vec![(0.1, Action::Release), (0.1, Action::Setpoint(PunchPress::RATING.speed.0))],
            duration: 8.5,
            counted: true,
            marks: vec![(0.1, "run-up"), (SECONDS[0], "plate"), (SECONDS[1], "no plate")],
            law: Some(Law { node: CRANK, torque: blanking }),
        }],
        load: CRANK,
        shaft_torque: shaft,
        load_torque: load,
        ..facts::scene::<PunchPress>(scene::SCENE, scene::COUNTS)
    })
}
