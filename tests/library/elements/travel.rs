//! Belts, screws, swinging masses, worms and planetary sets in a chain.

use std::f64::consts::TAU;

use driveline::machine::{
    Belt, Chain, Diameter, Efficiency, Error, Inertia, Length, LinearDamping, Mass, Match, Member, PlanetaryGear,
    Ratio, STANDARD_GRAVITY, Stiffness,
};

use crate::machine::planetary;
use crate::references::{case, close, meets};

/// A handful of roundings.
const ROUNDING: f64 = 5e-15;

const BELT: Belt = Belt {
    driving: Diameter(0.10),
    driven: Diameter(0.25),
    strand: Stiffness(4.0e5),
    damping: LinearDamping(60.0),
    efficiency: Efficiency(0.96),
};

/// The strain energy of both strands, `2 * 1/2 k (r1 phi1 - r2 phi2)^2`, is that of the referred shaft.
#[test]
fn a_belt_keeps_its_strain_energy() {
    let chain = Chain::motor(Inertia(0.02)).gear(Ratio(3.0), Efficiency(1.0)).rotor(Inertia(0.09));
    let chain = chain.belt(BELT).rotor(Inertia(1.5));
    close(chain.ratio(), 3.0 * 2.5, ROUNDING);
    close(chain.efficiency(), 0.96, ROUNDING);
    close(chain.masses()[1], 1.5 / (7.5 * 7.5), ROUNDING);
    // The motor turns by 0.3 rad, the load's shaft by 0.01.
    let (motor, load) = (0.3, 0.01);
    let stretch = 0.05 * motor / 3.0 - 0.125 * load;
    let twist: f64 = motor - 7.5 * load;
    close(0.5 * chain.shafts()[0].stiffness * twist * twist, 4.0e5 * stretch * stretch, ROUNDING);
    close(chain.shafts()[0].damping / chain.shafts()[0].stiffness, 60.0 / 4.0e5, ROUNDING);
}

/// 10 mm a turn: the kinetic energy of the table is that of the referred inertia.
#[test]
fn a_screw_travels_by_its_lead() {
    let chain = Chain::motor(Inertia(0.01)).screw(Length(0.01)).driven(Mass(800.0));
    close(chain.masses()[0] - 0.01, 800.0 * (0.01 / TAU).powi(2), 1e-13);
}

/// A pendulum under a trolley: sqrt(g/l) with the trolley held, sqrt(g/l (1 + m/M)) with it free.
#[test]
fn a_swinging_load_is_a_pendulum() {
    let chain = Chain::motor(Inertia(0.5))
        .gear(Ratio(20.0), Efficiency(0.95))
        .drum(Diameter(0.4))
        .driven(Mass(6_000.0))
        .swinging(Mass(10_000.0), Length(8.0));
    let pendulum = (STANDARD_GRAVITY / 8.0).sqrt();
    let trolley = chain.masses()[0] / (0.2_f64 / 20.0).powi(2);
    let two = chain.reduce(Match::ResonanceAntiresonance);
    close(two.antiresonance(), pendulum, ROUNDING);
    close(two.resonance(), pendulum * (1.0 + 10_000.0 / trolley).sqrt(), ROUNDING);
}

#[test]
fn a_worm_gives_back_less() {
    let lift = |chain: Chain| chain.drum(Diameter(0.5)).lifted(Mass(1_000.0));
    let worm = lift(Chain::motor(Inertia(0.1)).worm(Ratio(30.0), Efficiency(0.75), Efficiency(0.6)));
    let braking = lift(Chain::motor(Inertia(0.1)).braking().worm(Ratio(30.0), Efficiency(0.75), Efficiency(0.6)));
    close(braking.masses()[0] - 0.1, 0.6 * (worm.masses()[0] - 0.1), 1e-13);
    assert_eq!((worm.efficiency(), worm.back_efficiency()), (0.75, 0.6));
}

/// The second worm takes a fifth of the load torque to be lowered, and the motor drives the first one then.
#[test]
fn two_worms_that_lock_do_not_drive_each_other() {
    let behind = |back| Chain::motor(Inertia(0.1)).worm(Ratio(30.0), Efficiency(0.75), Efficiency(back));
    let lift = |back| behind(back).worm(Ratio(2.0), Efficiency(0.8), Efficiency(-0.2)).drum(Diameter(0.5));
    for back in [-0.1, 0.6] {
        let lift = lift(back).lifted(Mass(1_000.0));
        close(lift.losses().before[1], -0.2 / 0.75, ROUNDING);
    }
}

/// Any member driven and any other held, against the speeds at the pitch points and the kinetic energy: with radii of
/// sun and planet, `v` the speed of a planet's pin, the sun's rim moves at `v - w r_planet`, the ring's at
/// `v + w r_planet`.
#[test]
fn a_planetary_set_with_any_member_held() {
    let case = case("textbook_examples.json", "S07_planetary_1");
    let at = |key: &str| case[key].as_f64().unwrap();
    let (sun_teeth, ring_teeth, module) = (at("z_sun"), at("z_ring"), at("module_m"));
    let set = planetary(&case);
    let ring = 0.4;
    let (sun_radius, planet_radius) = (0.5 * module * sun_teeth, 0.5 * module * at("z_planet"));
    let (pin_radius, ring_radius) = (sun_radius + planet_radius, 0.5 * module * ring_teeth);
    let members = [Member::Sun, Member::Ring, Member::Carrier];
    for (driven, held) in [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)] {
        let gear = PlanetaryGear { set, ring: Inertia(ring), input: members[driven], held: members[held] };
        // speeds of sun, ring, carrier and planet
        let pins = [
            [sun_radius, 0.0, -pin_radius, planet_radius],
            [0.0, ring_radius, -pin_radius, -planet_radius],
            [0.0; 4],
            [0.0; 4],
        ];
        let mut matrix = nalgebra::Matrix4::from(pins).transpose();
        (matrix[(2, driven)], matrix[(3, held)]) = (1.0, 1.0);
        let speeds = matrix.lu().solve(&nalgebra::Vector4::new(0.0, 0.0, 1.0, 0.0)).unwrap();
        let pin = speeds[2] * pin_radius;
        let energies = at("J_sun") * speeds[0].powi(2)
            + ring * speeds[1].powi(2)
            + at("J_carrier") * speeds[2].powi(2)
            + at("planets") * (at("J_planet_own_axis") * speeds[3].powi(2) + at("m_planet") * pin * pin);
        // a solution of four equations: some roundings
        close(gear.ratio(), 1.0 / speeds[3 - driven - held], 1e-14);
        close(gear.inertia(), energies, 1e-14);
        assert_eq!(gear.ratio() < 0.0, members[held] == Member::Carrier);
        let chain = Chain::motor(Inertia(1.0)).planetary_gear(gear);
        close(chain.total_inertia() - 1.0, energies, 1e-14);
        assert_eq!(chain.ratio(), gear.ratio().abs());
    }
    let published = PlanetaryGear { set, ring: Inertia(0.0), input: Member::Carrier, held: Member::Ring };
    meets(published.inertia(), &case["expected_J_at_carrier"], 1e-12);
    let own = Chain::motor(Inertia(1.0)).planetary_gear(PlanetaryGear { input: Member::Sun, ..published });
    close(own.total_inertia(), Chain::motor(Inertia(1.0)).planetary(set).total_inertia(), 1e-15);
    let both = PlanetaryGear { held: Member::Carrier, ..published };
    assert_eq!(Chain::motor(Inertia(1.0)).planetary_gear(both).error(), Some(Error::PlanetaryMembers));
    let light = PlanetaryGear { ring: Inertia(-1.0), ..published };
    assert_eq!(Chain::motor(Inertia(1.0)).planetary_gear(light).error(), Some(Error::PlanetaryInertia));
}

#[test]
fn wrong_elements_are_refused() {
    let motor = Chain::motor(Inertia(1.0));
    let drum = motor.drum(Diameter(1.0));
    let belt = |change: fn(&mut Belt)| {
        let mut belt = BELT;
        change(&mut belt);
        motor.belt(belt)
    };
    for (result, error) in [
        (belt(|belt| belt.driving = Diameter(0.0)), Error::PulleyDiameter),
        (belt(|belt| belt.strand = Stiffness(-1.0)), Error::BeltStiffness),
        (belt(|belt| belt.damping = LinearDamping(f64::NAN)), Error::BeltDamping),
        (belt(|belt| belt.efficiency = Efficiency(1.1)), Error::GearEfficiency),
        (drum.belt(BELT), Error::RotaryAfterDrum),
        (motor.screw(Length(0.0)), Error::ScrewLead),
        (drum.screw(Length(0.01)), Error::RotaryAfterDrum),
        (motor.swinging(Mass(1.0), Length(1.0)), Error::DrumMissing),
        (drum.swinging(Mass(1.0), Length(0.0)), Error::PendulumLength),
        (drum.swinging(Mass(0.0), Length(1.0)), Error::LoadMass),
        (motor.worm(Ratio(30.0), Efficiency(0.7), Efficiency(1.1)), Error::GearEfficiency),
    ] {
        assert_eq!(result.error(), Some(error));
    }
}
