//! Every cycle's extremes and mean: of a published punch press, and through the real drive.

use core::f64::consts::TAU;

use driveline::fluctuation::{CycleConfig, Extremes, Fluctuation};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle};

use super::motion::{Motion, Part};
use super::rig::{Built, InDouble, PERIOD, RATED, run};
use crate::references::data;

const PARTS: [Part; 2] = [Part { n: 1.0, amplitude: 0.03, phase: 0.7 }, Part { n: 2.0, amplitude: 0.025, phase: -1.1 }];

/// The angle as finely as it is held: no encoder.
fn exact(phi: f64) -> u32 {
    (phi / TAU * 4_294_967_296.0).floor() as i64 as u32
}

/// The punch press of the reference cases: its speed falls by a third at a corner and rises at another. Between samples
/// that are four ticks apart a corner is known to what the speed changes in two: 280 N m on 1.8 kg m2 in 0.2 ms is
/// 0.031 rad/s of 3.4, one per cent, which the parabola halves.
#[test]
fn the_punch_press_of_the_reference_cases() {
    let document = data("speed_fluctuation.json");
    let press = &document["cases"][0];
    let number = |key: &str| press[key].as_f64().unwrap();
    let wave: Vec<[f64; 3]> = serde_json::from_value(press["wave"].clone()).unwrap();
    let [a, b]: [f64; 2] = serde_json::from_value(press["motor_line_a_b"].clone()).unwrap();
    let inertia = number("J_const_kg_m2");
    let load = &press["load"];
    let idle = load["M0"].as_f64().unwrap();
    let working = idle + load["M1"].as_f64().unwrap();
    let (from, to) = (load["p1"].as_f64().unwrap(), load["p2"].as_f64().unwrap());
    // The machine itself, in steps of 10 us; the load switches within a step, which is 0.0001 rad.
    let config = CycleConfig::new(Cycle::TURN, PERIOD, Bases::SI);
    let mut extremes = Extremes::<f64>::default();
    let (mut phi, mut speed) = (0.0, wave[0][2]);
    while extremes.cycles() < 4 {
        for _ in 0..10 {
            let at = |phi: f64, speed: f64| {
                let place = phi.rem_euclid(TAU);
                let torque = if place >= from && place < to { working } else { idle };
                (a - b * speed - torque) / inertia
            };
            let half = speed + 5e-6 * at(phi, speed);
            let next = speed + 1e-5 * at(phi + 5e-6 * speed, half);
            phi += 1e-5 * half;
            speed = next;
        }
        let estimate = Estimate { motor_speed: speed, load_speed: speed, ..Estimate::default() };
        extremes.measure(&config, exact(phi), 0.0, &estimate);
    }
    let reading = extremes.reading(&config).unwrap();
    assert!((reading.mean / number("w_mean_time_rad_s") - 1.0).abs() < 1e-4, "{reading:?}");
    assert!((reading.duration / number("cycle_time_s") - 1.0).abs() < 1e-4, "{reading:?}");
    for fluctuations in [reading.motor, reading.load] {
        // A parabola over a level that breaks off into a fall of 0.062 rad/s in four ticks stands above it by an eighth
        // of that at most; a corner that points downwards is missed by a quarter of it either way.
        assert!((fluctuations.max.speed - number("w_max_rad_s")).abs() < 0.008, "{reading:?}");
        assert!((fluctuations.min.speed - number("w_min_rad_s")).abs() < 0.016, "{reading:?}");
        assert!((fluctuations.arithmetic_mean / number("w_mean_arithmetic_rad_s") - 1.0).abs() < 5e-4);
        // Both together are 0.7 % of the swing.
        assert!((fluctuations.delta / number("delta_time_mean") - 1.0).abs() < 7e-3, "{reading:?}");
        assert!((fluctuations.delta_arithmetic / number("delta_arithmetic_mean") - 1.0).abs() < 7e-3, "{reading:?}");
        // The level's last sample is up to four ticks before the corner, and the vertex up to half of that before it: 7
        // mrad.
        assert!((fluctuations.max.angle - number("phi_at_w_max_rad")).abs() < 7e-3, "{reading:?}");
        assert!((fluctuations.min.angle - number("phi_at_w_min_rad")).abs() < 4e-3, "{reading:?}");
    }
}

/// Through the drive the speeds are the observer's. One that follows 3000 N m of load within a tenth of a second shows
/// a ripple of 12.5 and 25 Hz, which takes as much, within 5 % of delta at the motor; of the load's, a third. The
/// waveform has neither error.
#[test]
fn through_the_drive() {
    let config = f32::constants(Cycle::FOUR_STROKE, 16);
    let mut motion = Motion::new(RATED, 0.0, 2.0, &PARTS);
    let mut seen = Vec::new();
    run::<f32>(&config, &mut motion, 15_000, |drive| {
        seen.extend(drive.fluctuation().0.reading(&config.fluctuation.0));
        false
    });
    let reading = seen.last().unwrap().in_double();
    let (swing, ..) = motion.swing();
    // The two ends of a cycle of 16,384 counts, each to half a count.
    assert!((reading.mean / (RATED * motion.mean_by_time()) - 1.0).abs() < 1.0 / 16_384.0, "{reading:?}");
    assert!((reading.motor.delta / swing - 1.0).abs() < 0.05, "{reading:?} {swing}");
}
