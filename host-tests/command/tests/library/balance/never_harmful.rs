//! In-run balancing on rotors that it was not set for, with what disturbs it.

use driveline::balancing::{Action, Complex, InRun, InRunConfig};

use super::noise::Noise;

/// The largest correction of the head (kg m), as the grinding spindle's.
const CAPACITY: f64 = 1.5e-3;
/// The grinding spindle's settings.
const CONFIG: InRunConfig<f64, 1> = InRunConfig {
    probe: CAPACITY / 50.0,
    limits: [CAPACITY],
    step: 2.0 * CAPACITY,
    bound: 1.3,
    target: 0.01,
    forgetting: 0.7,
    noise: 0.005,
};
/// 3000 r/min.
const SPEED: f64 = 100.0 * std::f64::consts::PI;
/// Residual of 25 kg at that speed in G2.5 (kg m): 2.5e-3 m/s of the centre of mass.
const G2_5: f64 = 2.5e-3 * 25.0 / SPEED;

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

fn turned(size: f64, noise: &mut Noise) -> Complex<f64> {
    Complex::from_polar(size, std::f64::consts::TAU * noise.even())
}

/// What came of a start: the vibration at its end and its largest on the way, over that with the head as it was, on the
/// same bearings; whether G2.5 is reached, or a fifth of the vibration where the head cannot do more for both bearings.
fn balanced(noise: &mut Noise, disturbed: Disturbance) -> (f64, f64, bool) {
    let rotor = Rotor::random(noise);
    let mut wheel = turned(CAPACITY * (0.1 + 0.8 * noise.even()), noise);
    let nothing = Complex::new(0.0, 0.0);
    let mut head = nothing;
    let mut run = InRun::<f64, 2, 1>::new(CONFIG, 2, [head]).unwrap();
    let first = rotor.level(head, wheel, [1.0; 2]);
    let (mut softer, mut walk) = ([1.0; 2], [0.0; 2]);
    // what a jump itself makes is not the head's
    let (mut highest, mut jumped) = (1.0_f64, 0.0_f64);
    let jump = if disturbed.jump { 1 + (noise.even() * 20.0) as usize } else { usize::MAX };
    for step in 0..30 {
        for at in 0..2 {
            walk[at] += disturbed.drift * (2.0 * noise.even() - 1.0);
            softer[at] = (1.0 + walk[at]) * (1.0 + disturbed.bearings * (2.0 * noise.even() - 1.0));
        }
        wheel += turned(disturbed.thermal * wheel.norm() * noise.even(), noise);
        if step == jump {
            wheel += turned(0.3 * CAPACITY * noise.even(), noise);
        }
        // the head can balance all that there is
        wheel *= (0.98 * CAPACITY / wheel.norm()).min(1.0);
        let now = rotor.level(head, wheel, softer);
        if step == jump {
            jumped = now.max(first);
        }
        highest = highest.max(now / rotor.level(nothing, wheel, softer).max(jumped));
        let speed = SPEED * (1.0 + disturbed.swing * (2.0 * noise.even() - 1.0));
        let reading = rotor.reading(head, wheel, speed, softer).map(|truth| {
            let off = disturbed.noise * first / 2_f64.sqrt();
            truth + Complex::new(off * noise.normal(), off * noise.normal()) + turned(disturbed.hum * first, noise)
        });
        match run.advise_at(&reading, 0.0, speed) {
            Action::Set([to]) => head += (to - head) * (1.0 + 0.01 * noise.normal()),
            Action::Hold => {}
            Action::Abort([to], _) => {
                head = to;
                break;
            }
        }
    }
    let end = rotor.level(head, wheel, softer) / rotor.level(nothing, wheel, softer).max(jumped);
    (end, highest.max(end), (head + wheel).norm() < G2_5 || end < 0.2)
}

/// 2,000 starts, 200 of each kind: none ends worse than 1.02 times what was there, none passes 1.3 times on the way.
/// G2.5 is reached in nine of ten where the bearings hold still and the readings are good to 2 %.
///
/// The constants are tuned on other seeds, 1 to 300. Of 500 times 2,000 starts of seeds 501 to 1000 none did harm; the
/// highest was between 1.2 and 1.25 times. Here run the first ten of these seeds.
#[test]
fn two_thousand_starts_end_no_worse() {
    let plain = Disturbance { noise: 0.005, ..Disturbance::default() };
    let all =
        Disturbance { noise: 0.01, hum: 0.03, drift: 0.01, bearings: 0.2, thermal: 0.01, swing: 0.005, jump: true };
    let kinds = [
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
    ];
    for seed in 501..=510 {
        let mut noise = Noise::new(seed);
        let mut balanced_of_still = [0, 0];
        for (name, disturbed, still) in kinds {
            let (mut worst, mut highest, mut good) = (0.0_f64, 0.0_f64, 0);
            for _ in 0..200 {
                let (end, peak, within) = balanced(&mut noise, disturbed);
                (worst, highest) = (worst.max(end), highest.max(peak));
                good += u32::from(within);
            }
            println!("{seed}, {name}: worst end {worst:.3}, highest {highest:.3}, within G2.5 {good} of 200");
            assert!(worst <= 1.02, "{name}: {worst}");
            assert!(highest <= 1.3, "{name}: {highest}");
            if still {
                balanced_of_still = [balanced_of_still[0] + good, balanced_of_still[1] + 200];
            }
        }
        let [good, still] = balanced_of_still;
        assert!(10 * good >= 9 * still, "{good} of {still}");
    }
}

/// A correction, and the readings of two sensors with a head.
const NEEDED: Complex<f64> = Complex::new(0.8e-3, 0.5e-3);

fn reading(head: Complex<f64>) -> [Complex<f64>; 2] {
    [(head - NEEDED) * 900.0, (head - NEEDED) * Complex::new(0.0, 500.0)]
}

/// After an abort the influence is still there: the correction needs no probe.
#[test]
fn an_abort_is_left_with_what_was_learnt() {
    let mut run = InRun::<f64, 2, 1>::new(CONFIG, 2, [Complex::new(0.0, 0.0)]).unwrap();
    let mut head = Complex::new(0.0, 0.0);
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
    let Action::Set([to]) = run.advise(&reading(other), 0.0) else { panic!("it has not gone on") };
    // the sensors that came loose have cast doubt on the influence: towards the correction, if not all the way
    assert!(((to - other) / (NEEDED - other)).re > 0.1, "{to}");
}

/// Readings that wander by a quarter end a run. Once they hold still the run goes on when it is told to, and balances.
#[test]
fn a_run_that_was_given_up_for_wandering_can_be_resumed() {
    let mut run = InRun::<f64, 2, 1>::new(CONFIG, 2, [Complex::new(0.0, 0.0)]).unwrap();
    let mut head = Complex::new(0.0, 0.0);
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
    let mut run = InRun::<f64, 1, 1>::new(CONFIG, 1, [Complex::new(0.0, 0.0)]).unwrap();
    let v = [Complex::new(1.0, 0.0)];
    run.advise_at(&v, 0.0, 314.0);
    let Action::Set(probe) = run.advise_at(&v, 0.0, 314.0) else { panic!("no probe") };
    let before = run.influence(0, 0);
    assert_eq!(run.advise_at(&[v[0] * 2.0], 0.0, 330.0), Action::Set(probe));
    assert_eq!(run.advise_at(&[v[0] * 2.0], 0.0, f64::NAN), Action::Set(probe));
    assert_eq!(run.influence(0, 0), before);
    run.advise_at(&[v[0] * 1.1], 0.0, 314.1);
    assert_ne!(run.influence(0, 0), before);
}
