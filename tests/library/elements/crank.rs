//! The crank drive against its own geometry.

use std::f64::consts::TAU;

use driveline::machine::{CrankSlider, Error, Inertia, Length, Mass};

use crate::references::close;

const RADIUS: f64 = 0.10;
const ROD: f64 = 0.32;

/// A rod that is a thin stick of even mass: its centre halfway, `m l^2/12` about it.
const PRESS: CrankSlider = CrankSlider {
    radius: Length(RADIUS),
    rod: Length(ROD),
    crank: Inertia(0.4),
    rod_mass: Mass(6.0),
    rod_centre: Length(0.5 * ROD),
    rod_inertia: Inertia(6.0 * ROD * ROD / 12.0),
    slider: Mass(25.0),
};

/// The slider's distance from the crank's axis, by Pythagoras.
fn distance(angle: f64) -> f64 {
    RADIUS * angle.cos() + (ROD * ROD - (RADIUS * angle.sin()).powi(2)).sqrt()
}

fn angles() -> impl Iterator<Item = f64> {
    (0..97).map(|j| f64::from(j) * TAU / 97.0 - 1.0)
}

#[test]
fn travel_and_its_derivatives() {
    // Central differences: the error is h^2/6 of a third derivative of the size of the radius, and rounding over h.
    let h = 1e-4;
    for angle in angles() {
        let travel = PRESS.travel(angle);
        let (before, here, after) = (distance(angle - h), distance(angle), distance(angle + h));
        assert!((travel.travel - (RADIUS + ROD - here)).abs() < 1e-15);
        assert!((travel.first + (after - before) / (2.0 * h)).abs() < 2e-9);
        assert!((travel.second + (after - 2.0 * here + before) / (h * h)).abs() < 1e-7);
    }
    // At the dead centre nothing cancels: r (1 + lambda) phi^2/2, the next term phi^4/24 of it.
    let travel = PRESS.travel(1e-6).travel;
    close(travel, 0.5e-12 * RADIUS * (1.0 + RADIUS / ROD), 1e-11);
}

/// The energy at 1 rad/s of the crank, the slider and a thousand pieces of the stick, whose velocities are differences
/// of positions.
#[test]
fn inertia_is_twice_the_energy() {
    let h = 1e-4;
    let pieces = 1000;
    for angle in angles() {
        let energy = |point: &dyn Fn(f64) -> [f64; 2], mass: f64| {
            let (before, after) = (point(angle - h), point(angle + h));
            0.5 * mass * ((after[0] - before[0]).powi(2) + (after[1] - before[1]).powi(2)) / (4.0 * h * h)
        };
        let mut sum = 0.5 * 0.4 + energy(&|phi| [distance(phi), 0.0], 25.0);
        for piece in 0..pieces {
            let x = (f64::from(piece) + 0.5) / f64::from(pieces);
            let point = |phi: f64| {
                let pin = [RADIUS * phi.cos(), RADIUS * phi.sin()];
                [pin[0] + x * (distance(phi) - pin[0]), pin[1] * (1.0 - x)]
            };
            sum += energy(&point, 6.0 / f64::from(pieces));
        }
        // The pieces are points: 1/(12 n^2) of the stick's turning is missing, 1e-7; the differences err by less.
        close(PRESS.inertia(angle).inertia, 2.0 * sum, 2e-7);
        let slope = (PRESS.inertia(angle + h).inertia - PRESS.inertia(angle - h).inertia) / (2.0 * h);
        assert!((PRESS.inertia(angle).derivative - slope).abs() < 1e-8);
    }
}

#[test]
fn mean_inertia_over_a_turn() {
    // An even mean over many angles that are no multiple of those of the implementation.
    let many = 10_007;
    let mean = (0..many).map(|j| PRESS.inertia(f64::from(j) * TAU / f64::from(many)).inertia).sum::<f64>();
    close(PRESS.mean_inertia().0, mean / f64::from(many), 1e-12);
    // A long rod: m r^2 (1/2 + lambda^2/8), the next term of the order of lambda^4.
    let long = CrankSlider::massless_rod(Length(0.1), Length(1.0), Inertia(0.0), Mass(25.0));
    close(long.mean_inertia().0, 25.0 * 0.01 * (0.5 + 0.01 / 8.0), 1e-4);
}

#[test]
fn forces_of_the_masses_that_go_to_and_fro() {
    let light = CrankSlider { rod_mass: Mass(0.0), ..PRESS };
    let orders = light.force_orders::<17>(30.0);
    for angle in angles() {
        // lambda^16 is below a rounding
        let series: f64 = orders.iter().enumerate().map(|(k, force)| force * (k as f64 * angle).cos()).sum();
        assert!((light.mass_force(angle, 30.0, 0.0) - series).abs() < 1e-12 * orders[1]);
        // What accelerates the crank accelerates the slider.
        let jolt = light.mass_force(angle, 0.0, 7.0);
        assert!((jolt - 25.0 * light.travel(angle).first * 7.0).abs() < 1e-12);
    }
    // The rod's part: half its mass goes with the slider, half with the pin.
    assert_eq!(PRESS.reciprocating_mass().0, 28.0);
    close(PRESS.rotating_inertia().0, 0.4 + 3.0 * RADIUS * RADIUS, 1e-15);
}

#[test]
fn wrong_cranks_are_refused() {
    assert_eq!(PRESS.check(), Ok(()));
    assert_eq!(CrankSlider { radius: Length(ROD), ..PRESS }.check(), Err(Error::CrankRadius));
    assert_eq!(CrankSlider { slider: Mass(-1.0), ..PRESS }.check(), Err(Error::CrankMass));
    assert_eq!(CrankSlider { rod_centre: Length(0.4), ..PRESS }.check(), Err(Error::CrankMass));
}
