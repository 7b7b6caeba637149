//! Phasors against the vibration that they were made from.

use std::f64::consts::TAU;

use driveline::angle::{OncePerTurn, Synchronous};
use driveline::balancing::{Balancer, Phasor, Phasors, PhasorsConfig, Reading, ReadingFault, Steadiness};
use driveline::configure::{Configure, HasVibration, Machine, Rating};
use driveline::design::Encoder;
use driveline::machine::{Chain, Damping, Inertia, Speed, Stiffness, Torque};
use driveline::number::Fixed;
use driveline::settings::PhasorSettings;

use crate::noise::Noise;

/// A rotor behind a gear, its motor's angle as an encoder shows it, and one vibration channel.
struct Rig {
    /// Turns of the rotor, from where the motor's angle was zero.
    turned: f64,
    /// Ticks on a turn of the rotor.
    ticks: f64,
    /// Swing of the speed, once a turn of the rotor, over its mean.
    ripple: f64,
    /// Gain of speed in a tick, relative.
    gain: f64,
    /// Turns of the rotor to one of the motor.
    ratio: f64,
    /// Counts of the encoder.
    counts: f64,
    noise: Noise,
}

impl Rig {
    fn new(ticks: f64) -> Self {
        Rig { turned: 0.137, ticks, ripple: 0.0, gain: 0.0, ratio: 1.0, counts: 4_294_967_296.0, noise: Noise::new(7) }
    }

    /// The next tick: the motor's angle, the rotor's in radians.
    fn next(&mut self) -> (u32, f64) {
        // the middle of the tick decides its speed
        let about = self.turned + 0.5 / self.ticks;
        self.turned += (1.0 + self.ripple * (TAU * about).cos()) / self.ticks;
        self.ticks /= 1.0 + self.gain;
        let motor = ((self.turned / self.ratio * self.counts).floor() / self.counts).rem_euclid(1.0);
        ((motor * 4_294_967_296.0) as u32, TAU * self.turned.rem_euclid(1.0))
    }
}

const CALM: PhasorSettings = PhasorSettings::DIRECT;

fn run<N: Synchronous, const EDGES: usize>(
    config: &PhasorsConfig<N, 1>,
    rig: &mut Rig,
    number: impl Fn(f64) -> N,
    mut vibration: impl FnMut(f64, &mut Noise) -> f64,
) -> Result<Reading, ReadingFault> {
    let mut phasors = Phasors::<1, EDGES, N>::default();
    for _ in 0..2_000_000 {
        let (angle, theta) = rig.next();
        let v = vibration(theta, &mut rig.noise);
        phasors.measure(config, angle, &[number(v)]);
        if phasors.is_complete() {
            break;
        }
    }
    phasors.reading(config, 0)
}

/// Amplitude relative, phase in degrees.
fn error(phasor: Phasor, amplitude: f64, phase: f64) -> (f64, f64) {
    let (re, im) = (f64::from(phasor.re), f64::from(phasor.im));
    let turned = (im.atan2(re) - phase).rem_euclid(TAU);
    let turned = if turned > TAU / 2.0 { turned - TAU } else { turned };
    (re.hypot(im) / amplitude - 1.0, turned.to_degrees())
}

fn near(reading: &Reading, amplitude: f64, phase: f64, part: f64, degrees: f64) {
    let (by, turned) = error(reading.phasor, amplitude, phase);
    assert!(by.abs() < part && turned.abs() < degrees, "{by:e} {turned} deg of {reading:?}");
}

/// 0.5 % and 0.5 degree under 1 % of speed ripple and noise 20 dB below the vibration: what a reading is asked for.
#[test]
fn amplitude_and_phase_under_ripple_and_noise() {
    let measured = PhasorSettings { rotor_turns: 31, motor_turns: 47, turns: 16, ..CALM };
    let single = PhasorsConfig::<f32, 1>::new(&measured, [20.0]);
    let fixed = PhasorsConfig::<Fixed, 1>::new(&measured, [1.0]);
    let (mut worst, mut most) = (0.0_f64, 0.0_f64);
    for seed in 0..40 {
        let mut noise = Noise::new(seed);
        let (amplitude, phase) = (1.0 + 4.0 * noise.even(), TAU * noise.even());
        let rig = || Rig {
            ripple: 0.01,
            ratio: 31.0 / 47.0,
            counts: 8192.0,
            noise: Noise::new(100 + seed),
            ..Rig::new(40.0 + 60.0 * f64::from(seed as u32) / 40.0)
        };
        // 20 dB of power: a tenth of the rms, which is the amplitude over the root of two
        let signal = |theta: f64, noise: &mut Noise| {
            amplitude * (theta + phase).cos() + 0.1 * amplitude / 2_f64.sqrt() * noise.normal()
        };
        let a = run::<f32, 9>(&single, &mut rig(), |v| v as f32, signal).unwrap();
        let b = run::<Fixed, 9>(&fixed, &mut rig(), |v| Fixed::from_f64(v / 16.0), signal).unwrap();
        for (reading, base) in [(a, 1.0), (b, 16.0)] {
            let (by, turned) = error(reading.phasor, amplitude / base, phase);
            (worst, most) = (worst.max(by.abs()), most.max(turned.abs()));
            // What the blocks' scatter says the error is: 0.13 to 0.2 % by the number of samples; from twelve degrees
            // of freedom within 0.4 to 1.7 of that (chi square, one in a thousand).
            let said = f64::from(reading.variance).sqrt() / (amplitude / base);
            assert!((0.0005..0.0034).contains(&said), "{said}");
        }
    }
    println!("worst of 80 readings: {:.3} %, {most:.3} degrees", 100.0 * worst);
    assert!(worst < 0.005 && most < 0.5);
}

/// Without noise what is left is the table's 1.5e-4, the samples' 1/(6 n^2) of the edges, and for few ticks the slope's
/// change at an edge.
#[test]
fn a_clean_vibration_is_read_to_the_table() {
    for (ticks, tolerance) in [(200.3, 2e-4), (50.7, 3e-4), (17.3, 2e-3), (9.1, 8e-3)] {
        for phase in [0.0, 0.8, 2.5, 4.4] {
            let signal = |theta: f64, _: &mut Noise| 3.0 * (theta + phase).cos() + 11.0 + 0.5 * (2.0 * theta).sin();
            let config = PhasorsConfig::<f32, 1>::new(&CALM, [20.0]);
            let reading = run::<f32, 9>(&config, &mut Rig::new(ticks), |v| v as f32, signal).unwrap();
            near(&reading, 3.0, phase, tolerance, tolerance.to_degrees());
            let config = PhasorsConfig::<f64, 1>::new(&CALM, [20.0]);
            let exact = run::<f64, 9>(&config, &mut Rig::new(ticks), |v| v, signal).unwrap();
            near(&exact, 3.0, phase, tolerance, tolerance.to_degrees());
            assert!((reading.ticks - ticks as f32).abs() < 0.01 && reading.turns == 64 && reading.speed_spread < 2e-3);
        }
    }
}

/// The first and the last tick of a block are cut where its zero is, and what the first one has left counts by the
/// slope there. What remains is of second order, (2 pi/n)^2/6 of a tick at either end, which is two n-th of half a
/// turn.
#[test]
fn the_ends_of_a_block_are_cut_by_the_slope_there() {
    let config = PhasorsConfig::<f64, 1>::new(&PhasorSettings { turns: 1, ..CALM }, [20.0]);
    for ticks in [12.37, 17.3, 33.3_f64] {
        let tolerance = (TAU / ticks).powi(2) / 6.0 * 4.0 / ticks;
        for phase in [0.0, 0.8, 1.5, 2.5, 4.4] {
            let signal = |theta: f64, _: &mut Noise| 3.0 * (theta + phase).cos();
            let reading = run::<f64, 9>(&config, &mut Rig::new(ticks), |v| v, signal).unwrap();
            near(&reading, 3.0, phase, tolerance, tolerance.to_degrees());
        }
    }
}

/// The second order is read beside a first one of five times its size, and the other way round.
#[test]
fn orders_are_told_apart() {
    let signal = |theta: f64, _: &mut Noise| 5.0 * (theta + 1.0).cos() + (2.0 * theta - 0.7).cos();
    let second = PhasorsConfig::<f32, 1>::new(&PhasorSettings { order: 2, ..CALM }, [20.0]);
    let reading = run::<f32, 9>(&second, &mut Rig::new(73.1), |v| v as f32, signal).unwrap();
    // five times the table's and the edges' error of the first order
    near(&reading, 1.0, -0.7, 3e-3, 0.2);
    assert_eq!(reading.turns, 128);
}

/// The position behind a gear of 31 to 47 is exact: it is where it was after 47 turns of the motor, however often; a
/// year of 50 turns a second is 1.6e9 turns, of which this does 47e5 in steps of a third and checks that none is lost
/// by half a unit of 2^-26.
#[test]
fn a_ratio_loses_nothing() {
    let measured = PhasorSettings { rotor_turns: 31, motor_turns: 47, turns: 300, ..CALM };
    let config = PhasorsConfig::<f32, 1>::new(&measured, [1.0]);
    let mut phasors = Phasors::<1, 2, f32>::default();
    let (mut angle, mut seen) = (0_u32, 0);
    for turn in 0..4_700_000_u32 {
        for part in [1_431_655_765, 1_431_655_765, 1_431_655_766] {
            angle = angle.wrapping_add(part);
            phasors.measure(&config, angle, &[0.0]);
        }
        if turn % 47 == 46 {
            assert_eq!(phasors.angle(&config), 0, "after {turn} turns");
            seen += 1;
        } else if turn % 470_000 == 100 {
            let exact = (u64::from(turn % 47 + 1) * 31 % 47) as f64 / 47.0;
            let here = f64::from(phasors.angle(&config)) / 4_294_967_296.0;
            assert!((exact - here).abs() < 1.0 / 67_108_864.0, "{exact} {here}");
        }
    }
    assert_eq!(seen, 100_000);
}

fn unit(theta: f64, _: &mut Noise) -> f64 {
    theta.cos()
}

#[test]
fn a_reading_that_cannot_be_believed_says_why() {
    let config = PhasorsConfig::<f32, 1>::new(&CALM, [1.5]);
    let read = |rig: &mut Rig, signal: &mut dyn FnMut(f64, &mut Noise) -> f64| {
        run::<f32, 9>(&config, rig, |v| v as f32, |theta, noise| signal(theta, noise))
    };
    // a run-up of 2 % over the reading of 64 turns of 50 ticks
    let moved = read(&mut Rig { gain: 0.02 / 3200.0, ..Rig::new(50.0) }, &mut unit);
    assert!(matches!(moved, Err(ReadingFault::SpeedMoved { spread }) if (0.014..0.02).contains(&spread)), "{moved:?}");
    // near a critical: the speed gains 0.4 %, the phase goes by 20 degrees
    let mut tick = 0.0;
    let near_critical = read(&mut Rig { gain: 0.004 / 3200.0, ..Rig::new(50.0) }, &mut |theta, _| {
        tick += 1.0 / 3200.0;
        (theta + 0.35 * tick).cos()
    });
    assert!(
        matches!(near_critical, Err(ReadingFault::Drifting { drift }) if (0.25..0.4).contains(&drift)),
        "{near_critical:?}"
    );
    // a beat with a neighbour that turns 1.5 % slower: a beat over the reading, of 1.8 times the vibration
    let mut other = 0.0_f64;
    let beat = read(&mut Rig::new(50.0), &mut |theta, _| {
        other += TAU / 50.0 * 0.985;
        0.5 * theta.cos() + 0.9 * other.cos()
    });
    assert!(matches!(beat, Err(ReadingFault::Scattered { .. })), "{beat:?}");
    let clipping = read(&mut Rig::new(50.0), &mut |theta, _| (3.0 * theta.cos()).clamp(-1.6, 1.6));
    assert_eq!(clipping, Err(ReadingFault::Clipped));
    let mut tick = 0;
    let broken = read(&mut Rig::new(50.0), &mut |theta, _| {
        tick += 1;
        if tick == 1000 { f64::NAN } else { theta.cos() }
    });
    assert_eq!(broken, Err(ReadingFault::Clipped));
    let fast = read(&mut Rig::new(6.3), &mut unit);
    assert_eq!(fast, Err(ReadingFault::TooFast));
}

/// Steadiness is that of the mean: blocks that differ by 40 % are a reading where 32 of them leave 7 %.
#[test]
fn blocks_that_differ_are_a_reading_where_their_mean_is_certain() {
    let config = PhasorsConfig::<f32, 1>::new(&CALM, [20.0]);
    let mut taken = 0;
    for seed in 0..20 {
        let mut rig = Rig { noise: Noise::new(1000 + seed), ..Rig::new(50.0) };
        // a block of 400 samples has noise of 5.7 sqrt(2/400) = 0.4 in both parts together times sqrt 2
        let noisy = |theta: f64, noise: &mut Noise| theta.cos() + 4.0 * noise.normal();
        let reading = run::<f32, 33>(&config, &mut rig, |v| v as f32, noisy).expect("taken");
        let (by, turned) = error(reading.phasor, 1.0, 0.0);
        // 0.4 sqrt(2)/sqrt(2 * 32) = 7 % in each part: four of that
        assert!(by.abs() < 0.28 && turned.abs() < 16.0, "{by} {turned}");
        assert!((0.25..0.6).contains(&reading.scatter), "{reading:?}");
        taken += 1;
    }
    assert_eq!(taken, 20);
}

/// A sensor that saturates at the end of its range is clipped there, whatever the range, the scale of its converter and
/// the number: a count's value times the counts may round to either side of the limit. Just inside it is a good one.
#[test]
fn a_sample_at_the_end_of_the_range_is_clipped() {
    let mut noise = Noise::new(77);
    for case in 0..40 {
        // four decades of ranges, converters of 12 to 16 bits
        let (limit, counts) = (20.0 * 10f64.powf(-4.0 * noise.even()), f64::from(1_u32 << (11 + case % 5)));
        let base = 2.0 * limit;
        for (end, clipped) in [(1.0, true), (0.999, false)] {
            let signal = |theta: f64, _: &mut Noise| (1.5 * theta.cos()).clamp(-end, end);
            let single = run::<f32, 9>(
                &PhasorsConfig::<f32, 1>::new(&CALM, [limit]),
                &mut Rig::new(50.0),
                |v| (v * counts) as f32 * (limit / counts) as f32,
                signal,
            );
            let double = run::<f64, 9>(
                &PhasorsConfig::<f64, 1>::new(&CALM, [limit]),
                &mut Rig::new(50.0),
                |v| v * limit,
                signal,
            );
            let fixed = run::<Fixed, 9>(
                &PhasorsConfig::<Fixed, 1>::new(&CALM, [limit / base]),
                &mut Rig::new(50.0),
                |v| Fixed::from_f64(v * counts * (limit / counts / base)),
                signal,
            );
            for reading in [single, double, fixed] {
                assert_eq!(reading == Err(ReadingFault::Clipped), clipped, "{limit} {counts}: {reading:?}");
            }
        }
    }
}

/// The floor of a machine is in the unit of its sensors in every number: a vibration of a fifth of it scatters by less
/// than the limit, since the floor is its reference, and one of four times the floor by more.
#[test]
fn the_floor_of_a_machine_is_the_same_in_every_number() {
    const SCATTER: f32 = 0.1;
    struct Floored<const HUNDREDTHS: u32>;
    type Above = Floored<100>;
    type Below = Floored<5>;
    impl<const HUNDREDTHS: u32> Machine for Floored<HUNDREDTHS> {
        const CHAIN: Chain = Chain::motor(Inertia(0.5)).shaft(Stiffness(5e3), Damping(4.0)).rotor(Inertia(2.0));
        const RATING: Rating = Rating { torque: Torque(286.0), speed: Speed(77.0), torque_limit: Torque(572.0) };
        const ENCODER: Encoder = Encoder::counts(4096);
        const RATE_HZ: u32 = 10_000;
    }
    impl<const HUNDREDTHS: u32> HasVibration for Floored<HUNDREDTHS> {
        const PHASORS: PhasorSettings = PhasorSettings {
            steadiness: Steadiness { scatter: SCATTER, floor: HUNDREDTHS as f32 / 100.0, ..Steadiness::USUAL },
            ..PhasorSettings::DIRECT
        };
        const VIBRATION_LIMIT: f64 = 20.0;
    }
    type One = Phasors<1, 9>;
    // a block of 400 samples has noise of 1.6 sqrt(2/400) sqrt(2) = 0.16, the mean of eight 0.057: 28 % of 0.2, 6 % of
    // the floor of 1
    let signal = |theta: f64, noise: &mut Noise| 0.2 * theta.cos() + 1.6 * noise.normal();
    for seed in 0..10 {
        let rig = || Rig { noise: Noise::new(2000 + seed), ..Rig::new(50.0) };
        let base = Above::VIBRATION_BASE;
        let single = [<One as Configure<Above, f32>>::CONFIG, <One as Configure<Below, f32>>::CONFIG]
            .map(|config| run::<f32, 9>(&config, &mut rig(), |v| v as f32, signal));
        let fixed = [<One as Configure<Above, Fixed>>::CONFIG, <One as Configure<Below, Fixed>>::CONFIG]
            .map(|config| run::<Fixed, 9>(&config, &mut rig(), |v| Fixed::from_f64(v / base), signal));
        for [above, below] in [single, fixed] {
            assert!(above.is_ok(), "{seed}: {above:?}");
            assert!(matches!(below, Err(ReadingFault::Scattered { .. })), "{seed}: {below:?}");
        }
    }
}

/// Hum at 50 Hz beside a rotor at 48 turns a second, as large as the vibration: blocks of 24 turns, 25 periods of it.
#[test]
fn hum_beside_once_a_turn_vanishes_over_whole_beats() {
    let whole = PhasorSettings { turns: 24, ..CALM };
    let config = PhasorsConfig::<f32, 1>::new(&whole, [20.0]);
    let mut hum = 0.3_f64;
    let ticks = 83.3;
    let reading = run::<f32, 9>(
        &config,
        &mut Rig::new(ticks),
        |v| v as f32,
        |theta, _| {
            hum += TAU / ticks * 50.0 / 48.0;
            (theta + 0.7).cos() + hum.cos()
        },
    );
    // a clean vibration's errors
    near(&reading.unwrap(), 1.0, 0.7, 3e-3, 0.2);
}

/// One pulse a turn, seen by sampling: each is late by a part of a tick that is unknown, and a speed that swings by 0.5
/// % over 20 turns. The reading is within 2 % and 2 degrees: a tick is 18 degrees, uniform over it 5.2, and over 64
/// turns 0.65.
#[test]
fn one_pulse_a_turn_is_an_angle() {
    // a block of eight turns begins and ends within a third of a tick: 0.4 %, and the swing
    let steadiness = Steadiness { speed: 0.02, ..Steadiness::USUAL };
    let config = PhasorsConfig::<f32, 1>::new(&PhasorSettings { steadiness, ..CALM }, [20.0]);
    for (start, captured) in [(0.0, false), (0.31, false), (0.77, true), (0.93, true)] {
        let mut tacho = OncePerTurn::new();
        let mut phasors = Phasors::<1, 9, f32>::default();
        let mut turned = start;
        for _ in 0..3000 {
            let before: f64 = turned;
            turned += (1.0 + 0.0025 * (TAU * turned / 20.0).sin()) / 20.137;
            let passed = turned.floor() > before.floor();
            let part = turned.fract() / (turned - before);
            let late = if captured { (part * 4_294_967_296.0) as u32 } else { 1 << 31 };
            let Some(angle) = tacho.tick(passed.then_some(late)) else { continue };
            phasors.measure(&config, angle, &[(3.0 * (TAU * turned + 1.1).cos()) as f32]);
        }
        let reading = phasors.reading(&config, 0).unwrap();
        near(&reading, 3.0, 1.1, 0.02, 2.0);
        assert!((f64::from(tacho.speed()) * 20.137 - 1.0).abs() < 0.01);
    }
}

/// A pulse that bounces, one that is missing, and none any more.
#[test]
fn pulses_that_bounce_or_stay_away() {
    let mut tacho = OncePerTurn::new();
    let run = |tacho: &mut OncePerTurn, ticks: std::ops::Range<u32>, pulse: &dyn Fn(u32) -> bool| {
        ticks.map(|tick| (tick, tacho.tick(pulse(tick).then_some(0)))).collect::<Vec<_>>()
    };
    let exact = |tick: u32| f64::from(tick % 40) / 40.0;
    let off = |(tick, angle): &(u32, Option<u32>)| {
        let here = angle.map_or(f64::NAN, |angle| f64::from(angle) / 4_294_967_296.0);
        let off = (here - exact(*tick)).rem_euclid(1.0);
        off.min(1.0 - off)
    };
    run(&mut tacho, 0..400, &|tick| tick % 40 == 0);
    // a bounce half a turn later, and no pulse at 480
    let seen = run(&mut tacho, 400..600, &|tick| tick % 40 == 0 && tick != 480 || tick == 420);
    assert!(seen.iter().all(|seen| off(seen) < 1e-3));
    let seen = run(&mut tacho, 600..1000, &|_| false);
    // two turns and up to four
    assert!(seen[..80].iter().all(|seen| off(seen) < 1e-3) && seen[200..].iter().all(|seen| seen.1.is_none()));
    let seen = run(&mut tacho, 1000..1200, &|tick| tick % 40 == 0);
    assert!(seen[100..].iter().all(|seen| off(seen) < 1e-3));
}

#[test]
fn turning_backwards_is_no_reading_and_a_negative_ratio_makes_it_one() {
    let config = PhasorsConfig::<f32, 1>::new(&CALM, [1.5]);
    let reversed = PhasorsConfig::<f32, 1>::new(&PhasorSettings { rotor_turns: -1, ..CALM }, [1.5]);
    let (mut wrong, mut right) = (Phasors::<1, 9, f32>::default(), Phasors::<1, 9, f32>::default());
    let mut angle = 0_u32;
    for _ in 0..5000 {
        angle = angle.wrapping_sub(80_000_003);
        let theta = -f64::from(angle) / 4_294_967_296.0 * TAU;
        let v = (theta + 0.5).cos() as f32;
        wrong.measure(&config, angle, &[v]);
        right.measure(&reversed, angle, &[v]);
    }
    assert!(matches!(wrong.reading(&config, 0), Err(ReadingFault::Backwards { times }) if times > 80));
    near(&right.reading(&reversed, 0).unwrap(), 1.0, 0.5, 3e-4, 0.02);
    assert_eq!(right.reading(&reversed, 1), Err(ReadingFault::NoChannel));
    // a bad reading is behind it once another is begun
    right.begin();
    assert_eq!(right.reading(&reversed, 0), Err(ReadingFault::Incomplete { turns: 0, of: 64 }));
}

/// Angles that no rotor has leave a measurement that works again.
#[test]
fn garbage_is_survived() {
    let measured = PhasorSettings { rotor_turns: 97, motor_turns: 7, turns: 1, ..CALM };
    let config = PhasorsConfig::<f32, 1>::new(&measured, [1e3]);
    let mut phasors = Phasors::<1, 5, f32>::default();
    let mut noise = Noise::new(3);
    for _ in 0..200_000 {
        let v = [f32::from_bits((noise.even() * 4e9) as u32)];
        phasors.measure(&config, (noise.even() * 4_294_967_295.0) as u32, &v);
    }
    let motor = (noise.even() * 4_294_967_295.0) as u32;
    phasors.align(&config, motor, 1 << 30);
    assert!((i64::from(phasors.angle(&config)) - (1 << 30)).abs() < 64);
    // aligned at any angle of the motor, without a tick there
    let mut angle = 0x1234_5678_u32;
    phasors.align(&config, angle, 0);
    let mut turned = 0.0_f64;
    for _ in 0..2000 {
        angle = angle.wrapping_add(3_000_000);
        turned += 3_000_000.0 / 4_294_967_296.0 * 97.0 / 7.0;
        phasors.measure(&config, angle, &[(TAU * turned).cos() as f32]);
    }
    near(&phasors.reading(&config, 0).unwrap(), 1.0, 0.0, 1e-3, 0.1);
}

#[test]
fn run_out_is_taken_off() {
    let config = PhasorsConfig::<f32, 1>::new(&CALM, [20.0]);
    let run_out = |theta: f64| 0.8 * (theta + 2.0).cos();
    let slow = run::<f32, 9>(&config, &mut Rig::new(900.0), |v| v as f32, |theta, _| run_out(theta)).unwrap();
    let both = |theta: f64, _: &mut Noise| run_out(theta) + 2.0 * (theta - 1.0).cos();
    let fast = run::<f32, 9>(&config, &mut Rig::new(60.0), |v| v as f32, both).unwrap();
    let (by, turned) = error(fast.phasor.less(slow.phasor), 2.0, -1.0);
    assert!(by.abs() < 3e-4 && turned.abs() < 0.03, "{by} {turned}");
}

#[test]
fn a_phasor_is_a_complex_number() {
    let phasor = Phasor { re: 1.5, im: -0.25 };
    assert_eq!(nalgebra::Complex::<f32>::from(phasor), nalgebra::Complex::new(1.5, -0.25));
    assert_eq!(nalgebra::Complex::<f64>::from(phasor), nalgebra::Complex::new(1.5, -0.25));
}

#[test]
fn faults_of_a_reading_give_their_share_in_tenths_of_a_percent() {
    for (fault, expected) in [
        (ReadingFault::SpeedMoved { spread: 0.0346 }, "the speed moved by 3.5 %"),
        (ReadingFault::SpeedMoved { spread: 0.0344 }, "the speed moved by 3.4 %"),
        (ReadingFault::Scattered { scatter: 1.25 }, "the vibration fluctuates: the mean is uncertain by 125.0 %"),
    ] {
        assert_eq!(fault.to_string(), expected);
    }
}

/// Two channels and two orders at once, as a drive composes them.
#[test]
fn channels_and_orders_side_by_side() {
    type Both = (Phasors<2, 9>, Phasors<1, 9>);
    let config = (
        PhasorsConfig::<f32, 2>::new(&CALM, [20.0, 5.0]),
        PhasorsConfig::<f32, 1>::new(&PhasorSettings { order: 2, turns: 4, ..CALM }, [20.0]),
    );
    let mut both = Both::default();
    let mut rig = Rig::new(61.3);
    for _ in 0..6000 {
        let (angle, theta) = rig.next();
        let v = [(2.0 * (theta + 1.0).cos()) as f32, (theta - 1.0).sin() as f32];
        both.measure(&config, angle, &(v, [(2.0 * theta).cos() as f32]));
    }
    near(&both.0.reading(&config.0, 0).unwrap(), 2.0, 1.0, 5e-4, 0.03);
    near(&both.0.reading(&config.0, 1).unwrap(), 1.0, -1.0 - TAU / 4.0, 5e-4, 0.03);
    near(&both.1.reading(&config.1, 0).unwrap(), 1.0, 0.0, 1e-3, 0.06);
}

/// Eight blocks whose amplitude rises by a twentieth each and by a hundredth up and down. Of the alternation -4/42 a
/// block is taken for a rise, and the rest is scatter: of eight values less two degrees of freedom. Three deviations of
/// a line through such scatter are taken off the drift.
#[test]
fn drift_and_scatter_are_those_of_a_line_through_the_blocks() {
    let loose = Steadiness { speed: 1.0, scatter: 1.0, drift: 1.0, floor: 0.0 };
    let config = PhasorsConfig::<f64, 1>::new(&PhasorSettings { steadiness: loose, ..CALM }, [20.0]);
    for (rise, up_and_down) in [(0.05, 0.01), (-0.05, 0.01), (0.0, 0.01), (0.002, 0.01)] {
        let mut rig = Rig::new(400.3);
        let mut phasors = Phasors::<1, 9, f64>::default();
        while !phasors.is_complete() {
            let (angle, theta) = rig.next();
            let block = ((rig.turned - 1.0) / 8.0).floor().max(0.0);
            let sign = if block % 2.0 == 0.0 { 1.0 } else { -1.0 };
            let amplitude = 3.0 * (1.0 + rise * (block - 3.5) + up_and_down * sign);
            phasors.measure(&config, angle, &[amplitude * (theta + 0.8).cos()]);
        }
        let reading = phasors.reading(&config, 0).unwrap();
        near(&reading, 3.0, 0.8, 2e-4, 0.02);
        // half a tick of a turn of 400 on either side of a block of eight turns, of what changes there
        let rounding = 2e-4;
        let slope: f64 = rise - up_and_down * 4.0 / 42.0;
        let variance = up_and_down * up_and_down * (8.0 - 16.0 / 42.0) / 6.0;
        let taken_off = 3.0 * (variance / 42.0).sqrt() * 7.0;
        assert!((f64::from(reading.scatter) - variance.sqrt()).abs() < rounding, "{rise} {reading:?}");
        assert!((f64::from(reading.variance) / 9.0 - variance / 8.0).abs() < rounding * variance.sqrt(), "{reading:?}");
        let drift = (7.0 * slope.abs() - taken_off).max(0.0);
        assert!((f64::from(reading.drift) - drift).abs() < 7.0 * rounding, "{rise} {drift} {reading:?}");
    }
}
