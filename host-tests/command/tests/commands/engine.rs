//! A piston engine in a machine file: critical speeds with their phasor sums, free forces and moments.

use std::f64::consts::{PI, TAU};

use cargo_driveline::machine_file::{parse, parse_train};
use nalgebra::Complex;

use super::bench::{SETTINGS, number};
use super::critical::modes;

const INERTIA: f64 = 0.4;
const STIFFNESS: f64 = 9.0e5;
const DAMPING: f64 = 25.0;
const PRESSURE: f64 = 3.0e5;

/// Six equal masses on equal shafts, each a throw; the diagram is `p (1 + cos 3/2 phi)`.
fn six(engine: &str) -> String {
    let throw =
        |kind: &str, j: usize| format!("[[element]]\nkind = \"{kind}\"\nlabel = \"{j}\"\ninertia = {INERTIA}\n");
    let shaft = format!("[[element]]\nkind = \"shaft\"\nstiffness = {STIFFNESS}\ndamping = {DAMPING}\n");
    let rest: String = (2..=6).map(|j| format!("{shaft}{}", throw("rotor", j))).collect();
    format!("name = \"six\"\n{}{rest}{SETTINGS}[engine]\n{engine}", throw("motor", 1))
}

/// A crank so small against its rod that lambda is 1e-3, and next to no mass.
fn engine() -> String {
    let diagram = (0..48).map(|j| PRESSURE * (1.0 + (1.5 * f64::from(j) * 2.0 * TAU / 48.0).cos()));
    let diagram: Vec<String> = diagram.map(|p| format!("{p:.6}")).collect();
    format!(
        "strokes = 4\ncranks = [0, 240, 120, 120, 240, 0]\nfiring_order = [1, 5, 3, 6, 2, 4]\n\
         at = [\"1\", \"2\", \"3\", \"4\", \"5\", \"6\"]\npositions = [0, 0.1, 0.2, 0.3, 0.4, 0.5]\nradius = 0.05\n\
         rod = 50.0\nreciprocating = 1e-9\nbore = 0.2\norders = [0.5, 1.0, 1.5, 2.5, 3.0]\npressure = [{}]\n",
        diagram.join(", ")
    )
}

/// Largest shaft torque of the six under torques of one frequency, by Holzer's residual torque: the angle of the first
/// mass is the one that leaves no torque behind the last.
fn largest_shaft_torque(damping: [f64; 5], torques: [Complex<f64>; 6], omega: f64) -> f64 {
    let along = |first: Complex<f64>, share: f64| {
        let (mut angle, mut torque) = (first, Complex::from(0.0));
        let shafts: Vec<Complex<f64>> = (0..6)
            .map(|j| {
                torque += torques[j] * share + INERTIA * omega * omega * angle;
                if let Some(damping) = damping.get(j) {
                    angle -= torque / Complex::new(STIFFNESS, omega * damping);
                }
                torque
            })
            .collect();
        shafts
    };
    let zero = Complex::from(0.0);
    let first = -along(zero, 1.0)[5] / along(Complex::from(1.0), 0.0)[5];
    along(first, 1.0)[..5].iter().map(|torque| torque.norm()).fold(0.0, f64::max)
}

/// The first shaft damped as the others, and as a coupling.
#[test]
fn critical_speeds_of_a_six_in_line_with_their_phasor_sums() {
    critical_speeds([DAMPING; 5]);
    critical_speeds([12.0 * DAMPING, DAMPING, DAMPING, DAMPING, DAMPING]);
}

fn critical_speeds(damping: [f64; 5]) {
    let text = six(&engine()).replacen(&format!("damping = {DAMPING}"), &format!("damping = {}", damping[0]), 1);
    let (found, page) = modes(&text);
    let critical = found["critical"].as_array().unwrap();
    assert_eq!(critical.len(), 5 * 5);
    // firing angles in thirds of a turn
    let firing = [0.0, 4.0, 2.0, 5.0, 1.0, 3.0].map(|third| third * TAU / 3.0);
    let gas = PRESSURE * PI * 0.01 * 0.05;
    for row in critical {
        // equal masses in a free chain: omega = 2 sqrt(k/J) sin(m pi/12), shape cos(m pi (2 j - 1)/12)
        let m = number(&row["mode"]);
        let omega = 2.0 * f64::sqrt(STIFFNESS / INERTIA) * (m * PI / 12.0).sin();
        let order = number(&row["order"]);
        // eigenvalues of six masses, to rounding
        assert!((number(&row["speed"]) / (omega / order) - 1.0).abs() < 1e-12, "{row}");
        let shape: Vec<f64> = (0..6).map(|j| (m * PI * f64::from(2 * j + 1) / 12.0).cos()).collect();
        let most = shape.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let part = |f: fn(f64) -> f64| shape.iter().zip(firing).map(|(x, a)| x * f(order * a)).sum::<f64>();
        let sum = f64::hypot(part(f64::cos), part(f64::sin));
        // shapes to rounding
        assert!((number(&row["phasor_sum"]) - sum / most).abs() < 1e-12, "{row} {}", sum / most);
        // sin phi (1 + cos 3/2 phi) = sin phi + (sin 5/2 phi - sin 1/2 phi)/2, and lambda/4 of sin 1/2 phi
        let torque = gas
            * match order {
                0.5 => 0.5 - 0.25e-3,
                1.0 => 1.0,
                2.5 => 0.5,
                _ => 0.0,
            };
        // the next power of lambda, and six digits of the diagram
        assert!((number(&row["torque"]) - torque).abs() < 1e-8 * gas, "{row} {torque}");
        let torques = firing.map(|angle| Complex::from_polar(number(&row["torque"]), -order * angle));
        let shaft = largest_shaft_torque(damping, torques, omega);
        // the frequency to 1e-12 at a quality of up to 200, and roundings of torques that cancel, as often amplified
        let tolerance = 1e-9 * shaft + 1e-11 * number(&row["torque"]);
        assert!((number(&row["shaft_torque"]) - shaft).abs() < tolerance, "{row} {shaft}");
    }
    assert!(page.contains("phasor sum") && page.contains("Free forces and moments of the engine"));
    for (angle, third) in found["engine"]["firing"].as_array().unwrap().iter().zip(firing) {
        // a few additions
        assert!((number(angle) - third.to_degrees()).abs() < 1e-11, "{angle} {third}");
    }
    assert!(page.contains("fire at 0, 480, 240, 600, 120, 360 degrees"));
    // six in line have none
    for order in found["engine"]["orders"].as_array().unwrap() {
        for part in ["force_forward", "force_backward", "moment_forward", "moment_backward"] {
            // roundings of a first order of some 200 N
            assert!(number(&order[part]).abs() < 1e-12, "{order}");
        }
    }
}

#[test]
fn free_forces_of_one_cylinder_behind_a_gear() {
    let [one, behind] = [
        "strokes = 2\ncranks = [30.5]\npositions = [0]\nat = [\"6\"]\nradius = 0.05\nrod = 0.2\nreciprocating = 0.5\n\
         bore = 0.08\ncompression = 9\npeak_pressure = 4e6\norders = [1, 2]\n",
        "[[branch]]\nat = \"6\"\n[[branch.element]]\nkind = \"gear\"\nratio = 4\n[[branch.element]]\nkind = \"shaft\"\n\
         stiffness = 1e4\n[[branch.element]]\nkind = \"rotor\"\nlabel = \"slow\"\ninertia = 3\n",
    ];
    let (found, page) =
        modes(&six(&one.replace("\"6\"", "\"slow\"")).replace("[encoder]", &format!("{behind}[encoder]")));
    // 200 rad/s of the motor are 50 rad/s of the crankshaft
    assert_eq!(number(&found["engine"]["speed"]), 50.0);
    let first = 0.5 * 0.05 * 2500.0;
    // the Fourier series of a slider of lambda 1/4, to lambda^9: orders 2, 4 and 6 [derived]
    let second = 0.25 + 0.25_f64.powi(3) / 4.0 + 15.0 * 0.25_f64.powi(5) / 128.0 + 35.0 * 0.25_f64.powi(7) / 512.0;
    let fourth = 0.25_f64.powi(3) / 4.0 + 3.0 * 0.25_f64.powi(5) / 16.0 + 35.0 * 0.25_f64.powi(7) / 256.0;
    let sixth = 9.0 * 0.25_f64.powi(5) / 128.0 + 45.0 * 0.25_f64.powi(7) / 512.0;
    for (order, force) in [first, first * second, first * fourth, first * sixth].into_iter().enumerate() {
        for part in ["force_forward", "force_backward"] {
            // half of it each way, and the next power of lambda
            assert!((number(&found["engine"]["orders"][order][part]) - 0.5 * force).abs() < 1e-5 * first, "{found}");
        }
    }
    // half of m r opposite to the throw each way; with half of the mass as counterweight the backward half is left
    for shaft in found["engine"]["orders"][0]["balance_shafts"].as_array().unwrap() {
        assert!((number(&shaft[0]) - 0.5 * 0.5 * 0.05).abs() < 1e-9 && (number(&shaft[1]).abs() - 149.5).abs() < 1e-9);
    }
    assert!((number(&found["engine"]["counterweighted"]) - 0.5 * first).abs() < 1e-6 * first);
    assert!(page.contains("fire at 329.5 degrees"), "{page}");
    let (low, high) = (&found["critical"][0], found["critical"].as_array().unwrap().last().unwrap());
    assert!(number(&low["speed"]) < number(&high["speed"]));
    let omega = TAU * number(&low["hz"]);
    // four turns of the motor for one of the crankshaft
    assert!((number(&low["speed"]) / (4.0 * omega / number(&low["order"])) - 1.0).abs() < 1e-13, "{low}");
}

#[test]
fn wrong_engines_are_refused_at_their_place() {
    let right = engine();
    let cases = [
        ("strokes = 4", "strokes = 3", "engine.strokes", "2 or 4"),
        ("[1, 5, 3, 6, 2, 4]", "[1, 2, 3, 4, 5, 6]", "engine.firing_order", "two turns"),
        ("at = [\"1\"", "at = [\"7\"", "engine.at", "\"6\""),
        ("positions = [0, 0.1,", "positions = [", "engine.positions", "as many numbers as `cranks`, 6"),
        ("rod = 50.0", "rod = 0.05", "engine.radius", "below the rod's"),
        ("orders = [0.5", "orders = [0.7", "engine.orders", "multiples of 0.5"),
        ("orders = [0.5", "orders = [12.0", "engine.orders", "up to 11.5"),
        ("orders = [0.5", "orders = [24.5", "engine.orders[0]", "0.5 to 24"),
    ];
    for (old, new, key, expected) in cases {
        let fault = parse("six", &six(&right.replace(old, new))).unwrap_err();
        assert!(fault.key == key && fault.expected.contains(expected), "{new}: {}", fault.explained());
    }
    let both = format!("{}[[excitation]]\nname = \"engine\"\norders = [1]\n", six(&right));
    let fault = parse("six", &both).unwrap_err();
    assert!(fault.key == "excitation[0].name" && fault.expected.contains("`[engine]`"), "{}", fault.explained());
    let typical = right.split("pressure").next().unwrap().to_owned() + "compression = 17\npeak_pressure = 1e6\n";
    let fault = parse("six", &six(&typical)).unwrap_err();
    assert!(fault.key == "engine.peak_pressure" && fault.expected.contains("above that"), "{}", fault.explained());
    for (new, key) in
        [("compression = 1.0", "engine.compression"), ("compression = 9\nexponent = 1.0", "engine.exponent")]
    {
        let fault = parse("six", &six(&typical.replace("compression = 17", new))).unwrap_err();
        assert!(fault.key == key && fault.expected.contains("1.001 to"), "{}", fault.explained());
    }
}

/// Kinetic and strain energy of a run are the work of the gas, as the integral of its closed form.
#[test]
fn the_gas_torque_does_its_work_in_a_run() {
    // p (1 + sin phi): T = p A r (1/2 + sin phi + lambda/4 cos phi) in the orders 0 and 1
    let diagram = (0..24).map(|j| PRESSURE * (1.0 + (f64::from(j) * TAU / 24.0).sin()));
    let diagram: Vec<String> = diagram.map(|p| format!("{p:.9}")).collect();
    let text = format!(
        "[[element]]\nkind = \"motor\"\ninertia = 0.4\n[[element]]\nkind = \"shaft\"\nstiffness = 2e4\n[[element]]\n\
         kind = \"gear\"\nratio = 2\n[[element]]\nkind = \"rotor\"\nlabel = \"crank\"\ninertia = 2.0\n\
         {SETTINGS}[engine]\nstrokes = 2\ncranks = [0, 200]\n\
         at = [\"crank\", \"crank\"]\nradius = 0.05\nrod = 50.0\nreciprocating = 1e-9\nbore = 0.2\norders = [1]\n\
         pressure = [{}]\n[run]\ntime = 0.4\nstep = 0.4\n",
        diagram.join(", ")
    );
    let mut run = parse_train("work", &text).unwrap();
    run.motion.advance(0.4);
    let unit = PRESSURE * PI * 0.01 * 0.05;
    // the crankshaft turns half as fast as its mass at the motor
    let phi = 0.5 * run.motion.angle(1);
    let work = |firing: f64| {
        0.5 * phi + (firing.cos() - (phi - firing).cos()) + 0.25e-3 * ((phi - firing).sin() + firing.sin())
    };
    let work = unit * (work(0.0) + work((-200f64).to_radians()));
    let kinetic = 0.5 * (0.4 * run.motion.speed(0).powi(2) + 0.5 * run.motion.speed(1).powi(2));
    let energy = kinetic + 0.5 * 2e4 * run.motion.elongation(0).powi(2);
    // the next power of lambda, nine digits of the diagram, and the solver's 1e-10
    assert!((energy / work - 1.0).abs() < 1e-7, "{energy} {work} {phi}");
    assert!(phi > TAU, "{phi}");
}

/// Without gas an engine's reciprocating mass swings the speed of its throw as the slider of a crank drive does, whose
/// inertia is the throw's less the mean of the slider's.
#[test]
fn the_mass_torque_of_an_engine_is_that_of_its_slider() {
    let (radius, rod, mass, inertia) = (0.06_f64, 0.2_f64, 3.0, 0.05);
    let slope = |angle: f64| {
        let (sine, cosine) = angle.sin_cos();
        -radius * sine - radius * radius * sine * cosine / (rod * rod - (radius * sine).powi(2)).sqrt()
    };
    let mean = (0..400).map(|i| mass * slope(TAU * f64::from(i) / 400.0).powi(2)).sum::<f64>() / 400.0;
    let run = "[run]\ntime = 0.4\nstep = 0.4\n";
    let torque = |on: &str| format!("[[torque]]\non = \"{on}\"\nkind = \"constant\"\ntorque = 4.0\n");
    let engine = format!(
        "[[element]]\nkind = \"motor\"\nlabel = \"throw\"\ninertia = {inertia}\n{SETTINGS}[engine]\nstrokes = 2\ncranks = [0]\nat = [\"throw\"]\nradius = {radius}\n\
         rod = {rod}\nreciprocating = {mass}\nbore = 0.1\norders = [1]\npressure = [0, 0, 0, 0, 0, 0, 0, 0]\n{}{run}",
        torque("throw")
    );
    let crank = format!(
        "[[coordinate]]\nname = \"throw\"\ninertia = {:?}\n[coordinate.crank]\nradius = {radius}\nrod = {rod}\n\
         slider_mass = {mass}\n{}{run}",
        inertia - mean,
        torque("throw")
    );
    let [mut engine, mut crank] = [engine, crank].map(|text| parse_train("throw", &text).unwrap().motion);
    for _ in 0..40 {
        engine.advance(0.01);
        crank.advance(0.01);
        let (found, expected) = (engine.speed(0), crank.speed(0));
        // the mean by sums of 400, and the series to 1e-15
        assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
    }
    assert!(engine.angle(0) > TAU, "{}", engine.angle(0));
}

/// Reciprocating masses that their throw cannot carry are refused at it.
#[test]
fn a_throw_lighter_than_its_slider_swings_is_refused_by_name() {
    let text =
        six(&engine().replace("reciprocating = 1e-9", "reciprocating = 900")) + "[run]\ntime = 0.1\nstep = 0.1\n";
    let fault = parse_train("six", &text).unwrap_err();
    assert!(fault.to_string().contains("law of inertia"), "{fault}");
    assert!(text.lines().nth(fault.line - 1).is_some_and(|line| line.contains("[[element]]")), "{}", fault.line);
}

/// A friction damper on a throw, whose inertia changes with its angle: refused at the damper, not at the throw.
#[test]
fn a_friction_damper_on_a_throw_is_refused_at_its_table() {
    let text = format!(
        "[[element]]\nkind = \"motor\"\nlabel = \"throw\"\ninertia = 0.4\n[[element]]\nkind = \"shaft\"\n\
         stiffness = 2e4\n[[element]]\nkind = \"rotor\"\nlabel = \"load\"\ninertia = 0.5\n{SETTINGS}[engine]\n\
         strokes = 2\ncranks = [0]\nat = [\"throw\"]\nradius = 0.06\nrod = 0.2\nreciprocating = 3.0\nbore = 0.1\n\
         orders = [1]\npressure = [0, 0, 0, 0, 0, 0, 0, 0]\n[[damper]]\nkind = \"friction\"\nat = \"throw\"\n\
         inertia = 0.02\nexcitation = 10.0\n[run]\ntime = 0.1\nstep = 0.1\n"
    );
    let fault = parse_train("throw", &text).unwrap_err();
    assert!(fault.found.contains("on \"throw\", whose inertia changes with its angle"), "{fault}");
    assert_eq!(text.lines().nth(fault.line - 1), Some("[[damper]]"), "{fault}");
    assert!(parse_train("load", &text.replace("at = \"throw\"\ninertia", "at = \"load\"\ninertia")).is_ok());
}
