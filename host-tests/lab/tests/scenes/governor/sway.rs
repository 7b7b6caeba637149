//! A crane that travels and stops: what the load swings afterwards, as a pendulum of any angle under a trolley behind
//! gears with a gap, with the drive as it is flashed.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use driveline::configure::{Configure, Machine};
use driveline::design::{Error, InputShaperDesign};
use driveline::drive::{Composition, ConfigOf, Drive};
use driveline::governor::{Governor, InputShaper, InputShaperConfig};
use driveline::machine::Length;
use driveline::number::{Fixed, Number, Part};
use driveline::observer::SemiImplicitObserver;
use driveline::sample::{Estimate, Sample};
use driveline::scheduling::ShaperSlots;
use driveline::settings::Bases;
use driveline_firmware::scenes::crane_travel::{BY_ROPE, CraneTravel, Loop, SLOTS, StiffTravel};
use driveline_solver::plant::train::{Coordinate, Friction, Harmonic, Link, Motion, Source, Train, Unbalance};

const GRAVITY: f64 = 9.80665;
/// Travel per angle of the motor (m/rad).
const TRAVEL: f64 = 0.5 / (2.0 * 30.0);
const BRIDGE: f64 = 25_000.0;

/// A crane and its drive as they are.
#[derive(Clone, Copy, Debug)]
struct Crane {
    /// Rope (m), load (kg).
    rope: f64,
    load: f64,
    /// Ratios of bridge, travelling resistance and torque constant to what the drive is designed for.
    bridge: f64,
    resistance: f64,
    torque: f64,
}

const NOMINAL: Crane = Crane { rope: 10.0, load: 15_000.0, bridge: 1.0, resistance: 1.0, torque: 1.0 };

impl Crane {
    /// Travelling resistance at the motor (N m).
    fn resistance(&self) -> f64 {
        0.006 * 40_000.0 * GRAVITY * TRAVEL * self.resistance
    }

    /// Gear and shafts of 2e4 N m/rad at the motor, with 1 degree of gap there.
    fn plant(&self) -> Motion {
        let moment = self.load * self.rope;
        // horizontal way, so that the weight is a torque of the angle from the way: the load hangs at -90 degrees
        let weight = Source::Orders(vec![Harmonic { order: 1.0, cosine: -moment * GRAVITY, sine: 0.0 }]);
        let gear = Link::new(&[(0, TRAVEL), (1, -1.0)], 2.0e4 / (TRAVEL * TRAVEL));
        Train::new()
            .coordinate(Coordinate::new(0.2))
            .coordinate(Coordinate::new(BRIDGE * self.bridge + self.load))
            .coordinate(Coordinate::new(moment * self.rope).angle(-FRAC_PI_2).source(weight))
            .link(gear.damping(10.0 / (TRAVEL * TRAVEL)).gap(0.017 * TRAVEL))
            .unbalance(Unbalance { turning: 2, way: 1, moment, gravity: 0.0 })
            .friction(Friction::ground(0, self.resistance()))
            .build()
            .unwrap()
    }
}

/// Half of rated speed for 11 s, then a stop: the ramps of 3 s excite the swing most. The largest swing (rad) of
/// the whole run, and that of a period from `after` (s) behind the stop's beginning on.
fn stop<D: Ticks>(config: &ConfigOf<D>, crane: &Crane, after: f64) -> [f64; 2] {
    let mut plant = crane.plant();
    let mut drive = D::new(config, 0);
    let mut reported = 0.0;
    let mut noise = 12_345_u32;
    let [mut most, mut left] = [0.0_f64; 2];
    let ticks = ((11.0 + after + 6.7) * 1e3) as u32;
    for tick in 0..ticks {
        let time = f64::from(tick) * 1e-3;
        let setpoint = if (0.1..11.0).contains(&time) { 0.5 * CraneTravel::RATING.speed.0 } else { 0.0 };
        let angle = (plant.angle(0) / TAU * 4096.0).floor() / 4096.0;
        let angle = (angle.rem_euclid(1.0) * 4_294_967_296.0) as u64 as u32;
        // 1 % of rated torque, uniform with that standard deviation
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let random =
            (f64::from(noise >> 8) / 16_777_216.0 - 0.5) * 12.0_f64.sqrt() * 0.01 * CraneTravel::RATING.torque.0;
        let command = drive.next(config, angle, reported + random, setpoint);
        plant.set_torque(0, command * crane.torque);
        plant.advance(1e-3);
        // nine tenths of the resistance are deducted while it turns
        let known = 0.9 * NOMINAL.resistance();
        reported = if plant.speed(0) == 0.0 {
            command - command.clamp(-known, known)
        } else {
            command - known * plant.speed(0).signum()
        };
        let swing = (plant.angle(2) + FRAC_PI_2).abs();
        most = most.max(swing);
        if time > 11.0 + after {
            left = left.max(swing);
        }
    }
    [most, left]
}

/// A drive in SI units.
trait Ticks: Composition {
    fn next(&mut self, config: &ConfigOf<Self>, angle: u32, torque: f64, setpoint: f64) -> f64;
}

macro_rules! ticks {
    ($number:ident, $bases:expr) => {
        impl<G: Part<$number, State: Governor<$number>>> Ticks for Drive<$number, SemiImplicitObserver, G> {
            fn next(&mut self, config: &ConfigOf<Self>, angle: u32, torque: f64, setpoint: f64) -> f64 {
                let [torque, setpoint] = [number!($number, torque, $bases.0), number!($number, setpoint, $bases.1)];
                self.tick(config, &Sample { angle, torque, setpoint }).torque.to_real() * $bases.0
            }
        }
    };
}
macro_rules! number {
    (f32, $value:expr, $base:expr) => {
        ($value / $base) as f32
    };
    (Fixed, $value:expr, $base:expr) => {
        Fixed::from_f64($value / $base)
    };
}
ticks!(f32, (1.0, 1.0));
ticks!(Fixed, (StiffTravel::BASES.torque, StiffTravel::BASES.speed));

type Driven<N, G> = Drive<N, SemiImplicitObserver, G>;
type Zvd<N> = Driven<N, InputShaper<Loop, SLOTS>>;
type Zv = Driven<f32, InputShaper<Loop, 16, 2>>;

fn configured<M: Machine, N: Number, D: Composition + Configure<M, N, Config = ConfigOf<D>>>() -> ConfigOf<D> {
    D::CONFIG
}

fn residual<D: Ticks>(config: &ConfigOf<D>, crane: &Crane, after: f64) -> f64 {
    stop::<D>(config, crane, after)[1]
}

/// Swing after a stop, of the drive with a setpoint in three parts over that of the same drive with a plain ramp. With
/// the described crane and 40 draws of it 0.2 to 1.5 %.
#[test]
fn a_shaped_stop_leaves_less_than_a_fiftieth_of_the_swing() {
    let plain = configured::<StiffTravel, f32, Driven<f32, Loop>>();
    let shaped = configured::<StiffTravel, f32, Zvd<f32>>();
    let fixed = configured::<StiffTravel, Fixed, Zvd<Fixed>>();
    let two = configured::<StiffTravel, f32, Zv>();
    let longer = Crane { rope: 11.0, ..NOMINAL };
    let drawn = Crane { rope: 9.4, load: 1_500.0, bridge: 1.05, resistance: 1.2, torque: 0.97 };
    for crane in [NOMINAL, Crane { rope: 9.0, ..NOMINAL }, longer, drawn] {
        // the plain ramp ends after 3 s, the third part's after 9.4 s; the loop follows 1 s later
        let before = residual::<Driven<f32, Loop>>(&plain, &crane, 4.0);
        let after = residual::<Zvd<f32>>(&shaped, &crane, 10.4);
        assert!(after < 0.02 * before, "{crane:?}: {after} of {before}");
        if crane.rope == NOMINAL.rope {
            let after = residual::<Zvd<Fixed>>(&fixed, &crane, 10.4);
            assert!(after < 0.02 * before, "fixed: {after} of {before}");
        }
        if crane.rope == longer.rope {
            // Two parts by the closed form |sin(pi r/2)|, the frequency off by r as the root of the length: 7.3 %. The
            // tolerance is what two parts leave of the described crane, where the closed form has nothing: by noise of
            // the torque, counts, gap and friction 0.7 %.
            let expected = (FRAC_PI_2 * ((NOMINAL.rope / longer.rope).sqrt() - 1.0)).sin().abs();
            let after = residual::<Zv>(&two, &crane, 7.2);
            assert!((after / before - expected).abs() < 0.007, "two parts: {after} of {before}, {expected}");
        }
    }
}

/// With the shaper's slot for the rope, every length of the table and between leaves less than a fiftieth: 1.1 % at 8 m
/// to 0.6 % at 12 m, where the slot of 10 m leaves 4.2 % at 8 m.
#[test]
fn a_shaped_stop_follows_the_length_of_the_rope() {
    let plain = configured::<StiffTravel, f32, Driven<f32, Loop>>();
    let mut shaped = configured::<StiffTravel, f32, Zvd<f32>>();
    for rope in [8.0, 9.0, 10.0, 11.0, 12.0] {
        let crane = Crane { rope, ..NOMINAL };
        let before = residual::<Driven<f32, Loop>>(&plain, &crane, 4.0);
        // the third part's ramp ends after 10.0 s of the longest rope
        shaped.governor.slot = BY_ROPE.at(rope as f32);
        let after = residual::<Zvd<f32>>(&shaped, &crane, 11.1);
        assert!(after < 0.02 * before, "{crane:?}: {after} of {before}");
    }
}

/// Slots by straight lines between the roots, to the nearest tick: below the root by at most 0.16 %, and half a tick of
/// the result and of the points either way.
#[test]
fn slots_follow_the_root_of_the_length() {
    let design = InputShaperDesign::pendulum(Length(10.0));
    let slots = ShaperSlots::<3>::new(&design, Length(10.0), [8.0, 10.0, 12.0], 16, 1e-3);
    for step in 0..=40 {
        let rope = 8.0 + 0.1 * f64::from(step);
        let exact = PI * (rope / GRAVITY).sqrt() / 16e-3;
        let found = f64::from(slots.at(rope as f32));
        assert!(found < exact + 1.0 && found > (1.0 - 0.0016) * exact - 1.0, "{rope}: {found} {exact}");
    }
    assert_eq!([0.0, 99.0, f32::NAN].map(|rope| slots.at(rope)), [8.0, 12.0, 8.0].map(|rope| slots.at(rope)));
    for ropes in [[8.0, 7.0, 12.0], [0.0, 1.0, 2.0], [8.0, 10.0, f64::NAN]] {
        assert!(ShaperSlots::<3>::try_new(&design, Length(10.0), ropes, 16, 1e-3).is_err(), "{ropes:?}");
    }
    // slots of less than a tick
    assert!(ShaperSlots::<3>::try_new(&design, Length(10.0), [8.0, 10.0, 12.0], 10_000, 1e-3).is_err());
}

/// Commands its setpoint.
#[derive(Default)]
struct Probe(f64);

impl Governor<f64> for Probe {
    type Config = ();

    const COMMANDS: bool = true;

    fn set_setpoint(&mut self, setpoint: f64) {
        self.0 = setpoint;
    }

    fn command(&mut self, _: &(), _: &Estimate<f64>) -> f64 {
        self.0
    }

    fn permitted(&self, _: &(), _: &Estimate<f64>, torque: f64) -> f64 {
        torque
    }

    fn start(&mut self, _: &(), _: &Estimate<f64>, _: f64) {}
}

/// What changes of a setpoint, tick by tick, leave in a vibration, but for its decay since: `sum du exp(s t)`.
fn excited(setpoints: &[f64], frequency: f64, damping: f64) -> f64 {
    let damped = frequency * (1.0 - damping * damping).sqrt();
    let mut last = 0.0;
    let mut sum = [0.0; 2];
    for (tick, setpoint) in setpoints.iter().enumerate() {
        let time = tick as f64 * 1e-3;
        let size = (setpoint - last) * (damping * frequency * time).exp();
        let (sine, cosine) = (damped * time).sin_cos();
        sum = [sum[0] + size * cosine, sum[1] + size * sine];
        last = *setpoint;
    }
    sum[0].hypot(sum[1])
}

fn against_the_closed_form<const LINE: usize, const PARTS: usize>(damping: f64) {
    let design = InputShaperDesign::new(1.0, damping);
    let config = InputShaperConfig::<f64, ()>::new(&design, 16, 2.0, (), 1e-3, Bases::SI);
    // what whole ticks of a slot make of the delay
    let design = InputShaperDesign { delay: 16e-3 * f64::from(config.slot), ..design };
    let mut shaper = InputShaper::<Probe, LINE, PARTS, f64>::default();
    let (mut ramped, mut target, mut wanted, mut seed) = (0.0_f64, 0.0, 0.0, 7_u32);
    let (mut plain, mut shaped) = (Vec::new(), Vec::new());
    for tick in 0..40_000_u32 {
        if tick % 731 == 0 {
            // a joystick, and at rest from 20 s on
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            wanted = if tick < 20_000 { f64::from(seed >> 8) / 16_777_216.0 * 6.0 - 3.0 } else { 0.0 };
        }
        target = if tick % config.slot == 0 { wanted } else { target };
        ramped += (target - ramped).clamp(-config.ramp, config.ramp);
        plain.push(ramped);
        shaper.set_setpoint(wanted);
        shaped.push(shaper.command(&config, &Estimate::default()));
    }
    for frequency in [0.5, 0.8, 0.95, 1.0, 1.1, 1.7] {
        let found = excited(&shaped, frequency, damping) / excited(&plain, frequency, damping);
        let expected = design.residual(PARTS as u32, frequency, damping);
        // roundings of 40,000 sums
        assert!((found - expected).abs() < 1e-10, "{PARTS} {frequency} {damping}: {found} {expected}");
    }
}

#[test]
fn any_course_of_the_setpoint_is_shaped_as_the_closed_form_says() {
    for damping in [0.0, 0.03, 0.1] {
        against_the_closed_form::<16, 2>(damping);
        against_the_closed_form::<32, 3>(damping);
    }
    let rope = InputShaperDesign::pendulum(Length(10.0));
    let frequency = (GRAVITY / 10.0).sqrt();
    assert!((rope.delay * frequency / PI - 1.0).abs() < 1e-15 && rope.share == 0.5);
    for off in [-0.1, 0.05, 0.2] {
        // |sin(pi r/2)|
        let expected = (0.5 * PI * off).sin().abs();
        let found = [2, 3].map(|parts| rope.residual(parts, frequency * (1.0 + off), 0.0));
        assert!((found[0] - expected).abs() < 1e-14 && (found[1] - expected * expected).abs() < 1e-14);
    }
    for (frequency, damping) in [(0.0, 0.0), (f64::NAN, 0.0), (1.0, 1.0), (1.0, -0.1)] {
        assert_eq!(InputShaperDesign::try_new(frequency, damping), Err(Error::Shaper));
    }
    // less than half a tick
    assert!(InputShaperConfig::<f64, ()>::try_new(&rope, 10_000, 2.0, (), 1e-3, Bases::SI).is_err());
}

/// From a speed, the setpoint starts there, and goes down in three parts.
#[test]
fn a_start_at_a_speed_is_without_a_jump() {
    let config = InputShaperConfig::<f64, ()>::new(&InputShaperDesign::new(1.0, 0.0), 16, 2.0, (), 1e-3, Bases::SI);
    let mut shaper = InputShaper::<Probe, 32, 3, f64>::default();
    shaper.start(&config, &Estimate { motor_speed: 1.0, ..Estimate::default() }, 0.0);
    let down: Vec<f64> = (0..7000).map(|_| shaper.command(&config, &Estimate::default())).collect();
    // a quarter, a half, a quarter, each within half a second
    for (tick, expected) in [(0, 1.0), (600, 0.75), (3100, 0.75), (3700, 0.25), (6200, 0.25), (6900, 0.0)] {
        assert!((down[tick] - expected).abs() < 1e-3, "{tick}: {}", down[tick]);
    }
}
