//! Dampers in a machine file: their sizes, and the machine's response with and without them.

use std::f64::consts::TAU;

use cargo_driveline::campaign::scenes::CampaignScene;
use cargo_driveline::cli::Plan;
use cargo_driveline::machine_file::parse;
use driveline_closed_loop::departure::Departure;
use driveline_report::format::{percent, significant};
use nalgebra::{Complex, Matrix3, Vector3};
use serde_json::Value;

use super::bench::{Bench, SETTINGS, answered, number};
use super::critical::modes;

const MOTOR: f64 = 2.0;
const LOAD: f64 = 12.0;
const STIFFNESS: f64 = 4.0e4;
const RING: f64 = 0.8;

/// A motor, a shaft and a gear of two, a load with a ring.
fn machine(damper: &str) -> String {
    format!(
        "name = \"damped\"\n[[element]]\nkind = \"motor\"\ninertia = {MOTOR}\n[[element]]\nkind = \"shaft\"\n\
         stiffness = {STIFFNESS}\n[[element]]\nkind = \"gear\"\nratio = 2\n[[element]]\nkind = \"rotor\"\n\
         label = \"load\"\ninertia = {LOAD}\n{SETTINGS}[tolerance]\ndamping = 0\n[[damper]]\nat = \"load\"\n\
         inertia = {RING}\n{damper}"
    )
}

/// Angle of the load per torque on it, each on its own shaft, by the three equations of motion.
fn angle(stiffness: f64, damping: f64, omega: f64) -> f64 {
    let s = Complex::new(0.0, omega);
    let (coupling, inertia) = (damping * s + stiffness, |j: f64| s * s * j);
    let zero = Complex::from(0.0);
    // the shaft's twist is the motor's angle less twice the load's
    let matrix = Matrix3::new(
        inertia(MOTOR) + STIFFNESS,
        Complex::from(-2.0 * STIFFNESS),
        zero,
        Complex::from(-2.0 * STIFFNESS),
        inertia(LOAD) + 4.0 * STIFFNESS + coupling,
        -coupling,
        zero,
        -coupling,
        inertia(RING) + coupling,
    );
    matrix.lu().solve(&Vector3::new(zero, Complex::from(1.0), zero)).expect("damped")[1].norm()
}

#[test]
fn dampers_have_their_best_size_and_the_response_of_the_whole_machine() {
    // two masses at the motor, 2 and 3: omega^2 = k 5/6, and the mode at the second is 3 x 5/2
    let omega = f64::sqrt(STIFFNESS * 5.0 / 6.0);
    let mu = RING / 4.0 / 7.5;
    let tuned = omega / (1.0 + mu);
    let den_hartog = (RING * tuned * tuned, 2.0 * RING * tuned * f64::sqrt(3.0 * mu / (8.0 * (1.0 + mu))));
    let lanchester = (0.0, 2.0 * RING * omega / f64::sqrt(2.0 * (1.0 + mu) * (2.0 + mu)));
    for (keys, (stiffness, damping), fixed) in [
        ("kind = \"tuned\"\n", den_hartog, (1.0 + 2.0 / mu).sqrt()),
        ("kind = \"viscous\"\nmode = 1\n", lanchester, (2.0 + mu) / mu),
        ("kind = \"tuned\"\nstiffness = 20000\ndamping = 30\n", (2.0e4, 30.0), (1.0 + 2.0 / mu).sqrt()),
    ] {
        let (found, page) = modes(&machine(keys));
        let damper = &found["dampers"][0];
        for (key, expected) in
            [("mass_ratio", mu), ("stiffness", stiffness), ("damping", damping), ("fixed_amplitude", fixed)]
        {
            // modes to rounding
            assert!((number(&damper[key]) - expected).abs() <= 1e-12 * expected, "{key}: {damper} {expected}");
        }
        assert!(damper["without"].is_null() && page.contains("Dampers"), "{damper}");
        // torque and angle at the motor: four times
        let largest = (0..60_000)
            .map(|j| 4.0 * angle(stiffness, damping, omega * (0.5 + 1.5 * f64::from(j) / 6e4)))
            .fold(0.0, f64::max);
        // the peak lies between two of these points, 2.5e-5 apart: half of that over a half-width of 2 %, squared
        assert!((number(&damper["with"]) / largest - 1.0).abs() < 1e-6, "{damper} {largest}");
    }
}

/// `design` has the dampers in its two masses: a ring on a spring by the biquadratic equation of three masses, a stuck
/// one by its inertia, a viscous one by the share that it carries, a soft one as the vibration itself.
#[test]
fn a_design_has_the_dampers_in_its_two_masses() {
    let (load, ring) = (LOAD / 4.0, RING / 4.0);
    let bare = [STIFFNESS / load, STIFFNESS * (1.0 / MOTOR + 1.0 / load)];
    let carrying = |share: f64| [STIFFNESS / (load + share), STIFFNESS * (1.0 / MOTOR + 1.0 / (load + share))];
    // the first roots of the equations with the motor locked and free
    let root = |a: f64, b: f64, c: f64| (b - (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
    let sprung = |spring: f64| {
        [
            root(load * ring, (STIFFNESS + spring) * ring + spring * load, STIFFNESS * spring),
            root(
                1.0,
                STIFFNESS * (1.0 / MOTOR + 1.0 / load) + spring * (1.0 / load + 1.0 / ring),
                STIFFNESS * spring * (MOTOR + load + ring) / (MOTOR * load * ring),
            ),
        ]
    };
    // the ring's share at the resonance that it belongs to, on its own shaft 20 N m s/rad
    let mut slipping = carrying(0.0);
    for _ in 0..50 {
        slipping = carrying(ring * 25.0 / (25.0 + ring * ring * slipping[1]));
    }
    // spring and viscous coupling are at the load's shaft, a quarter of it at the motor's
    for (damper, squares, tolerance, rings) in [
        ("kind = \"friction\"\nexcitation = 1.0\n", carrying(ring), 1e-12, None),
        ("kind = \"tuned\"\nstiffness = 200000\ndamping = 1\n", sprung(5.0e4), 1e-12, None),
        // four passes, each a factor of a few hundredths, the ring's share of the inertia
        ("kind = \"viscous\"\ndamping = 20\n", slipping, 1e-6, None),
        // small roots: the squares of the coefficients cancel to 1e-4
        ("kind = \"tuned\"\nstiffness = 50\ndamping = 1\n", sprung(12.5), 1e-10, Some("load")),
    ] {
        let file = parse("damped", &machine(damper)).unwrap();
        let plan = Plan::with_dampers(&file).unwrap();
        let shaft = plan.shaft.unwrap();
        for (found, square) in [shaft.antiresonance, shaft.resonance].into_iter().zip(squares) {
            assert!((found / square.sqrt() - 1.0).abs() < tolerance, "{damper}: {found} {}", square.sqrt());
        }
        let sum = MOTOR + load + ring;
        assert!((plan.inertias.iter().sum::<f64>() / sum - 1.0).abs() < 1e-12, "{damper}: {:?}", plan.inertias);
        let dampers = plan.dampers.unwrap();
        assert_eq!(dampers.ring.as_deref(), rings);
        let without = dampers.without.unwrap();
        for (found, square) in without.into_iter().zip(bare) {
            assert!((found / square.sqrt() - 1.0).abs() < 1e-12, "{damper}: {without:?}");
        }
        let hertz = |square: f64| significant(square.sqrt() / std::f64::consts::TAU);
        let [held, free] = squares.map(hertz);
        let larger = percent(ring / (MOTOR + load));
        let expected = match rings {
            None => format!(
                "the antiresonance is {held} Hz instead of {} Hz, the resonance {free} Hz instead of {} Hz, and the \
                 inertia {larger} larger",
                hertz(bare[0]),
                hertz(bare[1])
            ),
            Some(_) => format!("the vibration of the damper of `load` at {free} Hz, its antiresonance at {held} Hz"),
        };
        assert!(dampers.to_string().contains(&expected), "{dampers}, not {expected}");
    }
    let none = parse("bare", machine("").split("[[damper]]").next().unwrap()).unwrap();
    assert_eq!(Plan::with_dampers(&none).unwrap().dampers, None);
}

/// A viscous ring and a tuned one on the load.
const TWO: &str = "kind = \"viscous\"\ndamping = 20\n[[damper]]\nat = \"load\"\ninertia = 0.4\nkind = \"tuned\"\n\
                   stiffness = 14000\ndamping = 40\n";

/// What is printed to paste is the train with its dampers, to the bit.
#[test]
fn printed_constants_have_the_dampers() {
    let text = Bench::with("damped.toml", machine(TWO)).run(&["design", "damped.toml", "--emit", "rust"]).stdout;
    let text = String::from_utf8(text).unwrap();
    // at the motor, a quarter; the tuned ring first: a viscous one takes its share of the mode that all others have
    let tuned = text.find(".damper(1, Ratio(1.0), Damper { inertia: 0.1, stiffness: 3500.0, damping: 10.0 })").unwrap();
    let viscous = text.find(".damper(1, Ratio(1.0), Damper { inertia: 0.2, stiffness: 0.0, damping: 5.0 });").unwrap();
    assert!(tuned < viscous && text.contains(": Train = Train::of("), "{text}");
}

/// Two rings on the load: what `new` writes, with the sizes of `design --emit rust`.
#[test]
fn a_project_has_the_dampers() {
    let bench = Bench::with("damped.toml", machine(TWO));
    bench.said(&["new", "press", "--machine", "damped.toml"]);
    let text = bench.read("press/src/machine.rs");
    let places = [
        "const DAMPED: Train = Train::of(<Press as Machine>::CHAIN)",
        ".damper(1, Ratio(1.0), Damper { inertia: 0.1, stiffness: 3500.0, damping: 10.0 })",
        ".damper(1, Ratio(1.0), Damper { inertia: 0.2, stiffness: 0.0, damping: 5.0 });",
        "const TWO_MASS: TwoMass = DAMPED.reduce(Match::ResonanceAntiresonance);",
    ]
    .map(|words| text.find(words).unwrap_or_else(|| panic!("no {words}: {text}")));
    assert!(places.is_sorted(), "{text}");
}

/// A pendulum on the roll of the README: without the check a drive was made; of three drawn machines two swung up.
#[test]
fn a_loop_without_margins_for_its_rings_is_refused() {
    let pendulum = "[[damper]]\nkind = \"pendulum\"\nat = \"roll\"\nmass = 2.0\nradius = 0.2\n\
                    order = 2.0\nspeed = 100.0\n";
    let bench = Bench::with("roll.toml", include_str!("../../machines/roll.toml").to_owned() + pendulum);
    let said = bench.refused(&["new", "roll", "--machine", "roll.toml"]);
    assert!(said.contains("the speed loop with its observer") && !bench.path("roll").exists(), "{said}");
}

/// The observer of a replay is designed with the dampers: its innovation is that of `design` at the same rate.
#[test]
fn a_replay_has_the_dampers() {
    let text = machine("kind = \"tuned\"\nstiffness = 14000\ndamping = 40\n");
    let bench = Bench::with("damped.toml", &text);
    let row = |tick: i32| {
        let time = f64::from(tick) * 1e-4;
        format!("{time},10,{}\n", time * time)
    };
    let rows: String = (0..2000).map(row).collect();
    bench.write("run.csv", format!("time_s,torque_Nm,angle_rad\n{rows}"));
    let found = bench.json(&["replay", "run.csv", "--machine", "damped.toml"]);
    let found = number(&found["predicted_innovation"]);
    let file = parse("damped", &text).unwrap();
    let [with, without] = [Plan::with_dampers(&file).unwrap(), Plan::of(&file).unwrap()].map(|plan| plan.innovation);
    // the period of a recording is a mean of decimal times
    assert!((found / with - 1.0).abs() < 1e-9, "{found} {with}");
    assert!((without / with - 1.0).abs() > 1e-6, "{without} {with}");
}

/// A campaign's drive has the two masses of `design`, and its plants, drawn ones too, the ring: three masses under a
/// torque by Runge-Kutta of order four.
#[test]
fn a_campaign_has_the_dampers() {
    let file = parse("damped", &machine("kind = \"tuned\"\nstiffness = 14000\ndamping = 40\n")).unwrap();
    let shaft = Plan::with_dampers(&file).unwrap().shaft.unwrap();
    let scene = CampaignScene::of_file(file).unwrap();
    assert_eq!(scene.resonance, shaft.resonance);
    let drawn = Departure { stiffness: 1.2, motor_inertia: 0.9, load_inertia: 1.1, ..Departure::NONE };
    for by in [Departure::NONE, drawn] {
        let inertias = [MOTOR * by.motor_inertia, LOAD / 4.0 * by.load_inertia, RING / 4.0];
        let rate = |[a, b, c, v, w, u]: [f64; 6]| {
            let (shaft, ring) = (STIFFNESS * by.stiffness * (a - b), 3500.0 * (b - c) + 10.0 * (w - u));
            [v, w, u, (50.0 - shaft) / inertias[0], (shaft - ring) / inertias[1], ring / inertias[2]]
        };
        let after = |y: [f64; 6], k: [f64; 6], h: f64| std::array::from_fn(|i| y[i] + h * k[i]);
        let (mut y, h) = ([0.0; 6], 1e-6);
        for _ in 0..50_000 {
            let k1 = rate(y);
            let k2 = rate(after(y, k1, 0.5 * h));
            let k3 = rate(after(y, k2, 0.5 * h));
            let k4 = rate(after(y, k3, h));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        let mut plant = scene.departing(&by).unwrap().scenarios[0].plant.clone();
        (0..500).for_each(|_| plant.advance(50.0, 1e-4));
        for (node, expected) in y[3..].iter().enumerate() {
            // 50,000 roundings
            assert!((plant.speed(node) / expected - 1.0).abs() < 1e-10, "{node}: {} {expected}", plant.speed(node));
        }
    }
}

/// With dampers the rate of the fastest mode times the length of a campaign is a million at most. An absorber a
/// thousandth below runs, one a thousandth above is refused. Its ring swings on the load at w sqrt(1 + J_ring/J_load).
#[test]
fn a_campaign_refuses_an_absorber_too_fast_to_follow() {
    let scene = |hertz: f64| {
        let file = parse("damped", &machine(&format!("kind = \"absorber\"\nfrequency = {hertz:?}\n"))).unwrap();
        CampaignScene::of_file(file)
    };
    let length = |hertz| scene(hertz).unwrap().departing(&Departure::NONE).unwrap().scenarios[0].duration;
    let limit = |end: f64| 1e6 / end / (1.0 + RING / LOAD).sqrt() / TAU;
    // far above the modes of the machine the ring is rigid, and the length of the run does not change with it
    let limit = limit(length(0.5 * limit(length(20.0))));
    // left out is the shaft's share of the square of the rate, k/J_load over it
    assert!(STIFFNESS * 4.0 / LOAD < 1e-3 * (limit * TAU).powi(2), "{limit}");
    scene(0.999 * limit).unwrap();
    let refusal = scene(1.001 * limit).map(|_| ()).unwrap_err().to_string();
    assert!(refusal.contains("with its dampers the machine is too stiff") && refusal.contains("damper of load"));
}

/// A light hub behind a stiff coupling, and a soft damper: the hub is named. Without the damper it is a campaign.
#[test]
fn a_campaign_names_the_hub_that_is_too_fast_with_a_damper() {
    let coupling = "[[element]]\nkind = \"shaft\"\nlabel = \"coupling\"\nstiffness = 1e6\n[[element]]\n\
                    kind = \"rotor\"\nlabel = \"hub\"\ninertia = 1e-5\n[[element]]\nkind = \"shaft\"";
    let text = machine("kind = \"tuned\"\nstiffness = 14000\ndamping = 40\n").replacen(
        "[[element]]\nkind = \"shaft\"",
        coupling,
        1,
    );
    let scene = |text: &str| CampaignScene::of_file(parse("damped", text).unwrap()).map(|_| ());
    let refusal = scene(&text).unwrap_err().to_string();
    assert!(
        refusal.contains("at `hub`") && refusal.contains("a stiffness of 1.0e6 on an inertia of 1.0e-5"),
        "{refusal}"
    );
    scene(text.split("[[damper]]").next().unwrap()).unwrap();
}

#[test]
fn the_sharp_peaks_of_a_weakly_damped_ring_are_found() {
    let (stiffness, damping) = (2.0e4, 1e-3);
    let keys = format!("kind = \"tuned\"\nstiffness = {stiffness}\ndamping = {damping}\n");
    let found = answered("modes", &machine(&keys));
    // three masses in a row, at the motor: omega^4 - b omega^2 + c = 0
    let ([one, two, three], [first, second]) = ([MOTOR, LOAD / 4.0, RING / 4.0], [STIFFNESS, stiffness / 4.0]);
    let b = first * (1.0 / one + 1.0 / two) + second * (1.0 / two + 1.0 / three);
    let c = first * second * (one + two + three) / (one * two * three);
    let root = (b * b - 4.0 * c).sqrt();
    let near = |omega: f64| {
        (-20_000..20_000).map(move |j| 4.0 * angle(stiffness, damping, omega * (1.0 + f64::from(j) * 1e-9)))
    };
    let largest = [b - root, b + root].into_iter().flat_map(|double| near((0.5 * double).sqrt())).fold(0.0, f64::max);
    let with = number(&found["dampers"][0]["with"]);
    // half a step over the half-width d omega/(2 k) = 4e-6, of which a mode has a tenth or more, squared
    assert!((with / largest - 1.0).abs() < 1e-5, "{with} {largest}");
    let (found, page) = modes(&machine("kind = \"tuned\"\ndamping = 0\n"));
    assert!(found["dampers"][0]["with"].is_null() && page.contains("undamped"), "{found}");
}

/// Two equal masses beside the ring's swing against each other without it: a node.
#[test]
fn an_undamped_mode_with_a_node_at_the_ring_does_not_count() {
    let end = format!("inertia = {MOTOR}\n[[element]]\nkind = \"shaft\"\nstiffness = {STIFFNESS}\n[[element]]\n");
    let text = format!(
        "{}[[element]]\nkind = \"shaft\"\nstiffness = {STIFFNESS}\n[[element]]\nkind = \"rotor\"\nlabel = \"end\"\n\
         inertia = {MOTOR}\n[encoder]{}",
        machine("").split("[encoder]").next().unwrap().replace("kind = \"gear\"\nratio = 2\n[[element]]\n", ""),
        machine("kind = \"viscous\"\nmode = 2\n").split("[encoder]").nth(1).unwrap()
    );
    assert!(text.contains(&end), "{text}");
    let found = answered("modes", &text);
    let damper = &found["dampers"][0];
    // the mode at sqrt(k/J) lies between half and twice that of the damper, sqrt(k (1/J + 2/J_load))
    let (node, mode) = (STIFFNESS / MOTOR, STIFFNESS * (1.0 / MOTOR + 2.0 / LOAD));
    assert!(node < mode && node > 0.25 * mode);
    let omega = mode.sqrt();
    // both ends are one of twice the inertia on twice the stiffness
    let ring = |omega: f64| {
        let s = Complex::new(0.0, omega);
        let ends = 2.0 * STIFFNESS * 2.0 * MOTOR * s * s / (2.0 * MOTOR * s * s + 2.0 * STIFFNESS);
        let coupling = number(&damper["damping"]) * s;
        let held = coupling * RING * s * s / (RING * s * s + coupling);
        1.0 / (ends + held + LOAD * s * s).norm()
    };
    let largest = (0..60_000).map(|j| ring(omega * (0.5 + 1.5 * f64::from(j) / 6e4))).fold(0.0, f64::max);
    // points as above, half of 2.5e-5 over the half-width of a quality of 121, squared
    assert!((number(&damper["with"]) / largest - 1.0).abs() < 1e-5, "{damper} {largest}");
}

#[test]
fn damping_of_the_machine_limits_its_response_without_a_damper() {
    let damped = machine("kind = \"tuned\"\n").replace("stiffness = 40000\n", "stiffness = 40000\ndamping = 3\n");
    let found = answered("modes", &damped);
    let omega = f64::sqrt(STIFFNESS * 5.0 / 6.0);
    // psi^2/(D omega) with D = d omega^2/k, less the rigid turning at a right angle
    let peak = f64::hypot(1.0 / (7.5 * 3.0 / STIFFNESS * omega.powi(3)), 1.0 / (5.0 * omega * omega));
    let without = number(&found["dampers"][0]["without"]);
    // the true peak lies a damping ratio squared beside the natural frequency
    assert!((without / peak - 1.0).abs() < 1e-3, "{without} {peak}");
    // a quality of k/(d omega) = 73 without, fixed points of 8.7 with
    assert!(number(&found["dampers"][0]["with"]) < 0.2 * without);
}

/// Two masses, a viscous ring, which is no mass of its own, and fourteen or fifteen others: 16 masses or one more.
#[test]
fn a_ring_too_many_is_refused_by_all_that_design_with_dampers() {
    let another = format!("[[damper]]\nat = \"load\"\ninertia = {RING}\nkind = \"absorber\"\nfrequency = 30.0\n");
    let rings = |count: usize| machine(&format!("kind = \"viscous\"\ndamping = 20\n{}", another.repeat(count - 1)));
    assert!(Plan::with_dampers(&parse("damped", &rings(15)).unwrap()).is_ok());
    let file = parse("damped", &rings(16)).unwrap();
    let expected = "`damper[15]`: a chain holds at most 16 masses";
    assert_eq!(Plan::with_dampers(&file).unwrap_err(), expected);
    let refused = CampaignScene::of_file(file).map(|_| ()).unwrap_err();
    assert!(refused.contains(expected), "{refused}");
    let bench = Bench::with("damped.toml", rings(16));
    bench.write("run.csv", "");
    for arguments in [
        &["design", "damped.toml"][..],
        &["design", "damped.toml", "--emit", "rust"],
        &["new", "press", "--machine", "damped.toml"],
        &["export", "fmu", "damped.toml", "--out", "press.fmu"],
        &["replay", "run.csv", "--machine", "damped.toml"],
    ] {
        let said = bench.refused(arguments);
        assert!(said.contains(expected), "{arguments:?}: {said}");
    }
}

#[test]
fn wrong_dampers_are_refused_at_their_place() {
    for (keys, key, expected) in [
        ("kind = \"loose\"\n", "damper[0].kind", "\"viscous\", \"friction\""),
        ("kind = \"friction\"\n", "damper[0].excitation", "a number"),
        ("kind = \"absorber\"\nmode = 1\nfrequency = 10\n", "damper[0].mode", "only"),
        ("kind = \"tuned\"\nmode = 2\n", "damper[0].mode", "mode of the machine, 1 to 1"),
        ("kind = \"viscous\"\nstiffness = 3\n", "damper[0].stiffness", "only"),
    ] {
        let fault = parse("damped", &machine(keys)).unwrap_err();
        assert!(fault.key == key && fault.expected.contains(expected), "{}", fault.explained());
    }
    let fault = parse("damped", &machine("kind = \"tuned\"\n").replace("at = \"load\"", "at = \"ring\"")).unwrap_err();
    assert!(fault.key == "damper[0].at" && fault.expected.contains("\"load\""), "{}", fault.explained());
}

/// Friction damper, absorber and pendulum: their sizes by the closed forms, each on its own shaft behind the gear.
#[test]
fn friction_dampers_absorbers_and_pendulums_have_their_sizes() {
    let omega = f64::sqrt(STIFFNESS * 5.0 / 6.0);
    let mu = RING / 4.0 / 7.5;
    let main = 7.5 * omega * omega;
    // sqrt(2)/pi J w^2 phi with phi = pi^2/(4 mu) of the static angle, at the motor; twice that behind the gear
    let (pi, excitation) = (std::f64::consts::PI, 3.0);
    let angle = 0.25 * pi * pi / mu * 0.5 * excitation / main;
    let torque = 2.0 * 2.0_f64.sqrt() / pi * RING / 4.0 * omega * omega * angle;
    let close = |found: &Value, expected: f64| {
        // modes to rounding
        assert!((number(found) / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    };
    let (found, page) = modes(&machine("kind = \"friction\"\nexcitation = 3.0\n"));
    let damper = &found["dampers"][0];
    close(&damper["friction"], torque);
    close(&damper["fixed_amplitude"], 0.25 * pi * pi / mu);
    close(&damper["with"], 0.25 * pi * pi / mu / main);
    assert!(page.contains("friction"), "{page}");
    // a load of its own: what the shaft of the motor and the load give without the ring
    let found = answered("modes", &machine("kind = \"absorber\"\nfrequency = 22.0\n"));
    let damper = &found["dampers"][0];
    let swung = 22.0 * std::f64::consts::TAU;
    close(&damper["stiffness"], RING * swung * swung);
    let bare = |omega: f64| {
        let shaft = STIFFNESS * MOTOR * omega * omega / (STIFFNESS - MOTOR * omega * omega);
        1.0 / (LOAD / 4.0 * omega * omega + shaft).abs()
    };
    close(&damper["without"], bare(swung));
    // it stands still but for rounding
    assert!(number(&damper["with"]) < 1e-12 * bare(swung) && damper["mode"].is_null(), "{damper}");
    let pendulum = machine("kind = \"pendulum\"\nmass = 0.9\nradius = 0.12\norder = 1.5\nspeed = 80.0\n");
    let found = answered("modes", &pendulum.replace("inertia = 0.8\n", ""));
    let damper = &found["dampers"][0];
    let length = 0.12 / 2.25;
    close(&damper["length"], length);
    close(&damper["hz"], 1.5 * 80.0 / std::f64::consts::TAU);
    close(&damper["stiffness"], 0.9 * (0.12_f64 + length).powi(2) * 120.0 * 120.0);
    close(&damper["swing"], 1.0 / (0.9 * 0.12 * (0.12 + length) * 6400.0));
    close(&damper["without"], bare(120.0));
    assert!(number(&damper["with"]) < 1e-12 * bare(120.0), "{damper}");
}

/// Of every kind the run has the ring, and shows the forces without it. The load's swing under a sine is that of the
/// three equations of motion; the absorber leaves none.
#[test]
fn a_run_with_a_damper_has_the_response_of_the_equations() {
    use std::f64::consts::PI;
    let omega = f64::sqrt(STIFFNESS * 5.0 / 6.0);
    let run = |keys: &str, frequency: f64, time: f64| {
        // the first term of a square of height pi/4 is a sine of one; the ground damps what is left of the start
        let torque = format!(
            "[[torque]]\non = \"load\"\nkind = \"square\"\nheight = {}\nperiod = {}\nterms = 1\n\
             [run]\ntime = {time}\nstep = 1e-3\n",
            0.25 * PI,
            2.0 * PI / frequency
        );
        let text = machine(keys).replace("inertia = 12\n", "inertia = 12\nviscous = 40\n");
        assert!(text.contains("viscous"), "{text}");
        let text = text.replace("kind = \"motor\"\n", "kind = \"motor\"\nviscous = 12\n");
        // a pendulum has its inertia by its size
        let text = if keys.contains("pendulum") { text.replace("inertia = 0.8\n", "") } else { text };
        cargo_driveline::machine_file::parse_train("damped", &format!("{text}{torque}")).unwrap()
    };
    // everything at the motor: motor, load, ring
    let closed = |[stiffness, damping]: [f64; 2], omega: f64| {
        let s = Complex::new(0.0, omega);
        let coupling = s * damping / 4.0 + stiffness / 4.0;
        let zero = Complex::from(0.0);
        let matrix = Matrix3::new(
            s * s * MOTOR + s * 12.0 + STIFFNESS,
            Complex::from(-STIFFNESS),
            zero,
            Complex::from(-STIFFNESS),
            s * s * LOAD / 4.0 + s * 10.0 + STIFFNESS + coupling,
            -coupling,
            zero,
            -coupling,
            s * s * RING / 4.0 + coupling,
        );
        matrix.lu().solve(&Vector3::new(zero, Complex::from(1.0), zero)).expect("damped")[1].norm()
    };
    let mu = RING / 4.0 / 7.5;
    let tuned = omega / (1.0 + mu);
    let best = [RING * tuned * tuned, 2.0 * RING * tuned * f64::sqrt(3.0 * mu / (8.0 * (1.0 + mu)))];
    let lanchester = [0.0, 2.0 * RING * omega / f64::sqrt(2.0 * (1.0 + mu) * (2.0 + mu))];
    let absorber = RING * (120.0_f64).powi(2);
    let pendulum = "kind = \"pendulum\"\nmass = 3.2\nradius = 0.4\nlength = 0.1\norder = 2\nspeed = 60\n";
    for (keys, sizes, frequency) in [
        ("kind = \"tuned\"\n".to_owned(), best, 0.95 * omega),
        ("kind = \"viscous\"\n".to_owned(), lanchester, omega),
        (format!("kind = \"absorber\"\nfrequency = {}\n", 120.0 / (2.0 * PI)), [absorber, 0.0], 130.0),
        (pendulum.to_owned(), [0.8 * 120.0 * 120.0, 0.0], 135.0),
    ] {
        let file = run(&keys, frequency, 1.0);
        assert_eq!(file.coordinates.last().map(String::as_str), Some("damper of load"));
        let mut motion = file.motion.clone();
        motion.advance(120.0);
        // speed over two periods by its Fourier coefficient
        let (mut sum, count) = (Complex::from(0.0), 400);
        for _ in 0..count {
            motion.advance(4.0 * PI / frequency / f64::from(count));
            sum += Complex::new(0.0, -frequency * motion.time()).exp() * motion.speed(1);
        }
        let swing = 2.0 * sum.norm() / f64::from(count) / frequency;
        let expected = closed(sizes, frequency);
        assert!((swing / expected - 1.0).abs() < 1e-6, "{keys}: {swing} {expected}");
        let bare = file.without_dampers.unwrap();
        assert_eq!((bare.coordinates.len(), bare.links.len()), (2, 1));
    }
    // at the frequency of the absorber the load stands still
    let file = run(&format!("kind = \"absorber\"\nfrequency = {}\n", 120.0 / (2.0 * PI)), 120.0, 1.0);
    let mut motion = file.motion.clone();
    motion.advance(200.0);
    let least = (0..200).map(|_| {
        motion.advance(1e-3);
        motion.speed(1).abs()
    });
    assert!(least.fold(0.0, f64::max) < 1e-9 * 120.0 * closed([0.0, 0.0], 120.0));
}

/// A friction damper in a run: proven, and at the natural frequency it holds the load to about the closed form, whose
/// ring slips all the time under a pure sine.
#[test]
fn a_friction_damper_holds_the_load_in_a_run() {
    use std::f64::consts::PI;
    let omega = f64::sqrt(STIFFNESS * 5.0 / 6.0);
    let text = machine("kind = \"friction\"\nexcitation = 2.0\n")
        + &format!(
            "[[torque]]\non = \"load\"\nkind = \"square\"\nheight = {}\nperiod = {}\nterms = 1\n\
             [run]\ntime = 1.5\nstep = 2e-3\n",
            0.25 * PI,
            2.0 * PI / omega
        );
    let found = answered("simulate", &text);
    assert!(number(&found["proof"][0]) <= 1e-8, "{found}");
    let greatest = |found: &Value| number(&found["links"][0]["greatest"]);
    // the shaft carries k psi_1/psi_2 (1 - psi_2/psi_1) of the load's swing: its twist is 2.5 times that
    let mu = RING / 4.0 / 7.5;
    let steady = 2.5 * STIFFNESS * 0.25 * PI * PI / mu / (7.5 * omega * omega);
    let (with, without) = (greatest(&found), greatest(&found["without_dampers"]));
    // without it the swing grows by t/(2 J w) for ever: 1.5 s are 43 swings, 136 times the static angle
    assert!(with < 1.25 * steady && without > 1.2 * steady, "{with} {without} {steady}");
}
