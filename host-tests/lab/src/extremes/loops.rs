//! The drive in time: dead times above the period, bursts of missed ticks, sensors at the end of their range.

use std::f64::consts::TAU;

use driveline::balancing::{Balancer, Phasors, PhasorsConfig};
use driveline::design::{Actuator, Disturbance, Encoder, LoadFeedForward, Rate};
use driveline::drive::{Config, ConfigOf, Drive, Limits};
use driveline::fault::Faults;
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
use driveline::observer::{TwoMassConfig, TwoMassObserver};
use driveline::sample::Sample;
use driveline::settings::{Bases, PhasorSettings, Screening};
use driveline_solver::plant::train::{Coordinate, Link, Motion, Source, Train};

use super::solver::said;
use super::{Cases, Found};

pub(super) fn add(all: &mut Cases) {
    all.subject("dead time above the period", "gain margin, relative", "own simulation, bisected for the gain");
    for (ticks, factor) in [(0.5, 2.0), (1.0, 2.0), (2.5, 2.0), (5.0, 2.0), (10.5, 2.0), (20.0, 2.0)]
        .into_iter()
        .chain([(50.0, 2.0), (50.0, 4.0), (200.0, 2.0), (200.0, 1.2), (20.0, 1.01), (50.0, 1.0)])
    {
        all.case(format!("{ticks} periods, optimum factor {factor}"), || dead_time(ticks, factor));
    }
    all.subject("bursts of missed ticks", "shaft torque after the burst, of its peak", "full solver");
    for missed in [1, 2, 4, 7, 8, 9, 16, 40, 160, 400, 1000] {
        all.case(format!("{missed} ticks of 0.1 ms, a vibration of 61 Hz"), || burst(missed));
    }
    all.subject("saturated sensor", "amplitude, relative; shaft torque, of its peak", "the vibration as it was made");
    for peak in [0.5, 0.9, 0.99, 0.999_999, 1.0, 1.001, 1.1, 2.0, 100.0] {
        all.case(format!("vibration of {peak} of the range"), || clipped(peak));
    }
    for peak in [0.5, 0.99, 1.01, 1.5, 5.0] {
        all.case(format!("torque of {peak} of the sensor's range"), || torque_sensor(peak));
    }
}

const STIFF: TwoMass = TwoMass::new(Inertia(4.0), Inertia(8.0), Stiffness(5e9), Damping(6e5));

/// The gain at which the loop becomes unstable: twenty steps to the period, torque held for a tick and late by a tick
/// and the dead time. The machine is one mass, so that the shaft's 7 kHz are left out.
fn dead_time(ticks: f64, factor: f64) -> Result<Found, String> {
    const STEPS: usize = 20;
    let period = 1e-3;
    let actuator = Actuator { delay: ticks * period, lag: 0.0 };
    let design = STIFF.try_governor(Rate::hz(1000), actuator, factor, LoadFeedForward::NONE).map_err(said)?;
    let late = STEPS + (ticks * STEPS as f64).round() as usize;
    let grows = |gain: f64| {
        let (mut speed, mut sum, mut held) = (1.0_f64, 0.0, 0.0);
        let mut pipe = std::collections::VecDeque::from(vec![0.0; late]);
        let windows = [100, 200].map(|delays| (f64::from(delays) * (ticks + 1.5)) as usize);
        let mut largest = [0.0_f64; 2];
        for tick in 0..windows[1] {
            for step in 0..STEPS {
                if step == 0 {
                    sum += design.integral * period * -speed;
                    held = gain * (sum - design.proportional * speed);
                }
                pipe.push_back(held);
                speed += pipe.pop_front().unwrap_or(0.0) / STIFF.total_inertia() * period / STEPS as f64;
            }
            let window = usize::from(tick > windows[0]);
            if tick > windows[0] / 2 {
                largest[window] = largest[window].max(speed.abs());
            }
        }
        largest[1] > largest[0]
    };
    let (mut low, mut high) = (1.0, 20.0);
    if grows(low) {
        return Ok(Found { error: f64::NAN, limit: 0.0 });
    }
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if grows(middle) { high = middle } else { low = middle }
    }
    // the library's dead time is in continuous time: between two ticks its margin is too small by the reciprocal of
    // |1 - f + f exp(-j w T)|, with f the fraction of a tick and w about a quarter of a turn in the whole delay
    let (fraction, turned) = (ticks.fract(), 0.25 * TAU / (ticks + 1.5));
    let short = (1.0 - 2.0 * fraction * (1.0 - fraction) * (1.0 - turned.cos())).sqrt();
    let ratio = design.margins(&STIFF).gain_up / low;
    Ok(Found { error: (ratio - 1.0).abs(), limit: if ratio > 1.0 { 0.02 } else { 1.02 - short } })
}

const SOFT: TwoMass = TwoMass::new(Inertia(2.0), Inertia(4.0), Stiffness(2e5), Damping(0.0));
const PERIOD: f64 = 1e-4;
type Observed = Drive<f64, TwoMassObserver>;

/// An observer's drive, its torque plausible up to `torque`, at a start.
fn observed(torque: f64) -> Result<(Observed, ConfigOf<Observed>), String> {
    let disturbance = Disturbance { torque_accuracy: 0.1, load_torque_step: 30.0, within: 0.3 };
    let design = SOFT.try_observer(Rate::hz(10_000), Encoder::counts(1 << 20), disturbance).map_err(said)?;
    let screening = Screening { torque, setpoint: 200.0, innovation: 0.05, frozen_turn: 1.5e-3, max_coast: 150 };
    let config = Config {
        limits: Limits::<f64>::new(&screening, Bases::SI),
        observer: TwoMassConfig::<f64>::new(&design, Bases::SI),
        fluctuation: (),
        governor: (),
        balancer: (),
    };
    Ok((Observed::new(&config, 0), config))
}

/// Two masses that a torque on the motor swings.
fn swung(torque: f64) -> Result<Motion, String> {
    let train = Train::new()
        .coordinate(Coordinate::new(2.0).source(Source::Constant(torque)))
        .coordinate(Coordinate::new(4.0))
        .link(Link::shaft(0, 1, 2e5));
    train.build().map_err(said)
}

fn seen(plant: &Motion) -> u32 {
    ((plant.angle(0) / TAU * 1_048_576.0).floor() as i64 as u32) << 12
}

/// After 0.5 s of a swing so many ticks do not run. Within five of the observer's own errors before the burst.
fn burst(missed: u32) -> Result<Found, String> {
    let torque = 300.0;
    let (mut drive, config) = observed(400.0)?;
    let mut plant = swung(torque)?;
    let sample = |plant: &Motion| Sample { angle: seen(plant), torque, setpoint: 0.0 };
    // undamped: up to twice the torque that accelerates the load
    let peak = 2.0 * torque * 4.0 / 6.0;
    let off = |drive: &Observed, plant: &Motion| (drive.estimate(&config).shaft_torque - plant.force(0)).abs() / peak;
    let mut before = 0.0_f64;
    for tick in 0..5000 {
        plant.advance(PERIOD);
        drive.tick(&config, &sample(&plant));
        if tick > 3000 {
            before = before.max(off(&drive, &plant));
        }
    }
    plant.advance(PERIOD * f64::from(missed + 1));
    let mut faults = drive.tick_after(&config, &sample(&plant), missed).faults;
    let mut after = off(&drive, &plant);
    for _ in 0..200 {
        plant.advance(PERIOD);
        faults |= drive.tick(&config, &sample(&plant)).faults;
        after = after.max(off(&drive, &plant));
    }
    if faults.intersects(Faults::ANGLE_MISSING | Faults::ANGLE_LOST | Faults::ANGLE_JUMP) {
        return Err(format!("flagged: {faults}"));
    }
    if !faults.contains(Faults::TICK_MISSED) {
        return Ok(Found { error: f64::NAN, limit: 0.0 });
    }
    Ok(Found { error: after, limit: 5.0 * before })
}

/// The motor's torque by a sensor that ends at its range, an eighth above the largest plausible torque.
fn torque_sensor(peak: f64) -> Result<Found, String> {
    let range = 450.0;
    let (mut drive, config) = observed(400.0)?;
    let mut plant = swung(peak * range)?;
    let largest = 2.0 * peak * range * 4.0 / 6.0;
    let (mut faults, mut squares) = (Faults::NONE, 0.0);
    for tick in 0..5000 {
        plant.advance(PERIOD);
        let sample = Sample { angle: seen(&plant), torque: (peak * range).min(range), setpoint: 0.0 };
        faults |= drive.tick(&config, &sample).faults;
        if tick > 3000 {
            squares += ((drive.estimate(&config).shaft_torque - plant.force(0)) / largest).powi(2);
        }
    }
    // the aim of a tight shaft, rms
    if faults.is_none() {
        Ok(Found { error: (squares / 2000.0_f64).sqrt(), limit: 0.02 })
    } else {
        Err(format!("flagged: {faults}"))
    }
}

/// Sixteen turns of a vibration once a turn, 50.3 ticks each, by a sensor that ends at its range.
fn clipped(peak: f64) -> Result<Found, String> {
    let config = PhasorsConfig::<f32, 1>::new(&PhasorSettings { turns: 16, ..PhasorSettings::DIRECT }, [1.0]);
    let mut phasors = Phasors::<1, 9, f32>::default();
    for tick in 0..50_000 {
        let turned = f64::from(tick) / 50.3;
        let value = (peak * (TAU * turned + 0.4).cos()).clamp(-1.0, 1.0);
        phasors.measure(&config, (turned.fract() * 4_294_967_296.0) as u32, &[value as f32]);
        if phasors.is_complete() {
            break;
        }
    }
    let reading = phasors.reading(&config, 0).map_err(said)?;
    Ok(Found { error: (f64::from(reading.phasor.amplitude()) / peak - 1.0).abs(), limit: 0.005 })
}
