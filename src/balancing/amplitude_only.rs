//! One plane without a phase sensor: amplitudes of runs with the same trial weight at different angles.

use super::error::Error;
use super::matrix::pick;
use super::qr::Qr;
use super::scalar::{Complex, Scalar, real, size};

/// A weight found from amplitudes alone.
#[derive(Clone, Copy, Debug, PartialEq)]
// Not logged: the complex numbers of `nalgebra` have no `Format`.
pub struct FromAmplitudes<T: Scalar> {
    /// The weight to add.
    pub weight: Complex<T>,
    /// A second answer, equally good, of two trial runs.
    pub or: Option<Complex<T>>,
    /// Difference of the two estimates of the squared effect (by the runs' mean, by their differences) over the second;
    /// 0: they agree, or are two runs, 1: the limit.
    pub disagreement: T,
}

/// From the baseline's amplitude, the trial weight, and the angle (rad) and amplitude of each trial run.
///
/// # Errors
/// [`Error::TrialWeightZero`], [`Error::Reading`], [`Error::ReadingMissing`] for fewer than two runs,
/// [`Error::NoEffect`] where the runs are no different, [`Error::TrialAngles`] where the angles are the same or the
/// weights of three or more runs lie on one line through the shaft, [`Error::AmplitudesDisagree`] where no influence
/// gives such amplitudes, or the runs contradict each other by more than the effect's square.
///
/// With `a` the influence, `v0` the baseline and the weight `W` at angle alpha,
/// `|v0 + a W e^{i alpha}|^2 = |v0|^2 + x^2 + 2 |v0| x cos(phi + alpha)`, where `x = |a| W` and phi is the angle of
/// `a/v0`. Three angles give x and phi by least squares; two leave two answers.
pub fn from_amplitudes<T: Scalar>(baseline: T, trial: T, runs: &[(T, T)]) -> Result<FromAmplitudes<T>, Error> {
    if !(trial > T::zero() && trial.is_finite()) {
        return Err(Error::TrialWeightZero { plane: 0 });
    }
    let right = |value: T| value >= T::zero() && value.is_finite();
    if !(right(baseline) && baseline > T::zero()) {
        return Err(Error::Reading { row: 0 });
    }
    if let Some(row) = runs.iter().position(|(angle, amplitude)| !(right(*amplitude) && angle.is_finite())) {
        return Err(Error::Reading { row: row + 1 });
    }
    if runs.len() < 2 {
        return Err(Error::ReadingMissing { row: runs.len() + 1 });
    }
    let same = |a: T, b: T| (a - b).abs() <= baseline * T::default_epsilon() * real(100.0);
    if runs.iter().all(|(_, amplitude)| same(*amplitude, baseline)) {
        return Err(Error::NoEffect { plane: 0 });
    }
    let weight = |effect: Complex<T>| -> Complex<T> {
        // w = -v0/a, and a/v0 = effect/(W |v0|)
        -Complex { re: baseline * trial, im: T::zero() } / effect
    };
    if runs.len() == 2 {
        let (one, other) = two(baseline, pick(runs, 0, (T::zero(), T::zero())), pick(runs, 1, (T::zero(), T::zero())))?;
        return Ok(FromAmplitudes { weight: weight(one), or: Some(weight(other)), disagreement: T::zero() });
    }
    // r^2 - v0^2 = p + q cos alpha + s sin alpha
    let mut qr = Qr::<T, 3>::new();
    for (angle, amplitude) in runs {
        let (sine, cosine) = angle.sin_cos();
        let row = [T::one(), cosine, sine].map(|re| Complex { re, im: T::zero() });
        let right = (*amplitude - baseline) * (*amplitude + baseline);
        qr.absorb(&row, Complex { re: right, im: T::zero() });
    }
    // Directions on one line through the shaft leave two answers: their scatter matrix is then singular. The root of
    // its determinant is this product; `own(0)` squared is the number of runs.
    if !(qr.own(1) * qr.own(2) > qr.own(0) * qr.own(0) * real(1e-3)) {
        return Err(Error::TrialAngles);
    }
    let [square, q, s] = qr.pivoted(T::zero()).solve().map(|value| value.re);
    let effect = Complex { re: q, im: -s }.unscale(baseline + baseline);
    let found = effect.re * effect.re + effect.im * effect.im;
    // The differences between the runs must exceed the rounding of their common part.
    let rounding = real::<T>(1e-6) * baseline;
    if !(found > rounding * rounding) {
        return Err(Error::NoEffect { plane: 0 });
    }
    let disagreement = (square - found).abs() / found;
    if !(disagreement <= T::one()) {
        return Err(Error::AmplitudesDisagree);
    }
    Ok(FromAmplitudes { weight: weight(effect), or: None, disagreement })
}

/// The effect `x e^{i phi}` of two runs: where two circles meet, twice.
fn two<T: Scalar>(baseline: T, a: (T, T), b: (T, T)) -> Result<(Complex<T>, Complex<T>), Error> {
    // |v0 e^{-i alpha} + effect| = r
    let centre = |angle: T| -> Complex<T> {
        let (sine, cosine) = angle.sin_cos();
        Complex { re: -baseline * cosine, im: baseline * sine }
    };
    let (from, to) = (centre(a.0), centre(b.0));
    let apart = to - from;
    let square = apart.re * apart.re + apart.im * apart.im;
    if !(square > baseline * baseline * real(1e-6)) {
        return Err(Error::TrialAngles);
    }
    let along = ((a.1 - b.1) * (a.1 + b.1) / square + T::one()) * real(0.5);
    let height = a.1 * a.1 / square - along * along;
    // rounding, and some reading error where the circles only touch
    if !(height > real(-0.01)) {
        return Err(Error::AmplitudesDisagree);
    }
    let height = height.max(T::zero()).sqrt();
    let middle = from + apart.scale(along);
    let aside = Complex { re: -apart.im, im: apart.re }.scale(height);
    let (one, other) = (middle + aside, middle - aside);
    // an effect within rounding
    let little = |effect: Complex<T>| size(effect) < baseline * real(1e-6);
    if little(one) || little(other) { Err(Error::NoEffect { plane: 0 }) } else { Ok((one, other)) }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI};

    use super::*;

    /// Runs that differ from the baseline by ten units in the last place are no different.
    #[test]
    fn no_effect() {
        let (more, less) = (1.0 + 10.0 * f64::EPSILON, 1.0 - 10.0 * f64::EPSILON);
        let refused = Err(Error::NoEffect { plane: 0 });
        assert_eq!(from_amplitudes(1.0, 1.0, &[(0.0, more), (FRAC_PI_2, less)]), refused);
        assert_eq!(from_amplitudes(1.0, 1.0, &[(0.0, more), (FRAC_PI_2, less), (PI, more)]), refused);
        let more = 1.0 + 50.0 * f32::EPSILON;
        let refused_single = Err(Error::NoEffect { plane: 0 });
        assert_eq!(from_amplitudes(1.0, 1.0, &[(0.0_f32, more), (1.5, 2.0 - more)]), refused_single);
        // of two runs, one answer is none, or both are: a weight cannot lower the vibration on either side
        assert_eq!(from_amplitudes(1.0, 1.0, &[(0.0, 1.0 + 1e-9), (FRAC_PI_2, 1.0)]), refused);
        assert_eq!(from_amplitudes(1.0, 1.0, &[(0.0, 0.999), (PI, 0.999)]), refused);
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let runs = [(0.0, 1.5), (1.0, 1.2)];
        for trial in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert_eq!(from_amplitudes(1.0, trial, &runs), Err(Error::TrialWeightZero { plane: 0 }), "{trial}");
        }
        for baseline in [0.0, -1.0, f64::INFINITY, f64::NAN] {
            assert_eq!(from_amplitudes(baseline, 1.0, &runs), Err(Error::Reading { row: 0 }), "{baseline}");
        }
        for wrong in [(0.0, -1.0), (0.0, f64::INFINITY), (0.0, f64::NAN), (f64::INFINITY, 1.0), (f64::NAN, 1.0)] {
            assert_eq!(
                from_amplitudes(1.0, 1.0, &[runs[0], wrong, runs[1]]),
                Err(Error::Reading { row: 2 }),
                "{wrong:?}"
            );
        }
        assert_eq!(from_amplitudes(1.0, 1.0, &runs[..1]), Err(Error::ReadingMissing { row: 2 }));
        // a run may stand still
        assert!(from_amplitudes(1.0, 1.0, &[(0.0, 0.0), (1.0, 1.0)]).is_ok());
    }

    /// An effect of 0.3 + 0.4i on a baseline of two, so that `r^2 = 4 + 0.25 + 4 (0.3 cos alpha - 0.4 sin alpha)`, and
    /// the weight is -2/effect of the trial weight. Of two runs either answer gives their amplitudes.
    #[test]
    fn a_weight_from_amplitudes() {
        let effect = Complex { re: 0.3, im: 0.4 };
        let square = |angle: f64, common: f64| 4.0 + common + 4.0 * (0.3 * angle.cos() - 0.4 * angle.sin());
        let run = |angle: f64| (angle, square(angle, 0.25).sqrt());
        // some operations, over the differences of the runs
        let near = |found: Complex<f64>, expected: Complex<f64>| (found - expected).norm_sqr() < 1e-24;
        let effect_of = |weight: Complex<f64>| -Complex { re: 2.0 * 5.0, im: 0.0 } / weight;
        let two = from_amplitudes(2.0, 5.0, &[run(0.2), run(1.7)]).unwrap();
        let answers = [two.weight, two.or.unwrap()].map(effect_of);
        for answer in answers {
            for (angle, amplitude) in [run(0.2), run(1.7)] {
                let with = Complex { re: 2.0, im: 0.0 } + answer * Complex { re: angle.cos(), im: angle.sin() };
                assert!((with.norm_sqr().sqrt() - amplitude).abs() < 1e-12, "{answer}");
            }
        }
        assert!(near(answers[0], effect) != near(answers[1], effect), "{answers:?}");
        let angles = [0.1, 1.0, 2.5, 4.0];
        for runs in [&angles.map(run)[..], &angles.map(run)[..3]] {
            let found = from_amplitudes(2.0, 5.0, runs).unwrap();
            assert!(near(effect_of(found.weight), effect) && found.or.is_none(), "{found:?}");
            assert!(found.disagreement < 1e-12, "{found:?}");
        }
        // with 0.3 for the effect's square, 0.25, the runs contradict each other by a fifth
        let found = from_amplitudes(2.0, 5.0, &angles.map(|angle| (angle, square(angle, 0.3).sqrt()))).unwrap();
        assert!(near(effect_of(found.weight), effect) && (found.disagreement - 0.2).abs() < 1e-12, "{found:?}");
        // angles of which two are the same, and those on a line through the shaft, leave two answers
        for apart in [[0.2, 1.7, 0.2], [0.0, PI, -PI], [FRAC_PI_2, -FRAC_PI_2, 3.0 * FRAC_PI_2], [0.0, PI, 2.0 * PI]] {
            assert_eq!(from_amplitudes(2.0, 5.0, &apart.map(run)), Err(Error::TrialAngles), "{apart:?}");
        }
        // the determinant of a triangle is four thirds of its area's square; here the area is sin(apart), and 0.0026
        // the limit of three thousandths
        for (apart, is_found) in [(2.7e-3, true), (2.5e-3, false)] {
            assert_eq!(from_amplitudes(2.0, 5.0, &[0.0, apart, PI].map(run)).is_ok(), is_found, "{apart}");
        }
        // contradictions beyond the effect's square, 0.25
        for (common, is_found) in [(0.49, true), (0.51, false), (1e12, false)] {
            let found = from_amplitudes(2.0, 5.0, &angles.map(|angle| (angle, square(angle, common).sqrt())));
            assert_eq!(found.is_ok(), is_found, "{common} {found:?}");
        }
        // centres 0.12 and 0.09 apart on a baseline of 100, of which a thousandth is 0.1
        let hundred = |apart: f64| from_amplitudes(100.0, 1.0, &[(0.0, 110.0), (apart, 110.0)]);
        assert!(hundred(1.2e-3).is_ok() && hundred(0.9e-3) == Err(Error::TrialAngles));
    }

    /// An effect of i/2 on a baseline of one: at the angle alpha the amplitude's square is 5/4 - sin alpha, and the
    /// weight is -1/(i/2) = 2i of the trial weight.
    #[test]
    fn two_runs_a_twelfth_of_a_turn_apart() {
        let run = |angle: f64| (angle, (1.25 - angle.sin()).sqrt());
        let found = from_amplitudes(1.0, 3.0, &[run(0.0), run(FRAC_PI_6)]).unwrap();
        let is = |weight: Complex<f64>| (weight - Complex { re: 0.0, im: 6.0 }).norm_sqr() < 1e-26;
        // rounding over the angle between the runs
        assert!(is(found.weight) || found.or.is_some_and(is), "{found:?}");
        // a little more than a thousandth of a radian apart are two angles
        assert!(from_amplitudes(1.0, 3.0, &[run(0.0), run(1.2e-3)]).is_ok());
    }
}
