//! In-run balancing of rigid rotors under disturbances that last: slow swings of the speed, bearings that drift, jumps
//! of the unbalance, a hum beside once-a-turn. Each machine is balanced twice, with and without the readings' speed.
//!
//! The rotor is its own: translation and tilt on two bearings, an impedance matrix of two by two. The library knows
//! influence coefficients alone.

use std::f64::consts::TAU;

use driveline::balancing::{Action, Complex, InRun};

use super::{CAPACITY, G2_5, SPEED, SPINDLE, ZERO, turned};
use crate::noise::Noise;

type Z = Complex<f64>;

fn largest(vibration: [Z; 2]) -> f64 {
    vibration[0].norm().max(vibration[1].norm())
}

#[derive(Clone)]
struct Rotor {
    mass: f64,
    /// Diametral inertia less the polar one (kg m2).
    tilting: f64,
    /// Places of the bearings, of the head and of the wheel (m).
    arms: [f64; 2],
    places: [f64; 2],
    stiffness: [f64; 2],
    damping: [f64; 2],
}

impl Rotor {
    /// Entries 11, 12 (as 21) and 22 of the dynamic stiffness.
    fn stiff(&self, speed: f64, softer: [f64; 2]) -> [Z; 3] {
        let mut stiff = [self.mass, 0.0, self.tilting].map(|mass| Complex::new(-mass * speed * speed, 0.0));
        for (at, (arm, softer)) in self.arms.into_iter().zip(softer).enumerate() {
            let bearing = Complex::new(self.stiffness[at] * softer, self.damping[at] * speed);
            for (power, entry) in (0..).zip(&mut stiff) {
                *entry += bearing * arm.powi(power);
            }
        }
        stiff
    }

    /// Acceleration at the bearings by the unbalance of head and wheel (kg m).
    fn vibration(&self, unbalance: [Z; 2], speed: f64, softer: [f64; 2]) -> [Z; 2] {
        let [a, b, c] = self.stiff(speed, softer);
        let force = unbalance[0] + unbalance[1];
        let moment = unbalance[0] * self.places[0] + unbalance[1] * self.places[1];
        let scale = Complex::from(speed.powi(4)) / (a * c - b * b);
        let (x, tilt) = ((force * c - b * moment) * scale, (a * moment - force * b) * scale);
        self.arms.map(|arm| x + tilt * arm)
    }

    /// No critical speed within a fifth of the running speed: between 0.8 and 1.2 of it the undamped determinant keeps
    /// its sign.
    fn runs_clear(&self) -> bool {
        let undamped = Rotor { damping: [0.0; 2], ..self.clone() };
        let is_positive = |step: u32| {
            let [a, b, c] = undamped.stiff(SPEED * (0.8 + 0.01 * f64::from(step)), [1.0; 2]);
            (a * c - b * b).re > 0.0
        };
        (1..=40).all(|step| is_positive(step) == is_positive(0))
    }

    fn random(noise: &mut Noise) -> Self {
        loop {
            let (mass, length) = (10.0 + 20.0 * noise.even(), 0.1 + 0.15 * noise.even());
            let tilting = mass * length * length * (0.5 + noise.even()) * (1.0 - 0.8 * noise.even());
            let arms = [-1.0, 1.0].map(|side| side * length * (0.6 + 0.6 * noise.even()));
            let critical = arms.map(|_| SPEED * 0.5 * 8_f64.powf(noise.even()));
            let damping = critical.map(|critical| (0.01 + 0.1 * noise.even()) * critical * mass);
            let head = length * (2.0 * noise.even() - 1.0);
            let places = [head, head + 0.3 * length * (2.0 * noise.even() - 1.0)];
            let stiffness = critical.map(|critical| 0.5 * mass * critical * critical);
            let rotor = Rotor { mass, tilting, arms, places, stiffness, damping };
            if rotor.runs_clear() {
                return rotor;
            }
        }
    }
}

/// Each as a share: of the first vibration, of the stiffness, of the speed.
#[derive(Clone, Copy, Default)]
struct Disturbance {
    hum: f64,
    drift: f64,
    swing: f64,
    jump: bool,
}

/// Vibration at the end over that with the head at rest, the largest such ratio on the way, and whether it is balanced.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    end: f64,
    highest: f64,
    good: bool,
}

/// None where the probe may change the vibration by more than the configuration states.
fn balanced(seed: u64, disturbance: Disturbance, with_speed: bool) -> Option<Outcome> {
    let mut noise = Noise::new(seed);
    let rotor = Rotor::random(&mut noise);
    let (rest, mut wheel) = (ZERO, turned(CAPACITY * (0.1 + 0.8 * noise.even()), &mut noise));
    let first = largest(rotor.vibration([rest, wheel], SPEED, [1.0; 2]));
    let probe = rotor.vibration([SPINDLE.probe.into(), rest], SPEED, [1.0; 2]);
    if largest(probe) > (SPINDLE.bound - 1.0) * first {
        return None;
    }
    let mut run = InRun::<f64, 2, 1>::new(SPINDLE, 2, [rest]).unwrap();
    let (period, phase) = (6.0 + 60.0 * noise.even(), TAU * noise.even());
    let (beat, hum) = (0.2 * TAU * (noise.even() - 0.5), [(); 2].map(|()| turned(disturbance.hum * first, &mut noise)));
    let jump = 1 + (noise.even() * 20.0) as u32;
    let (mut head, mut softer, mut jumped, mut outcome) = (rest, [1.0; 2], 0.0, None);
    for step in 0..80 {
        // the same for both, whatever the head does
        let mut noise = Noise::new(1000 * seed + u64::from(step));
        softer = softer.map(|share| share + disturbance.drift * (2.0 * noise.even() - 1.0));
        if disturbance.jump && step == jump {
            wheel += turned(0.3 * CAPACITY * noise.even(), &mut noise);
            wheel *= (0.98 * CAPACITY / wheel.norm()).min(1.0);
        }
        let speed = SPEED * (1.0 + disturbance.swing * (TAU * f64::from(step) / period + phase).sin());
        let levels = |head| [head, rest].map(|head| largest(rotor.vibration([head, wheel], speed, softer)));
        let [now, at_rest] = levels(head);
        if disturbance.jump && step == jump {
            // what a jump itself makes is not the head's
            jumped = now.max(first);
        }
        let mut reading = rotor.vibration([head, wheel], speed, softer);
        for (reading, hum) in reading.iter_mut().zip(hum) {
            *reading += hum * Complex::from_polar(1.0, beat * f64::from(step));
            *reading += Complex::new(noise.normal(), noise.normal()) * (0.005 * first / 2_f64.sqrt());
        }
        let before = *run.weights();
        let action = if with_speed { run.advise_at(&reading, 0.0, speed) } else { run.advise(&reading, 0.0) };
        let ended = match action {
            Action::Set([to]) => {
                head += (to - head) * (1.0 + 0.01 * noise.normal());
                step >= 29 && [to] == before
            }
            Action::Hold => step >= 29,
            Action::Abort([to], _) => {
                head = to;
                true
            }
        };
        let [last, _] = levels(head);
        let end = last / at_rest;
        let highest = outcome.map_or(1.0, |before: Outcome| before.highest).max(now / at_rest.max(jumped));
        outcome = Some(Outcome { end, highest, good: (head + wheel).norm() < G2_5 || end < 0.2 });
        if ended {
            break;
        }
    }
    outcome
}

/// What a start may meet, and it all together.
const KINDS: [(&str, Disturbance); 10] = {
    const NONE: Disturbance = Disturbance { hum: 0.0, drift: 0.0, swing: 0.0, jump: false };
    [
        ("nothing", NONE),
        ("speed by 0.3 %", Disturbance { swing: 0.003, ..NONE }),
        ("speed by 1 %", Disturbance { swing: 0.01, ..NONE }),
        ("speed by 2 %", Disturbance { swing: 0.02, ..NONE }),
        ("speed by 5 %", Disturbance { swing: 0.05, ..NONE }),
        ("speed by 5 %, jump", Disturbance { swing: 0.05, jump: true, ..NONE }),
        ("bearings", Disturbance { drift: 0.02, ..NONE }),
        ("jump", Disturbance { jump: true, ..NONE }),
        ("hum", Disturbance { hum: 0.1, ..NONE }),
        ("all", Disturbance { hum: 0.03, drift: 0.01, swing: 0.01, jump: true }),
    ]
};

/// None ends above 1.02 of the rotor at rest, none passes 1.3, and with the speed as many are balanced as without it.
/// Of 25,000 starts with the seeds from 0 on none ends above, and one rotor passes: its speed falls by 7.5 % in five
/// readings, and its vibration with it, so that with the speed and without it moves look better than they are. Here run
/// the first of them.
#[test]
fn no_disturbed_rotor_ends_above_its_rest() {
    starts(0, 60);
}

#[test]
#[ignore = "a minute"]
fn no_rotor_of_25_thousand_ends_above_its_rest() {
    starts(0, 2500);
}

fn starts(begin: u64, count: u64) {
    for (name, disturbance) in KINDS {
        let [without, with] = [false, true].map(|with_speed| {
            let all = (begin..begin + count).filter_map(|seed| balanced(seed + 1, disturbance, with_speed));
            let (mut good, mut passed) = (0, 0);
            for outcome in all {
                assert!(outcome.end <= 1.02, "{name}, speed {with_speed}: {outcome:?}");
                good += u32::from(outcome.good);
                passed += u64::from(outcome.highest > 1.3);
            }
            let rare = if disturbance.swing > 0.02 { count / 2500 } else { 0 };
            assert!(passed <= rare, "{name}, speed {with_speed}: {passed} pass 1.3");
            good
        });
        println!("{name}: balanced {with} of {count} with the speed, {without} without");
        assert!(with >= without, "{name}: {with} with the speed, {without} without");
    }
}
