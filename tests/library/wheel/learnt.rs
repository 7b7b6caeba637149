//! A wheel learnt from a steady run.

use driveline::settings::Teeth;

use super::edges::{Run, clock};

const STEADY: Run = Run { speed: 10.0, ripple: 0.0, order: 1.0, jitter: 0.0, seed: 1 };

#[test]
fn a_steady_run_shows_the_teeth() {
    let teeth = Teeth::<5>::degrees([0.0, 50.0, 110.0, 180.0, 270.0]);
    // From any tooth on; a count of the clock is 0.0036 degrees.
    for begin in 0..5 {
        let times: Vec<u32> = STEADY.edges(&teeth, 12)[begin..].iter().map(|time| clock(*time)).collect();
        let learnt = Teeth::<5>::learnt(&times).unwrap();
        // Two spans are 90 degrees: behind the first or the second of them.
        let first = if learnt.angles[1] * 360.0 > 80.0 { 4 } else { 0 };
        for (tooth, angle) in learnt.angles.iter().enumerate() {
            let exact = (teeth.angles[(first + tooth) % 5] - teeth.angles[first]).rem_euclid(1.0);
            assert!((angle - exact).abs() * 360.0 < 0.01, "{learnt:?}");
        }
    }
}

#[test]
fn what_does_not_repeat_is_not_learnt() {
    let times: Vec<u32> = STEADY.edges(&Teeth::<35>::gap(36, 1), 12).iter().map(|time| clock(*time)).collect();
    assert!(Teeth::<34>::learnt(&times).unwrap_err().to_string().contains("repeat"));
    assert!(Teeth::<35>::learnt(&times[..70]).unwrap_err().to_string().contains("three turns"));
    assert!(Teeth::<35>::learnt(&times).is_ok());
}
