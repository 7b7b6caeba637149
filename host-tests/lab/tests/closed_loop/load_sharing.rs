//! Four motors on a bull gear, each with its backlash: with a torque bias, against a plain speed loop that gives all
//! four the same torque.

use std::{io, iter};

use driveline::configure::{Configure, Machine as _};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::observer::TwoMassObserver;
use driveline_closed_loop::lockstep::{Moment, run};
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::ticks::{OnHost, Ticks};
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_firmware::scene::composed::OverWords as _;
use driveline_firmware::scene::{Input, Output};
use driveline_firmware::scenes::converter_ring::{ConverterRing, MOTORS};
use driveline_firmware::scenes::find;
use driveline_lab::drivetrains::converter_ring::{HEAVY, Pinion, REVERSAL, pinion, with};

const RATED_SPEED: f64 = ConverterRing::RATING.speed.0;

/// Torques of the pinions' shafts (N m).
fn pinions(plant: &Body) -> [f64; MOTORS] {
    [0, 1, 2, 3].map(|motor| pinion(plant, motor))
}

/// The largest torque of a pinion's shaft, either way (N m).
fn peak(plant: &Body) -> f64 {
    pinions(plant).iter().fold(0.0, |peak, torque| torque.abs().max(peak))
}

/// The least torque that holds a pinion on its flank (N m): the forward one of the first and third, the backward one of
/// the others; zero or below where one has left it.
fn hold(plant: &Body) -> f64 {
    let [a, b, c, d] = pinions(plant);
    a.min(-b).min(c).min(-d)
}

/// Pinions that stand in their gaps.
fn open(plant: &Body) -> f64 {
    pinions(plant).iter().filter(|torque| **torque == 0.0).count() as f64
}

/// Largest deviation of a pinion's torque from their mean, as a share of it.
fn unequal(plant: &Body) -> f64 {
    let torques = pinions(plant);
    let mean = torques.iter().sum::<f64>() / MOTORS as f64;
    torques.iter().fold(0.0, |unequal, torque| (torque / mean - 1.0).abs().max(unequal))
}

type PlainDrive = Drive<f32, TwoMassObserver, SpeedLoop>;

/// A drive of one motor that takes the mean of the four angles and gives each motor a fourth of its torque.
struct EqualTorque {
    drive: PlainDrive,
    config: ConfigOf<PlainDrive>,
    torque: f32,
}

impl Ticks for EqualTorque {
    fn tick(&mut self, input: &Input) -> io::Result<Output> {
        if input.flags & Input::MOTORS != 0 {
            let share = (0.25 * self.torque).to_bits();
            let [torque, motor_speed, shaft_torque, load_speed] = [share; MOTORS];
            return Ok(Output { torque, motor_speed, shaft_torque, load_speed, ..Output::default() });
        }
        let further = [input.vibration[0], input.vibration[1], input.asked[1]];
        let apart: i32 = further.map(|angle| angle.wrapping_sub(input.angle) as i32 / MOTORS as i32).iter().sum();
        let angle = input.angle.wrapping_add(apart as u32);
        let output = self.drive.advance(&self.config, &Input { angle, vibration: [0; 2], asked: [0; 2], ..*input });
        self.torque = f32::from_bits(output.torque);
        Ok(output)
    }
}

/// A quantity of the plant over a run, and another one.
fn follow(
    words: Words,
    drive: &mut impl Ticks,
    pinions: &[Pinion; MOTORS],
    quantities: [fn(&Body) -> f64; 2],
) -> Result<Vec<Moment>, Box<dyn std::error::Error>> {
    let mut machine = with(pinions)?;
    [machine.shaft_torque, machine.load_torque] = quantities;
    let units = Units::new(words, machine.bases);
    let scenario = machine.scenarios[0].clone();
    Ok(run(&machine, &scenario, &units, ConverterRing::RATE_HZ, drive, |_| {})?.moments)
}

/// What a run with the bias shows.
#[derive(Debug)]
struct Biased {
    /// Peak of the pinions' torques in the reversal (N m).
    peak: f64,
    /// Least torque on a flank in it (N m).
    hold: f64,
    /// Largest deviation of a pinion's torque from the mean of all under the skull.
    unequal: f64,
    /// Speed of the load at the end of the reversal (rad/s).
    speed: f64,
}

fn within(moments: &[Moment], [from, to]: [f64; 2]) -> impl Iterator<Item = &Moment> {
    moments.iter().filter(move |moment| moment.time >= from && moment.time < to)
}

fn biased(variant: &str, pinions: &[Pinion; MOTORS]) -> Result<Biased, Box<dyn std::error::Error>> {
    let row = find(variant).ok_or("a variant of the firmware's table")?;
    let moments = follow(row.words(), &mut OnHost(row.start()), pinions, [peak, hold])?;
    assert!(moments.iter().all(|moment| moment.faults == 0), "{variant}");
    let shares = follow(row.words(), &mut OnHost(row.start()), pinions, [unequal, peak])?;
    Ok(Biased {
        peak: within(&moments, REVERSAL).fold(0.0, |peak, moment| moment.truth[0].max(peak)),
        hold: within(&moments, REVERSAL).fold(f64::INFINITY, |hold, moment| moment.truth[2].min(hold)),
        unequal: within(&shares, HEAVY).fold(0.0, |unequal, moment| moment.truth[0].max(unequal)),
        speed: within(&moments, REVERSAL).last().map_or(0.0, |moment| moment.truth[1]),
    })
}

/// Peak of the pinions' torques in the reversal (N m), and how often a pinion left a flank in it, by a plain loop.
fn plain(pinions: &[Pinion; MOTORS]) -> Result<(f64, u32), Box<dyn std::error::Error>> {
    let mut config = <PlainDrive as Configure<ConverterRing, f32>>::CONFIG;
    // rated speed in a fifth of a second, which is more than the motors can
    config.governor.damping = 0.0;
    config.governor.ramp *= (5.0 * RATED_SPEED / ConverterRing::RAMP) as f32;
    let mut drive = EqualTorque { drive: PlainDrive::new(&config, 0), config, torque: 0.0 };
    let moments = follow(Words::Single, &mut drive, pinions, [peak, open])?;
    let mut left = 0;
    let mut last = 0.0;
    for moment in within(&moments, REVERSAL) {
        left += (moment.truth[2] - last).max(0.0) as u32;
        last = moment.truth[2];
    }
    Ok((within(&moments, REVERSAL).fold(0.0, |peak, moment| moment.truth[0].max(peak)), left))
}

/// The limits on the machine as told and on drives within their tolerances, in both numbers. The plain loop
/// leaves flanks in each of them.
#[test]
fn with_a_bias_no_flank_is_left_and_all_share_a_heavy_load() -> Result<(), Box<dyn std::error::Error>> {
    // odd seeds: `Noise` draws the same of an even one and the next
    let draws = iter::once([Pinion::NOMINAL; MOTORS]).chain([1, 3, 5].map(Pinion::drawn));
    for (draw, pinions) in draws.enumerate() {
        let (plain, left) = plain(&pinions)?;
        assert!(left > 0, "draw {draw}: the comparison leaves no flank");
        for number in ["f32", "fixed"] {
            let found = biased(&format!("converter-ring/{number}/biased/10000"), &pinions)?;
            println!(
                "draw {draw}, {number}: {:.3} of the plain loop's peak, {found:?}; it left {left}",
                found.peak / plain
            );
            // positive throughout: every pinion stays on its flank, motors one and three on the forward one
            assert!(found.hold > 0.0, "draw {draw}, {number}: {found:?}");
            assert!(found.unequal < 0.02, "draw {draw}, {number}: {found:?}");
            assert!(found.peak < 0.7 * plain, "draw {draw}, {number}: {found:?}, plain {plain}");
            // it has reversed: the load turns the other way, at the rated speed
            assert!(found.speed < -0.95 * RATED_SPEED, "draw {draw}, {number}: {found:?}");
        }
    }
    Ok(())
}
