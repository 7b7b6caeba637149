//! Four motors on a bull gear, each with its backlash: with a torque bias, against a plain speed loop that gives all
//! four the same torque.
//!
//! The tilting drive of a 300 t oxygen converter, motor by motor: four motors of 110 kW at 600 r/min, each with its
//! brake, its gearbox of four-pinion trains, its encoder and its inverter, on one bull gear. The trains are alike, but
//! for their tolerances; each has a gap of 0.3 rad at the motor. Two motors pull against the other two, so that the bull
//! gear is held from both sides; above 90 % of rated torque all four share the load equally.
//!
//! The observer stands on the mean of the four angles: with a bias it moves as one motor of four inertias on four
//! shafts in parallel without a gap, whatever the motors do against each other, and the counts of four encoders blur
//! one another. So it is the linear one of two masses.

use std::iter;

use driveline::configure::{Configure, HasLoadSharing, Machine, Rating};
use driveline::design::{Disturbance, Encoder, SpeedLoopTuning};
use driveline::drive::{Composition, Drive};
use driveline::governor::{LoadSharing, LoadSharingConfig, SpeedLoop};
use driveline::machine::{Chain, Damping, Efficiency, Inertia, Ratio, Speed, Stiffness, Torque};
use driveline::number::{Fixed, Number};
use driveline::observer::TwoMassObserver;
use driveline::sample::Sample;
use driveline::settings::{Bases, LoadSharingSettings, Screening};
use driveline_closed_loop::sensors;
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_solver::noise::Noise;
use driveline_solver::plant::train::{Coordinate, Friction, Link, Motion, Source, Train};
use driveline_solver::plant::{LoadProgram, PlantError};

/// Motors on the bull gear.
const MOTORS: usize = 4;
/// Motor turns per turn of the trunnion.
const RATIO: f64 = 690.0;
/// Inertia of a motor with its brake (kg m2), and its rated torque (N m).
const MOTOR: f64 = 9.0;
const RATED: f64 = 1_750.0;
/// Stiffness (N m/rad), damping (N m s/rad) and gap (rad) of a motor's train, at the motor.
const TRAIN: [f64; 3] = [5.0e4, 3.75, 0.3];
const LINES: u32 = 2048;

/// The machine, from the motors to the vessel: four motors; their trains in parallel; the bull gear; the trunnion.
struct Converter;

impl Machine for Converter {
    const CHAIN: Chain = Chain::motor(Inertia(MOTORS as f64 * MOTOR))
        .shaft(Stiffness(MOTORS as f64 * TRAIN[0]), Damping(MOTORS as f64 * TRAIN[1]))
        .rotor(Inertia(4.0))
        .gear(Ratio(RATIO), Efficiency(1.0))
        .shaft(Stiffness(3.6e9), Damping(1.0e7))
        .rotor(Inertia(1.2e7));
    /// All four motors; 600 r/min.
    const RATING: Rating = Rating {
        torque: Torque(MOTORS as f64 * RATED),
        speed: Speed(62.8),
        torque_limit: Torque(2.0 * MOTORS as f64 * RATED),
    };
    const ENCODER: Encoder = Encoder::lines(LINES);
    const RATE_HZ: u32 = 10_000;
    /// The load may wander by a third of rated in ten seconds.
    const DISTURBANCE: Disturbance =
        Disturbance { load_torque_step: 0.35 * Self::RATING.torque.0, ..Self::RATING.disturbance() };
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.3, damping: 1.0, shaft_damping: 0.1 };
    /// Rated speed in 1.6 s: two motors carry the load and the acceleration.
    const RAMP: f64 = 40.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 2.0 * Self::RATING.speed.0);
    /// In 30 ms the motor turns by less than half a turn.
    const SCREENING: Screening = Screening {
        setpoint: 1.5 * Self::RATING.speed.0,
        max_coast: Self::RATE_HZ / 34,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

impl HasLoadSharing for Converter {
    /// A ninth of rated torque holds a flank. The motors swing against the held bull gear at 12 Hz; the damping is 0.3
    /// of the critical, and lags by a twelfth of a period. The share of the shaft torque changes by up to 5 kN m/s when
    /// friction reverses; the bias has to be faster.
    const SHARING: LoadSharingSettings = LoadSharingSettings {
        motors: MOTORS as u32,
        preload: RATED / 9.0,
        equal_above: 0.9 * RATED,
        bias_below: 0.8 * RATED,
        slew: 8_000.0,
        torque_limit: 2.0 * RATED,
        damping: 400.0,
        lag: 6.4e-3,
        max_deviation: 0.7,
    };
}

/// What is particular to each of the four motors, over what the drive is told: inertia, stiffness, gap and torque.
#[derive(Clone, Copy)]
struct Pinion {
    inertia: f64,
    stiffness: f64,
    gap: f64,
    torque: f64,
}

impl Pinion {
    const NOMINAL: Pinion = Pinion { inertia: 1.0, stiffness: 1.0, gap: 1.0, torque: 1.0 };

    /// Four within their tolerances, evenly spread: inertia 5 %, stiffness 20 %, gap 50 %, torque 1 %.
    fn drawn(seed: u64) -> [Pinion; MOTORS] {
        let mut noise = Noise::new(seed);
        let mut within = |tolerance: f64| 1.0 + tolerance * noise.uniform();
        [(); MOTORS].map(|()| Pinion {
            inertia: within(0.05),
            stiffness: within(0.2),
            gap: within(0.5),
            torque: within(0.01),
        })
    }
}

const BULL_GEAR: usize = MOTORS;
const VESSEL: usize = MOTORS + 1;

/// Friction of trunnion bearings and gears (N m at the motors): a tenth of rated torque.
const FRICTION: f64 = 700.0;
/// Torque of the bath on either side of its dead centre, and of a skull at the mouth (N m at the motors).
const BATH: f64 = 2_400.0;
const SKULL: f64 = 6_600.0;

/// When the speed reverses; when all motors carry the skull (s).
const REVERSAL: [f64; 2] = [4.0, 7.3];
const HEAVY: [f64; 2] = [8.9, 9.2];

/// The plant at rest in the middle of its gaps: six inertias on their own shafts. [Derived; heading: Huang 1987 ch. 12.]
fn ring(pinions: &[Pinion; MOTORS]) -> Result<Motion, PlantError> {
    let load =
        [(0.9, 0.0), (1.8, BATH), (5.2, BATH), (6.2, -BATH), (6.6, -BATH), (7.0, 0.0), (7.3, 0.0), (8.1, -SKULL)];
    let load = [&load[..], &[(9.2, -SKULL), (9.8, 0.0)]].concat();
    let load: Vec<(f64, f64)> = load.into_iter().map(|(time, torque)| (time, -torque * RATIO)).collect();
    let motors =
        pinions.iter().fold(Train::new(), |train, pinion| train.coordinate(Coordinate::new(9.0 * pinion.inertia)));
    let train = motors
        .coordinate(Coordinate::new(4.0 * RATIO * RATIO))
        .coordinate(Coordinate::new(1.2e7).source(Source::Program(LoadProgram::table(&load))))
        .friction(Friction::ground(VESSEL, FRICTION * RATIO));
    let train = pinions.iter().enumerate().fold(train, |train, (motor, pinion)| {
        let [stiffness, damping, gap] = TRAIN;
        let shaft = Link::geared(motor, BULL_GEAR, RATIO, stiffness * pinion.stiffness);
        train.link(shaft.damping(damping * pinion.stiffness).gap(gap * pinion.gap))
    });
    train.link(Link::shaft(BULL_GEAR, VESSEL, 3.6e9).damping(1.0e7)).build()
}

/// What a drive is told in a tick: the motors' angles (2^-32 turn), the torque of them all in the tick that has ended
/// (N m), and the setpoint (rad/s); none while the brakes are closed.
struct Told {
    angles: [u32; MOTORS],
    torque: f64,
    setpoint: Option<f64>,
}

/// A drive of the four motors: each one's torque (N m), and whether there was a fault.
fn drive<D: Composition>(
    config: D::Config,
    sharing: Option<LoadSharingConfig<D::Number>>,
    words: Words,
) -> impl FnMut(&Told) -> ([f64; MOTORS], bool) {
    let units = Units::new(words, Converter::BASES);
    let mut drive = D::new(&config, 0);
    let mut shared = LoadSharing::<D::Number, MOTORS>::default();
    move |told| {
        let Some(setpoint) = told.setpoint else {
            drive.hold(&config, shared.hold(&told.angles), D::Number::ZERO);
            return ([0.0; MOTORS], false);
        };
        let first = told.angles[0];
        let angle = match &sharing {
            Some(sharing) => shared.mean_angle(sharing, &told.angles),
            None => {
                let apart = told.angles.map(|angle| angle.wrapping_sub(first) as i32 / MOTORS as i32);
                first.wrapping_add(apart.iter().sum::<i32>() as u32)
            }
        };
        let [torque, setpoint] = [units.torque_word(told.torque), units.speed_word(setpoint)].map(D::Number::from_word);
        let command = drive.tick(&config, &Sample { angle, torque, setpoint });
        let torques = match &sharing {
            Some(sharing) => shared
                .torques(sharing, command.torque, drive.estimate(&config).shaft_torque)
                .map(|torque| units.torque(torque.to_word())),
            None => [0.25 * units.torque(command.torque.to_word()); MOTORS],
        };
        (torques, !command.faults.is_none() || shared.left_out() != 0)
    }
}

/// The pinions after a tick.
struct Moment {
    time: f64,
    /// The largest torque of a pinion's shaft, either way (N m).
    peak: f64,
    /// The least torque that holds a pinion on its flank (N m): the forward one of the first and third, the backward
    /// one of the others; zero or below where one has left it.
    hold: f64,
    /// Pinions that stand in their gaps.
    open: u32,
    /// Largest deviation of a pinion's torque from their mean, as a share of it.
    unequal: f64,
    /// Speed of the vessel, at the motors (rad/s).
    speed: f64,
}

impl Moment {
    fn of(time: f64, plant: &Motion) -> Self {
        let torques = [0, 1, 2, 3].map(|motor| plant.force(motor));
        let mean = torques.iter().sum::<f64>() / MOTORS as f64;
        let [a, b, c, d] = torques;
        Moment {
            time,
            peak: torques.iter().fold(0.0, |peak, torque| torque.abs().max(peak)),
            hold: a.min(-b).min(c).min(-d),
            open: torques.iter().filter(|torque| **torque == 0.0).count() as u32,
            unequal: torques.iter().fold(0.0, |unequal, torque| (torque / mean - 1.0).abs().max(unequal)),
            speed: plant.speed(VESSEL) * RATIO,
        }
    }
}

/// Tilting out of the gaps, over the dead centre, back, a skull that all four motors carry, and a stop. The torque that
/// is told has noise of 1 % of rated in every tick.
fn run(
    pinions: &[Pinion; MOTORS],
    mut drive: impl FnMut(&Told) -> ([f64; MOTORS], bool),
) -> Result<(Vec<Moment>, bool), PlantError> {
    let mut plant = ring(pinions)?;
    let (encoder, mut noise) = (sensors::Encoder::new(4 * LINES), Noise::new(1));
    let (mut given, mut faulty) = ([0.0; MOTORS], false);
    let mut moments = Vec::new();
    for tick in 0..108_000 {
        let time = f64::from(tick) * Converter::PERIOD;
        let setpoint = match tick {
            ..1_000 => None,
            1_000..40_000 => Some(Converter::RATING.speed.0),
            40_000..98_000 => Some(-Converter::RATING.speed.0),
            _ => Some(0.0),
        };
        let angles = [0, 1, 2, 3].map(|motor| encoder.read(plant.angle(motor)));
        let torque = given.iter().sum::<f64>() + 0.01 * Converter::RATING.torque.0 * noise.normal();
        let (torques, fault) = drive(&Told { angles, torque, setpoint });
        (given, faulty) = (torques, faulty | fault);
        moments.push(Moment::of(time, &plant));
        for (motor, (torque, pinion)) in torques.iter().zip(pinions).enumerate() {
            plant.set_torque(motor, torque * pinion.torque);
        }
        plant.advance(Converter::PERIOD);
    }
    Ok((moments, faulty))
}

fn within(moments: &[Moment], [from, to]: [f64; 2]) -> impl Iterator<Item = &Moment> {
    moments.iter().filter(move |moment| moment.time >= from && moment.time < to)
}

type OneDrive<N> = Drive<N, TwoMassObserver, SpeedLoop>;

/// Peak of the pinions' torques in the reversal (N m), and how often a pinion left a flank in it, by a plain loop that
/// gives each motor a fourth of its torque.
fn plain(pinions: &[Pinion; MOTORS]) -> Result<(f64, u32), PlantError> {
    let mut config = <OneDrive<f32> as Configure<Converter, f32>>::CONFIG;
    // rated speed in a fifth of a second, which is more than the motors can
    config.governor.damping = 0.0;
    config.governor.ramp *= (5.0 * Converter::RATING.speed.0 / Converter::RAMP) as f32;
    let (moments, _) = run(pinions, drive::<OneDrive<f32>>(config, None, Words::Single))?;
    let (mut left, mut last) = (0, 0);
    for moment in within(&moments, REVERSAL) {
        left += moment.open.saturating_sub(last);
        last = moment.open;
    }
    Ok((within(&moments, REVERSAL).fold(0.0, |peak, moment| moment.peak.max(peak)), left))
}

/// The limits on the machine as told and on drives within their tolerances, in both numbers. The plain loop
/// leaves flanks in each of them.
#[test]
fn with_a_bias_no_flank_is_left_and_all_share_a_heavy_load() {
    const SINGLE: LoadSharingConfig<f32> = <LoadSharing<f32, MOTORS> as Configure<Converter, f32>>::CONFIG;
    const FIXED: LoadSharingConfig<Fixed> = <LoadSharing<Fixed, MOTORS> as Configure<Converter, Fixed>>::CONFIG;
    // odd seeds: `Noise` draws the same of an even one and the next
    let draws = iter::once([Pinion::NOMINAL; MOTORS]).chain([1, 3, 5].map(Pinion::drawn));
    for (draw, pinions) in draws.enumerate() {
        let (plain, left) = plain(&pinions).unwrap();
        assert!(left > 0, "draw {draw}: the comparison leaves no flank");
        let single = drive::<OneDrive<f32>>(OneDrive::<f32>::configure::<Converter>(), Some(SINGLE), Words::Single);
        let fixed = drive::<OneDrive<Fixed>>(OneDrive::<Fixed>::configure::<Converter>(), Some(FIXED), Words::Fixed);
        for (number, biased) in [("f32", run(&pinions, single)), ("fixed", run(&pinions, fixed))] {
            let (moments, faulty) = biased.unwrap();
            assert!(!faulty, "draw {draw}, {number}");
            let peak = within(&moments, REVERSAL).fold(0.0, |peak, moment| moment.peak.max(peak));
            let hold = within(&moments, REVERSAL).fold(f64::INFINITY, |hold, moment| moment.hold.min(hold));
            let unequal = within(&moments, HEAVY).fold(0.0, |unequal, moment| moment.unequal.max(unequal));
            let speed = within(&moments, REVERSAL).last().map_or(0.0, |moment| moment.speed);
            let found =
                format!("draw {draw}, {number}: peak {peak} of {plain}, hold {hold}, unequal {unequal}, {speed}");
            println!("{found}; the plain loop left {left}");
            // positive throughout: every pinion stays on its flank, motors one and three on the forward one
            assert!(hold > 0.0, "{found}");
            assert!(unequal < 0.02, "{found}");
            assert!(peak < 0.7 * plain, "{found}");
            // it has reversed: the load turns the other way, at the rated speed
            assert!(speed < -0.95 * Converter::RATING.speed.0, "{found}");
        }
    }
}
