//! Shafts from their dimensions.

use std::f64::consts::PI;

use driveline::machine::{
    Density, Diameter, Error, Length, Section, ShearModulus, Stiffness, series, stepped, try_stepped,
};

use crate::references::{case, close, meets};

const G: ShearModulus = ShearModulus::STEEL;

/// A dozen roundings.
const ROUNDING: f64 = 5e-15;

/// Integral of `dx/(D^4 - d^4)` by Simpson's rule on 4000 pieces.
fn simpson(length: f64, ends: [f64; 2], bore: f64) -> f64 {
    let pieces = 4000;
    let at = |j: usize| {
        let d = ends[0] + (ends[1] - ends[0]) * j as f64 / pieces as f64;
        let weight = if j == 0 || j == pieces { 1.0 } else { 2.0 + 2.0 * (j % 2) as f64 };
        weight / (d.powi(4) - bore.powi(4))
    };
    (0..=pieces).map(at).sum::<f64>() * length / (3.0 * pieces as f64)
}

/// The shafts of Friswell et al., Dynamics of Rotating Machines, example 9.6.3, whose stiffness follows from length and
/// diameter.
#[test]
fn solid_shafts_of_the_twin_screw_ship() {
    let ship = case("torsional_modes.json", "A10_friswell_963_twin_screw_ship");
    for shaft in ship["shafts"].as_array().unwrap() {
        let at = |key: &str| shaft[key].as_f64().unwrap();
        let section = Section::solid(Length(at("L_m")), Diameter(at("D_m")));
        meets(section.stiffness(ShearModulus(at("G_Pa"))).0, &shaft["k"], ROUNDING);
    }
}

#[test]
fn sections_of_a_stepped_shaft_are_in_series() {
    let thin = Section::solid(Length(0.3), Diameter(0.06));
    let thick = Section::solid(Length(0.5), Diameter(0.09)).bored(Diameter(0.04));
    let (a, b) = (thin.stiffness(G).0, thick.stiffness(G).0);
    close(b, G.0 * PI * (0.09_f64.powi(4) - 0.04_f64.powi(4)) / (32.0 * 0.5), ROUNDING);
    close(stepped(&[thin, thick], G).0, series(a, b), ROUNDING);
    // Wang 1989 (1-16): one diameter for both, l_e = l (d_e/d)^4.
    close(Section::solid(Length(0.3 * 16.0), Diameter(0.12)).stiffness(G).0, a, ROUNDING);
}

/// In closed form where it is solid, by quadrature where it is bored; both against Simpson's rule, whose error is
/// h^4/180 of the fourth derivative: below 1e-10 here.
#[test]
fn tapers_are_the_integral_over_their_length() {
    for (ends, bore) in [([0.05, 0.1], 0.0), ([0.1, 0.05], 0.0), ([0.1, 0.1 + 1e-9], 0.0), ([0.08, 0.1], 0.04)] {
        let section =
            Section::tapered(Length(0.4), Diameter(ends[0]), Diameter(ends[1])).bored(Diameter(bore)).stiffness(G);
        close(section.0, G.0 * PI / (32.0 * simpson(0.4, ends, bore)), 1e-10);
    }
    // A hardly tapered bored shaft is a cylinder, and a bore of next to nothing is none: quadrature against closed
    // forms.
    let cone = |from: f64, to: f64| Section::tapered(Length(0.4), Diameter(from), Diameter(to));
    let bored = cone(0.1, 0.1 * (1.0 + 1e-14)).bored(Diameter(0.09)).stiffness(G).0;
    close(bored, Section::solid(Length(0.4), Diameter(0.1)).bored(Diameter(0.09)).stiffness(G).0, 1e-12);
    close(cone(0.05, 0.1).bored(Diameter(1e-9)).stiffness(G).0, cone(0.05, 0.1).stiffness(G).0, 1e-12);
    // The docstring's claim at its edge, against partial fractions: with u = D/d, dx/(D^4 - d^4) integrates to
    // (ln((u - 1)/(u + 1)) / 4 - atan(u) / 2) / d^3 per slope.
    let (from, to, bore, length) = (0.1, 0.2, 0.09, 0.4);
    let primitive = |d: f64| {
        let u: f64 = d / bore;
        (((u - 1.0) / (u + 1.0)).ln() / 4.0 - u.atan() / 2.0) / bore.powi(3)
    };
    let whole = (primitive(to) - primitive(from)) * length / (to - from);
    close(cone(from, to).bored(Diameter(bore)).stiffness(G).0, G.0 * PI / (32.0 * whole), 1e-12);
}

#[test]
fn inertia_of_cylinders_and_cones() {
    let density = Density::STEEL;
    let mass = density.0 * PI / 4.0 * 0.09_f64.powi(2) * 0.5;
    close(Section::solid(Length(0.5), Diameter(0.09)).inertia(density).0, mass * 0.09_f64.powi(2) / 8.0, ROUNDING);
    // A cone to a point weighs a third of its cylinder and has 3/10 m r^2.
    let point = Section::tapered(Length(0.5), Diameter(0.09), Diameter(1e-15)).inertia(density).0;
    close(point, 0.3 * mass / 3.0 * 0.045_f64.powi(2), 1e-13);
}

#[test]
fn wrong_sections_are_refused() {
    let good = Section::solid(Length(1.0), Diameter(0.1));
    for (section, error) in [
        (Section::solid(Length(0.0), Diameter(0.1)), Error::SectionLength),
        (Section::solid(Length(1.0), Diameter(f64::NAN)), Error::SectionDiameter),
        (good.bored(Diameter(0.1)), Error::SectionDiameter),
        (Section::tapered(Length(1.0), Diameter(0.1), Diameter(0.05)).bored(Diameter(0.06)), Error::SectionDiameter),
    ] {
        assert_eq!(try_stepped(&[good, section], G), Err(error));
        assert_eq!(section.try_inertia(Density::STEEL), Err(error));
    }
    assert_eq!(try_stepped(&[good], ShearModulus(0.0)), Err(Error::ShearModulus));
    assert_eq!(try_stepped(&[], G), Err(Error::SectionLength));
    assert_eq!(good.try_inertia(Density(-1.0)), Err(Error::Density));
    const AT_COMPILE_TIME: Stiffness = stepped(&[Section::solid(Length(1.0), Diameter(0.1))], G);
    assert_eq!(AT_COMPILE_TIME.0.to_bits(), stepped(&[good], G).0.to_bits());
}
