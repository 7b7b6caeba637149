//! Torque constant and offset from known loads.

use driveline::learning::{Finding, TorqueCalibration, TorqueConstant, TorqueConstantConfig};
use driveline::number::{Fixed, Number};
use driveline_solver::noise::Noise;

/// A hoist of 750 N m and 155 rad/s, updated every 10 ms.
const CONFIG: TorqueConstantConfig = TorqueConstantConfig::new(750.0, 155.0, [0.85, 0.99], 0.01);

/// A motor with this gain and offset, and its learner.
struct Feed {
    learner: TorqueConstant,
    gain: f64,
    offset: f64,
    noise: Noise,
    findings: Vec<Finding>,
}

impl Feed {
    fn new(gain: f64, offset: f64) -> Self {
        let learner = TorqueConstant::new(&CONFIG, 1.0, 0.0);
        Feed { learner, gain, offset, noise: Noise::new(3), findings: Vec::new() }
    }

    /// Takes the torque at the shaft.
    fn update(&mut self, torque: f64, speed: f64) {
        let reported = (torque - self.offset) / self.gain + 7.5 * self.noise.normal();
        let finding = self.learner.update(&CONFIG, reported as f32, speed as f32);
        if finding != Finding::None {
            self.findings.push(finding);
        }
    }

    /// Up, down and up, four seconds each at a speed and two in between on a ramp.
    fn runs(&mut self, speed: f64, torque: impl Fn(f64, f64) -> f64) {
        for speed in [speed, -speed, speed] {
            for tick in 0..400 {
                self.update(torque(f64::from(tick) * 0.01, speed), speed);
            }
            for tick in 0..200 {
                self.update(torque(4.0, speed), speed * (1.0 - f64::from(tick) / 100.0));
            }
        }
    }

    /// The same under a load that is named, through a gear.
    fn lifts(&mut self, load: f64, efficiency: f64) {
        self.learner.set_load(Some(load as f32));
        self.runs(155.0, |_, speed| carried(load, efficiency, speed));
    }
}

/// The motor's torque at a speed under a load, through a gear.
fn carried(load: f64, efficiency: f64, speed: f64) -> f64 {
    if load * speed > 0.0 { load / efficiency } else { load * efficiency }
}

/// Each load's torque has 0.5 N m of noise from four windows of fifty updates: three standard deviations of the
/// difference of two over that of the loads, 716 N m, are 0.003, and of the offset 2 N m.
#[test]
fn an_empty_hook_and_a_test_weight_give_gain_and_offset() {
    for (gain, offset, efficiency) in [(0.95, 7.5, 0.9), (1.05, -7.5, 0.94), (1.0, 20.0, 0.97), (1.03, 0.0, 0.88)] {
        for loads in [[747.0, 31.0], [31.0, 747.0]] {
            let mut feed = Feed::new(gain, offset);
            loads.iter().for_each(|&load| feed.lifts(load, efficiency));
            let found = [feed.learner.gain(), feed.learner.offset()].map(f64::from);
            let misses = [(found[0] - gain).abs(), (found[1] - offset).abs()];
            assert!(misses[0] < 0.003 && misses[1] < 2.0, "{gain} {offset}: {found:?} {:?}", feed.findings);
        }
    }
}

/// With the offset known the weight gives the gain to 0.5/747, without a load the offset is the torque's mean.
#[test]
fn one_weight_gives_the_gain_and_a_run_without_load_the_offset() {
    let mut feed = Feed::new(0.96, 0.0);
    feed.lifts(747.0, 0.94);
    assert!((feed.learner.gain() - 0.96).abs() < 0.003 && feed.learner.offset() == 0.0, "{:?}", feed.learner);
    let mut feed = Feed::new(1.0, -12.0);
    feed.learner.set_load(Some(0.0));
    // friction of 3 % of rated
    feed.runs(100.0, |_, speed| 22.0 * speed.signum());
    assert!((feed.learner.offset() + 12.0).abs() < 2.0 && feed.learner.gain() == 1.0, "{:?}", feed.learner);
}

/// In `f32` and in fixed point, where the base of the torque is 1000 N m here: resolution 4e-9 of it and of the gain.
#[test]
fn the_calibration_is_gain_and_offset() {
    let single = TorqueCalibration::<f32>::new(0.96, -5.0);
    assert!((single.torque(600.0) - 571.0).abs() < 1e-3);
    let fixed = TorqueCalibration::<Fixed>::new(0.96, Fixed::from_f64(-0.005));
    // a gain in `f32` is right to 6e-8
    assert!((fixed.torque(Fixed::from_f64(0.6)).to_real() - 0.571).abs() < 1e-7);
    let none = TorqueCalibration::<Fixed>::new(1.0, Fixed::ZERO);
    assert_eq!(none.torque(Fixed::from_f64(0.6)), Fixed::from_f64(0.6));
}

/// None of these is a known load that is moved up and down: gain and offset stay as they were set.
#[test]
fn nonsense_changes_nothing() {
    type Nonsense = (&'static str, Option<f32>, fn(&mut Feed));
    let all: [Nonsense; 14] = [
        ("not a number", Some(480.0), |feed| feed.runs(155.0, |_, _| f64::NAN)),
        ("a speed that is not a number", Some(480.0), |feed| (0..2000).for_each(|_| feed.update(480.0, f64::NAN))),
        ("a load that is not a number", Some(f32::NAN), |feed| {
            feed.runs(155.0, |_, speed| carried(440.0, 0.94, speed))
        }),
        ("a load that is not named", None, |feed| feed.runs(155.0, |_, speed| carried(440.0, 0.94, speed))),
        ("a jammed load", Some(480.0), |feed| feed.runs(0.0, |_, _| 900.0)),
        ("creep", Some(480.0), |feed| feed.runs(10.0, |_, speed| carried(440.0, 0.94, speed))),
        ("one direction", Some(480.0), |feed| (0..5000).for_each(|_| feed.update(500.0, 155.0))),
        ("half of the load", Some(480.0), |feed| feed.runs(155.0, |_, speed| carried(240.0, 0.94, speed))),
        ("no load at all", Some(480.0), |feed| feed.runs(155.0, |_, speed| 20.0 * speed.signum())),
        ("a torque with the wrong sign", Some(480.0), |feed| {
            feed.runs(155.0, |_, speed| -carried(480.0, 0.94, speed));
        }),
        ("directions told the wrong way round", Some(480.0), |feed| {
            feed.runs(155.0, |_, speed| carried(440.0, 0.94, -speed));
        }),
        ("a slipping brake", Some(480.0), |feed| {
            feed.runs(155.0, |_, speed| carried(440.0, 0.94, speed) + 100.0 * speed.signum());
        }),
        ("a load that swings", Some(480.0), |feed| {
            feed.runs(155.0, |time, speed| carried(440.0, 0.94, speed) + 100.0 * (5.0 * time).sin());
        }),
        ("a load that changes all the time", Some(480.0), |feed| {
            for load in [300.0, 360.0, 420.0] {
                feed.learner.set_load(Some(480.0));
                feed.runs(155.0, |time, speed| carried(load + 60.0 * time, 0.94, speed));
            }
        }),
    ];
    for (name, load, nonsense) in all {
        let mut feed = Feed::new(1.0, 0.0);
        feed.learner.set_load(load);
        nonsense(&mut feed);
        assert_eq!((feed.learner.gain(), feed.learner.offset()), (1.0, 0.0), "{name}: {:?}", feed.findings);
    }
}

/// From a record: moved to the bound, and what is no number is nothing learnt.
#[test]
fn a_kept_calibration_is_checked() {
    for (kept, taken) in [([1.02, 5.0], [1.02, 5.0]), ([3.0, 500.0], [1.1, 22.5]), ([f32::NAN; 2], [1.0, 0.0])] {
        let learner = TorqueConstant::new(&CONFIG, kept[0], kept[1]);
        assert_eq!([learner.gain(), learner.offset()], taken);
    }
}
