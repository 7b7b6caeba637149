//! Starting times by `simulate`, each against its closed form.

use cargo_driveline::machine_file::parse_train;

use super::bench::Bench;

/// Simulated and rigid starting time of a machine (s), and what a reader sees of them.
fn starting(text: &str) -> (Option<f64>, Option<f64>, String) {
    let bench = Bench::with("start.toml", text);
    let found = bench.json(&["simulate", "start.toml"]);
    let time = |key: &str| found["starting"][key].as_f64();
    (time("time"), time("rigid"), bench.said(&["simulate", "start.toml"]))
}

/// One mass with a load that is constant, its mover, and its target.
fn one_mass(mover: &str, speed: f64, target: f64) -> String {
    format!(
        "name = \"one\"\n[[coordinate]]\nname = \"drum\"\ninertia = 2.0\nspeed = {speed:?}\n\
         [[torque]]\non = \"drum\"\n{mover}\n[[torque]]\non = \"drum\"\nkind = \"constant\"\ntorque = -20.0\n\
         [run]\ntime = 12.0\nstep = 0.01\nstarting = \"drum\"\nstarting_speed = {target:?}\n"
    )
}

#[test]
fn one_mass_starts_in_the_time_of_its_closed_form() {
    // Line: J/b ln(end/(end - w)), end = (100 - 20)/0.5.
    let line = 2.0 / 0.5 * (160.0_f64 / (160.0 - 140.0)).ln();
    // Combustion: x' = (0.87 + 1.13 x - x^2 - 20/60)/T from 0.4 to 1, T = J w/tau_N; then to 205 on its governor's
    // line, against the load: its rest falls as e^(-6 t/J).
    let (a, b) = (0.87 - 20.0 / 60.0, 1.13);
    let root = f64::sqrt(b * b + 4.0 * a);
    let odds = |x: f64| (x - (b - root) / 2.0) / ((b + root) / 2.0 - x);
    let engine = 2.0 * 200.0 / 60.0 / root * (odds(1.0) / odds(0.4)).ln();
    let end = 210.0 - 20.0 / 6.0;
    let engine = engine + 2.0 / 6.0 * ((end - 200.0_f64) / (end - 205.0)).ln();
    // Kloss, the load as part of it: with T = 90 N m and a = 0.4, 2 T a s - 20 (s^2 + a^2) has the roots s1, s2, and
    // J w0 (s^2 + a^2)/(20 (s - s2)(s1 - s)) integrates by partial fractions.
    let half = 90.0 * 0.4 / 20.0;
    let swing = f64::sqrt(half * half - 0.16);
    let (s1, s2) = (half + swing, half - swing);
    let part = |s: f64, other: f64| (s * s + 0.16) / (s - other);
    let integral = |s: f64| -s + part(s2, s1) * -(s - s2).ln() - part(s1, s2) * (s1 - s).ln();
    let kloss = 2.0 * 150.0 / 20.0 * (integral(1.0) - integral(0.1));
    let combustion = "kind = \"combustion\"\ncombustion_type = \"direct injection\"\nrated_torque = 60.0\n\
        rated_speed = 200.0\nidle = 70.0\nno_load = 210.0";
    for (mover, speed, target, expected) in [
        ("kind = \"line\"\nstall = 100.0\nslope = 0.5", 0.0, 140.0, line),
        (combustion, 80.0, 205.0, engine),
        ("kind = \"kloss\"\nbreakdown = 90.0\nslip = 0.4\nsynchronous = 150.0", 0.0, 135.0, kloss),
    ] {
        let (time, rigid, said) = starting(&one_mass(mover, speed, target));
        let (time, rigid) = (time.unwrap(), rigid.unwrap());
        // Roundings of a thousand steps; Gauss's quadrature is within a few 1e-12.
        assert!((time / expected - 1.0).abs() < 1e-11, "{mover}: {time} {expected}");
        assert!((rigid / expected - 1.0).abs() < 1e-11, "{mover}: {rigid} {expected}");
        assert!(said.contains("Starting time"), "{said}");
    }
}

/// A motor that lifts by a drum behind a gear of ten, and its friction.
const HOIST: &str = "name = \"hoist\"\n[[coordinate]]\nname = \"motor\"\ninertia = 0.5\n\
        [[coordinate]]\nname = \"drum\"\ninertia = 30.0\n\
        [[link]]\nname = \"gear\"\nbetween = [\"motor\", \"drum\"]\nratio = 10.0\nstiffness = 2.0e5\n\
        damping = 20.0\nefficiency = 0.9\n\
        [[torque]]\non = \"motor\"\nkind = \"constant\"\ntorque = 120.0\n\
        [[torque]]\non = \"drum\"\nkind = \"constant\"\ntorque = -450.0\n\
        [[friction]]\non = \"drum\"\ntorque = 90.0\n\
        [start]\nkind = \"pretensioned\"\nheld = \"motor\"\n\
        [run]\ntime = 2.0\nstep = 1e-3\nstarting = \"drum\"\nstarting_speed = 10.0\n";

#[test]
fn a_hoist_with_losses_starts_in_the_time_of_its_rigid_machine() {
    let (time, rigid, _) = starting(HOIST);
    // (J_m + J/(i^2 eta)) w/(tau - tau_L/eta), at the motor.
    let expected = (0.5 + 0.3 / 0.9) * 100.0 / (120.0 - 54.0 / 0.9);
    assert!((rigid.unwrap() / expected - 1.0).abs() < 1e-12, "{rigid:?} {expected}");
    // The swing of 1033 rad/s has died out by e^-74, and moves no momentum. Until the load breaks loose, within a
    // quarter of its period, friction takes up to 9 N m less than it slides with, of 60 N m that accelerate.
    assert!((time.unwrap() - expected).abs() < 9.0 / 60.0 * 1.6e-3, "{time:?} {expected}");
}

#[test]
fn a_start_from_rest_has_to_break_loose() {
    let mover = |breakaway: f64| {
        format!(
            "kind = \"constant\"\ntorque = 120.0\n[[friction]]\non = \"drum\"\ntorque = 80.0\nbreakaway = {breakaway:?}"
        )
    };
    // At rest 100 N m push, in motion 20 N m accelerate 2 kg m2.
    for (breakaway, speed, expected) in [(99.0, 0.0, Some(5.0)), (101.0, 0.0, None), (101.0, 1.0, Some(4.9))] {
        let (time, rigid, _) = starting(&one_mass(&mover(breakaway), speed, 50.0));
        assert_eq!([time.is_some(), rigid.is_some()], [expected.is_some(); 2], "{breakaway}: {time:?} {rigid:?}");
        for (found, expected) in [time, rigid].into_iter().flatten().zip([expected; 2].into_iter().flatten()) {
            // Roundings of a thousand steps.
            assert!((found / expected - 1.0).abs() < 1e-11, "{breakaway}: {time:?} {rigid:?}");
        }
    }
}

#[test]
fn a_damper_that_slips_leaves_the_rigid_machine_without_a_starting_time() {
    let with = |ratio: f64| {
        let damper = format!(
            "[[link]]\nname = \"brake\"\nbetween = [\"motor\", \"drum\"]\nratio = {ratio:?}\nstiffness = 0.0\n\
             damping = 0.2\n[[torque]]"
        );
        let text = HOIST.replace("efficiency = 0.9\n", "").replace("torque = 90.0", "torque = 0.0");
        starting(&text.replacen("[[torque]]", &damper, 1))
    };
    // 0.8 kg m2 and 75 N m at the motor: at the gear's own ratio the damper stands still.
    let (time, rigid, _) = with(10.0);
    let expected = 0.8 * 100.0 / 75.0;
    assert!((rigid.unwrap() / expected - 1.0).abs() < 1e-12, "{rigid:?} {expected}");
    // A quarter of a period of 1033 rad/s, in which the shaft winds up further.
    assert!((time.unwrap() - expected).abs() < 1.6e-3, "{time:?} {expected}");
    // At half of it, it slips by half the motor's speed, and takes a quarter of 0.2 N m s/rad of it.
    let (time, rigid, _) = with(5.0);
    let slipping = 0.8 / 0.05 * (75.0_f64 / (75.0 - 5.0)).ln();
    assert!(rigid.is_none() && (time.unwrap() - slipping).abs() < 1.6e-3, "{time:?} {rigid:?} {slipping}");
}

#[test]
fn a_load_that_drives_on_the_way_leaves_the_losses_open() {
    let of = |constant: f64| {
        let parabola = format!("kind = \"parabola\"\na = {constant:?}\nb = 200.0\nc = -20.0\n");
        starting(&HOIST.replace("kind = \"constant\"\ntorque = -450.0\n", &parabola)).1
    };
    // -50 N m at rest and at 10 rad/s, and 450 N m half way; of -550 N m there are -50.
    assert!(of(-50.0).is_none() && of(-550.0).is_some());
}

#[test]
fn a_machine_reaches_a_lower_speed_as_well() {
    let of = |torque: f64, speed, target| {
        starting(&one_mass(&format!("kind = \"constant\"\ntorque = {torque:?}"), speed, target))
    };
    // Backwards from rest by 100 N m on 2 kg m2; braked by 30 N m from 80 to 20 rad/s; through rest by the same.
    for (torque, speed, target, expected) in
        [(-80.0, 0.0, -60.0, 1.2), (-10.0, 80.0, 20.0, 4.0), (-10.0, 80.0, -10.0, 6.0)]
    {
        let (time, rigid, _) = of(torque, speed, target);
        // Roundings of a thousand steps; the closed form is that of a start.
        assert!((time.unwrap() / expected - 1.0).abs() < 1e-11 && rigid.is_none(), "{time:?} {rigid:?} {expected}");
    }
}

#[test]
fn what_has_no_starting_time_says_so() {
    let line = "kind = \"line\"\nstall = 100.0\nslope = 0.5";
    // It tends to 160 rad/s.
    let (time, rigid, said) = starting(&one_mass(line, 0.0, 161.0));
    assert_eq!((time, rigid), (None, None));
    assert!(said.contains("none"), "{said}");
    // Reached after the run: 34 s.
    let (time, rigid, _) = starting(&one_mass(line, 0.0, 159.97));
    let expected = 4.0 * (160.0_f64 / 0.03).ln();
    assert!(time.is_none() && (rigid.unwrap() / expected - 1.0).abs() < 1e-9, "{rigid:?} {expected}");
    // A torque by time has no closed form here: 80 N m for 12 s.
    let steps = "kind = \"steps\"\npoints = [[0.0, 100.0], [1.0, 60.0]]";
    let (time, rigid, _) = starting(&one_mass(steps, 0.0, 60.0));
    // 40 rad/s after a second, then 20 rad/s2.
    assert!((time.unwrap() - 2.0).abs() < 1e-12 && rigid.is_none(), "{time:?} {rigid:?}");
    for (text, expected) in [
        (one_mass(line, 80.0, 80.0), "a speed other than that of the coordinate at the start"),
        (one_mass(line, 0.0, 5.0).replace("starting = \"drum\"", "starting = \"dram\""), "\"drum\""),
        (one_mass(line, 0.0, 5.0).replace("starting = \"drum\"\n", ""), "`starting`, the coordinate"),
    ] {
        let fault = parse_train("one", &text).unwrap_err();
        assert!(fault.expected.contains(expected), "{}", fault.explained());
    }
}
