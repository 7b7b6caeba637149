//! Deltas beside their standard deviations: two of these hold the truth in 95 of 100 runs, and no delta of which three
//! are within 5 % is off by more than 5 %.
//!
//! The truth is the speed that the run was made from, over a fine grid.

use core::f64::consts::TAU;

use driveline::fluctuation::{CycleConfig, Extremes, Fluctuation, Fluctuations, ToothErrors, ToothWindow};
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle, Teeth, ToothClock};
use driveline::wheel::{CycleTimes, ToothedWheel, ToothedWheelConfig};

use crate::balance::noise::Noise;

/// Orders of the speed over its mean by the angle: amplitude and phase.
struct Wave([(f64, f64); 4]);

impl Wave {
    /// Some of four orders, with a swing from peak to peak.
    fn random(swing: f64, noise: &mut Noise) -> Self {
        let mut wave = Wave([(); 4].map(|()| (f64::max(0.0, noise.even() - 0.3), TAU * noise.even())));
        wave.0[1].0 += 0.2;
        let [largest, least] = wave.extremes();
        wave.0.iter_mut().for_each(|order| order.0 *= swing / (largest - least));
        wave
    }

    fn at(&self, angle: f64) -> f64 {
        (1..)
            .zip(self.0)
            .fold(1.0, |sum, (n, (amplitude, phase))| sum + amplitude * (f64::from(n) * angle - phase).cos())
    }

    fn grid(&self) -> impl Iterator<Item = f64> {
        (0..4000).map(|at| self.at(TAU * f64::from(at) / 4000.0))
    }

    fn extremes(&self) -> [f64; 2] {
        [self.grid().fold(f64::MIN, f64::max), self.grid().fold(f64::MAX, f64::min)]
    }

    /// (max - min) over the mean by time.
    fn delta(&self) -> f64 {
        let [largest, least] = self.extremes();
        (largest - least) * self.grid().map(|speed| 1.0 / speed).sum::<f64>() / 4000.0
    }
}

#[derive(Default)]
struct Judged {
    runs: u32,
    within: u32,
    usable: u32,
    worst: f64,
}

impl Judged {
    fn add(&mut self, found: Fluctuations, truth: f64) {
        let off = (found.delta - truth).abs();
        self.runs += 1;
        self.within += u32::from(off <= 2.0 * found.deviation);
        if 3.0 * found.deviation <= 0.05 * found.delta {
            self.usable += 1;
            self.worst = self.worst.max(off / truth);
        }
    }

    fn holds(&self, name: &str) {
        let Judged { runs, within, usable, worst } = self;
        println!("{name}: {within} of {runs} within two deviations; {usable} usable, the worst off by {worst:.4}");
        assert!(100 * within >= 95 * runs && *worst <= 0.05, "{name}: {within} of {runs}, {worst}");
        // not by a deviation that is never small
        assert!(10 * usable >= *runs, "{name}: {usable} of {runs}");
    }
}

/// The time that each tooth passes at, by Simpson's rule over the slowness, rounded down to a count of the clock.
fn by_teeth(
    wave: &Wave,
    speed: f64,
    clock: f64,
    [cycles, orders]: [u32; 2],
    noise: &mut Noise,
) -> Option<Fluctuations> {
    let config = ToothedWheelConfig::<58>::new(&Teeth::gap(60, 2), ToothClock { turns: 1, clock, lowest_speed: 2.0 });
    let (mut wheel, mut window) = (ToothedWheel::<CycleTimes<58>>::default(), ToothWindow::<58>::default());
    let step = TAU / 60.0;
    let (mut time, mut times) = (0.0, [0.0; 60]);
    for (tooth, at) in (0..).zip(&mut times) {
        *at = time;
        for part in 0..8 {
            let slow = |x: f64| 1.0 / wave.at(step * (f64::from(tooth) + (f64::from(part) + x) / 8.0));
            time += (slow(0.0) + 4.0 * slow(0.5) + slow(1.0)) / 6.0 * step / 8.0;
        }
    }
    let start = noise.even();
    for turn in 0..cycles + 6 {
        for at in &times[..58] {
            let passed = start + (f64::from(turn) * time + at) / speed;
            wheel.tooth(&config, (passed * clock) as u64 as u32);
            if let Some(cycle) = wheel.take() {
                window.add(&config, &cycle);
            }
            if window.cycles() == cycles {
                return window.ripple(&config, &ToothErrors::NONE, orders as usize).ok().map(|ripple| ripple.motor);
            }
        }
    }
    None
}

#[test]
fn by_teeth_on_clocks_of_1_to_50_microseconds() {
    for (name, window) in [("8 cycles, 8 orders", [8, 8]), ("8 cycles, 4 orders", [8, 4]), ("a cycle", [1, 8])] {
        let (mut noise, mut judged) = (Noise::new(71), Judged::default());
        while judged.runs < 200 {
            let wave = Wave::random(0.002 * 100_f64.powf(noise.even()), &mut noise);
            let (speed, clock) = (20.0 * 20_f64.powf(noise.even()), 1e6 / 50_f64.powf(noise.even()));
            // a wheel that is too fast for its clock gives nothing
            if let Some(found) = by_teeth(&wave, speed, clock, window, &mut noise) {
                judged.add(found, wave.delta());
            }
        }
        judged.holds(name);
    }
}

/// Estimated speeds with noise of a known deviation, alike over up to 60 ticks, as an observer's is.
#[test]
fn by_extremes_of_noisy_speeds() {
    let mut noise = Noise::new(72);
    let mut judged = Judged::default();
    while judged.runs < 300 {
        let swing = 0.002 * 50_f64.powf(noise.even());
        let (wave, ticks) = (Wave::random(swing, &mut noise), 160.0 * 12_f64.powf(noise.even()));
        let mean = TAU / ticks / 1e-4;
        let deviation = 0.0025 * 100_f64.powf(noise.even()) * swing * mean;
        let alike = (-1.0 / (60.0 * noise.even() * noise.even())).exp();
        let config = CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI);
        let mut extremes = Extremes::<f64>::default();
        let (mut angle, mut off) = (TAU * noise.even(), 0.0);
        while extremes.cycles() < 2 {
            angle += TAU / ticks;
            off = alike * off + (1.0 - alike * alike).sqrt() * noise.normal();
            let load_speed = mean * wave.at(angle) + deviation * off;
            let estimate = Estimate { motor_speed: mean, load_speed, ..Estimate::default() };
            let turned = (angle / TAU).fract() * 4_294_967_296.0;
            extremes.measure(&config, turned as u32, 0.0, &estimate);
        }
        let [largest, least] = wave.extremes();
        let reading = extremes.reading(&config).unwrap();
        assert_eq!(reading.load.deviation, f64::INFINITY);
        judged.add(reading.with_noise(&config, [0.0, deviation]).load, largest - least);
    }
    judged.holds("extremes");
}
