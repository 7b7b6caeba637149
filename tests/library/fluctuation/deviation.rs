//! Deltas beside their standard deviations: two of these hold the truth in 95 of 100 runs, and no delta of which three
//! are within 5 % is off by more than 5 %.
//!
//! The truth is the speed that the run was made from, over a fine grid.

use core::f64::consts::TAU;

use driveline::design::{Disturbance, Encoder, Rate, TwoMassDesign};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::fluctuation::{
    CycleConfig, Drivetrain, Extremes, Fluctuation, Fluctuations, SpeedErrors, ToothErrors, ToothWindow, Waveform,
    WaveformConfig,
};
use driveline::machine::{Damping, Inertia, Rigid, Stiffness, TwoMass};
use driveline::number::Part;
use driveline::observer::{Observer, RigidConfig, RigidObserver, TwoMassConfig, TwoMassObserver};
use driveline::sample::{Estimate, Sample};
use driveline::settings::{Bases, Cycle, Screening, Teeth, ToothClock};
use driveline::wheel::{CycleTimes, ToothedWheel, ToothedWheelConfig};

use super::rig::InDouble;
use crate::noise::Noise;
use crate::runge_kutta;

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

    /// At least this share is usable: not by a deviation that is never small.
    fn holds(&self, name: &str, least: f64) {
        let Judged { runs, within, usable, worst } = self;
        println!("{name}: {within} of {runs} within two deviations; {usable} usable, the worst off by {worst:.4}");
        assert!(100 * within >= 95 * runs && *worst <= 0.05, "{name}: {within} of {runs}, {worst}");
        assert!(f64::from(*usable) >= least * f64::from(*runs), "{name}: {usable} of {runs}");
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
        judged.holds(name, 0.1);
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
        let mut extremes = Extremes::<f32>::default();
        let (mut angle, mut off) = (TAU * noise.even(), 0.0);
        while extremes.cycles() < 2 {
            angle += TAU / ticks;
            off = alike * off + (1.0 - alike * alike).sqrt() * noise.normal();
            let load_speed = mean * wave.at(angle) + deviation * off;
            let estimate = Estimate { motor_speed: mean as f32, load_speed: load_speed as f32, ..Estimate::default() };
            let turned = (angle / TAU).fract() * 4_294_967_296.0;
            extremes.measure(&config, turned as u32, 0.0, &estimate);
        }
        let [largest, least] = wave.extremes();
        let reading = extremes.reading(&config).unwrap();
        assert_eq!(reading.load.deviation, f32::INFINITY);
        let errors = SpeedErrors { noise: [0.0, deviation], lag: [[0.0; _]; 2] };
        judged.add(reading.with_errors(&config, &errors, 4).load.in_double(), largest - least);
    }
    judged.holds("extremes", 0.1);
}

/// A window of 64 bins, by an encoder of so many counts at so many ticks to the turn.
fn by_ticks(wave: &Wave, ticks: f64, counts: f64, [cycles, orders]: [u32; 2], start: f64) -> Option<Fluctuations> {
    let config = WaveformConfig::new::<64>(CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI), cycles);
    let mut waveform = Waveform::<64, f32>::default();
    let slowness = wave.grid().map(|speed| 1.0 / speed).sum::<f64>() / 4000.0;
    let (step, mut angle) = (TAU / ticks * slowness / 4.0, start);
    for _ in 0..(ticks * f64::from(cycles + 4)) as u32 {
        for _ in 0..4 {
            let middle = wave.at(angle + 0.5 * step * wave.at(angle));
            angle += step * middle;
        }
        let turned = ((angle / TAU * counts).floor() / counts).fract() * 4_294_967_296.0;
        waveform.measure(&config, turned as u32, 0.0, &Estimate { motor_speed: 1.0, ..Estimate::default() });
        if let Some(window) = waveform.take() {
            return window.ripple(&config, orders as usize).ok().map(|ripple| ripple.motor.in_double());
        }
    }
    None
}

/// Ticks and counts at random, of which one in five is a whole number of ticks to the turn, and nearly one.
#[test]
fn by_ticks_of_an_encoder() {
    for (name, orders) in [("4 orders", 4), ("8 orders", 8), ("12 orders", 12)] {
        let (mut noise, mut judged) = (Noise::new(73), Judged::default());
        while judged.runs < 150 {
            let wave = Wave::random(noise.between(0.002, 0.3), &mut noise);
            let ticks = noise.between(75.0, 1500.0);
            let whole = noise.even() < 0.4;
            let ticks = if whole { ticks.round() + 0.1 * noise.even().powi(8) } else { ticks };
            let counts = noise.between(500.0, 1e5).round();
            let cycles = noise.between(1.0, 50.0) as u32;
            if let Some(found) = by_ticks(&wave, ticks, counts, [cycles, orders], TAU * noise.even()) {
                judged.add(found, wave.delta());
            }
        }
        judged.holds(&format!("ticks, {name}"), 0.1);
    }
    // Ticks that go round the bins in 13 turns leave an order of 12 that is 15 % of this delta.
    let wave = Wave([(0.001_202_6, 5.357_4), (0.003_091_3, 0.590_9), (0.002_89, 6.107_4), (0.0, 0.0)]);
    let found = (0..8).filter_map(|start| by_ticks(&wave, 76.076, 32_768.0, [45, 12], f64::from(start)));
    for Fluctuations { delta, deviation, .. } in found {
        assert!((delta - wave.delta()).abs() < 3.0 * deviation, "{delta} +- {deviation} for {}", wave.delta());
    }
}

type Observed = Drive<f64, TwoMassObserver, (), Extremes>;

/// Two masses that a cut of a few orders loads, by Runge and Kutta's fourth order.
struct Cut {
    machine: TwoMass,
    /// Mean load torque (N m), and its orders by the angle of the load: amplitude and phase.
    level: f64,
    orders: Vec<(f64, f64)>,
    /// Angle and speed of the motor, of the load.
    state: [f64; 4],
}

impl Cut {
    fn rates(&self, [motor, motor_speed, load, load_speed]: [f64; 4], torque: f64) -> [f64; 4] {
        let TwoMass { motor_inertia, load_inertia, stiffness, damping, .. } = self.machine;
        let shaft = stiffness * (motor - load) + damping * (motor_speed - load_speed);
        let swing = (1..).zip(&self.orders).map(|(n, order)| order.0 * (f64::from(n) * load - order.1).cos());
        let cut = self.level * (1.0 + swing.sum::<f64>());
        [motor_speed, (torque - shaft) / motor_inertia, load_speed, (shaft - cut) / load_inertia]
    }

    fn advance(&mut self, torque: f64, period: f64, steps: u32) {
        let h = period / f64::from(steps);
        for _ in 0..steps {
            self.state = runge_kutta::step(self.state, h, |state| self.rates(state, torque));
        }
    }
}

/// Delta of motor and load as a drive reads them and as they are, of a random machine under a cut of so many orders;
/// none where the random observer cannot be designed or its drive has a fault.
fn of_a_cut(orders: usize, noise: &mut Noise) -> Option<([Fluctuations; 2], [f64; 2])> {
    const PERIOD: f64 = 1e-4;
    let motor = noise.between(0.05, 5.0);
    let load = motor * noise.between(0.2, 8.0);
    let resonance = noise.between(60.0, 1500.0);
    let stiffness = resonance * resonance / (1.0 / motor + 1.0 / load);
    let damping = Damping(2.0 * noise.between(0.005, 0.08) * stiffness / resonance);
    let machine = TwoMass::new(Inertia(motor), Inertia(load), Stiffness(stiffness), damping);
    let mean = TAU / PERIOD / noise.between(160.0, 2500.0);
    let lines = noise.between(1024.0, 1e6) as u32;
    let rated = (motor + load) * mean * noise.between(0.5, 5.0);
    // from an observer that is as fast as the encoder allows to one that follows in seconds
    let (step, within) = (rated * noise.between(0.02, 2.0), noise.between(0.005, 5.0));
    let disturbance = Disturbance { torque_accuracy: 0.01 * rated, load_torque_step: step, within };
    let swing = noise.between(0.05, 1.0);
    let cut = (0..orders).map(|_| (swing * f64::max(0.05, noise.even() - 0.3), TAU * noise.even())).collect();
    let design: TwoMassDesign = machine.try_observer(Rate::hz(10_000), Encoder::lines(lines), disturbance).ok()?;
    let level = 0.5 * rated;
    let mut cut = Cut { machine, level, orders: cut, state: [0.0, mean, -level / stiffness, mean] };
    let cycle = CycleConfig::new(Cycle::TURN, PERIOD, Bases::SI);
    let screening = Screening { torque: 1e9, setpoint: 1e6, innovation: 0.2, frozen_turn: 0.1, max_coast: 150 };
    let config: ConfigOf<Observed> = Config {
        limits: Limits::<f64>::new(&screening, Bases::SI),
        observer: TwoMassConfig::<f64>::new(&design, Bases::SI),
        fluctuation: cycle,
        governor: (),
        balancer: (),
    };
    let counts = f64::from(4 * lines);
    let mut drive = Observed::new(&config, 0);
    let (mut torque, mut integral, mut turn) = (level, level, 0.0);
    let none = [(f64::MAX, f64::MIN); 2];
    let (mut range, mut last, mut cycles) = (none, none, 0);
    for tick in 0..60_000 {
        cut.advance(torque, PERIOD, (resonance * PERIOD * 10.0).ceil().max(2.0) as u32);
        let [angle, motor_speed, _, load_speed] = cut.state;
        if (angle / TAU).floor() != turn {
            (turn, last, range) = ((angle / TAU).floor(), range, none);
        }
        for (range, speed) in range.iter_mut().zip([motor_speed, load_speed]) {
            *range = (range.0.min(speed), range.1.max(speed));
        }
        let counted = ((angle / TAU * counts).floor() / counts).rem_euclid(1.0) * 4_294_967_296.0;
        let faults = drive.tick(&config, &Sample { angle: counted as u32, torque, setpoint: 0.0 }).faults;
        if tick > 15_000 && faults != driveline::fault::Faults::NONE {
            return None;
        }
        // a soft speed loop, known to the observer
        integral += 0.2 * rated * PERIOD * (1.0 - motor_speed / mean);
        torque = integral + 0.25 * rated * (1.0 - motor_speed / mean);
        let is_new = core::mem::replace(&mut cycles, drive.fluctuation().cycles()) != drive.fluctuation().cycles();
        if is_new && tick > 30_000 {
            let reading = drive.fluctuation().reading(&cycle)?.with_errors(&cycle, &SpeedErrors::of(&design), orders);
            return Some(([reading.motor, reading.load], last.map(|(least, most)| (most - least) / reading.mean)));
        }
    }
    None
}

/// An observer that is too slow for the cut shows a swing that is too small or, near its bandwidth, too large.
#[test]
fn by_extremes_of_an_observer_of_any_speed() {
    for (orders, least) in [(1, 0.04), (2, 0.02), (4, 0.0)] {
        let (mut noise, mut judged) = (Noise::new(74), [(); 2].map(|()| Judged::default()));
        while judged[0].runs < 120 {
            if let Some((found, truth)) = of_a_cut(orders, &mut noise) {
                judged.iter_mut().zip(found.into_iter().zip(truth)).for_each(|(judged, (f, t))| judged.add(f, t));
            }
        }
        judged[0].holds(&format!("motor, {orders} orders"), least);
        judged[1].holds(&format!("load, {orders} orders"), 0.0);
    }
}

/// Delta of the load by the window's law, as it is read and as it is, where motor and torque have the orders that are
/// read: their products have twice as many. The shaft's twist is integrated by Runge and Kutta's fourth order.
fn behind_a_shaft(noise: &mut Noise) -> Option<(Fluctuations, f64)> {
    const PERIOD: f64 = 1e-4;
    let motor = noise.between(0.05, 5.0);
    let load = motor * noise.between(0.2, 8.0);
    let mean = noise.between(10.0, 150.0);
    // the orders lie on both sides of it
    let resonance = mean * noise.between(0.6, 40.0);
    let stiffness = resonance * resonance / (1.0 / motor + 1.0 / load);
    let damping = 2.0 * noise.between(0.005, 0.08) * stiffness / resonance;
    let wave = Wave::random(noise.between(0.002, 0.1), noise);
    let (driven, level) = (Wave::random(noise.between(0.002, 0.3), noise), motor * mean * mean);
    let force = |angle: f64| {
        let slope = (wave.at(angle + 1e-5) - wave.at(angle - 1e-5)) / 2e-5;
        level * (0.1 * driven.at(angle) - wave.at(angle) * slope)
    };
    let rates = |[angle, twist]: [f64; 2]| [mean * wave.at(angle), (force(angle) - stiffness * twist) / damping];
    let turn = TAU / mean * wave.grid().map(|speed| 1.0 / speed).sum::<f64>() / 4000.0;
    let steps = (2.0 * turn * stiffness / damping).max(4000.0);
    if steps > 1e5 {
        return None;
    }
    let (h, mut state) = (turn / steps, [0.0, force(0.0) / stiffness]);
    let (mut least, mut most) = (f64::MAX, f64::MIN);
    for step in 0..2 * steps as u32 {
        state = runge_kutta::step(state, h, rates);
        if f64::from(step) > steps {
            let [speed, rate] = rates(state);
            (least, most) = (least.min(speed - rate), most.max(speed - rate));
        }
    }
    let cycle = CycleConfig::new(Cycle::TURN, PERIOD, Bases::SI);
    let config = WaveformConfig::new::<64>(cycle, noise.between(1.0, 40.0) as u32);
    let counts = (4.0 * noise.between(512.0, 1e5)).round();
    let (mut waveform, mut angle) = (Waveform::<64, f32>::default(), TAU * noise.even());
    loop {
        let before = angle;
        for _ in 0..4 {
            angle += 0.25 * PERIOD * mean * wave.at(angle + 0.125 * PERIOD * mean * wave.at(angle));
        }
        let turned = ((angle / TAU * counts).floor() / counts).fract() * 4_294_967_296.0;
        let torque = 0.1 * level * driven.at(0.5 * (before + angle));
        waveform.measure(&config, turned as u32, torque as f32, &Estimate { motor_speed: 1.0, ..Estimate::default() });
        if let Some(window) = waveform.take() {
            let machine = Drivetrain { motor_inertia: motor, load_inertia: load, stiffness, damping };
            let side = window.ripple(&config, 4).ok()?.load_side(&cycle, &machine, &window.motor_torque(&config, 4));
            return Some((side.load.in_double(), (most - least) * turn / TAU));
        }
    }
}

#[test]
fn by_the_law_of_the_load_side() {
    let (mut noise, mut judged) = (Noise::new(75), Judged::default());
    while judged.runs < 200 {
        if let Some((found, truth)) = behind_a_shaft(&mut noise) {
            judged.add(found, truth);
        }
    }
    judged.holds("load side", 0.4);
}

/// Error of the two speeds over what an observer shows of them, while the motor swings by a tenth of a radian at a
/// frequency (rad in a tick) and the load by a share of that: by correlation over the last whole periods.
fn shown<O: Part<f64, State: Observer<f64>>>(
    observer: <O::State as Observer<f64>>::Config,
    frequency: f64,
    share: f64,
) -> [f64; 2] {
    let screening = Screening { torque: 1e9, setpoint: 1e6, innovation: 3.0, frozen_turn: 3.0, max_coast: 150 };
    let limits = Limits::<f64>::new(&screening, Bases::SI);
    let config = Config { limits, observer, fluctuation: (), governor: (), balancer: () };
    let mut drive = Drive::<f64, O>::new(&config, 0);
    let (period, settled) = ((TAU / frequency).round() as u32, 100_000);
    let mut sums = [[0.0; 2]; 2];
    for tick in 1..=settled + period {
        let (sin, cos) = (frequency * f64::from(tick)).sin_cos();
        let angle = (0.1 * sin / TAU * 4_294_967_296.0).round() as i64 as u32;
        drive.tick(&config, &Sample { angle, torque: 0.0, setpoint: 0.0 });
        if tick > settled {
            let Estimate { motor_speed, load_speed, .. } = drive.estimate(&config);
            for (sum, speed) in sums.iter_mut().zip([motor_speed, load_speed]) {
                *sum = [sum[0] + speed * cos, sum[1] + speed * sin];
            }
        }
    }
    [0, 1].map(|side| {
        let truth = 0.1 * frequency / 1e-4 * [1.0, share][side];
        let [cos, sin] = sums[side].map(|sum| 2.0 * sum / f64::from(period));
        (truth - cos).hypot(sin) / cos.hypot(sin)
    })
}

/// The lag of the settings against observers that run along a swing: never less than theirs.
#[test]
fn the_lag_is_that_of_a_running_observer() {
    let disturbance = Disturbance { torque_accuracy: 3.0, load_torque_step: 300.0, within: 0.1 };
    let (rate, encoder) = (Rate::hz(10_000), Encoder::lines(2048));
    let (motor, load, stiffness) = (0.5, 1.5, 2.0e4);
    let two = TwoMass::new(Inertia(motor), Inertia(load), Stiffness(stiffness), Damping(0.0));
    let (design, rigid) =
        (two.observer(rate, encoder, disturbance), Rigid::new(Inertia(2.0)).observer(rate, encoder, disturbance));
    let (of_two, of_one) = (SpeedErrors::of(&design), SpeedErrors::of_rigid(&rigid));
    for octave in 3..11 {
        let frequency = 0.5 * TAU / f64::from(1 << octave);
        let share = 1.0 - motor * (frequency / 1e-4).powi(2) / stiffness;
        let config = TwoMassConfig::<f64>::new(&design, Bases::SI);
        let two = shown::<TwoMassObserver>(config, frequency, share);
        let one = shown::<RigidObserver>(RigidConfig::<f64>::new(&rigid, 0.75, Bases::SI), frequency, 1.0);
        for (name, errors, found) in [("two", &of_two, two), ("one", &of_one, one)] {
            for (lag, found) in errors.lag.iter().zip(found) {
                // the table is in f32, the angle in 2^-32 turns; below the bandwidth the lag rises with the frequency
                let most = f64::from(lag[octave]);
                let is_reached = octave < 9 || found > 0.98 * most - 1e-6;
                assert!(found <= 1.001 * most + 1e-6 && is_reached, "{name} {octave}: {found} {most}");
            }
        }
    }
    // far below the bandwidth nothing lags
    assert!(of_two.lag.iter().chain(&of_one.lag).all(|lag| lag[13] < 0.01), "{of_two:?} {of_one:?}");
}
