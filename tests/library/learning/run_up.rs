//! Inertia from run-ups between two steady speeds.

use driveline::learning::{Finding, RunUp, RunUpConfig};
use driveline_solver::noise::Noise;

/// A drive of 750 N m and 155 rad/s, updated every 10 ms.
const CONFIG: RunUpConfig = RunUpConfig::new(750.0, 155.0, [0.5, 2.5], 0.01);
/// By the drawings (kg m2).
const TOLD: f32 = 1.2;

/// What is fed to the learner.
struct Feed {
    learner: RunUp,
    noise: Noise,
    findings: Vec<Finding>,
}

impl Feed {
    fn new() -> Self {
        Feed { learner: RunUp::new(&CONFIG, TOLD), noise: Noise::new(5), findings: Vec::new() }
    }

    fn update(&mut self, torque: f64, speed: f64) {
        let finding = self.learner.update(&CONFIG, torque as f32, speed as f32);
        if finding != Finding::None {
            self.findings.push(finding);
        }
    }

    /// Two seconds at each speed, ramps of 77.5 rad/s2 in between, with 1 % of rated of noise.
    /// The torque follows from time, speed and acceleration.
    fn course(&mut self, speeds: &[f64], torque: impl Fn(f64, f64, f64) -> f64) {
        let (mut speed, mut time) = (speeds[0], 0.0);
        for &target in speeds {
            let mut steady = 0;
            while steady < 200 {
                let step = (target - speed).clamp(-0.775, 0.775);
                steady += i32::from(step == 0.0);
                // the torque over the tick that ends at the new speed
                speed += step;
                time += 0.01;
                let noise = 7.5 * self.noise.normal();
                self.update(torque(time, speed, step / 0.01) + noise, speed);
            }
        }
    }
}

/// Four changes of the speed in each direction. The sum over 3 s has 1.3 N m s of noise, and 3.2 N m s from that of its
/// steady torque, of 138 N m s: 2.5 %; three standard deviations of the mean of eight.
#[test]
fn the_inertia_is_found_by_run_ups_and_coast_downs() {
    for inertia in [0.7, 1.2, 2.0] {
        for (load, viscous) in [(0.0, 0.0), (400.0, 0.0), (100.0, 0.1), (-300.0, 0.0)] {
            let mut feed = Feed::new();
            feed.course(&[40.0, 155.0, 40.0, 155.0, 40.0, 155.0, 40.0, 155.0, 40.0], |_, speed, acceleration| {
                load + viscous * speed + inertia * acceleration
            });
            let found = f64::from(feed.learner.inertia());
            let limit = 3.0 * 3.5 / 115.0 / 8.0_f64.sqrt();
            assert!((found - inertia).abs() < limit, "{inertia} {load}: {found} {:?}", feed.findings);
            assert!(feed.learner.is_learnt());
        }
    }
}

/// A loop creeps into its setpoint with a time constant of 3 s: within 1 % of it, 0.3 rad/s2 are left over a window of
/// 3 s, 6 % of the change in the 15 s between two windows. Of these the window's first interval of 300 is missing.
#[test]
fn a_creeping_loop_is_no_error_of_the_inertia() {
    let config = RunUpConfig { window: 300, pause: 3_000, ..CONFIG };
    let (mut learner, mut speed) = (RunUp::new(&config, TOLD), 75.0);
    for target in [75.0, 155.0, 75.0, 155.0, 75.0] {
        for _ in 0..2_500 {
            let step = (target - speed) * 0.01 / 3.0;
            speed += step;
            learner.update(&config, (100.0 + 2.0 * step / 0.01) as f32, speed as f32);
        }
    }
    assert!(learner.is_learnt() && (f64::from(learner.inertia()) / 2.0 - 1.0).abs() < 0.001, "{learner:?}");
}

/// None of these is a run-up of one inertia under one load: the inertia stays as it was set.
#[test]
fn nonsense_changes_nothing() {
    const SPEEDS: [f64; 6] = [40.0, 155.0, 40.0, 155.0, 40.0, 155.0];
    type Nonsense = (&'static str, fn(&mut Feed));
    let all: [Nonsense; 11] = [
        ("not a number", |feed| feed.course(&SPEEDS, |_, _, _| f64::NAN)),
        ("a speed that is not a number", |feed| (0..2000).for_each(|_| feed.update(400.0, f64::NAN))),
        ("a jammed load", |feed| feed.course(&[0.0; 6], |time, _, _| 800.0 * (time / 2.0).sin().signum())),
        ("no excitation", |feed| feed.course(&[155.0; 6], |_, _, _| 400.0)),
        ("small changes of the speed", |feed| {
            feed.course(&[100.0, 155.0, 100.0, 155.0], |_, _, acceleration| 400.0 + 0.8 * acceleration);
        }),
        ("a torque with the wrong sign", |feed| {
            feed.course(&SPEEDS, |_, _, acceleration| -400.0 - 1.2 * acceleration);
        }),
        ("reversals alone", |feed| {
            feed.course(&[155.0, -155.0, 155.0, -155.0], |_, _, acceleration| 400.0 + 0.8 * acceleration);
        }),
        ("a load that changes with each run-up", |feed| {
            let load = |time: f64| 300.0 + 100.0 * f64::from(u8::from(((time / 3.5) as u32).is_multiple_of(2)));
            feed.course(&SPEEDS, |time, _, acceleration| load(time) + 0.8 * acceleration);
        }),
        ("a brake that drags on the ramps", |feed| {
            feed.course(&SPEEDS, |_, speed, acceleration| {
                let drag = if acceleration == 0.0 { 0.0 } else { 60.0 * speed.signum() };
                400.0 + drag + 1.0 * acceleration
            });
        }),
        ("a shaft that has come loose", |feed| {
            feed.course(&SPEEDS, |_, _, acceleration| 20.0 + 0.3 * acceleration);
        }),
        ("a load that swings", |feed| {
            feed.course(&SPEEDS, |time, _, acceleration| 400.0 + 100.0 * (5.0 * time).sin() + 0.8 * acceleration);
        }),
    ];
    for (name, nonsense) in all {
        let mut feed = Feed::new();
        nonsense(&mut feed);
        assert_eq!(feed.learner.inertia(), TOLD, "{name}: {:?}", feed.findings);
        assert!(!feed.learner.is_learnt());
    }
}

/// From a record: moved to the end of the range, what is no number to its start.
#[test]
fn a_kept_inertia_is_checked() {
    for (kept, taken) in [(1.0, 1.0), (9.0, 2.5), (-1.0, 0.5), (f32::NAN, 0.5)] {
        assert_eq!(RunUp::new(&CONFIG, kept).inertia(), taken);
    }
}
