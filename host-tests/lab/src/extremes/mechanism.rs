//! Free machines with a crank or a linkage: they have no load, so that what the observer takes for one is its error.

use std::f64::consts::TAU;

use driveline::design::{Disturbance, Encoder, Rate};
use driveline::machine::{CrankSlider, DrivenMechanism, FourBar, Inertia, Length, Mass, Mechanism};
use driveline::observer::{MechanismConfig, MechanismObserver, Observer};
use driveline::settings::Bases;

use super::solver::said;
use super::{Cases, Found};

const RATE_HZ: u32 = 10_000;
/// Turns of the motor to one of the crank.
const RATIO: u32 = 10;
/// Speed at the start (rad/s).
const SPEED: f64 = 100.0;

pub(super) fn add(all: &mut Cases) {
    const ERROR: &str = "load torque of a free machine, of what its inertia takes";
    all.subject("crank observer at its limits", ERROR, "energy of the slider-crank, own derivative");
    for lambda in [0.3, 0.9, 0.99] {
        for flywheel in [1.0, 0.1, 0.03, 0.01, 1e-3] {
            all.case(format!("r/l {lambda}, flywheel {flywheel} of the ram"), || slider_crank(lambda, flywheel));
        }
    }
    all.subject("four-bar near its change point", ERROR, "energy of the bars, own closure (Freudenstein)");
    for short in [0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-5, 1e-7, 1e-12, 0.0, -1e-3] {
        all.case(format!("bars that clear it by {short:e} m"), || four_bar(short));
    }
}

fn slider_crank(lambda: f64, flywheel: f64) -> Result<Found, String> {
    let (r, mass) = (0.1, 100.0);
    let crank = CrankSlider::massless_rod(Length(r), Length(r / lambda), Inertia(0.0), Mass(mass));
    let law = |phi: f64| {
        let (s, c) = phi.sin_cos();
        mass * (r * s * (1.0 + lambda * c / (1.0 - (lambda * s).powi(2)).sqrt())).powi(2)
    };
    free(&Mechanism::slider_crank(&crank), flywheel, law)
}

/// Crank 0.1, coupler 0.3, ground 0.35 m: the crank turns round where the rocker is longer than 0.15 m.
fn four_bar(short: f64) -> Result<Found, String> {
    let [a, b, c, d] = [0.1, 0.3, 0.15 + short, 0.35];
    let bars = FourBar::massless(Length(a), Length(b), Length(c), Length(d), Inertia(6.0));
    let law = |phi: f64| {
        let [one, two, three] = [d / a, d / c, (a * a - b * b + c * c + d * d) / (2.0 * a * c)];
        let (s, cosine) = phi.sin_cos();
        let reach = f64::hypot(one - cosine, s);
        let psi = (-s).atan2(one - cosine) + ((two * cosine - three) / reach).clamp(-1.0, 1.0).acos();
        let between = (phi - psi).sin();
        6.0 * ((two * s + between) / (one * psi.sin() + between)).powi(2)
    };
    free(&Mechanism::four_bar(&bars), 0.3, law)
}

/// A free machine of a mechanism and a flywheel, a share of the mechanism's largest inertia. Its energy is kept, so its
/// speed follows from the angle. What the table's 64 straight lines may leave is a tenth of the torque that the inertia
/// takes at most.
fn free(mechanism: &Mechanism, flywheel: f64, law: impl Fn(f64) -> f64) -> Result<Found, String> {
    let r = 1.0 / f64::from(RATIO);
    let grid = || (0..40_000).map(|k| f64::from(k) / 40_000.0 * TAU);
    let largest = grid().map(&law).fold(0.0, f64::max);
    let constant = flywheel * r * r * largest;
    let driven = DrivenMechanism::try_new(Inertia(constant), mechanism, 1, RATIO).map_err(said)?;
    let inertia = |motor: f64| constant + r * r * law(r * motor);
    let energy = inertia(0.0) * SPEED * SPEED;
    let speed = |motor: f64| (energy / inertia(motor)).sqrt();
    // J' w^2/2 by central differences
    let taken = grid().map(|phi| {
        let (at, h) = (phi / r, 1e-4);
        (0.25 / h * (inertia(at + h) - inertia(at - h)) * energy / inertia(at)).abs()
    });
    let taken = taken.fold(0.0, f64::max);
    let disturbance = Disturbance { torque_accuracy: 0.01 * taken, load_torque_step: 0.2 * taken, within: 0.5 };
    let design = driven.try_observer(Rate::hz(RATE_HZ), Encoder::counts(131_072), disturbance).map_err(said)?;
    let config = MechanismConfig::<f64>::try_new(&design, Bases::SI).map_err(said)?;
    let mut observer = MechanismObserver::<f64>::steady(&config, 0, 0.0, SPEED);
    let (mut motor, mut worst) = (0.0_f64, 0.0_f64);
    let h = 1.0 / f64::from(RATE_HZ) / 16.0;
    for tick in 0..RATE_HZ {
        for _ in 0..16 {
            let a = speed(motor);
            let b = speed(motor + 0.5 * h * a);
            let c = speed(motor + 0.5 * h * b);
            motor += h / 6.0 * (a + 2.0 * b + 2.0 * c + speed(motor + h * c));
        }
        let counts = (motor / TAU * 131_072.0).floor() as i64 as u32;
        observer.step(&config, counts << 15, 0.0);
        if tick > RATE_HZ / 5 {
            worst = worst.max(observer.estimate(&config).load_torque.abs());
        }
    }
    Ok(Found { error: worst / taken, limit: 0.1 })
}
