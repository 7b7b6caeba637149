//! Cylinders from the teeth of a simulated engine: one at 80 %, one that misfires, and none.
//!
//! The engine is not the library's: its combustion is a half sine from 5 to 140 degrees behind the dead centre, and
//! compression, expansion and the masses' torque are added. The speed follows from the energy, `J omega^2/2`, in closed
//! form at any angle.

use std::f64::consts::TAU;

use driveline::fluctuation::{CylinderReading, CylinderVerdict, Engine, ToothErrors, ToothWindow};
use driveline::settings::{Teeth, ToothClock};
use driveline::wheel::{Cam, CycleTimes, ToothedWheel, ToothedWheelConfig};

use crate::wheel::edges::Random;

/// Points of a cycle of 720 degrees.
const POINTS: usize = 360;

struct Simulated {
    cylinders: usize,
    inertia: f64,
    /// Mean torque (N m).
    torque: f64,
    speed: f64,
    /// Standard deviation of a single combustion, relative.
    combustion: f64,
    /// Of an edge's place (degree).
    edge: f64,
}

/// Combustion torque of a cylinder over its mean, at so many degrees behind its dead centre.
fn combustion(degrees: f64) -> f64 {
    let part = (degrees - 5.0) / 135.0;
    // A half sine over 135 of 720 degrees has a mean of 2/pi of that.
    if (0.0..1.0).contains(&part) { (part * TAU / 2.0).sin() * 720.0 / 135.0 * TAU / 4.0 } else { 0.0 }
}

/// Torque of compression, expansion and the masses, over the mean torque of a cylinder: odd about the dead centre.
fn motored(degrees: f64, speed: f64) -> f64 {
    let radians = degrees.to_radians();
    let gas = 8.0 * radians.sin() * (-(degrees.min(720.0 - degrees) / 40.0).powi(2)).exp();
    gas - 3.0 * (speed / 300.0).powi(2) * (2.0 * radians).sin()
}

impl Simulated {
    /// The verdicts of windows of eight cycles each, with these strengths of the cylinders in the order of firing.
    fn windows(&self, strengths: &[f64], windows: usize, seed: u64) -> Vec<Vec<CylinderReading>> {
        match self.cylinders {
            4 => self.of::<4>(strengths, [1, 3, 4, 2], windows, seed),
            _ => self.of::<6>(strengths, [1, 5, 3, 6, 2, 4], windows, seed),
        }
    }

    fn of<const Z: usize>(
        &self,
        strengths: &[f64],
        order: [u8; Z],
        windows: usize,
        seed: u64,
    ) -> Vec<Vec<CylinderReading>> {
        let mut random = Random(seed);
        let config =
            ToothedWheelConfig::new(&Teeth::<58>::gap(60, 2), ToothClock { turns: 2, clock: 4e6, lowest_speed: 10.0 });
        let engine =
            Engine { firing_order: order, first: 0.0, peak: 0.9, inertia: self.inertia, coupling: None, turns: 2 };
        let mut wheel = ToothedWheel::<CycleTimes<116>>::default();
        let (mut window, mut found) = (ToothWindow::default(), Vec::new());
        let (mut time, mut energy) = (0.0, 0.5 * self.inertia * self.speed * self.speed);
        let own = self.torque / Z as f64;
        let mut last = vec![1.0; Z];
        let step = TAU * 2.0 / POINTS as f64;
        let behind =
            |point: usize, k: usize| (point as f64 * 2.0 + 1.0 - 720.0 * k as f64 / Z as f64).rem_euclid(720.0);
        let sum = |point: usize| (0..Z).map(|k| motored(behind(point, k), self.speed)).sum::<f64>();
        let motored: Vec<f64> = (0..POINTS).map(sum).collect();
        // The cylinders that burn at a point, with their torque, and whether it began in the last cycle.
        let burning = |point: usize| {
            let all =
                (0..Z).map(move |k| (k, combustion(behind(point, k)), behind(point, k) > point as f64 * 2.0 + 1.0));
            all.filter(|burning| burning.1 > 0.0).collect()
        };
        let burning: Vec<Vec<(usize, f64, bool)>> = (0..POINTS).map(burning).collect();
        for cycle in 0..100 * windows {
            // The load takes the mean away and holds the speed.
            let held = 0.5 * self.inertia * self.speed * self.speed;
            let now: Vec<f64> = strengths.iter().map(|s| s * (1.0 + self.combustion * random.normal())).collect();
            let load = own * strengths.iter().sum::<f64>() + 0.2 * (energy - held) / (2.0 * TAU);
            for point in 0..POINTS {
                if point % 3 == 0 && point / 3 % 60 < 58 && cycle + point > 0 {
                    let late = self.edge * random.normal() / 360.0 * TAU / self.speed;
                    wheel.tooth(&config, ((time + late + 0.01) * 4e6) as u32);
                    if let Some(taken) = wheel.take()
                        && wheel.has_phase()
                    {
                        window.add(&config, &taken);
                    }
                }
                if point == 50 {
                    // A cam shows the turn: an edge 100 degrees behind the first cylinder's dead centre.
                    wheel.cam(&config, &Cam::degrees(2, [100.0], 30.0), ((time + 0.01) * 4e6) as u32);
                }
                let burnt =
                    |(k, torque, before): &(usize, f64, bool)| torque * if *before { last[*k] } else { now[*k] };
                let torque = own * (motored[point] + burning[point].iter().map(burnt).sum::<f64>());
                let before = (2.0 * energy / self.inertia).sqrt();
                energy += (torque - load) * step;
                time += 2.0 * step / (before + (2.0 * energy / self.inertia).sqrt());
            }
            last = now;
            if window.cycles() == 8 {
                let ripple = window.ripple(&config, &ToothErrors::NONE, Z);
                found.push(ripple.unwrap().cylinders(&engine, load, 116).to_vec());
                window = ToothWindow::default();
            }
            if found.len() == windows {
                break;
            }
        }
        found
    }
}

fn engines() -> Vec<Simulated> {
    let mut engines = Vec::new();
    for cylinders in [4, 6] {
        // Idle with a tenth of the torque, part load, and 3000 r/min.
        for (rpm, torque) in [(700.0, 25.0), (1500.0, 120.0), (3000.0, 150.0)] {
            let speed = rpm / 60.0 * TAU;
            engines.push(Simulated { cylinders, inertia: 0.25, torque, speed, combustion: 0.03, edge: 0.01 });
        }
    }
    engines
}

#[test]
fn a_weak_cylinder_and_a_misfire_are_found() {
    for engine in engines() {
        for place in 0..engine.cylinders {
            for (strength, verdict) in [(0.8, CylinderVerdict::Weak), (0.0, CylinderVerdict::Misfire)] {
                let mut strengths = vec![1.0; engine.cylinders];
                strengths[place] = strength;
                let windows = engine.windows(&strengths, 50, 1 + place as u64);
                let right = |cylinders: &&Vec<CylinderReading>| {
                    cylinders.iter().enumerate().all(|(k, cylinder)| {
                        cylinder.verdict == if k == place { verdict } else { CylinderVerdict::Good }
                    })
                };
                let good = windows.iter().filter(right).count();
                let at = engine.speed / TAU * 60.0;
                let told = format!("{} at {at}: {good} of 50, {:?}", engine.cylinders, windows[1]);
                println!("{told}");
                // 99 %: of 50 one may be wrong.
                assert!(good >= 49, "{told}");
            }
        }
    }
}

/// Windows of eight cycles, for each of six engines: 100,000 cycles.
const WINDOWS: usize = 2083;

/// Engines without a fault.
#[test]
#[ignore = "minutes where the library is not optimised"]
fn an_even_engine_has_no_weak_cylinder() {
    for engine in engines() {
        let windows = engine.windows(&vec![1.0; engine.cylinders], WINDOWS, 9);
        // Where it is uncertain there is no false one.
        let faulty = |c: &CylinderReading| matches!(c.verdict, CylinderVerdict::Weak | CylinderVerdict::Misfire);
        let bad = windows.iter().filter(|cylinders| cylinders.iter().any(faulty));
        assert_eq!(bad.count(), 0, "{} at {}", engine.cylinders, engine.speed);
    }
}

/// Where the teeth scatter too much there is no verdict: two deviations are more than a tenth.
#[test]
fn scatter_gives_no_verdict() {
    let engine = Simulated { cylinders: 4, inertia: 0.25, torque: 120.0, speed: 150.0, combustion: 0.03, edge: 0.9 };
    let windows = engine.windows(&[1.0; 4], 20, 3);
    let uncertain = |cylinder: &CylinderReading| cylinder.verdict == CylinderVerdict::Uncertain;
    assert!(windows.iter().flatten().all(|cylinder| uncertain(cylinder) == (cylinder.deviation >= 0.05)));
    assert!(windows.iter().any(|cylinders| cylinders.iter().all(uncertain)), "{windows:?}");
}
