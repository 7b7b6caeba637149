//! A made-up report with everything in it: good and bad variants, courses, samples, budgets.

use driveline_report::{
    Budget, Deviation, Fact, Instructions, Mark, Report, Sample, Sampled, Signal, Trajectory, Variant,
};

pub fn report() -> Report {
    let fact = |name: &str, value: &str| Fact { name: name.into(), value: value.into() };
    Report {
        scene: "hoist".into(),
        summary:
            "A 12 t bridge-crane hoist, observed and governed from the motor's encoder alone, in closed loop with the \
                  full solver of the machine. (Made-up figures of a test.)"
                .into(),
        facts: vec![
            fact("motor inertia", "0.62 kg m²"),
            fact("shaft", "50 kN m/rad"),
            fact("ratio", "31.5"),
            fact("load", "12 t"),
            fact("encoder", "2048 lines"),
            fact("torque noise", "1 %"),
            fact("first resonance", "41.2 Hz"),
            fact("time simulated", "12 s"),
        ],
        samples: vec![sampled()],
        variants: variants(),
        trajectories: trajectories(),
        budgets: vec![
            budget("exact step, m4f, f32", "instructions", 61.0, 70.0),
            budget("exact step, m3, fixed", "instructions", 97.0, 110.0),
            budget("whole tick, m4f, f32", "instructions", 143.0, 150.0),
            budget("tick code and constants", "byte", 1_612.0, 1_536.0),
            budget("stack, f32", "byte", 56.0, 64.0),
        ],
        notes: vec!["These figures are made up: they show what a page looks like.".into()],
    }
}

fn budget(name: &str, unit: &str, measured: f64, limit: f64) -> Budget {
    Budget { name: name.into(), unit: unit.into(), measured, limit }
}

fn variants() -> Vec<Variant> {
    let mut variants = Vec::new();
    for (number, core, cost, noise) in
        [("f32", "m4f", 1.0, 1.0), ("fixed", "m4f", 0.85, 1.02), ("fixed", "m3", 0.9, 1.02)]
    {
        for (observer, work, error) in [("rigid", 62, 0.21), ("cut", 138, 0.052), ("reduced", 139, 0.0086)] {
            for (rate_hz, slow) in [(1_000, 2.6), (4_000, 1.35), (10_000, 1.0)] {
                let median = (f64::from(work) * cost) as u64;
                let error = error * noise * slow;
                variants.push(Variant {
                    number: number.into(),
                    core: core.into(),
                    observer: observer.into(),
                    rate_hz,
                    shaft_torque: Deviation { rms: error, max: error * 4.2 },
                    load_speed: Deviation { rms: error * 0.11, max: error * 0.5 },
                    load_torque: Deviation { rms: error * 1.9, max: error * 7.0 },
                    instructions: Instructions { min: median - 9, median, max: median + 11 },
                    cycles: Some([median * 16 / 10, median * 19 / 10]),
                    flash_bytes: 700 + median * 5,
                    ram_bytes: 96,
                    stack_bytes: 48,
                    bit_exact: true,
                    ticks: u64::from(rate_hz) * 12,
                });
            }
        }
    }
    variants
}

fn trajectories() -> Vec<Trajectory> {
    let time: Vec<f64> = (0..24_000).map(|n| f64::from(n) * 5e-4).collect();
    let mut all = Vec::new();
    for (observer, wrong) in [("reduced", 0.02), ("cut", 0.1), ("rigid", 0.5)] {
        for (situation, start) in [("load step and lowering", 2.0), ("slack rope", 4.0)] {
            let ring = |t: f64, from: f64, hz: f64, decay: f64| {
                if t < from {
                    0.0
                } else {
                    (-(t - from) * decay).exp() * ((t - from) * hz * std::f64::consts::TAU).sin()
                }
            };
            let step = |t: f64| {
                if t < start {
                    60.0
                } else if t < 8.0 {
                    96.0
                } else {
                    48.0
                }
            };
            let torque = |t: f64| {
                step(t) + 70.0 * ring(t, 0.05, 6.0, 2.0) + 40.0 * ring(t, start, 6.0, 1.4)
                    - 55.0 * ring(t, 8.0, 6.0, 1.1)
            };
            let speed = |t: f64| {
                104.0 * (1.0 - (-t * 2.4).exp()) - 9.0 * ring(t, start, 6.0, 1.4) + 7.0 * ring(t, 8.0, 6.0, 1.1)
            };
            let made = |truth: &dyn Fn(f64) -> f64, size: f64| Signal {
                truth: time.iter().map(|&t| truth(t)).collect(),
                estimate: time
                    .iter()
                    .enumerate()
                    .map(|(n, &t)| {
                        truth(t - 0.01 * wrong)
                            + size
                                * wrong
                                * (0.1 * ((n * 7_919 % 1_000) as f64 / 500.0 - 1.0) + ring(t, start, 4.0, 0.8))
                    })
                    .collect(),
            };
            let mark = |time: f64, label: &str| Mark { time, label: label.into() };
            all.push(Trajectory {
                variant: format!("f32 · m4f · {observer} · 10 kHz"),
                situation: situation.into(),
                shaft_torque: made(&torque, 60.0),
                load_speed: made(&speed, 8.0),
                load_torque: made(&step, 50.0),
                time: time.clone(),
                marks: vec![mark(0.05, "pretensioned start"), mark(start, "load step +50 %"), mark(8.0, "lowering")],
            });
        }
    }
    all
}

fn sampled() -> Sample {
    let error = |nominal: f64| Sampled { nominal, median: 5.0 * nominal, p90: 8.0 * nominal };
    Sample {
        variant: "hoist/f32/reduced/10000".into(),
        run: "a lift".into(),
        draws: 10,
        seed: 1,
        unstable: 0,
        shaft_torque: error(0.002),
        load_speed: error(0.003),
        load_torque: error(0.006),
    }
}
