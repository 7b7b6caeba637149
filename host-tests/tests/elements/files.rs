//! Machine files with every kind of element make the chain that the builder makes.

use driveline::machine::{
    Belt, Chain, CrankSlider, Damping, Diameter, Efficiency, Gap, Inertia, Length, LinearDamping, Mass, Planetary,
    Ratio, Section, ShearModulus, Stiffness, stepped,
};
use host_tests::machine_file::parse;

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
        "kind = \"planetary\"\nsun_teeth = 20\nring_teeth = 90\nmodule = 0.004\nplanets = 3\nsun = 0.013\nplanet = 0.0027\nplanet_mass = 3.7\ncarrier = 0.067\nefficiency = 0.97",
        "kind = \"belt\"\ndriving = 0.2\ndriven = 0.3\nstiffness = 4.0e5\ndamping = 60.0\nefficiency = 0.96",
        "kind = \"crank\"\ninertia = 0.4\nradius = 0.1\nrod = 0.32\nrod_mass = 6.0\nrod_centre = 0.16\nrod_inertia = 0.05\nslider = 25.0",
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
        let shaft = "[[element]]\nkind = \"shaft\"\nstiffness = 850.0\ndamping = 0.3\n[[element]]\nkind = \"rotor\"\ninertia = 0.35\n";
        let text = format!("name = \"x\"\n[[element]]\nkind = \"motor\"\ninertia = 1.2\n{shaft}{SETTINGS}{duty}");
        parse("x.toml", &text)
    };
    let need = |duty: &str| host_tests::cli::Plan::of(&with(duty).unwrap()).unwrap().need;
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
