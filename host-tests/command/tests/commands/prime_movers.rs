//! Prime movers in train files, run by `simulate`, each against its closed form.

use cargo_driveline::machine_file::parse_train;

use super::bench::answered;

const MOVERS: &str = "name = \"movers\"\n\
    [[coordinate]]\nname = \"winch\"\ninertia = 8.0\n\
    [[coordinate]]\nname = \"tram\"\ninertia = 40.0\n\
    [[coordinate]]\nname = \"engine\"\ninertia = 30.0\nspeed = 70.0\n\
    [[torque]]\non = \"winch\"\nkind = \"shunt\"\nvoltage = 440.0\nresistance = 2.0\nflux = 2.8\n\
    [[torque]]\non = \"tram\"\nkind = \"series\"\nvoltage = 600.0\nresistance = 1.2\nflux = 0.02\n\
    [[torque]]\non = \"engine\"\nkind = \"combustion\"\ncombustion_type = \"TYPE\"\nrated_torque = 1500.0\n\
    rated_speed = 200.0\nidle = 70.0\nno_load = 210.0\n\
    [run]\ntime = 2.5\nstep = 1e-2\n";

#[test]
fn prime_movers_run_up_as_their_closed_forms() {
    let time = 2.5_f64;
    for (burns, [a, b, c]) in
        [("spark", [1.0, 1.0, 1.0]), ("indirect injection", [0.6, 1.4, 1.0]), ("direct injection", [0.87, 1.13, 1.0])]
    {
        let found = answered("simulate", &MOVERS.replace("TYPE", burns));
        let last = |j: usize| found["coordinates"][j]["last"].as_f64().unwrap();
        // c^2/(R J) of the shunt motor; (R + c w)^3 = R^3 + 3 c^2 U^2 t/J of the series motor
        let shunt = 440.0 / 2.8 * -(-2.8 * 2.8 / (2.0 * 8.0) * time).exp_m1();
        let series = ((1.2_f64.powi(3) + 3.0 * (0.02 * 600.0_f64).powi(2) * time / 40.0).cbrt() - 1.2) / 0.02;
        // x' = (a + b x - c x^2)/T from 0.35 to 1, then the rest to no load falls as e^(-150 t/J)
        let root = f64::sqrt(b * b + 4.0 * a * c);
        let odds = |x: f64| (x - (b - root) / (2.0 * c)) / ((b + root) / (2.0 * c) - x);
        let rated = 30.0 * 200.0 / 1500.0 / root * (odds(1.0) / odds(0.35)).ln();
        let engine = 210.0 - 10.0 * (-150.0 * (time - rated) / 30.0).exp();
        assert!(rated < time, "{rated}");
        for (found, expected) in [(last(0), shunt), (last(1), series), (last(2), engine)] {
            // 250 steps, each rounded
            assert!((found / expected - 1.0).abs() < 1e-12, "{burns}: {found} {expected}");
        }
        assert!(found["proof"][0].as_f64().unwrap() < 1e-8);
    }
}

#[test]
fn a_prime_mover_that_cannot_be_is_refused_at_its_key() {
    let text = MOVERS.replace("TYPE", "spark");
    assert!(parse_train("movers", &text).is_ok());
    for (from, to, expected) in [
        ("\"spark\"", "\"steam\"", "\"spark\", \"indirect injection\" or \"direct injection\""),
        ("idle = 70.0", "idle = 200.0", "a speed below `rated_speed`"),
        ("no_load = 210.0", "no_load = 200.0", "a speed above `rated_speed`"),
        ("resistance = 1.2", "resistance = 0.0", "ohm"),
    ] {
        let fault = parse_train("movers", &text.replace(from, to)).unwrap_err();
        assert!(fault.expected.contains(expected), "{to}: {}", fault.explained());
    }
}

/// At -R/c, -60 rad/s here, the current of a series motor has no bound, and below it the formula is of no motor.
#[test]
fn a_series_motor_that_starts_at_its_pole_or_below_is_refused_where_it_acts() {
    let text = MOVERS.replace("TYPE", "spark");
    let start = |speed: &str| {
        parse_train("movers", &text.replace("inertia = 40.0\n", &format!("inertia = 40.0\nspeed = {speed}\n")))
    };
    assert!(start("-59.0").is_ok());
    for speed in ["-60.0", "-65.0"] {
        let fault = start(speed).unwrap_err();
        assert_eq!(fault.key, "torque[1].on");
        assert!(fault.expected.contains("above -60 rad/s") && fault.expected.contains(speed.trim_end_matches(".0")));
    }
}

/// The torque of the first instant halves within 1e-18 s, a tiny part of a step; the motion is smooth all the same.
#[test]
fn a_series_motor_almost_without_resistance_runs_up_as_its_closed_form() {
    let text = MOVERS.replace("TYPE", "spark").replace("resistance = 1.2", "resistance = 1e-6");
    let found = answered("simulate", &text);
    let series = ((1e-6_f64.powi(3) + 3.0 * (0.02 * 600.0_f64).powi(2) * 2.5 / 40.0).cbrt() - 1e-6) / 0.02;
    // 250 steps, and some hundred from the first instant to them, each rounded
    assert!((found["coordinates"][1]["last"].as_f64().unwrap() / series - 1.0).abs() < 1e-12, "{found}");
    assert!(found["proof"][0].as_f64().unwrap() < 1e-8);
}
