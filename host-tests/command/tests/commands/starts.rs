//! Dynamic factors that `modes` prints, against an integration of one's own.

use std::f64::consts::{PI, TAU};

use super::bench::answered;

/// Largest change of the shaft's torque of an undamped vibration at 1 rad/s under a torque of time, by Runge-Kutta of
/// order four; the fourth power of a step of 1/2000 period is below 1e-10.
fn factor(torque: impl Fn(f64) -> f64, time: f64) -> f64 {
    let (h, mut x, mut v, mut most) = (TAU / 2000.0, 0.0_f64, 0.0_f64, 0.0_f64);
    // steps end where the torque ends, and in the middle; the amplitude after it is that of the state there
    let steps = 2.0 * (0.5 * time / h).ceil();
    let h = time / steps;
    for step in 0..steps as u32 {
        let t = h * f64::from(step);
        let f = |t: f64, x: f64, v: f64| (v, torque(t) - x);
        let k1 = f(t, x, v);
        let k2 = f(t + 0.5 * h, x + 0.5 * h * k1.0, v + 0.5 * h * k1.1);
        let k3 = f(t + 0.5 * h, x + 0.5 * h * k2.0, v + 0.5 * h * k2.1);
        let k4 = f((t + h).min(time * (1.0 - 1e-15)), x + h * k3.0, v + h * k3.1);
        x += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
        let before = v;
        v += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
        // the extreme between, of a parabola
        if before * v < 0.0 {
            let part = v / (v - before);
            most = most.max((x - 0.5 * part * h * v).abs());
        }
        most = most.max(x.abs());
    }
    let end = torque(time * (1.0 + 1e-12));
    most.max(end.abs() + (x - end).hypot(v))
}

#[test]
fn starts_are_those_of_an_integration() {
    // twenty machines: inertias and stiffness over decades
    for k in 0..20 {
        let [motor, load, stiffness] = [0.2 * 1.3_f64.powi(k), 3.0 / 1.2_f64.powi(k), 500.0 * 1.5_f64.powi(k)];
        let text = format!(
            "name = \"mill\"\n[[element]]\nkind = \"motor\"\ninertia = {motor:?}\n[[element]]\nkind = \"shaft\"\n\
             stiffness = {stiffness:?}\n[[element]]\nkind = \"rotor\"\ninertia = {load:?}\n[encoder]\nlines = 2048\n\
             [control]\nrate_hz = 4000\n[disturbance]\ntorque_accuracy = 2.0\nload_torque_step = 60.0\nwithin = 0.1\n\
             [limits]\ntorque = 300.0\nspeed = 100.0\n"
        );
        let starts = &answered("modes", &text)["starts"];
        let omega = (stiffness * (motor + load) / (motor * load)).sqrt();
        let close = |found: &serde_json::Value, expected: f64| {
            let found = found.as_f64().unwrap();
            assert!((found - expected).abs() < 1e-6 * expected.abs(), "machine {k}: {found} {expected}");
        };
        close(&starts["resonance"], omega);
        for row in starts["factors"].as_array().unwrap() {
            let time = row["time"].as_f64().unwrap() * omega;
            let within = |value: f64, t: f64| if t <= time { value } else { 0.0 };
            close(&row["ramp"], factor(|t| (t / time).min(1.0), time));
            close(&row["pulse"], factor(|t| within(1.0, t), time));
            close(&row["half_sine"], factor(|t| within((PI * t / time).sin(), t), time));
            close(&row["triangle"], factor(|t| within(1.0 - (2.0 * t / time - 1.0).abs(), t), time));
            close(&row["soft"], factor(|t| within(1.0 - t / time, t), time));
            close(&row["medium"], factor(|t| within(1.0 - (t / time).powi(2), t), time));
        }
        // the envelope 1 + 2/(omega T) of all ramps, T the change over the slew
        for pair in starts["slew"].as_array().unwrap() {
            close(&pair[1], 300.0 * omega * (pair[0].as_f64().unwrap() - 1.0) / 2.0);
        }
        // without a gap the shaft swings about the new torque: 2 (-m) - m of the mean m
        close(&starts["reversal"], -3.0 * 300.0 * load / (motor + load));
    }
}
