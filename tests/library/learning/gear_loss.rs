//! Friction of a gear from lifting and lowering.

use driveline::learning::{Finding, GearLoss, GearLossConfig};
use driveline_solver::noise::Noise;

/// A hoist of 750 N m and 155 rad/s, updated every 10 ms.
const CONFIG: GearLossConfig = GearLossConfig::new(750.0, 155.0, [0.85, 0.99], 0.01);
/// What the data sheet says: 94 %.
const TOLD: f32 = 0.061_797;

/// The friction of a gear: what the motor carries more upwards than downwards, over their sum.
fn friction(efficiency: f64) -> f64 {
    (1.0 / efficiency - efficiency) / (1.0 / efficiency + efficiency)
}

/// The motor's torque at a speed under a load, through a gear.
fn carried(load: f64, efficiency: f64, speed: f64) -> f64 {
    if load * speed > 0.0 { load / efficiency } else { load * efficiency }
}

/// What is fed to the learner.
struct Feed {
    learner: GearLoss,
    noise: Noise,
    findings: Vec<Finding>,
}

impl Feed {
    fn new() -> Self {
        Feed { learner: GearLoss::new(&CONFIG, TOLD), noise: Noise::new(3), findings: Vec::new() }
    }

    fn update(&mut self, torque: f64, speed: f64) {
        let finding = self.learner.update(&CONFIG, torque as f32, speed as f32);
        if finding != Finding::None {
            self.findings.push(finding);
        }
    }

    /// Four seconds at a speed, with 1 % of rated of noise, and two in between on a ramp.
    fn run(&mut self, speed: f64, torque: impl Fn(f64) -> f64) {
        for tick in 0..400 {
            let noise = 7.5 * self.noise.normal();
            self.update(torque(f64::from(tick) * 0.01) + noise, speed);
        }
        for tick in 0..200 {
            self.update(torque(4.0), speed * (1.0 - f64::from(tick) / 100.0));
        }
    }

    /// Up and down, and again, at a torque that follows from time and speed.
    fn pairs(&mut self, speed: f64, torque: impl Fn(f64, f64) -> f64) {
        for speed in [speed, -speed, speed, -speed] {
            self.run(speed, |time| torque(time, speed));
        }
    }

    /// Runs at speeds, each under a load of its own.
    fn loads<const K: usize>(&mut self, runs: [(f64, f64); K]) {
        for (speed, load) in runs {
            self.run(speed, |_| carried(load, 0.94, speed));
        }
    }
}

/// The window's mean of fifty updates has 1.1 N m of noise, of 480 N m: 0.0016 of each torque, half of the sum of both
/// is as much; three standard deviations of the mean of two pairs, and the aim of 0.003.
#[test]
fn the_loss_is_found_by_two_pairs() {
    for efficiency in [0.87, 0.90, 0.94, 0.98] {
        for load in [300.0, 480.0, -480.0, 800.0] {
            let mut feed = Feed::new();
            for speed in [155.0, -155.0, 155.0] {
                feed.run(speed, |_| carried(load, efficiency, speed));
            }
            assert_eq!(feed.findings, [Finding::Unconfirmed, Finding::Changed], "{efficiency} {load}");
            let found = f64::from(feed.learner.friction());
            assert!((found - friction(efficiency)).abs() < 0.004, "{efficiency} {load}: {found}");
        }
    }
}

/// The torque constant cancels out.
#[test]
fn a_torque_that_is_reported_too_small_gives_the_same_loss() {
    let mut feed = Feed::new();
    for speed in [120.0, -120.0, 120.0] {
        feed.run(speed, |_| 0.95 * carried(480.0, 0.9, speed));
    }
    assert!((f64::from(feed.learner.friction()) - friction(0.9)).abs() < 0.004);
}

/// Nothing that is fed in here is a lift and a lowering of one load: the friction stays as it was set.
#[test]
fn nonsense_changes_nothing() {
    type Nonsense = (&'static str, fn(&mut Feed));
    let all: [Nonsense; 16] = [
        ("not a number", |feed| (0..2000).for_each(|_| feed.update(f64::NAN, 155.0))),
        ("a speed that is not a number", |feed| (0..2000).for_each(|_| feed.update(500.0, f64::NAN))),
        ("infinity", |feed| (0..2000).for_each(|k| feed.update(f64::INFINITY, [155.0, -155.0][k / 100 % 2]))),
        ("a jammed load", |feed| (0..2000).for_each(|k| feed.update([900.0, -900.0][k / 100 % 2], 0.0))),
        ("no load", |feed| feed.pairs(155.0, |_, speed| 20.0 * speed.signum())),
        ("one direction", |feed| (0..5).for_each(|_| feed.run(155.0, |_| 550.0))),
        ("a load that changes between", |feed| {
            feed.loads([(155.0, 500.0), (-155.0, 400.0), (155.0, 480.0), (-155.0, 450.0), (155.0, 600.0)]);
        }),
        ("a load that changes once", |feed| feed.loads([(155.0, 500.0), (-155.0, 440.0), (155.0, 440.0)])),
        ("a load that changes all the time", |feed| {
            feed.pairs(155.0, |time, speed| carried(400.0 + 60.0 * time, 0.94, speed));
        }),
        ("a slipping brake", |feed| {
            feed.pairs(155.0, |_, speed| carried(480.0, 0.94, speed) + 150.0 * speed.signum());
        }),
        ("a brake that grabs", |feed| {
            let grab = |time: f64| if time % 0.5 < 0.2 { 200.0 } else { 0.0 };
            feed.pairs(155.0, |time, speed| carried(480.0, 0.94, speed) + grab(time) * speed.signum());
        }),
        ("a torque with the wrong sign", |feed| feed.pairs(155.0, |_, speed| 480.0 * speed.signum())),
        ("directions told the wrong way round", |feed| feed.pairs(155.0, |_, speed| carried(480.0, 0.94, -speed))),
        ("creep", |feed| feed.pairs(10.0, |_, speed| carried(480.0, 0.85, speed))),
        ("speeds that differ", |feed| {
            for speed in [155.0, -60.0, 155.0, -60.0] {
                feed.run(speed, |_| carried(480.0, 0.85, speed));
            }
        }),
        ("a closed brake between", |feed| {
            for speed in [155.0, -155.0, 155.0, -155.0] {
                feed.run(speed, |_| carried(480.0, 0.88, speed));
                feed.learner.interrupt();
            }
        }),
    ];
    for (name, nonsense) in all {
        let mut feed = Feed::new();
        nonsense(&mut feed);
        assert_eq!(feed.learner.friction(), TOLD, "{name}: {:?}", feed.findings);
    }
}

/// A friction that was kept and is out of range is moved to the end of the range; one that is no number to its start.
#[test]
fn a_kept_friction_is_checked() {
    let [least, most] = CONFIG.range;
    for (kept, taken) in [(0.1, 0.1), (7.0, most), (-1.0, least), (f32::NAN, least)] {
        assert_eq!(GearLoss::new(&CONFIG, kept).friction(), taken);
    }
}
