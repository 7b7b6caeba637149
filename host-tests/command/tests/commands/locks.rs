//! Gears that lock themselves, as elements: each holds its load in every command and in both FMUs.

use cargo_driveline::campaign::file::FileCase;
use cargo_driveline::cosim::fmu::Fmu;
use cargo_driveline::machine_file::parse;
use driveline_closed_loop::departure::Departure;

use super::bench::{Bench, answered};

const SETTINGS: &str = "[encoder]\nlines = 2048\n[control]\nrate_hz = 4000\n[disturbance]\ntorque_accuracy = 4.0\n\
    load_torque_step = 150.0\nwithin = 10.0\n[limits]\ntorque = 600.0\nspeed = 150.0\n";

/// Kind and ratio of a gear, and the mass that it lifts (kg).
const GEARS: [(&str, &str, f64); 3] = [
    ("worm", "ratio = 20.0", 1000.0),
    ("gear", "ratio = 20.0", 1000.0),
    (
        "planetary",
        "sun_teeth = 20\nring_teeth = 90\nmodule = 0.004\nplanets = 3\nsun = 0.013\nplanet = 0.0027\n\
         planet_mass = 3.7\ncarrier = 0.067",
        100.0,
    ),
];

/// Motor, shaft, rotor, gear and drum, which lifts a mass on a rope or directly: then no shaft is behind the gear.
fn machine((kind, ratio, mass): (&str, &str, f64), rope: bool, back_efficiency: f64) -> String {
    let element = |kind: &str, rest: &str| format!("[[element]]\nkind = \"{kind}\"\n{rest}\n");
    let rope = if rope { element("rope", "falls = 1\nstiffness = 2.9e6\ndamping = 3.6e3") } else { String::new() };
    [
        "name = \"lift\"\n".to_owned(),
        element("motor", "inertia = 0.5"),
        element("shaft", "stiffness = 2.0e4\ndamping = 3.0"),
        element("rotor", "inertia = 0.3"),
        element(kind, &format!("{ratio}\nefficiency = 0.7\nback_efficiency = {back_efficiency}")),
        element("drum", "diameter = 0.8"),
        rope,
        element("lifted", &format!("label = \"load\"\nmass = {mass}")),
        SETTINGS.to_owned(),
    ]
    .concat()
}

/// Turn of the motor by which a shaft unwinds that carries the load at the start, and swings about what it held (rad).
const UNWINDS: f64 = 0.2;
/// Turn of the motor by which the load falls in half a second where the gear does not lock (rad): 5 m/s2 of free fall
/// take 0.6 m, which is 1.5 rad of the drum. A tenth of that is for the gear's loss and the motor's inertia.
const FALLS: f64 = 1.0;

/// Without a torque of the motor the mass in front of the gear does not turn, from rest to the last bit.
#[test]
fn a_gear_that_locks_holds_its_load_in_simulate() {
    for gear in GEARS {
        for (rope, back_efficiency, holds) in [(true, -0.1, true), (false, -0.1, true), (true, 0.6, false)] {
            let text = machine(gear, rope, back_efficiency) + "[run]\ntime = 0.5\nstep = 1e-3\n";
            let second = &answered("simulate", &text)["coordinates"][1];
            let [least, greatest] = ["least", "greatest"].map(|key| second[key].as_f64().unwrap());
            assert_eq!((least, greatest) == (0.0, 0.0), holds, "{gear:?} {rope} {back_efficiency}: {second}");
        }
    }
}

/// The plant of a campaign and that of an FMU begin with shafts that carry the load. The motor lets go.
fn falls(mut step: impl FnMut() -> f64) -> f64 {
    (0..500).map(|_| step()).fold(0.0, |most: f64, angle| most.max(angle.abs()))
}

#[test]
fn a_gear_that_locks_holds_its_load_in_a_campaign() {
    for gear in GEARS {
        for (rope, back_efficiency, holds) in [(true, -0.1, true), (false, -0.1, true), (true, 0.6, false)] {
            let file = parse("m.toml", &machine(gear, rope, back_efficiency)).unwrap();
            let case: &'static FileCase = Box::leak(Box::new(FileCase::of(file).unwrap()));
            let mut plant = case.departing(&Departure::NONE).unwrap().scenarios.remove(0).plant;
            let turned = falls(|| {
                plant.advance(0.0, 1e-3);
                plant.motor_angle()
            });
            let right = if holds { turned < UNWINDS } else { turned > FALLS };
            assert!(right, "{gear:?} {rope} {back_efficiency}: {turned}");
        }
    }
}

/// Plant FMUs with a shaft behind the gear and without; the drive, an FMU too, comes to rest and stays there.
#[test]
fn a_gear_that_locks_holds_its_load_in_both_fmus() {
    let bench = Bench::new();
    for (gear, rope) in [(GEARS[0], true), (GEARS[2], false)] {
        bench.write("m.toml", machine(gear, rope, -0.1));
        bench.said(&["export", "fmu", "m.toml", "--of", "plant", "--out", "plant.fmu"]);
        // of the second mass, at the gear or with the gear in it
        let number = 2;
        for (back_efficiency, holds) in [(-0.1, true), (0.6, false)] {
            let mut plant = Fmu::open(&bench.path("plant.fmu")).unwrap();
            let reference = |name: &str| {
                let mut of = plant.description.variables.iter();
                of.find(|variable| variable.name == name).unwrap_or_else(|| panic!("no {name}")).reference
            };
            let [torque, angle, back] =
                ["motor_torque", "motor_angle", &format!("back_efficiency[{number}]")].map(reference);
            plant.instance.set(&[torque, back], &[0.0, back_efficiency]).unwrap();
            plant.instance.begin().unwrap();
            plant.instance.start().unwrap();
            let mut time = 0.0;
            let turned = falls(|| {
                plant.instance.step(time, 1e-3).unwrap();
                time += 1e-3;
                let mut now = [0.0];
                plant.instance.get(&[angle], &mut now).unwrap();
                now[0]
            });
            let right = if holds { turned < UNWINDS } else { turned > FALLS };
            assert!(right, "{gear:?} {rope} {back_efficiency}: {turned}");
        }
        let setpoints = ["--setpoint", "0", "--setpoint", "0.5:20", "--setpoint", "2:0", "--time", "5"];
        let table = [&["cosim", "m.toml", "plant.fmu", "--csv", "run.csv", "--json"], &setpoints[..]].concat();
        bench.said(&table);
        let run = bench.read("run.csv");
        let [angle, faults] = ["machine.motor_angle", "faults"].map(|name| column(&run, name));
        let at = |time: f64| angle[(4000.0 * time) as usize];
        println!("{gear:?} {} {} {} {}", at(0.5), at(2.0), at(4.0), angle[angle.len() - 1]);
        assert!(faults.iter().all(|bits| *bits == 0.0));
        assert!(at(0.5).abs() < UNWINDS && at(2.0) > 10.0, "{gear:?}: {} {}", at(0.5), at(2.0));
        assert!((angle[angle.len() - 1] - at(4.0)).abs() < UNWINDS, "{gear:?}");
    }
}

/// Without inertia enough in front of it a rigid gear has no motion in which the load drives it.
#[test]
fn a_gear_that_would_stop_its_load_at_once_is_refused() {
    let bench = Bench::with("m.toml", machine(GEARS[0], false, -0.9));
    let said = bench.refused(&["export", "fmu", "m.toml", "--of", "plant", "--out", "plant.fmu"]);
    assert!(said.contains("`rotor + load` would stop at once"), "{said}");
}

/// Drive and machine mean the same torque: that of the rope, behind the gear's loss. In each 50 ms once the gear turns
/// within 0.04 %, a fifth of what the loss would leave that is taken for the same both ways; over all ticks, the start of
/// the lift among them, within 0.1 % of the weight.
#[test]
fn the_hoists_two_fmus_agree_on_the_torque_of_its_rope() {
    let bench = Bench::with("hoist.toml", include_str!("../../machines/hoist.toml"));
    bench.said(&["export", "fmu", "hoist.toml", "--of", "plant", "--out", "plant.fmu"]);
    bench.said(&["cosim", "hoist.toml", "plant.fmu", "--csv", "run.csv", "--json"]);
    let run = bench.read("run.csv");
    let [estimated, rope, load] =
        ["drive.shaft_torque", "machine.shaft_torque[2]", "drive.load_torque"].map(|name| column(&run, name));
    let errors: Vec<f64> = estimated.iter().zip(&rope).map(|(estimate, torque)| estimate / torque - 1.0).collect();
    for window in errors[2000..].chunks(500) {
        let mean = window.iter().sum::<f64>() / window.len() as f64;
        assert!(mean.abs() < 4e-4, "{mean}");
    }
    let squares: f64 = estimated.iter().zip(&rope).map(|(estimate, torque)| (estimate - torque).powi(2)).sum();
    let rms = (squares / rope.len() as f64).sqrt();
    // the shaft carries the weight at the start
    println!("{rms} N m of {}", rope[0]);
    assert!(rms < 0.001 * rope[0], "{rms} N m of {}", rope[0]);
    assert!(load.iter().all(|torque| (torque / rope[0] - 1.0).abs() < 0.03));
}

/// A column of a table with a header.
fn column(table: &str, name: &str) -> Vec<f64> {
    let (header, rows) = table.split_once('\n').unwrap();
    let at = header.split(',').position(|other| other == name).unwrap_or_else(|| panic!("no {name}: {header}"));
    rows.lines().map(|row| row.split(',').nth(at).unwrap().parse().unwrap()).collect()
}
