//! A rotor that balances itself: the drive and its task in a closed loop with a rotor, a head and power cuts.
//!
//! The rotor is a rigid body in two bearings, by the equations of motion of its two coordinates, integrated exactly
//! between the ticks. It shares nothing with the library. Its true level is the closed form of the steady whirl.

use core::f64::consts::TAU;

use driveline::balancing::{
    BalanceTolerance, BalancingDesign, BalancingDesignError, BalancingFault, BalancingHead, BalancingMemory,
    BalancingRecord, BalancingState, BalancingTask, Complex, HeadPosition, Phasors,
};
use driveline::configure::HasVibration;
use driveline::parameters::Store;
use driveline::prelude::*;
use nalgebra::{Matrix2, Matrix4, Vector2, Vector4};

use super::{CAPACITY, G2_5, MASS, SPEED, ZERO, turned};
use crate::flash::Flash;
use crate::noise::Noise;

struct Grinder;

impl Machine for Grinder {
    const CHAIN: Chain = Chain::motor(Inertia(0.02)).shaft(Stiffness(1.5e3), Damping(0.2)).rotor(Inertia(0.18));
    const RATING: Rating = Rating { torque: Torque(20.0), speed: Speed(SPEED), torque_limit: Torque(80.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 4_000;
}

impl HasVibration for Grinder {
    const VIBRATION_LIMIT: f64 = 200.0;
}

type GrinderDrive = Drive<f32, TwoMassObserver, SpeedLoop, (), Phasors<2, 9>>;
type Task<'a> = BalancingTask<Grinder, &'a mut Head, &'a mut Memory>;
type Memory = Option<BalancingRecord<2, 1>>;
static CONFIG: ConfigOf<GrinderDrive> = GrinderDrive::configure::<Grinder>();

const DESIGN: BalancingDesign = BalancingDesign {
    rotor: BalanceTolerance { grade: 2.5, mass: MASS as f32, speed: SPEED as f32 },
    capacity: [CAPACITY as f32],
    travel: 5.0,
    settle: 0.3,
    quiet: 0.0,
};
const PERIOD: f64 = 1.0 / Grinder::RATE_HZ as f64;

/// A head that moves along a straight line.
struct Head {
    at: Complex<f64>,
    to: Complex<f64>,
    /// (kg m/s)
    rate: f64,
    /// Whether it has a position sensor.
    measured: bool,
    /// Share of the moves that it does not begin, and error of those that it makes.
    sticks: f64,
    error: f64,
    noise: Noise,
}

impl Head {
    /// A head with a sensor and without errors, which stands at a weight.
    fn exact(at: Complex<f64>) -> Self {
        Head { at, to: at, rate: CAPACITY, measured: true, sticks: 0.0, error: 0.0, noise: Noise::new(3) }
    }

    fn tick(&mut self) {
        let left = self.to - self.at;
        let step = self.rate * PERIOD;
        self.at = if left.norm() <= step { self.to } else { self.at + left * (step / left.norm()) };
    }
}

impl BalancingHead for &mut Head {
    type Error = core::convert::Infallible;

    fn set(&mut self, [to]: &[Complex<f32>; 1]) -> Result<(), Self::Error> {
        let to = Complex::new(f64::from(to.re), f64::from(to.im));
        if self.noise.even() >= self.sticks {
            self.to = to * (1.0 + self.error * self.noise.normal());
        }
        Ok(())
    }

    fn position(&mut self) -> Result<HeadPosition, Self::Error> {
        let at = Complex::new(self.at.re as f32, self.at.im as f32);
        let moving = self.at != self.to;
        Ok(match self.measured {
            false => HeadPosition::Unmeasured,
            true if moving => HeadPosition::Moving,
            true => HeadPosition::At([at]),
        })
    }
}

/// The rotor: centre of mass and tilt, in the direction of the sensors.
struct Rotor {
    mass: Matrix2<f64>,
    damping: Matrix2<f64>,
    stiffness: Matrix2<f64>,
    /// Lever arms of head, wheel and both bearings from the centre of mass (m).
    head: f64,
    wheel: f64,
    bearings: [f64; 2],
    state: Vector4<f64>,
    /// State and force over a tick.
    transition: Matrix4<f64>,
    input: nalgebra::Matrix4x2<f64>,
}

impl Rotor {
    fn random(noise: &mut Noise, apart: bool) -> Self {
        let bearings = [0.1, -0.15];
        let factor = |noise: &mut Noise| 2_f64.powf(2.0 * noise.even() - 1.0);
        let k = [1.5e7 * factor(noise), 1.0e7 * factor(noise)];
        let c = [3.0e3 * factor(noise), 3.0e3 * factor(noise)];
        let head = 0.2;
        let wheel = if apart { head + 0.06 * (noise.even() - 0.5) } else { head };
        let sum = |of: [f64; 2]| {
            let both = bearings.iter().zip(of);
            both.fold(Matrix2::zeros(), |sum, (z, of)| sum + Matrix2::new(of, of * z, of * z, of * z * z))
        };
        let (mass, stiffness, damping) = (Matrix2::new(MASS, 0.0, 0.0, 0.35), sum(k), sum(c));
        let inverse = mass.try_inverse().unwrap();
        let mut rate = nalgebra::Matrix6::<f64>::zeros();
        rate.fixed_view_mut::<2, 2>(0, 2).fill_with_identity();
        rate.fixed_view_mut::<2, 2>(2, 0).copy_from(&(-inverse * stiffness));
        rate.fixed_view_mut::<2, 2>(2, 2).copy_from(&(-inverse * damping));
        rate.fixed_view_mut::<2, 2>(2, 4).copy_from(&inverse);
        let whole = (rate * PERIOD).exp();
        Rotor {
            mass,
            damping,
            stiffness,
            head,
            wheel,
            bearings,
            state: Vector4::zeros(),
            transition: whole.fixed_view::<4, 4>(0, 0).into(),
            input: whole.fixed_view::<4, 2>(0, 4).into(),
        }
    }

    fn force(&self, head: f64, wheel: f64) -> Vector2<f64> {
        Vector2::new(head + wheel, head * self.head + wheel * self.wheel)
    }

    /// Acceleration of both bearings after a tick.
    fn tick(&mut self, head: Complex<f64>, wheel: Complex<f64>, angle: f64, speed: f64) -> [f64; 2] {
        let turned = Complex::from_polar(speed * speed, angle);
        let force = self.force((head * turned).re, (wheel * turned).re);
        self.state = self.transition * self.state + self.input * force;
        let (place, rate) = (self.state.fixed_rows::<2>(0), self.state.fixed_rows::<2>(2));
        let acceleration = self.mass.try_inverse().unwrap() * (force - self.stiffness * place - self.damping * rate);
        self.bearings.map(|z| acceleration[0] + acceleration[1] * z)
    }

    /// Largest acceleration of both bearings in steady whirl.
    fn level(&self, head: Complex<f64>, wheel: Complex<f64>, speed: f64) -> f64 {
        let complex = |matrix: &Matrix2<f64>, by: Complex<f64>| matrix.map(|value| by * value);
        let one = Complex::new(1.0, 0.0);
        let dynamic = complex(&self.stiffness, one)
            + complex(&self.mass, -one * speed * speed)
            + complex(&self.damping, Complex::new(0.0, speed));
        let force = Vector2::new(head + wheel, head * self.head + wheel * self.wheel) * Complex::from(speed * speed);
        let place = dynamic.try_inverse().unwrap() * force;
        self.bearings.map(|z| (place[0] + place[1] * z).norm() * speed * speed).into_iter().fold(0.0, f64::max)
    }
}

/// What disturbs a start.
#[derive(Clone, Copy, Debug)]
struct Kind {
    /// Noise of a sample over the first vibration.
    noise: f64,
    /// Slow swing of the speed, as a share.
    swing: f64,
    /// Power cuts, and changes of the rotor while it turns.
    cuts: u32,
    changes: u32,
    /// Share of the moves that the head does not begin.
    sticks: f64,
    /// The wheel is not where the head is.
    apart: bool,
    /// The least unbalance, of the head's capacity.
    least: f64,
}

/// What came of a start.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    /// Residual over that of G2.5, and level over that with the head as it was at first.
    grade: f64,
    end: f64,
    /// The largest level on the way over that with the head at rest.
    peak: f64,
    /// Whether a verdict "passed" stood at an unbalance above the tolerance, by more than a tenth.
    wrong: bool,
}

fn start(kind: Kind, seed: u64) -> Outcome {
    let mut noise = Noise::new(seed.wrapping_mul(77) + 3);
    for _ in 0..8 {
        noise.even();
    }
    let mut rotor = Rotor::random(&mut noise, kind.apart);
    let unbalance = |noise: &mut Noise| {
        let size = CAPACITY * (kind.least + (0.95 - kind.least) * noise.even());
        turned(size, noise)
    };
    let mut wheel = unbalance(&mut noise);
    let mean = SPEED * (0.6 + 0.4 * noise.even());
    let (swing, slow) = (kind.swing * noise.even(), TAU / (2.0 + 18.0 * noise.even()));
    let mut head = Head {
        at: ZERO,
        to: ZERO,
        rate: CAPACITY * (0.5 + noise.even()),
        measured: noise.even() < 0.5,
        sticks: kind.sticks,
        error: 0.005,
        noise: Noise::new(seed + 1_000_003),
    };
    let mut memory: Memory = None;
    // where the head stood at first; since a change also where it stood and went to then
    let mut rest = [ZERO; 3];
    let first = rotor.level(ZERO, wheel, mean);
    let deviation = kind.noise * first;
    let (mut peak, mut now, mut angle) = (1.0_f64, 0.0_f64, TAU * noise.even());
    let mut begun = first;
    let mut events: Vec<(f64, bool)> = Vec::new();
    for at in 0..kind.cuts + kind.changes {
        events.push((5.0 + 45.0 * noise.even(), at < kind.cuts));
    }
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let end = 150.0 + events.last().map_or(0.0, |event| event.0);
    let mut events = events.into_iter().peekable();
    let mut wrong = false;
    while now < end {
        let zero = TAU * noise.even();
        let counted = |angle: f64| ((((angle - zero).rem_euclid(TAU)) / TAU * 8192.0) as u32) << 19;
        let mut drive = GrinderDrive::new(&CONFIG, counted(angle));
        let mut task = Task::new(DESIGN, &mut head, &mut memory).unwrap();
        let mut tick = 0_u32;
        loop {
            now += PERIOD;
            tick += 1;
            let speed = mean * (1.0 + swing * (slow * now).sin());
            angle += speed * PERIOD;
            task.head().tick();
            let at = task.head().at;
            let motion = rotor.tick(at, wheel, angle, speed);
            drive.tick(&CONFIG, &Sample { angle: counted(angle), torque: 0.0, setpoint: mean as f32 });
            drive.vibration(&CONFIG, &motion.map(|value| (value + deviation * noise.normal()) as f32));
            if tick.is_multiple_of(8) {
                let state = task.run(&mut drive, &CONFIG).unwrap();
                wrong |= matches!(state, BalancingState::Held(Some(verdict)) if verdict.passed)
                    && (at + wheel).norm() > 1.1 * G2_5
                    && tick.is_multiple_of(4000);
            }
            if tick.is_multiple_of(40) {
                let rest = rest.map(|rest| rotor.level(rest, wheel, mean)).into_iter().fold(0.0, f64::max);
                peak = peak.max(rotor.level(at, wheel, mean) / rest);
            }
            if events.peek().is_some_and(|event| event.0 < now) || now >= end {
                break;
            }
        }
        if let Some((_, cut)) = events.next() {
            if cut {
                // the head stands where the power left it
                head.to = head.at;
            } else {
                (wheel, rest) = (unbalance(&mut noise), [rest[0], head.at, head.to]);
                begun = rest.map(|rest| rotor.level(rest, wheel, mean)).into_iter().fold(0.0, f64::max);
            }
        }
    }
    let level = rotor.level(head.at, wheel, mean);
    Outcome { grade: (head.at + wheel).norm() / G2_5, end: level / begun, peak, wrong }
}

/// The kinds of disturbance; the last two are held to no share of G2.5: a swing of 2 % on a machine near a resonance,
/// and an unbalance that is small already.
const KINDS: [(&str, Kind); 9] = {
    let usual = Kind { noise: 0.07, swing: 0.0, cuts: 0, changes: 0, sticks: 0.0, apart: false, least: 0.1 };
    [
        ("plain", usual),
        ("noise", Kind { noise: 0.3, ..usual }),
        ("cuts", Kind { cuts: 3, ..usual }),
        ("changes", Kind { changes: 2, ..usual }),
        ("sticks", Kind { sticks: 0.3, ..usual }),
        ("apart", Kind { apart: true, ..usual }),
        ("all", Kind { swing: 0.01, cuts: 2, changes: 1, sticks: 0.15, apart: true, ..usual }),
        ("swing", Kind { swing: 0.02, ..usual }),
        ("small", Kind { least: 0.0, ..usual }),
    ]
};

/// Starts of each kind end in G2.5 in 95 of 100, none ends worse than it began, none passes 1.3 times the rotor with its
/// head at rest, no verdict is wrong. An unbalance of less than half of G2.5 may pass 1.3 times on the way: the probe is
/// as large as it. It stays within half of G2.5.
fn starts(seeds: core::ops::RangeInclusive<u64>, kinds: &[(&str, Kind)]) {
    let (mut all, mut within) = (0, 0);
    for (name, kind) in kinds {
        let (mut good, mut count, mut most) = (0, 0, [0.0_f64; 2]);
        for seed in seeds.clone() {
            let outcome = start(*kind, seed);
            (good, count) = (good + u32::from(outcome.grade <= 1.0), count + 1);
            most = [most[0].max(outcome.end), most[1].max(outcome.peak)];
            assert!(outcome.end <= 1.02 || outcome.grade <= 0.5, "{name} {seed}: {outcome:?}");
            assert!(outcome.peak <= 1.3 || *name == "small", "{name} {seed}: {outcome:?}");
            assert!(!outcome.wrong, "{name} {seed}: {outcome:?}");
        }
        println!("measured: {name}: G2.5 {good} of {count}, worst end {:.3}, highest {:.3}", most[0], most[1]);
        if !matches!(*name, "swing" | "small") {
            (all, within) = (all + count, within + good);
        }
    }
    assert!(100 * within >= 95 * all, "{within} of {all}");
}

/// Three of the seeds of [`two_hundred_starts_of_each_kind`].
#[test]
fn starts_balance_themselves() {
    starts(501..=503, &KINDS);
}

/// The task's constants were chosen on seeds 1 to 100. It fails: start 530 with changes of the rotor passes 1.35 times,
/// which is not mended yet; the 629 before it keep every limit. The kinds after it did not run.
#[test]
#[ignore = "minutes"]
fn two_hundred_starts_of_each_kind() {
    starts(501..=700, &KINDS);
}

/// What a wrong design or a main loop without samples is told.
#[test]
fn a_mistake_has_an_error_of_its_own() {
    let mut head = Head::exact(ZERO);
    let mut refused = |design: BalancingDesign| match Task::new(design, &mut head, &mut None).err() {
        Some(BalancingFault::Design(error)) => error,
        other => panic!("{design:?}: {other:?}"),
    };
    for (design, error) in [
        (
            BalancingDesign { rotor: BalanceTolerance { mass: 0.0, ..DESIGN.rotor }, ..DESIGN },
            BalancingDesignError::Rotor,
        ),
        (BalancingDesign { capacity: [f32::NAN], ..DESIGN }, BalancingDesignError::Capacity),
        (BalancingDesign { travel: 0.0, ..DESIGN }, BalancingDesignError::Travel),
        (BalancingDesign { settle: -1.0, ..DESIGN }, BalancingDesignError::Settle),
        (BalancingDesign { quiet: f32::INFINITY, ..DESIGN }, BalancingDesignError::Quiet),
    ] {
        assert_eq!(refused(design), error);
    }
    // `Drive::vibration` is not called
    let (mut memory, mut drive) = (None, GrinderDrive::new(&CONFIG, 0));
    let mut task = Task::new(DESIGN, &mut head, &mut memory).unwrap();
    let fault = (0..1_000_100).find_map(|_| task.run(&mut drive, &CONFIG).err());
    assert_eq!(fault, Some(BalancingFault::NoVibration));
}

/// A record goes through a flash with all of its numbers. One of other sizes is refused, as one that is no number or
/// beyond the head: the task then begins from where the head stands.
#[test]
fn a_record_is_remembered_or_refused() {
    let z = |re: f32, im: f32| Complex { re, im };
    let record = BalancingRecord::<2, 1> {
        weights: [z(1e-3, -2e-4)],
        first: 3.5,
        speed: 300.0,
        influence: [[z(1.0, 2.0)], [z(-3.0, 4.0)]],
        deviation: [0.25],
    };
    let mut store = Store::new(Flash::<1, 4>::erased(), 0..4096).unwrap();
    BalancingMemory::save(&mut store, &record).unwrap();
    assert_eq!(BalancingMemory::<2, 1>::load(&mut store), Ok(Some(record)));
    assert_eq!(BalancingMemory::<1, 1>::load(&mut store), Ok(None));
    let found = Complex::new(5e-4, 0.0);
    let mut head = Head::exact(found);
    for (record, goes_to) in [
        (record, record.weights),
        (BalancingRecord { first: f32::NAN, ..record }, [z(5e-4, 0.0)]),
        (BalancingRecord { weights: [z(2e-3, 0.0)], ..record }, [z(5e-4, 0.0)]),
    ] {
        let (mut memory, mut drive) = (Some(record), GrinderDrive::new(&CONFIG, 0));
        let mut task = Task::new(DESIGN, &mut head, &mut memory).unwrap();
        for _ in 0..3 {
            task.run(&mut drive, &CONFIG).unwrap();
        }
        assert_eq!(*task.weights(), goes_to, "{record:?}");
        (head.at, head.to) = (found, found);
    }
}

/// A head whose first positions cannot be, as of a sensor that wakes up: it is neither sent there nor is that remembered.
#[test]
fn a_position_that_cannot_be_is_waited_for() {
    struct Waking(Vec<f32>);
    impl BalancingHead for Waking {
        type Error = core::convert::Infallible;
        fn set(&mut self, to: &[Complex<f32>; 1]) -> Result<(), Self::Error> {
            panic!("sent to {to:?}")
        }
        fn position(&mut self) -> Result<HeadPosition, Self::Error> {
            Ok(HeadPosition::At([Complex::new(self.0.pop().unwrap_or(5e-4), 0.0)]))
        }
    }
    let (mut memory, mut drive): (Memory, _) = (None, GrinderDrive::new(&CONFIG, 0));
    let head = Waking(vec![1.0, f32::INFINITY, f32::NAN]);
    let mut task = BalancingTask::<Grinder, _, _>::new(DESIGN, head, &mut memory).unwrap();
    for _ in 0..4 {
        task.run(&mut drive, &CONFIG).unwrap();
    }
    assert_eq!(*task.weights(), [Complex::new(5e-4, 0.0)]);
    assert_eq!(memory.map(|record| record.weights), Some([Complex::new(5e-4, 0.0)]));
}
