//! In-run balancing on rotors that it was not set for, with what disturbs it.

use std::ops::RangeInclusive;

use driveline::balancing::{Action, Complex, InRun};

use super::{CAPACITY, G2_5, SPEED, SPINDLE, ZERO, turned};
use crate::noise::Noise;

/// What disturbs a start, each as a share.
#[derive(Clone, Copy, Default)]
struct Disturbance {
    /// Standard deviation of a reading, of the first one.
    noise: f64,
    /// Hum in a reading, at any phase, of the first one.
    hum: f64,
    /// Change of a bearing's stiffness from step to step, that stays; and that goes.
    drift: f64,
    bearings: f64,
    /// Change of the unbalance from step to step.
    thermal: f64,
    /// Speed away from its mean.
    swing: f64,
    /// Whether the unbalance jumps.
    jump: bool,
}

/// Two bearings with a sensor each, neither critical speed within 25 % of the speed: a machine does not run nearer, and
/// 20 % of stiffness moves a critical speed by 10 %.
struct Rotor {
    mass: f64,
    stiffness: [f64; 2],
    damping: [f64; 2],
    head: [f64; 2],
    wheel: [f64; 2],
}

impl Rotor {
    fn random(noise: &mut Noise) -> Self {
        let mass = 10.0 + 20.0 * noise.even();
        let critical = [(); 2].map(|()| {
            loop {
                let ratio = 0.5 * 8_f64.powf(noise.even());
                if (ratio - 1.0).abs() > 0.25 {
                    break SPEED * ratio;
                }
            }
        });
        let head = [(); 2].map(|()| 0.3 + 0.7 * noise.even());
        Rotor {
            mass,
            stiffness: critical.map(|critical| mass * critical * critical),
            damping: critical.map(|critical| 2.0 * (0.01 + 0.1 * noise.even()) * critical * mass),
            head,
            // the wheel is not where the head is
            wheel: head.map(|head| head * (0.8 + 0.4 * noise.even())),
        }
    }

    /// Acceleration of each bearing: `x = U w^2 / (k - m w^2 + i c w)`, times the square of the speed.
    fn reading(&self, head: Complex<f64>, wheel: Complex<f64>, speed: f64, softer: [f64; 2]) -> [Complex<f64>; 2] {
        std::array::from_fn(|at| {
            let dynamic = self.stiffness[at] * softer[at] - self.mass * speed * speed;
            (head * self.head[at] + wheel * self.wheel[at]) * speed.powi(4)
                / Complex::new(dynamic, self.damping[at] * speed)
        })
    }

    fn level(&self, head: Complex<f64>, wheel: Complex<f64>, softer: [f64; 2]) -> f64 {
        self.reading(head, wheel, SPEED, softer).map(|z| z.norm()).into_iter().fold(0.0, f64::max)
    }
}

/// A rotor with its unbalance, its head, and its bearings as they are now.
struct Machine {
    rotor: Rotor,
    wheel: Complex<f64>,
    head: Complex<f64>,
    /// Stiffness of the bearings over the rotor's, and what of it stays.
    softer: [f64; 2],
    walk: [f64; 2],
    /// Its first vibration.
    first: f64,
    /// Whether it was resumed.
    resumed: bool,
}

/// What came of a run: the vibration at its end and its largest on the way, over that with the head as it was, on the
/// same bearings; whether G2.5 is reached, or a fifth of the vibration where the head cannot do more for both bearings.
struct Outcome {
    end: f64,
    highest: f64,
    good: bool,
    aborted: bool,
}

impl Machine {
    fn random(noise: &mut Noise) -> Self {
        let rotor = Rotor::random(noise);
        let wheel = turned(CAPACITY * (0.1 + 0.8 * noise.even()), noise);
        let head = ZERO;
        let first = rotor.level(head, wheel, [1.0; 2]);
        Machine { rotor, wheel, head, softer: [1.0; 2], walk: [0.0; 2], first, resumed: false }
    }

    /// The head can balance all that there is.
    fn limit(&mut self) {
        self.wheel *= (0.98 * CAPACITY / self.wheel.norm()).min(1.0);
    }

    /// What a halt of the machine may bring: nothing, another unbalance, other bearings, a head that was moved.
    fn halted(&mut self, noise: &mut Noise) {
        match (noise.even() * 4.0) as usize {
            0 => {}
            1 => self.wheel += turned(0.6 * CAPACITY * noise.even(), noise),
            2 => self.walk = self.walk.map(|walk| walk + 0.2 * (2.0 * noise.even() - 1.0)),
            _ => self.head = turned(0.9 * CAPACITY * noise.even(), noise),
        }
        self.limit();
    }

    /// Vibration with the head where it stood at first, on the bearings as they are. A resumed run may begin nearly
    /// balanced. An unbalance that wanders then passes by zero with the head at rest, which is not the head's: of all
    /// unbalances since it was resumed the largest counts.
    fn at_rest(&self, rest: Complex<f64>, unbalances: &[Complex<f64>]) -> f64 {
        let since = if self.resumed { 0 } else { unbalances.len() - 1 };
        let levels = unbalances[since..].iter().map(|wheel| self.rotor.level(rest, *wheel, self.softer));
        levels.fold(0.0, f64::max)
    }

    /// Goes on from where the head stands.
    fn resume(&mut self, run: &mut InRun<f64, 2, 1>) {
        run.resume(&[self.head]);
        self.resumed = true;
    }

    /// A run from where the head stands: 30 readings, and more where it has not come to rest by then.
    fn run(&mut self, run: &mut InRun<f64, 2, 1>, disturbed: Disturbance, noise: &mut Noise) -> Outcome {
        let rest = self.head;
        // what a jump itself makes is not the head's
        let (mut highest, mut jumped, mut aborted) = (1.0_f64, 0.0_f64, false);
        let jump = if disturbed.jump { 1 + (noise.even() * 20.0) as usize } else { usize::MAX };
        let mut unbalances = Vec::new();
        for step in 0..60 {
            for at in 0..2 {
                self.walk[at] += disturbed.drift * (2.0 * noise.even() - 1.0);
                self.softer[at] = (1.0 + self.walk[at]) * (1.0 + disturbed.bearings * (2.0 * noise.even() - 1.0));
            }
            self.wheel += turned(disturbed.thermal * self.wheel.norm() * noise.even(), noise);
            if step == jump {
                self.wheel += turned(0.3 * CAPACITY * noise.even(), noise);
            }
            self.limit();
            unbalances.push(self.wheel);
            let now = self.rotor.level(self.head, self.wheel, self.softer);
            if step == jump {
                jumped = now.max(self.first);
            }
            highest = highest.max(now / self.at_rest(rest, &unbalances).max(jumped));
            let speed = SPEED * (1.0 + disturbed.swing * (2.0 * noise.even() - 1.0));
            let reading = self.rotor.reading(self.head, self.wheel, speed, self.softer).map(|truth| {
                let off = disturbed.noise * self.first / 2_f64.sqrt();
                truth
                    + Complex::new(off * noise.normal(), off * noise.normal())
                    + turned(disturbed.hum * self.first, noise)
            });
            let before = *run.weights();
            match run.advise_at(&reading, 0.0, speed) {
                Action::Set(to) if step < 29 || to != before => {
                    self.head += (to[0] - self.head) * (1.0 + 0.01 * noise.normal());
                }
                Action::Set(_) | Action::Hold if step < 29 => {}
                Action::Set(_) | Action::Hold => break,
                Action::Abort([to], _) => {
                    (self.head, aborted) = (to, true);
                    break;
                }
            }
        }
        let there = self.at_rest(rest, &unbalances).max(jumped);
        let end = self.rotor.level(self.head, self.wheel, self.softer) / there;
        let good = (self.head + self.wheel).norm() < G2_5 || end < 0.2;
        Outcome { end, highest: highest.max(end), good, aborted }
    }
}

/// The kinds of disturbance: name, what, and whether bearings hold still with readings good to 2 %.
fn kinds() -> [(&'static str, Disturbance, bool); 10] {
    let plain = Disturbance { noise: 0.005, ..Disturbance::default() };
    let all =
        Disturbance { noise: 0.01, hum: 0.03, drift: 0.01, bearings: 0.2, thermal: 0.01, swing: 0.005, jump: true };
    [
        ("plain", plain, true),
        ("noise", Disturbance { noise: 0.02, ..plain }, true),
        ("hum", Disturbance { hum: 0.02, ..plain }, true),
        ("speed", Disturbance { swing: 0.005, ..plain }, true),
        ("thermal", Disturbance { thermal: 0.03, ..plain }, true),
        ("jump", Disturbance { jump: true, ..plain }, true),
        ("much hum", Disturbance { hum: 0.2, ..plain }, false),
        ("drift", Disturbance { drift: 0.02, ..plain }, false),
        ("bearings", Disturbance { bearings: 0.2, ..plain }, false),
        ("all", all, false),
    ]
}

/// Of runs of a kind: the worst end, the highest on the way, and how many are good.
#[derive(Default)]
struct Judged {
    end: f64,
    highest: f64,
    good: u32,
    runs: u32,
}

impl Judged {
    fn add(&mut self, outcome: &Outcome) {
        (self.end, self.highest) = (self.end.max(outcome.end), self.highest.max(outcome.highest));
        self.good += u32::from(outcome.good);
        self.runs += 1;
    }

    fn no_harm(&self, name: &str) {
        let Judged { end, highest, good, runs } = self;
        println!("{name}: worst end {end:.3}, highest {highest:.3}, within G2.5 {good} of {runs}");
        assert!(*end <= 1.02, "{name}: {end}");
        assert!(*highest <= 1.3, "{name}: {highest}");
    }
}

/// 2,000 starts, 200 of each kind: none ends worse than 1.02 times what was there, none passes 1.3 times on the way.
/// G2.5 is reached in nine of ten where the bearings hold still and the readings are good to 2 %.
///
/// The constants are tuned on other seeds, 1 to 300. Of 500 times 2,000 starts of seeds 501 to 1000 none did harm; the
/// highest was between 1.2 and 1.25 times. Here run the first ten of these seeds.
#[test]
fn two_thousand_starts_end_no_worse() {
    starts_end_no_worse(501..=510);
}

#[test]
#[ignore = "minutes"]
fn a_hundred_thousand_starts_end_no_worse() {
    starts_end_no_worse(501..=550);
}

fn starts_end_no_worse(seeds: RangeInclusive<u64>) {
    let (mut worst, mut starts) = (Judged::default(), 0);
    for seed in seeds {
        let mut noise = Noise::new(seed);
        let mut still = [0, 0];
        for (name, disturbed, holds_still) in kinds() {
            let mut judged = Judged::default();
            for _ in 0..200 {
                let mut machine = Machine::random(&mut noise);
                let mut run = InRun::<f64, 2, 1>::new(SPINDLE, 2, [machine.head]).unwrap();
                judged.add(&machine.run(&mut run, disturbed, &mut noise));
            }
            judged.no_harm(&format!("{seed}, {name}"));
            (worst.end, worst.highest) = (worst.end.max(judged.end), worst.highest.max(judged.highest));
            starts += judged.runs;
            if holds_still {
                still = [still[0] + judged.good, still[1] + judged.runs];
            }
        }
        assert!(10 * still[0] >= 9 * still[1], "{still:?}");
    }
    let Judged { end, highest, .. } = worst;
    println!("measured: {starts} starts, the worst ends at {end:.3} and passes {highest:.3} times what was there");
}

/// The same starts, resumed: those that were aborted go on with the same machine, and all go on after a halt.
///
/// A resumed run may begin where the readings' error is as large as the vibration, with an influence that is true no
/// more. Before an influence had to be confirmed again, 6 of the 7,056 aborted ones ended above 1.02 times what was
/// there when they were resumed, and 49 passed 1.3 times; after a halt 27 and 592 of 20,000. Of seeds 6001 to 6100 no
/// run of 270,570 does harm; the constants are tuned on seeds 511 to 3400.
#[test]
fn resumed_runs_end_no_worse() {
    for seed in 501..=510 {
        let (mut noise, mut later) = (Noise::new(seed), Noise::new(seed + 100_000));
        let (mut still, mut aborted) = ([0, 0], 0);
        for (name, disturbed, holds_still) in kinds() {
            let (mut same, mut halted) = (Judged::default(), Judged::default());
            for _ in 0..200 {
                let mut machine = Machine::random(&mut noise);
                let mut run = InRun::<f64, 2, 1>::new(SPINDLE, 2, [machine.head]).unwrap();
                if machine.run(&mut run, disturbed, &mut noise).aborted {
                    machine.resume(&mut run);
                    same.add(&machine.run(&mut run, disturbed, &mut later));
                }
                machine.halted(&mut later);
                machine.resume(&mut run);
                halted.add(&machine.run(&mut run, disturbed, &mut later));
            }
            same.no_harm(&format!("{seed}, {name}, the same machine"));
            halted.no_harm(&format!("{seed}, {name}, after a halt"));
            aborted += same.runs;
            if holds_still {
                still = [still[0] + halted.good, still[1] + halted.runs];
            }
        }
        // some 700 a seed: fewer would show nothing
        assert!(aborted > 350, "{seed}: {aborted}");
        assert!(10 * still[0] >= 9 * still[1], "{still:?}");
    }
}

/// A correction, and the readings of two sensors with a head.
const NEEDED: Complex<f64> = Complex::new(0.8e-3, 0.5e-3);

fn reading(head: Complex<f64>) -> [Complex<f64>; 2] {
    [(head - NEEDED) * 900.0, (head - NEEDED) * Complex::new(0.0, 500.0)]
}

/// After an abort the influence is still there: the first move is towards the correction, and needs no probe.
#[test]
fn an_abort_is_left_with_what_was_learnt() {
    let mut run = InRun::<f64, 2, 1>::new(SPINDLE, 2, [ZERO]).unwrap();
    let mut head = ZERO;
    for _ in 0..8 {
        if let Action::Set([to]) = run.advise(&reading(head), 0.0) {
            head = to;
        }
    }
    assert!((head - NEEDED).norm() < 0.05 * NEEDED.norm());
    // the sensors come loose: it aborts, and stays aborted until it is told to go on
    let loose = [Complex::new(9.0, 0.0), Complex::new(0.0, 9.0)];
    let aborted = (0..30)
        .any(|step| matches!(run.advise(&loose.map(|z| z * (1.0 + f64::from(step % 3))), 0.0), Action::Abort(..)));
    assert!(aborted);
    assert!(matches!(run.advise(&reading(head), 0.0), Action::Abort(..)));
    let other = Complex::new(-0.2e-3, 0.0);
    run.resume(&[other]);
    for _ in 0..5 {
        assert_eq!(run.advise(&reading(other), 0.0), Action::Set([other]));
    }
    let Action::Set([to]) = run.advise(&reading(other), 0.0) else { panic!("it has not gone on") };
    // a fifth of the vibration is allowed above it, and the influence may be 1.8 times what was learnt: a ninth of the
    // way. From nothing known it would be the probe, a fiftieth of the capacity: less than a thirtieth
    assert!(((to - other) / (NEEDED - other)).re > 0.1, "{to}");
}

/// Readings that wander by a quarter end a run. Once they hold still the run goes on when it is told to, and balances.
#[test]
fn a_run_that_was_given_up_for_wandering_can_be_resumed() {
    let mut run = InRun::<f64, 2, 1>::new(SPINDLE, 2, [ZERO]).unwrap();
    let mut head = ZERO;
    let wanders = (0..30).any(|step| {
        let bearings = if step % 2 == 0 { 1.0 } else { 1.25 };
        match run.advise(&reading(head).map(|z| z * bearings), 0.0) {
            Action::Set([to]) => head = to,
            Action::Hold => {}
            Action::Abort([to], _) => {
                head = to;
                return true;
            }
        }
        false
    });
    assert!(wanders, "it was not given up");
    run.resume(&[head]);
    for _ in 0..20 {
        match run.advise(&reading(head), 0.0) {
            Action::Set([to]) => head = to,
            Action::Hold => {}
            Action::Abort(_, reason) => panic!("{reason}"),
        }
    }
    // the target is a hundredth, and the correction of a tenth that is left is smaller than twice the error assumed
    assert!((head - NEEDED).norm() < 0.1 * NEEDED.norm(), "{head}");
}

/// A reading of another speed is asked for again, and teaches nothing.
#[test]
fn a_reading_of_another_speed_is_not_used() {
    let mut run = InRun::<f64, 1, 1>::new(SPINDLE, 1, [ZERO]).unwrap();
    let v = [Complex::new(1.0, 0.0)];
    run.advise_at(&v, 0.0, 314.0);
    let Action::Set(probe) = run.advise_at(&v, 0.0, 314.0) else { panic!("no probe") };
    let before = run.influence(0, 0);
    assert_eq!(run.advise_at(&[v[0] * 0.6], 0.0, 331.0), Action::Set(probe));
    assert_eq!(run.advise_at(&[v[0] * 0.6], 0.0, f64::NAN), Action::Set(probe));
    // above the bound the head goes back
    assert_eq!(run.advise_at(&[v[0] * 2.0], 0.0, 300.0), Action::Set([ZERO]));
    run.installed(&probe);
    assert_eq!(run.influence(0, 0), before);
    run.advise_at(&[v[0] * 1.1], 0.0, 314.1);
    assert_ne!(run.influence(0, 0), before);
}
