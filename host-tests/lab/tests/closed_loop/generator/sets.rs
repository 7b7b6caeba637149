//! The generator sets on the host, in closed loop with their full plants: classes, faults, load that goes and comes.

use driveline_closed_loop::ticks::OnHost;
use driveline_firmware::Words;
use driveline_firmware::scene::Scene;
use driveline_firmware::scenes::find;
use driveline_firmware::scenes::generator::{CHEST_LAG, RATED_SPEED, VALVE_LAG};
use driveline_lab::generator::run::{Moment, Program, run};
use driveline_lab::generator::set::Kind;
use driveline_lab::generator::standard::Figures;

/// Largest torque that may be commanded, of rated: the curve's, and its rounding in the words.
pub const MOST: f64 = 1.2001;

/// With the estimated load fed forward, and without, as the panel's choice of constants counts them.
const WAYS: [u32; 2] = [0, 1];

/// The loads of a set's run, times (s) and shares of rated power, and its duration (s).
fn loads(kind: Kind) -> (Vec<(f64, f64)>, f64) {
    match kind {
        // A turbocharged engine's steps: half, then what its charge pressure allows.
        Kind::Diesel => (vec![(0.0, 0.0), (9.0, 0.5), (13.0, 0.8), (17.0, 1.0), (22.0, 0.0)], 27.0),
        Kind::Turbine => (vec![(0.0, 0.0), (12.0, 0.25), (22.0, 0.5), (32.0, 0.75), (42.0, 1.0), (56.0, 0.0)], 112.0),
    }
}

fn moments(kind: Kind, words: Words, program: &Program) -> Vec<Moment> {
    run(kind, words, program, &mut on_host(kind, words), |_, _| {}).unwrap()
}

pub fn on_host(kind: Kind, words: Words) -> OnHost<Box<dyn Scene>> {
    let number = if words == Words::Single { "f32" } else { "fixed" };
    OnHost(find(&format!("generator/{number}/{}/2400", kind.name())).unwrap().start())
}

/// The diesel is started from its starter's speed, the turbine found turning.
fn judged(kind: Kind, words: Words, constants: u32) -> (Figures, Vec<Moment>) {
    let (loads, duration) = loads(kind);
    let speed = if kind == Kind::Diesel { 20.0 } else { RATED_SPEED };
    let program = Program { speed, on: 0.5, constants, loads: loads.clone(), seizes: None, duration };
    let moments = moments(kind, words, &program);
    (Figures::of(&moments, &loads, duration), moments)
}

/// The diesel reaches what G3 asks for and what precise power asks for beyond it, with feed-forward and without, in
/// both numbers; the loss of the whole load does not trip it, and the feed-forward halves what a load does to the
/// frequency.
#[test]
fn the_diesel_is_precise() {
    for words in [Words::Single, Words::Fixed] {
        let [fed, plain] = WAYS.map(|way| judged(Kind::Diesel, words, way));
        for (figures, moments) in [&fed, &plain] {
            assert!(figures.is_precise(), "{words:?}: {figures:#?}");
            assert!(moments.iter().all(|moment| moment.mode < 16 && (0.0..=MOST).contains(&moment.command)));
            assert_eq!(moments.last().map(|moment| moment.mode), Some(2));
        }
        assert!(fed.0.drop < 0.65 * plain.0.drop && fed.0.rise < 0.65 * plain.0.rise, "{words:?}");
    }
}

/// The turbine meets class D with feed-forward and without, in both numbers. By the energy that the steam brings in
/// while the valve closes, no governor keeps the speed below a rise of the sum of the lags over the acceleration time.
#[test]
fn the_turbine_is_of_class_d() {
    let bound = (VALVE_LAG + CHEST_LAG) / 8.0;
    for words in [Words::Single, Words::Fixed] {
        for way in WAYS {
            let (figures, moments) = judged(Kind::Turbine, words, way);
            assert!(figures.is_of_class_d(), "{words:?} {way:?}: {figures:#?}");
            assert!(moments.iter().all(|moment| moment.mode < 16 && (0.0..=MOST).contains(&moment.command)));
            // Less what friction takes and the steam loses by the speed, a tenth of it.
            assert!(figures.rise > 0.9 * bound, "{words:?} {way:?}: {figures:#?}");
        }
    }
}

/// In droop the frequency yields by 4 % of the load's share, and comes back.
#[test]
fn in_droop_the_frequency_yields_to_the_load() {
    let loads = vec![(0.0, 0.0), (3.0, 0.5), (11.0, 0.0)];
    let program =
        Program { speed: RATED_SPEED, on: 0.2, constants: 2, loads: loads.clone(), seizes: None, duration: 19.0 };
    let moments = moments(Kind::Diesel, Words::Single, &program);
    let figures = Figures::of(&moments, &loads, 19.0);
    let [before, loaded, after] = [0, 1, 2].map(|k: usize| figures.steady[k][1]);
    // 0.02 and the calibration's 3 % of it, at constant power.
    assert!((before - loaded - 0.02).abs() < 0.0015 && (before - after).abs() < 5e-4, "{before} {loaded} {after}");
}

/// The figures of a course that is known: a drop of 5 %, exponential recovery of 0.5 s, a ripple of 0.05 %.
#[test]
fn figures_are_those_of_a_known_course() {
    let course: Vec<Moment> = (0..48_000)
        .map(|tick| {
            let time = f64::from(tick) / 2400.0;
            let fall = if time < 10.0 { 0.0 } else { 0.05 * (-(time - 10.0) / 0.5).exp() };
            let frequency = 1.0 - fall + 2.5e-4 * (40.0 * time).sin();
            Moment { time, frequency, ..Moment::default() }
        })
        .collect();
    let figures = Figures::of(&course, &[(0.0, 0.0), (10.0, 0.5)], 20.0);
    // The ripple is 2.5e-4 either way; what is left of the exponential in the last two seconds 1e-7 of 5 %.
    assert!((figures.band - 5e-4).abs() < 1e-5);
    assert!((figures.drop - 0.05).abs() < 3e-4 && figures.rise < 3e-4);
    // 0.5 s times ln(5 %/0.1 %), give or take the ripple: 0.5 s times 2.5e-4 of the band.
    assert!((figures.recovery - 0.5 * 50.0_f64.ln()).abs() < 0.5 * 0.3);
    assert!(!figures.is_precise() && !Figures::of(&[], &[(0.0, 0.0), (3.0, 1.0)], 9.0).is_precise());
}
