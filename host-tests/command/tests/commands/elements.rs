//! Machine files with every kind of element make the chain that the builder makes.

use cargo_driveline::machine_file::parse;
use driveline::machine::{
    Belt, Chain, CrankSlider, Damping, Diameter, Efficiency, FourBar, Gap, Inertia, Length, LinearDamping, Mass,
    Mechanism, Member, Planetary, PlanetaryGear, Ratio, Section, ShearModulus, Stiffness, Toggle, Train, stepped,
};

use crate::references::{case, close, meets};

const SETTINGS: &str = "
[encoder]
lines = 2048
[control]
rate_hz = 10000
[disturbance]
torque_accuracy = 1.0
load_torque_step = 10.0
within = 1.0
[limits]
torque = 100.0
speed = 100.0
";

fn chain(elements: &[&str]) -> Result<Chain, String> {
    let tables: String = elements.iter().map(|keys| format!("[[element]]\n{keys}\n")).collect();
    let text = format!("name = \"x\"\n{tables}{SETTINGS}");
    parse("x.toml", &text).map(|machine| machine.chain).map_err(|fault| format!("{}: {}", fault.key, fault.found))
}

const MOTOR: &str = "kind = \"motor\"\ninertia = 0.5";

#[test]
fn rotary_elements() {
    let read = chain(&[
        MOTOR,
        "kind = \"section\"\nlength = 0.3\ndiameter = 0.06\ndamping = 2.0",
        "kind = \"section\"\nlength = 0.1\ndiameter = 0.06\nend = 0.08\nbore = 0.02\nmodulus = 8.0e10\ndamping = 2.0",
        "kind = \"planetary\"\nsun_teeth = 20\nring_teeth = 90\nmodule = 0.004\nplanets = 3\nsun = 0.013\nplanet = \
            0.0027\nplanet_mass = 3.7\ncarrier = 0.067\nefficiency = 0.97",
        "kind = \"belt\"\ndriving = 0.2\ndriven = 0.3\nstiffness = 4.0e5\ndamping = 60.0\nefficiency = 0.96",
        "kind = \"crank\"\ninertia = 0.4\nradius = 0.1\nrod = 0.32\nrod_mass = 6.0\nrod_centre = 0.16\nrod_inertia = \
            0.05\nslider = 25.0",
        "kind = \"worm\"\nratio = 30.0\nefficiency = 0.75\nback_efficiency = 0.6",
        "kind = \"rotor\"\ninertia = 3.0",
    ]);
    let planetary = Planetary {
        sun_teeth: 20,
        ring_teeth: 90,
        module: 0.004,
        planets: 3,
        sun: Inertia(0.013),
        planet: Inertia(0.0027),
        planet_mass: Mass(3.7),
        carrier: Inertia(0.067),
        efficiency: Efficiency(0.97),
    };
    let crank = CrankSlider {
        radius: Length(0.1),
        rod: Length(0.32),
        crank: Inertia(0.4),
        rod_mass: Mass(6.0),
        rod_centre: Length(0.16),
        rod_inertia: Inertia(0.05),
        slider: Mass(25.0),
    };
    let belt = Belt {
        driving: Diameter(0.2),
        driven: Diameter(0.3),
        strand: Stiffness(4.0e5),
        damping: LinearDamping(60.0),
        efficiency: Efficiency(0.96),
    };
    let first = Section::solid(Length(0.3), Diameter(0.06));
    let second = Section::tapered(Length(0.1), Diameter(0.06), Diameter(0.08)).bored(Diameter(0.02));
    let built = Chain::motor(Inertia(0.5))
        .shaft(stepped(&[first], ShearModulus::STEEL), Damping(2.0))
        .shaft(stepped(&[second], ShearModulus(8.0e10)), Damping(2.0))
        .planetary(planetary)
        .belt(belt)
        .rotor(crank.mean_inertia())
        .worm(Ratio(30.0), Efficiency(0.75), Efficiency(0.6))
        .rotor(Inertia(3.0));
    assert_eq!(read, Ok(built));
}

#[test]
fn elements_that_travel() {
    let read = chain(&[
        MOTOR,
        "kind = \"backlash\"\ngap = 0.001",
        "kind = \"shaft\"\nstiffness = 1.0e4",
        "kind = \"rotor\"\ninertia = 0.1",
        "kind = \"screw\"\nlead = 0.02",
        "kind = \"rope\"\nfalls = 1\nstiffness = 1.0e6",
        "kind = \"slack\"\ntravel = 0.001",
        "kind = \"driven\"\nmass = 500.0",
        "kind = \"swinging\"\nmass = 200.0\nlength = 3.0",
    ]);
    let built = Chain::motor(Inertia(0.5))
        .backlash(Gap(0.001))
        .shaft(Stiffness(1.0e4), Damping(0.0))
        .rotor(Inertia(0.1))
        .screw(Length(0.02))
        .rope(driveline::machine::Falls(1), Stiffness(1.0e6))
        .slack(Length(0.001))
        .driven(Mass(500.0))
        .swinging(Mass(200.0), Length(3.0));
    assert_eq!(read, Ok(built));
}

/// A file that says how its machine is shaken is told which observer that needs, as the library says.
#[test]
fn the_observer_that_is_needed() {
    let with = |duty: &str| {
        let shaft = "[[element]]\nkind = \"shaft\"\nstiffness = 850.0\ndamping = 0.3\n[[element]]\nkind = \
            \"rotor\"\ninertia = 0.35\n";
        let text = format!("name = \"x\"\n[[element]]\nkind = \"motor\"\ninertia = 1.2\n{shaft}{SETTINGS}{duty}");
        parse("x.toml", &text)
    };
    let need = |duty: &str| cargo_driveline::cli::Plan::of(&with(duty).unwrap()).unwrap().need;
    assert!(need("").is_none());
    let soft = need("[duty]\nchange = 60.0\nrise = 0.0\nevery = 0.7\n").unwrap();
    assert_eq!((soft.observer, soft.without_gap), ("semi-implicit", [0.0; 2]));
    assert_eq!(need("[duty]\nchange = 60.0\nrise = 10.0\nevery = 0.7\n").unwrap().observer, "rigid");
    assert_eq!(with("[duty]\nchange = 60.0\nrise = -1.0\nevery = 0.7\n").unwrap_err().key, "duty.rise");
    assert_eq!(with("[duty]\nchange = 60.0\nrise = 1.0\nevery = 0.0\n").unwrap_err().key, "duty.every");
}

/// What no element can be is told at its key, what cannot stand there at the element.
#[test]
fn faults_are_told_with_their_place() {
    let key = |element: &str| chain(&[MOTOR, element]).unwrap_err();
    assert!(key("kind = \"section\"\nlength = -0.3\ndiameter = 0.06").starts_with("element[1].length: -0.3"));
    assert!(key("kind = \"section\"\nlength = 0.3").starts_with("element[1].diameter: nothing"));
    assert!(
        key("kind = \"swinging\"\nmass = 1.0\nlength = 3.0")
            .starts_with("element[1]: a swinging that cannot stand here")
    );
    let bored = key("kind = \"section\"\nlength = 0.3\ndiameter = 0.06\nbore = 0.07");
    assert!(bored.contains("outer diameters of the shaft's section"), "{bored}");
    let crank = key("kind = \"crank\"\ninertia = 0.4\nradius = 0.4\nrod = 0.32\nslider = 25.0");
    assert!(crank.contains("radius of the crank"), "{crank}");
}

#[test]
fn a_planetary_set_with_another_member_held() {
    let keys = |more: &str| {
        format!(
            "kind = \"planetary\"\nsun_teeth = 20\nring_teeth = 90\nmodule = 0.004\nplanets = 3\nsun = 0.013\nplanet = \
                0.0027\nplanet_mass = 3.7\n\
             carrier = 0.067\n{more}"
        )
    };
    let set = Planetary {
        sun_teeth: 20,
        ring_teeth: 90,
        module: 0.004,
        planets: 3,
        sun: Inertia(0.013),
        planet: Inertia(0.0027),
        planet_mass: Mass(3.7),
        carrier: Inertia(0.067),
        efficiency: Efficiency(1.0),
    };
    let gear = PlanetaryGear { set, ring: Inertia(0.4), input: Member::Ring, held: Member::Sun };
    let read = chain(&[MOTOR, &keys("ring = 0.4\ninput = \"ring\"\nheld = \"sun\"")]);
    assert_eq!(read, Ok(Chain::motor(Inertia(0.5)).planetary_gear(gear)));
    // the sun drives and the ring is held where the file is silent
    let silent = chain(&[MOTOR, &keys("")]);
    assert_eq!(silent, Ok(Chain::motor(Inertia(0.5)).planetary(set)));
    for (more, fault) in [
        ("held = \"sun\"", "element[1].held: the text \"sun\""),
        ("input = \"ring\"", "element[1].held: nothing"),
        ("held = \"planet\"", "element[1].held: the text \"planet\""),
        ("ring = -1.0", "element[1].ring: -1.0"),
    ] {
        assert_eq!(chain(&[MOTOR, &keys(more)]), Err(fault.to_owned()), "{more}");
    }
}

const SHIP: &str = include_str!("../../machines/ship.toml");

/// The published ship as a file: the train that the builder makes, and its frequencies.
#[test]
fn a_ship_with_two_screws() {
    let ship = parse("ship.toml", SHIP).unwrap();
    let case = case("torsional_modes.json", "A10_friswell_963_twin_screw_ship");
    let tolerance = case["rel_tol"].as_f64().unwrap();
    for (mode, expected) in ship.modes().resonances().iter().zip(&case["expected_omega_rad_s"].as_array().unwrap()[1..])
    {
        meets(mode.frequency, expected, tolerance);
    }
    let fit = &case["two_mass_reduction"]["resonance_antiresonance_fit"];
    let two = ship.reduce(driveline::machine::Match::ResonanceAntiresonance).unwrap();
    meets(two.motor_inertia, &fit["J_motor"], tolerance);
    meets(two.stiffness, &fit["k"], tolerance);
    assert_eq!(ship.branches.len(), 2);
    assert_eq!(ship.branches[1].elements[2].label, "starboard shaft");
    // what it is designed from is what it shows: the two masses stand in the plan
    let plan = cargo_driveline::cli::Plan::of(&ship).unwrap();
    assert_eq!(plan.inertias, [two.motor_inertia, two.load_inertia]);
}

/// A branch that begins with its shaft adds nothing to the mass that it stands on, and may stand on a branch, whose
/// speed it has.
#[test]
fn branches_on_branches_and_behind_gears() {
    let branch = |at: &str, elements: &[&str]| {
        let tables: String = elements.iter().map(|keys| format!("[[branch.element]]\n{keys}\n")).collect();
        format!("[[branch]]\nat = \"{at}\"\n{tables}")
    };
    let text = format!(
        "name = \"x\"\n[[element]]\n{MOTOR}\n[[element]]\nkind = \"gear\"\nratio = 2.0\n[[element]]\nkind = \
            \"rotor\"\nlabel = \"wheel\"\n\
         inertia = 0.3\n[[element]]\nkind = \"shaft\"\nstiffness = 1e4\n[[element]]\nkind = \"rotor\"\ninertia = \
         1.0\n{}{}{SETTINGS}",
        branch(
            "wheel",
            &[
                "kind = \"shaft\"\nstiffness = 2e4",
                "kind = \"gear\"\nratio = 3.0",
                "kind = \"rotor\"\nlabel = \"second\"\ninertia = 5.0",
            ]
        ),
        branch(
            "second",
            &[
                "kind = \"rotor\"\ninertia = 0.7",
                "kind = \"shaft\"\nstiffness = 9e5",
                "kind = \"rotor\"\ninertia = 8.0"
            ]
        ),
    );
    let read = parse("x.toml", &text).unwrap();
    let main = Chain::motor(Inertia(0.5))
        .gear(Ratio(2.0), Efficiency(1.0))
        .rotor(Inertia(0.3))
        .shaft(Stiffness(1e4), Damping(0.0))
        .rotor(Inertia(1.0));
    let first = Chain::motor(Inertia(f64::MIN_POSITIVE))
        .shaft(Stiffness(2e4), Damping(0.0))
        .gear(Ratio(3.0), Efficiency(1.0))
        .rotor(Inertia(5.0));
    let second = Chain::motor(Inertia(0.7)).shaft(Stiffness(9e5), Damping(0.0)).rotor(Inertia(8.0));
    let built = Train::of(main).branch(0, Ratio(2.0), first).branch(2, Ratio(6.0), second);
    assert_eq!(read.train, Some(built));
    // by hand: 0.5 + 0.3/4 at the motor, 1/4, (5 + 0.7)/36, 8/36
    for (mass, expected) in read.masses().iter().zip([0.575, 0.25, 5.7 / 36.0, 8.0 / 36.0]) {
        close(*mass, expected, 1e-15);
    }
    // a run of it has the same masses and shafts: its frequencies are those of the solver of trains
    let run = format!("{text}[run]\ntime = 0.1\nstep = 0.01\n");
    let train = cargo_driveline::machine_file::parse_train("x.toml", &run).unwrap();
    assert_eq!(train.coordinates, ["motor + wheel", "rotor 2", "second + rotor 4", "rotor 5"]);
    let modes = train.train.modes().unwrap();
    for (mode, omega) in read.modes().resonances().iter().zip(&modes.omega[1..]) {
        // by another way, with eigenvalues of the stiffness: half the digits of the lowest
        close(mode.frequency, *omega, 1e-9);
    }
}

#[test]
fn a_branch_that_cannot_be_is_told_at_its_place() {
    let fault = |from: &str, to: &str| {
        assert!(SHIP.contains(from), "{from}");
        let text = SHIP.replacen(from, to, 1);
        let fault = parse("ship.toml", &text).unwrap_err();
        let line = text.lines().nth(fault.line - 1).unwrap_or("").to_owned();
        (fault.key.clone(), line, fault.to_string())
    };
    let (key, line, text) = fault("at = \"pinions\"", "at = \"pinion\"");
    assert_eq!((key.as_str(), line.as_str()), ("branch[0].at", "at = \"pinion\""));
    assert!(text.contains("\"engine\", \"pinions\""), "{text}");
    // a later branch can stand on an earlier one, not the other way round
    let (key, ..) = fault("at = \"pinions\"", "at = \"starboard wheel\"");
    assert_eq!(key, "branch[0].at");
    let (key, _, text) = fault("inertia = 800.0", "inertia = -800.0");
    assert!(key == "branch[0].element[1].inertia" && text.contains("-800.0"), "{text}");
    let (key, _, text) = fault("kind = \"rotor\"\nlabel = \"port wheel\"", "kind = \"motor\"\nlabel = \"port wheel\"");
    assert!(key == "branch[0].element[1]" && text.contains("a second motor"), "{text}");
    let (key, ..) = fault("[[branch.element]]\nkind = \"rotor\"\nlabel = \"port propeller\"\ninertia = 450.0", "");
    assert_eq!(key, "branch[0].element[2]");
    let (key, ..) = fault("at = \"pinions\"", "at = \"pinions\"\nside = 1");
    assert_eq!(key, "branch[0].side");
    // which of two masses is meant is not told by a label that both have
    let (key, _, text) = fault("label = \"engine\"", "label = \"pinions\"");
    assert!(key == "branch[0].at" && text.contains("one mass alone"), "{text}");
    let (start, end) = (SHIP.find("[[branch.element]]").unwrap(), SHIP.rfind("[[branch]]").unwrap());
    let (key, _, text) = fault(&SHIP[start..end], "");
    assert!(key == "branch[0].element" && text.contains("part of the branch"), "{text}");
    let (key, _, text) = fault(&SHIP[start..end], "[[branch.element]]\nkind = \"gear\"\nratio = 2.0\n\n");
    assert!(key == "branch[0]" && text.contains("without a mass"), "{text}");
}

/// A shaft of its own inertia in pieces, free at both ends: each piece has half of its inertia at either end, so that
/// the frequencies are `2 n sqrt(k/J) sin(m pi/2n)`. A section has the inertia `pi rho l (d^4 - b^4)/32`.
#[test]
fn shafts_have_inertia_of_their_own() {
    use std::f64::consts::PI;
    let (n, k, j) = (5, 4.0e4, 0.3);
    let piece = format!("kind = \"shaft\"\nstiffness = {}\ninertia = {}", k * 5.0, j / 5.0);
    let motor = "kind = \"motor\"\ninertia = 1e-12";
    let bar = chain(&[motor, &piece, &piece, &piece, &piece, &piece]).unwrap();
    for (mode, m) in bar.modes().resonances().iter().zip(1..=n) {
        let omega = 2.0 * f64::from(n) * f64::sqrt(k / j) * (f64::from(m) * PI / f64::from(2 * n)).sin();
        // the motor adds 3e-11 of an end's inertia
        close(mode.frequency, omega, 1e-10);
    }
    let section = "kind = \"section\"\nlength = 0.6\ndiameter = 0.07\nbore = 0.03\ndensity = 7850.0";
    let rotor = "kind = \"rotor\"\nlabel = \"roll\"\ninertia = 2.0";
    let own = PI * 7850.0 * 0.6 * (0.07_f64.powi(4) - 0.03_f64.powi(4)) / 32.0;
    let read = chain(&[MOTOR, section, rotor]).unwrap();
    for (mass, expected) in read.masses().iter().zip([0.5 + 0.5 * own, 2.0 + 0.5 * own]) {
        close(*mass, expected, 1e-14);
    }
    // a cone from 0.2 to 0.1 m in 10,000 slices, of each `pi rho dx d^4/32`: total and centre are kept
    let cone = "kind = \"section\"\nlength = 2.0\ndiameter = 0.2\nend = 0.1\ndensity = 7850.0";
    let mut ends = [0.0; 2];
    for slice in 0..10_000 {
        let x = (f64::from(slice) + 0.5) * 1e-4;
        let own = PI * 7850.0 * 2e-4 * (0.2 - 0.1 * x).powi(4) / 32.0;
        ends = [ends[0] + (1.0 - x) * own, ends[1] + x * own];
    }
    let read = chain(&[MOTOR, cone, rotor]).unwrap();
    for (mass, expected) in read.masses().iter().zip([0.5 + ends[0], 2.0 + ends[1]]) {
        // the rule of mid-points is off by 1e-8 of what is added, a twentieth of the whole
        close(*mass, expected, 1e-8);
    }
    let built = Chain::motor(Inertia(0.5)).rotor(Inertia(0.2)).shaft(Stiffness(9e3), Damping(1.0)).rotor(Inertia(0.2));
    let text = "kind = \"shaft\"\nstiffness = 9e3\ndamping = 1.0\ninertia = 0.4";
    assert_eq!(chain(&[MOTOR, text]), Ok(built));
    // masses of nothing but shafts have names, and a gear behind them keeps its losses
    let gear = "kind = \"gear\"\nratio = 2.0\nefficiency = 0.9";
    let tables: String = [MOTOR, text, text, gear, text].iter().map(|keys| format!("[[element]]\n{keys}\n")).collect();
    let text = format!("name = \"x\"\n{tables}{SETTINGS}[run]\ntime = 0.1\nstep = 0.01\n");
    let train = cargo_driveline::machine_file::parse_train("x.toml", &text).unwrap();
    assert_eq!(train.coordinates, ["motor", "end of shaft", "end of shaft 2", "end of shaft 3"]);
}

/// An external gear turns the sense round: referred to the motor the machine is the same.
#[test]
fn an_external_gear_has_a_negative_ratio() {
    let gear = |ratio: f64| format!("kind = \"gear\"\nratio = {ratio:?}\nefficiency = 0.97");
    let shaft = "kind = \"shaft\"\nstiffness = 1e4";
    let with = |ratio: f64| chain(&[MOTOR, shaft, &gear(ratio), "kind = \"rotor\"\ninertia = 3.0"]);
    assert!(with(4.0).is_ok() && with(-4.0) == with(4.0));
    assert_eq!(with(0.0), Err("element[2].ratio: 0.0".to_owned()));
    assert_eq!(with(-1e7), Err("element[2].ratio: -10000000.0".to_owned()));
}

/// Damping against the ground on each shaft, in proportion to the inertia: the machine coasts as `exp(-a t)`, and every
/// mode has the damping ratio `a/(2 w)`.
#[test]
fn rotors_are_damped_against_the_ground() {
    let text = |first: f64, second: f64, torque: &str| {
        format!(
            "name = \"x\"\n[[element]]\nkind = \"motor\"\ninertia = 0.5\nviscous = {first:?}\n[[element]]\nkind = \
             \"gear\"\nratio = -2.0\n[[element]]\nkind = \"shaft\"\nstiffness = 3e3\n[[element]]\nkind = \
             \"rotor\"\ninertia = 6.0\nviscous = {second:?}\n{SETTINGS}{torque}[run]\ntime = 2.0\nstep = 0.5\n"
        )
    };
    // a = 4 1/s: the masses slow down together from a torque in the ratio of their inertias
    let torque = |on: &str, torque: f64| {
        format!("[[torque]]\non = \"{on}\"\nkind = \"steps\"\npoints = [[0.0, {torque:?}], [1.0, 0.0]]\n")
    };
    let run = text(2.0, 24.0, &(torque("motor", 5.0) + &torque("rotor", 15.0)));
    let mut motion = cargo_driveline::machine_file::parse_train("x.toml", &run).unwrap().motion;
    motion.advance(2.0);
    let expected = 10.0 / 4.0 * (1.0 - (-4.0_f64).exp()) * (-4.0_f64).exp();
    for j in 0..2 {
        // roundings of a run of two seconds
        assert!((motion.speed(j) / expected - 1.0).abs() < 1e-11, "{} {expected}", motion.speed(j));
    }
    let machine = parse("x.toml", &text(2.0, 24.0, "")).unwrap();
    assert_eq!(machine.viscous(), [2.0, 6.0]);
    let vibration = cargo_driveline::cli::Vibration::of(&machine).unwrap();
    let omega = f64::sqrt(750.0 * (1.0 / 0.5 + 1.0 / 1.5));
    close(vibration.damped[0].decay, 4.0, 1e-14);
    close(vibration.damped[1].damping_ratio, 4.0 / (2.0 * omega), 1e-13);
    close(vibration.damped[1].frequency, (omega * omega - 4.0_f64).sqrt(), 1e-14);
}

/// A shaft between two masses is not lumped: of an even one the equation of its angles, of a cone that of the spherical
/// Bessel functions of order 1, which `(s^4 f')' + kappa^2 s^4 f = 0` leads to. Five modes each.
#[test]
fn modes_of_a_shaft_with_inertia_are_those_of_the_continuum() {
    let [motor, rotor] = [2000.0, 394.0];
    let (table, bit) = (format!("kind = \"motor\"\ninertia = {motor}"), format!("kind = \"rotor\"\ninertia = {rotor}"));
    let of = |shaft: &str| {
        let tables: String = [&table, shaft, &bit].iter().map(|keys| format!("[[element]]\n{keys}\n")).collect();
        let machine = parse("x.toml", &format!("name = \"x\"\n{tables}{SETTINGS}")).unwrap();
        cargo_driveline::cli::Vibration::of(&machine).unwrap().resonances
    };
    // angle and torque of two solutions at either end
    let residual = |near: [[f64; 2]; 2], far: [[f64; 2]; 2], omega: f64| {
        let square = omega * omega;
        let [a, b] = near.map(|[angle, torque]| torque + square * motor * angle);
        let [c, d] = far.map(|[angle, torque]| torque - square * rotor * angle);
        a * d - b * c
    };
    let even = |omega: f64| {
        let (theta, k) = (omega * f64::sqrt(317.0 / 473.0), 473.0);
        let (sine, cosine) = theta.sin_cos();
        residual([[1.0, 0.0], [0.0, k * theta]], [[cosine, -k * theta * sine], [sine, k * theta * cosine]], omega)
    };
    // 0.6 to 0.2 m over 40 m: the apex lies 20 m beyond the thin end
    let cone = |omega: f64| {
        let kappa = omega * f64::sqrt(7850.0 / 79.3e9);
        let at = |s: f64| {
            let (x, stiffness) = (kappa * s, 79.3e9 * std::f64::consts::PI / 32.0 * (0.01 * s).powi(4) * kappa);
            let (sine, cosine) = x.sin_cos();
            let [one, other] = [sine - x * cosine, cosine + x * sine];
            // towards the apex
            [[one, x * sine], [other, x * cosine]]
                .map(|[f, rate]| [f / x.powi(3), -stiffness * (x * rate - 3.0 * f) / x.powi(4)])
        };
        residual(at(60.0), at(20.0), omega)
    };
    let even_text = "kind = \"shaft\"\nstiffness = 473.0\ninertia = 317.0";
    let cone_text = "kind = \"section\"\nlength = 40.0\ndiameter = 0.6\nend = 0.2\ndensity = 7850.0";
    for (text, equation) in [(even_text, &even as &dyn Fn(f64) -> f64), (cone_text, &cone)] {
        for mode in &of(text)[..5] {
            // the equation changes its sign within 1e-9
            let [below, above] = [1.0 - 1e-9, 1.0 + 1e-9].map(|by| equation(by * mode.frequency));
            assert!(below * above < 0.0, "{text}: {} {below} {above}", mode.frequency);
        }
    }
}

/// A chain of elements of any length: `2 sqrt(k/J) sin(m pi/2n)`; a controller has room for 16 masses.
#[test]
fn modes_take_a_chain_of_any_length() {
    let n = 60;
    let pair = "[[element]]\nkind = \"shaft\"\nstiffness = 800.0\n[[element]]\nkind = \"rotor\"\ninertia = 2.0\n";
    let text = format!("name = \"x\"\n[[element]]\nkind = \"motor\"\ninertia = 2.0\n{}{SETTINGS}", pair.repeat(n - 1));
    assert!(parse("x.toml", &text).is_err());
    let machine = cargo_driveline::machine_file::parse_for_modes("x.toml", &text).unwrap();
    let vibration = cargo_driveline::cli::Vibration::of(&machine).unwrap();
    assert_eq!(vibration.masses.len(), n);
    for (m, mode) in (1..).zip(&vibration.resonances) {
        close(mode.frequency, 40.0 * (f64::from(m) * std::f64::consts::PI / (2 * n) as f64).sin(), 1e-13);
    }
    assert_eq!(vibration.resonances.len(), n - 1);
}

/// The mean inertia of each law, by the full solver's ways, is that of the library's table.
#[test]
fn mechanisms_of_every_law() {
    let bars = "crank = 0.1, coupler = 0.35, rocker = 0.3, ground = 0.4, coupler_mass = 4.0, rocker_inertia = 2.5";
    let library = FourBar {
        coupler_mass: Mass(4.0),
        coupler_centre: Length(0.175),
        ..FourBar::massless(Length(0.1), Length(0.35), Length(0.3), Length(0.4), Inertia(2.5))
    };
    let knee = Toggle { bars: library, link: Length(0.5), direction: 0.4, slider: Mass(30.0) };
    let cases = [
        (format!("four_bar = {{ {bars} }}"), Mechanism::four_bar(&library)),
        (format!("toggle = {{ {bars}, link = 0.5, direction = 0.4, slider_mass = 30.0 }}"), Mechanism::toggle(&knee)),
        (
            "cam = { lift = [0.0, 0.02, 0.05, 0.04, 0.01], mass = 40.0 }".to_owned(),
            Mechanism::cam(&[0.0, 0.02, 0.05, 0.04, 0.01], Mass(40.0)),
        ),
        ("inertia_table = [3.0, 4.0, 2.0]".to_owned(), Mechanism::table(&[3.0, 4.0, 2.0], &[0.0; 3])),
    ];
    for (law, mechanism) in &cases {
        let read = chain(&[
            MOTOR,
            "kind = \"shaft\"\nstiffness = 850.0",
            &format!("kind = \"mechanism\"\ninertia = 0.4\n{law}"),
        ])
        .unwrap();
        // the solver's series end where their coefficients are below 1e-10
        close(read.masses()[1], 0.4 + mechanism.mean_inertia().0, 1e-9);
    }
    let refused = |law: &str| chain(&[MOTOR, &format!("kind = \"mechanism\"\n{law}")]).unwrap_err();
    assert!(refused("inertia = 1.0").contains("mechanism"), "{}", refused("inertia = 1.0"));
    assert!(refused(&format!("{}\n{}", cases[0].0, cases[3].0)).contains("mechanism"));
    assert!(refused("inertia_table = [1.0, 2.0]").contains("inertia_table"));
    assert!(refused("cam = { lift = [0.0, 0.1, 0.2], mass = 1.0, friction = 2.0 }").contains("friction"));
}
