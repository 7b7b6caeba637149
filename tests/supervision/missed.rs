//! Ticks that do not run, singly and in bursts, told by a count in the sample: the estimates' errors beside those without,
//! every gap flagged, and no stop of the supervision.

use driveline::configure::Configure;
use driveline::drive::{ConfigOf, TickCount};
use driveline::fault::Faults;
use driveline::sample::Sample;

use crate::machines::{Crane, Hoist, Mill, Set, Spindle, Tested, Winder};
use crate::run::{Drawn, Draws, Watched, held, seen};

/// Rms errors of shaft torque, load speed and load torque, over their ratings, of a run up with its load; `share` of the
/// ticks begin a gap of `burst`.
fn errors<M: Tested>(config: &ConfigOf<Watched>, share: f64, burst: u32, told: bool) -> [f64; 3] {
    let duty = M::DUTY;
    let period = 1.0 / f64::from(M::RATE_HZ);
    let (mut plant, mut draws, mut count) = (held::<M>(&Drawn::NOMINAL, duty.held), Draws(3), TickCount::default());
    let mut noise = Draws(5);
    let start = plant.angle[0];
    let mut drive = Watched::new(config, 0);
    let (mut torque, mut reported, mut gap, mut gaps, mut flagged) = (0.0, 0.0, 0, 0, 0);
    let (mut sums, mut ran) = ([0.0; 3], 0.0);
    let hold = (0.2 / period) as u32;
    let ticks = ((duty.fails + 0.5) / period) as u32;
    for tick in 0..ticks {
        let released = tick >= hold;
        plant.brake = if released { 0.0 } else { 4.0 * M::RATING.torque.0 };
        plant.load = duty.load_at(f64::from(tick) * period - 0.2, period);
        if gap == 0 && tick > hold + 1 && draws.unit() < share {
            (gap, gaps) = (burst, gaps + 1);
        }
        if gap > 0 {
            gap -= 1;
        } else {
            let angle = seen::<M>(plant.angle[0] - start);
            let missed = count.missed(tick as u16);
            let command = if released {
                let sample = Sample { angle, torque: reported as f32, setpoint: duty.speed as f32 };
                drive.tick_after(config, &sample, if told { missed } else { 0 })
            } else {
                drive.hold(config, angle, duty.held as f32)
            };
            flagged += u32::from(command.faults.contains(Faults::TICK_MISSED));
            if told {
                assert!((command.faults & Faults::SUPERVISION).is_none(), "{} {}", duty.name, command.faults);
            }
            torque = f64::from(command.torque);
            let estimate = drive.estimate(config);
            let last = plant.speed.len() - 1;
            let truth = [plant.torque(plant.weak), plant.speed[last], plant.load];
            let found = [estimate.shaft_torque, estimate.load_speed, estimate.load_torque].map(f64::from);
            let rated = [M::RATING.torque.0, M::RATING.speed.0, M::RATING.torque.0];
            for k in 0..3 {
                sums[k] += ((found[k] - truth[k]) / rated[k]).powi(2);
            }
            ran += 1.0;
        }
        reported = torque + 0.01 * M::RATING.torque.0 * noise.normal();
        plant.advance(torque, period);
    }
    // a gap that begins where another ends is the same one
    assert!(!told || flagged <= gaps && 20 * flagged >= 18 * gaps, "{}: {flagged} of {gaps}", duty.name);
    sums.map(|sum| (sum / ran).sqrt())
}

/// `seen`: whether a drive that is not told of the gaps is beyond the targets.
fn survey<M: Tested>(seen: bool)
where
    Watched: Configure<M, f32, Config = ConfigOf<Watched>>,
{
    let config = Watched::configure::<M>();
    let without = errors::<M>(&config, 0.0, 1, true);
    for (share, burst) in [(0.001, 1), (0.01, 1), (0.002, 5)] {
        let [told, untold] = [true, false].map(|told| errors::<M>(&config, share, burst, told));
        let over = |errors: [f64; 3]| [0, 1, 2].map(|k| (100.0 * errors[k] / without[k]).round() / 100.0);
        println!("{} {share} x {burst}: {:?} untold {:?}", M::DUTY.name, over(told), over(untold));
        // the targets: 1.2 for a thousandth, 1.5 for a hundredth and for bursts
        let most = if share * f64::from(burst) > 0.002 { 1.5 } else { 1.2 };
        assert!(over(told).iter().all(|&ratio| ratio <= most), "{} {share} x {burst}", M::DUTY.name);
        // the test sees the gaps
        assert!(!seen || over(untold).iter().any(|&ratio| ratio > most), "{} {share} x {burst}", M::DUTY.name);
    }
}

#[test]
fn ticks_that_did_not_run_leave_the_errors_and_are_flagged() {
    survey::<Hoist>(true);
    survey::<Mill>(true);
    survey::<Spindle>(true);
    // its observer leaves out a vibration of 30 Hz, whose errors are as large
    survey::<Crane>(false);
    survey::<Set>(true);
    survey::<Winder>(true);
}
