//! Tables of the laws, and the observer of each.

use std::f64::consts::TAU;

use driveline::design::{Disturbance, Encoder, Rate};
use driveline::machine::{
    CrankSlider, DrivenMechanism, Error, FourBar, Inertia, Length, MECHANISM_POINTS, Mass, Mechanism, Toggle,
};
use driveline::observer::{MechanismConfig, MechanismObserver, Observer, TABLE_POINTS, ToolObserver};
use driveline::settings::Bases;
use driveline_solver::noise::Noise;

use super::rig::{LAWS, Machine, RATIO, between, draw};

#[test]
fn tables_are_those_of_the_full_solver() {
    let mut noise = Noise::new(44);
    for law in LAWS {
        for drawn in (0..20).map(|_| draw(law, &mut noise)) {
            assert_eq!(drawn.mechanism.error(), None, "{law}");
            let truth = [&drawn.inertia, &drawn.inertia.slope(), &drawn.way.slope()];
            let (mut off, mut most) = ([0.0_f64; 3], [0.0_f64; 3]);
            for (j, point) in drawn.mechanism.points.iter().enumerate() {
                let angle = TAU * j as f64 / MECHANISM_POINTS as f64;
                let values = [point.inertia, point.derivative, point.leverage];
                for k in 0..3 {
                    let right = truth[k].at(angle);
                    off[k] = off[k].max((values[k] - right).abs());
                    most[k] = most[k].max(right.abs());
                }
            }
            // the solver's series end where the last tenth of the orders of a slope is below 1e-10
            for k in 0..3 {
                assert!(off[k] < 1e-8 * most[k], "{law} {k}: {} of {}", off[k], most[k]);
            }
        }
    }
}

/// A free machine has no load, whatever its law and its weight: neither inertia nor weight is taken for one.
#[test]
fn a_free_mechanism_has_no_load() {
    const RATE_HZ: u32 = 10_000;
    let mut noise = Noise::new(45);
    for law in LAWS {
        for _ in 0..3 {
            let drawn = draw(law, &mut noise);
            let truth = Machine::new(&drawn, 2.0, 0.0);
            // a weight of the size of the inertia's torque at 60 rad/s
            let leverage = drawn.mechanism.points.iter().map(|p| p.leverage.abs()).fold(0.0, f64::max);
            let weight = between(&mut noise, 0.5, 1.0) * truth.most_taken(60.0) * RATIO / leverage;
            let mut truth = Machine::new(&drawn, 2.0, weight);
            let driven =
                DrivenMechanism::new(Inertia(truth.constant), &drawn.mechanism.weight(weight), 1, RATIO as u32);
            let taken = truth.most_taken(100.0);
            let disturbance = Disturbance { torque_accuracy: 0.01 * taken, load_torque_step: 0.2 * taken, within: 0.5 };
            let design = driven.observer(Rate::hz(RATE_HZ), Encoder::counts(131_072), disturbance);
            let config = MechanismConfig::<f64, 1>::new(&design, Bases::SI);
            assert!(MechanismConfig::<f64>::try_new(&design, Bases::SI).is_err(), "a weight is not lost");
            truth.speed = 100.0;
            let mut observer = ToolObserver::<f64>::steady(&config, 0, 0.0, 100.0);
            let mut worst = 0.0_f64;
            for tick in 0..RATE_HZ {
                truth.tick(0.0, 1.0 / f64::from(RATE_HZ));
                observer.step(&config, truth.seen(), 0.0);
                if tick > RATE_HZ / 5 {
                    worst = worst.max(observer.estimate(&config).load_torque.abs());
                }
            }
            // what the straight lines between 64 places leave, from the truth's table: at most the deviation in the
            // middle, of inertia's and weight's torque at the highest speed
            let step = TAU * RATIO / TABLE_POINTS as f64;
            let torque = |angle: f64| {
                let [_, slope, weight] = truth.at(angle);
                0.5 * slope * 110.0 * 110.0 + weight
            };
            let straight = (0..TABLE_POINTS).map(|k| {
                let at = step * k as f64;
                (torque(at + 0.5 * step) - 0.5 * (torque(at) + torque(at + step))).abs()
            });
            let bound = 5.0 * design.rigid.standard_deviation[2] + straight.fold(0.0, f64::max) + 0.005 * taken;
            println!("{law}: {worst:.4} of {taken:.3}, bound {bound:.4}");
            assert!(worst < bound && bound < 0.3 * taken, "{law}: {worst} of {taken}, {bound}");
        }
    }
}

#[test]
fn wrong_mechanisms_are_refused() {
    let bars = FourBar::massless(Length(0.1), Length(0.4), Length(0.3), Length(0.35), Inertia(6.0));
    let of = |mechanism: Mechanism| DrivenMechanism::try_new(Inertia(0.5), &mechanism, 1, 10).map(|_| ());
    let knee = Toggle { bars, link: Length(0.5), direction: 0.0, slider: Mass(10.0) };
    let slider = CrankSlider::massless_rod(Length(0.6), Length(0.5), Inertia(4.0), Mass(4.0));
    let cases = [
        (Mechanism::four_bar(&bars), Ok(())),
        (Mechanism::toggle(&knee), Ok(())),
        (Mechanism::cam(&[0.0, 0.1, 0.1], Mass(1.0)), Ok(())),
        (Mechanism::slider_crank(&slider), Err(Error::CrankRadius)),
        (Mechanism::four_bar(&FourBar { crank: Length(0.36), ..bars }), Err(Error::LinkageBars)),
        (Mechanism::four_bar(&FourBar { ground: Length(0.7), ..bars }), Err(Error::LinkageBars)),
        (Mechanism::four_bar(&FourBar { ground: Length(f64::NAN), ..bars }), Err(Error::LinkageBars)),
        (Mechanism::four_bar(&FourBar { coupler_mass: Mass(-1.0), ..bars }), Err(Error::LinkageMass)),
        (Mechanism::four_bar(&FourBar { coupler_centre: Length(0.5), ..bars }), Err(Error::LinkageMass)),
        (Mechanism::toggle(&Toggle { link: Length(0.3), ..knee }), Err(Error::LinkageBars)),
        (Mechanism::toggle(&Toggle { slider: Mass(f64::NAN), ..knee }), Err(Error::LinkageMass)),
        (Mechanism::cam(&[0.0, 0.1], Mass(1.0)), Err(Error::MechanismTable)),
        (Mechanism::cam(&[0.0, f64::INFINITY, 0.1], Mass(1.0)), Err(Error::MechanismTable)),
        (Mechanism::cam(&[0.0, 0.1, 0.1], Mass(-1.0)), Err(Error::LinkageMass)),
        (Mechanism::table(&[1.0, -200.0, 1.0], &[0.0; 3]), Err(Error::MechanismInertia)),
        (Mechanism::four_bar(&bars).rotor(Inertia(-1.0)), Err(Error::RotorInertia)),
        (Mechanism::four_bar(&bars).weight(f64::NAN), Err(Error::MechanismInertia)),
    ];
    for (case, (mechanism, expected)) in cases.into_iter().enumerate() {
        assert_eq!(of(mechanism), expected, "{case}");
    }
    let _: MechanismObserver<f32> = MechanismObserver::default();
}
