//! Random reversals: right in every number, and for long.

use driveline::number::Fixed;
use driveline::observer::Gap;
use driveline_lab::backlash::{Case, Course, Kind, Library, RATE_HZ, Rig, cases, error};

/// Errors over all cases and courses of four seconds.
fn errors<N: Gap>(library: impl Fn(&Case) -> Library<N>) -> Vec<f64> {
    let all = cases().into_iter().flat_map(|case| Kind::ALL.map(|kind| (case, kind)));
    all.map(|(case, kind)| error(&Course::record(&case, kind, 31, 4.0).unwrap(), &mut library(&case))).collect()
}

/// The project's aim is 4 % rms of the peak, its limit 6 %, over the trial; a single course of a light load that hardly
/// twists its shaft by the gap may be worse, and no course is where the observer that ignores the gap is, above 15 %.
#[test]
fn the_shaft_torque_is_right_through_the_gap() {
    let all = [errors(Library::<f64>::double), errors(Library::<f32>::single), errors(Library::<Fixed>::fixed)];
    let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
    let double = mean(&all[0]);
    for (name, errors) in ["f64", "f32", "fixed"].into_iter().zip(&all) {
        println!("{name}: {:.2} %", 100.0 * mean(errors));
        assert!(errors.iter().all(|error| *error < 0.15), "{name}: {errors:?}");
        assert!(mean(errors) < 0.04, "{name}: {:.2} %", 100.0 * mean(errors));
        // One algorithm: the numbers differ by their rounding, which is small beside what an encoder count does.
        assert!((mean(errors) - double).abs() < 0.02 * double, "{name}");
    }
}

/// Largest root mean square error in any second, over the peak of the whole run, and that of the whole run.
fn long<N: Gap>(case: &Case, mut library: Library<N>, seconds: u32) -> (f64, f64) {
    let mut rig = Rig::new(case, Kind::Rattling, 77).unwrap();
    let (mut worst, mut peak, mut whole) = (0.0_f64, 0.0_f64, 0.0);
    for second in 0..seconds {
        let mut sum = 0.0;
        for _ in 0..RATE_HZ {
            let (angle, torque) = rig.sensed();
            library.tick(angle, torque);
            let shaft = library.shaft_torque();
            assert!(shaft.is_finite());
            let truth = rig.plant().shaft_torque(0);
            sum += (shaft - truth).powi(2);
            peak = peak.max(truth.abs());
            rig.advance();
        }
        whole += sum;
        // The first second finds the side.
        if second > 0 {
            worst = worst.max(sum / f64::from(RATE_HZ));
        }
    }
    (worst.sqrt() / peak, (whole / f64::from(seconds * RATE_HZ)).sqrt() / peak)
}

fn stays_right(seconds: u32) {
    let case = &cases()[0];
    for (name, (worst, whole)) in [
        ("f32", long(case, Library::<f32>::single(case), seconds)),
        ("fixed", long(case, Library::<Fixed>::fixed(case), seconds)),
    ] {
        println!(
            "measured: {name} {:.2} % rms over {seconds} s, {:.2} % in the worst second",
            100.0 * whole,
            100.0 * worst
        );
        // The aim over the run, the limit in every second of it: never lost. A second on the wrong side is off by a
        // fifth of the peak and more.
        assert!(whole < 0.04 && worst < 0.06, "{name}: {whole} {worst}");
    }
}

#[test]
fn it_stays_right_over_random_reversals() {
    stays_right(20);
}

/// 1e7 ticks.
#[test]
#[ignore = "ten million ticks take a minute"]
fn it_stays_right_over_ten_million_ticks() {
    stays_right(1000);
}
