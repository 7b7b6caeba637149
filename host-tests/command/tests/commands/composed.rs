//! What a train file composes, on 20 drawn machines each against closed forms: a skip hoist on an incline, a speed that
//! is given, a planetary set with three free members; and the forces in the pins of a crank.

use std::f64::consts::{PI, TAU};

use driveline_solver::noise::Noise;
use serde_json::Value;

use super::bench::answered;

/// Within 1e-6, which the elements far exceed: of the figure, or of what it is the difference of.
fn close(found: &Value, expected: f64, scale: f64) {
    let found = found.as_f64().unwrap();
    assert!((found - expected).abs() <= 1e-6 * expected.abs().max(scale), "{found} for {expected}");
}

fn coordinate(name: &str, inertia: f64, speed: f64) -> String {
    format!("[[coordinate]]\nname = \"{name}\"\ninertia = {inertia:?}\nspeed = {speed:?}\n")
}

fn constant(on: &str, torque: f64) -> String {
    format!("[[torque]]\non = \"{on}\"\nkind = \"constant\"\ntorque = {torque:?}\n")
}

/// The result of a train for a time (s).
fn simulated(train: &str, time: f64) -> Value {
    let run = format!("[run]\ntime = {time:?}\nstep = {:?}\n", time / 100.0);
    answered("simulate", &format!("name = \"train\"\n{train}{run}"))
}

/// Values between two bounds, even by ratio.
fn drawn(noise: &mut Noise, low: f64, high: f64) -> f64 {
    low * (high / low).powf(0.5 + 0.5 * noise.uniform())
}

/// The rope carries weight and friction `W` at an even speed; then the motor's torque accelerates by `a`, and the force
/// swings between `W` and `W + 2 m a`.
#[test]
fn a_skip_on_an_incline() {
    let mut noise = Noise::new(1);
    for _ in 0..20 {
        let [drum, radius, mass, stiffness, incline, friction, rate] =
            [(5.0, 100.0), (0.2, 1.0), (500.0, 2e4), (2e5, 5e6), (0.2, 1.5), (0.005, 0.1), (0.1, 1.0)]
                .map(|(low, high)| drawn(&mut noise, low, high));
        let [weight, rubbing] = [incline.sin(), friction * incline.cos()].map(|share| mass * 9.806_65 * share);
        let held = weight + rubbing;
        let time = 4.0 * TAU / (stiffness * (1.0 / mass + radius * radius / drum)).sqrt();
        let train = coordinate("drum", drum, 1.0 / radius)
            + &coordinate("skip", mass, 1.0)
            + &constant("drum", radius * (held + mass * rate) + drum * rate / radius)
            + &constant("skip", -weight)
            + &format!(
                "[[friction]]\non = \"skip\"\ntorque = {rubbing:?}\n[[link]]\nname = \"rope\"\nterms = {{ drum = \
                 {radius:?}, skip = -1.0 }}\nstiffness = {stiffness:?}\nrope = true\nelongation = {:?}\n",
                held / stiffness
            );
        let found = simulated(&train, time);
        close(&found["links"][0]["least"], held, 0.0);
        close(&found["links"][0]["greatest"], held + 2.0 * mass * rate, 0.0);
        close(&found["coordinates"][1]["last"], 1.0 + rate * time, 0.0);
    }
}

/// A mass of 1e9 times the load's has the given speed: it rises evenly for a time, and the shaft's torque swings up to
/// twice the load's acceleration, then by `2 |sin(w T/2)|` about the load.
#[test]
fn a_speed_that_is_given() {
    let mut noise = Noise::new(2);
    for _ in 0..20 {
        let [inertia, stiffness, load, rate, periods] =
            [(0.1, 10.0), (1e3, 1e5), (10.0, 500.0), (1.0, 100.0), (0.2, 5.0)]
                .map(|(low, high)| drawn(&mut noise, low, high));
        let omega = (stiffness / inertia).sqrt();
        let rise = periods * TAU / omega;
        let (given, end) = (1e9 * inertia, rise * (1.0 + 1e-10));
        let train = coordinate("given", given, 10.0)
            + &coordinate("load", inertia, 10.0)
            + &constant("load", -load)
            + &format!(
                "[[link]]\nname = \"shaft\"\nbetween = [\"given\", \"load\"]\nstiffness = {stiffness:?}\nelongation = \
                 {:?}\n[[torque]]\non = \"given\"\nkind = \"table\"\npoints = [[0.0, {torque:?}], [{rise:?}, \
                 {torque:?}], [{end:?}, 0.0]]\n",
                load / stiffness,
                torque = given * rate
            );
        let found = simulated(&train, rise + 2.0 * TAU / omega);
        let swing = (1.0 - (omega * rise).min(PI).cos()).max(2.0 * (0.5 * omega * rise).sin().abs());
        close(&found["links"][0]["greatest"], load + inertia * rate * swing, 0.0);
        close(&found["coordinates"][0]["last"], 10.0 + rate * rise, 0.0);
    }
}

/// Torques on all three: the mesh's force swings from zero to twice its mean; after whole periods each member has the
/// speed of its torque less the mean force's.
#[test]
fn a_planetary_set_with_three_free_members() {
    let mut noise = Noise::new(3);
    for _ in 0..20 {
        let [sun, ring] = [(15.0, 40.0), (60.0, 120.0)].map(|(low, high)| drawn(&mut noise, low, high).round());
        let (teeth, names) = ([sun, ring, -(sun + ring)], ["sun", "ring", "carrier"]);
        let inertias: [f64; 3] = std::array::from_fn(|_| drawn(&mut noise, 0.01, 10.0));
        let torques: [f64; 3] = std::array::from_fn(|_| 200.0 * noise.uniform());
        let stiffness = drawn(&mut noise, 1.0, 1e3);
        let sum = |of: &dyn Fn(usize) -> f64| (0..3).map(|k| teeth[k] * of(k) / inertias[k]).sum::<f64>();
        let mobility = sum(&|k| teeth[k]);
        let mean = sum(&|k| torques[k]) / mobility;
        let time = 4.0 * TAU / (stiffness * mobility).sqrt();
        let members: String =
            (0..3).map(|k| coordinate(names[k], inertias[k], 0.0) + &constant(names[k], torques[k])).collect();
        let mesh = format!(
            "[[link]]\nname = \"mesh\"\nterms = {{ sun = {sun:?}, ring = {ring:?}, carrier = {:?} }}\nstiffness = \
             {stiffness:?}\n",
            teeth[2]
        );
        let found = simulated(&(members + &mesh), time);
        close(&found["links"][0][if mean > 0.0 { "greatest" } else { "least" }], 2.0 * mean, 0.0);
        for k in 0..3 {
            let rate = |torque: f64| torque / inertias[k] * time;
            let (free, back) = (rate(torques[k]), rate(teeth[k] * mean));
            close(&found["coordinates"][k]["last"], free - back, free.abs());
        }
    }
}

/// Second derivative of a place by the angle of the crank: five points, whose error is of the fourth power of 1e-3.
fn bend(place: impl Fn(f64) -> f64, angle: f64) -> f64 {
    let h = 1e-3;
    let even = |k: f64| place(angle + k * h) + place(angle - k * h);
    (16.0 * even(1.0) - even(2.0) - 30.0 * place(angle)) / (12.0 * h * h)
}

/// Newton's laws with the places themselves, differentiated by number, and the rod's moments about the wrist pin.
#[test]
fn forces_in_the_pins_of_a_crank() {
    let mut noise = Noise::new(4);
    for _ in 0..20 {
        let [radius, longer, slider, mass, inertia, share, speed, angle, load] = [
            (0.02, 0.5),
            (2.0, 6.0),
            (1.0, 500.0),
            (0.5, 100.0),
            (0.01, 10.0),
            (0.1, 0.9),
            (5.0, 100.0),
            (0.05, 6.2),
            (100.0, 1e5),
        ]
        .map(|(low, high)| drawn(&mut noise, low, high));
        let rod = radius * longer;
        let pin = |phi: f64| [radius * phi.cos(), radius * phi.sin()];
        let wrist = |phi: f64| pin(phi)[0] + (rod * rod - pin(phi)[1].powi(2)).sqrt();
        let centre = |phi: f64| [pin(phi)[0] * (1.0 - share) + wrist(phi) * share, pin(phi)[1] * (1.0 - share)];
        let rate = |place: &dyn Fn(f64) -> f64| speed * speed * bend(place, angle);
        let [x, y] = [0, 1].map(|k| mass * rate(&|phi| centre(phi)[k]));
        let spin = inertia * rate(&|phi| -(pin(phi)[1] / rod).asin());
        let at_wrist = slider * rate(&wrist) + load;
        let at_crank = at_wrist + x;
        // arms from the wrist pin to the rod's centre and to the crank pin
        let [arm, lever] = [centre(angle), pin(angle)].map(|place| [place[0] - wrist(angle), place[1]]);
        let across = (arm[0] * y - arm[1] * x + spin + lever[1] * at_crank) / lever[0];
        let text = coordinate("crank", 1e3, speed)
            + &format!(
                "[coordinate.crank]\nradius = {radius:?}\nrod = {rod:?}\nslider_mass = {slider:?}\nrod_mass = \
                 {mass:?}\nrod_inertia = {inertia:?}\nrod_centre = {share:?}\npins_at = {angle:?}\n[[torque]]\non = \
                 \"crank\"\nkind = \"stroke\"\nforce = {:?}\n",
                -load
            );
        let found = &simulated(&text, 1e-3)["pin_forces"][0];
        // forces across are differences of parts as large as those along
        let scale = at_crank.abs().max(at_wrist.abs());
        close(&found["crank"][0], at_crank, 0.0);
        close(&found["wrist"][0], at_wrist, 0.0);
        close(&found["crank"][1], across, scale);
        close(&found["wrist"][1], across - y, scale);
        close(&found["guide"], y - across, scale);
    }
}
