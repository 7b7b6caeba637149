//! The machine that is likeliest behind the lines of a spectrum, and how well they determine it.
//!
//! The error of a line is the measured motion less that of the model, and less the transient of the states at both ends
//! of the record. Its variance is a sum of three parts whose sizes are estimated with the machine: noise of the motion,
//! noise of the torque, and a share of the response for friction, cogging and whatever else the two masses leave out.
//! Parameters follow by the Levenberg-Marquardt method, variances by the likelihood of independent lines, in turn.
//! Standard deviations allow for a misspecified model, with errors that neighbouring lines share [Newey and West
//! 1987].

use driveline::commissioning::Figure;
use nalgebra::{Complex, DMatrix, DVector};

use super::model::{Model, Motion, Third, Torque};
use super::spectrum::Line;

/// Parameters of two masses: three logarithms, damping, two frictions, delay.
const TWO: usize = 7;
/// Those of a third: two logarithms, damping.
const THIRD: usize = 3;
/// Parts of the variance.
const PARTS: usize = 3;
/// Power of a line's torque over that of its noise, below which the line is left out.
const CLEAR: f64 = 30.0;
/// Least standard deviation of a figure, of the figure: the recorder's clock, and the torque between samples.
const SURE: f64 = 1e-4;
/// Most lines that are used.
const MOST: usize = 3000;
/// Most lines that two masses and three are compared by.
const FEW: usize = 150;
/// Rounds of parameters and variances in turn, at most.
const ROUNDS: usize = 12;

/// How the lines were made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// The motion that was measured.
    pub motion: Motion,
    /// The torque between samples.
    pub torque: Torque,
    /// Time between samples (s); of a table of responses any.
    pub period: f64,
}

/// A machine with its deviations.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The machine.
    pub model: Model,
    /// Figures and their standard deviations.
    pub figures: Figures,
    /// Rms torque that the model leaves unexplained, over that of the lines.
    pub unexplained: f64,
    /// Share of the response that neither noise of the motion nor of the torque explains.
    pub misfit: f64,
    /// Condition of the information about resonance, antiresonance and inertia, each in its own size.
    pub condition: f64,
    /// Minus twice the logarithm of the likelihood.
    pub unlikely: f64,
    /// The lines that were used.
    pub lines: usize,
    /// Their lowest frequency and the highest (rad/s).
    pub band: [f64; 2],
}

/// What is identified, in SI units at the motor.
#[derive(Clone, Copy, Debug)]
pub struct Figures {
    /// Inertia on the motor's side.
    pub motor_inertia: Figure,
    /// Inertia on the load's side.
    pub load_inertia: Figure,
    pub stiffness: Figure,
    /// Damping of the shaft, friction apart.
    pub damping: Figure,
    /// Viscous friction of the motor.
    pub motor_friction: Figure,
    /// Viscous friction of the load.
    pub load_friction: Figure,
    /// Resonance (rad/s).
    pub resonance: Figure,
    /// Antiresonance (rad/s).
    pub antiresonance: Figure,
    /// Damping ratio of the resonance.
    pub damping_ratio: Figure,
    /// Damping of a shaft that takes as much from the swing as damping and friction.
    pub swing_damping: Figure,
    /// Dead time of the torque (s).
    pub delay: Figure,
}

/// The parameters about a first guess, all of them about one in size.
struct Parameters {
    start: Model,
}

impl Parameters {
    fn model(&self, x: &DVector<f64>) -> Model {
        let Model { motor, load, stiffness, .. } = self.start;
        let [damping, friction, delay] = self.units();
        Model {
            motor: motor * x[0].exp(),
            load: load * x[1].exp(),
            stiffness: stiffness * x[2].exp(),
            damping: damping * x[3],
            friction: [friction * x[4], friction * x[5]],
            delay: delay * x[6],
            third: self.start.third.map(|third| Third {
                inertia: third.inertia * x[TWO].exp(),
                stiffness: third.stiffness * x[TWO + 1].exp(),
                damping: damping * x[TWO + 2],
            }),
        }
    }

    /// The parameters of the machine; those of a transient follow.
    fn count(&self) -> usize {
        if self.start.third.is_some() { TWO + THIRD } else { TWO }
    }

    /// A damping ratio of 1 %, as much friction, and a hundredth of the swing's period.
    fn units(&self) -> [f64; 3] {
        let (resonance, reduced) = (self.start.resonance(), self.start.reduced());
        [0.02 * resonance * reduced, 0.02 * resonance * reduced, 0.06 / resonance]
    }

    fn begin(&self) -> DVector<f64> {
        let mut x = DVector::zeros(self.count() + self.start.transients());
        x[3] = self.start.damping / self.units()[0];
        if let Some(third) = self.start.third {
            x[TWO + 2] = third.damping / self.units()[0];
        }
        x
    }
}

/// The lines with their setting.
struct Problem<'l> {
    lines: &'l [Line],
    setting: Setting,
    parameters: Parameters,
    /// Whether there is a state before and after.
    transient: bool,
}

impl Problem<'_> {
    fn respond(&self, model: &Model, line: &Line) -> Complex<f64> {
        model.response(line.frequency, self.setting.motion, self.setting.torque, self.setting.period)
    }

    /// Errors of the lines, and the responses.
    fn errors(&self, x: &DVector<f64>) -> Vec<[Complex<f64>; 2]> {
        let model = self.parameters.model(x);
        let error = |line: &Line| {
            let response = self.respond(&model, line);
            let mut error = line.motion - response * line.torque;
            if self.transient {
                let parts = model.transient(line.frequency).into_iter();
                error -= parts
                    .zip(x.iter().skip(self.parameters.count()))
                    .map(|(part, size)| part * *size)
                    .sum::<Complex<f64>>();
            }
            [error, response]
        };
        self.lines.iter().map(error).collect()
    }

    /// Errors over their deviations, real and imaginary parts.
    fn weighted(&self, x: &DVector<f64>, deviations: &[f64]) -> DVector<f64> {
        let errors = self.errors(x);
        let parts = errors.iter().zip(deviations).flat_map(|([error, _], by)| [error.re / by, error.im / by]);
        DVector::from_iterator(2 * errors.len(), parts)
    }

    fn jacobian(&self, x: &DVector<f64>, deviations: &[f64]) -> DMatrix<f64> {
        let machine = self.parameters.count();
        let count = if self.transient { x.len() } else { machine };
        let mut jacobian = DMatrix::zeros(2 * self.lines.len(), count);
        for column in 0..machine {
            let step = 1e-5;
            let moved = |by: f64| {
                let mut x = x.clone();
                x[column] += by;
                self.weighted(&x, deviations)
            };
            jacobian.set_column(column, &((moved(step) - moved(-step)) / (2.0 * step)));
        }
        if self.transient {
            let model = self.parameters.model(x);
            for ((line, by), row) in self.lines.iter().zip(deviations).zip(0..) {
                for (part, column) in model.transient(line.frequency).iter().zip(machine..) {
                    jacobian[(2 * row, column)] = -part.re / by;
                    jacobian[(2 * row + 1, column)] = -part.im / by;
                }
            }
        }
        jacobian
    }

    /// The variance of each line, and of its parts, that the errors make likeliest: by steps that keep them positive.
    fn variances(&self, errors: &[[Complex<f64>; 2]], parts: &mut [f64; PARTS]) -> Vec<f64> {
        let powers: Vec<[f64; PARTS]> = self
            .lines
            .iter()
            .zip(errors)
            .map(|(line, [_, response])| {
                let gain = response.norm_sqr();
                [line.noise, gain, gain * line.torque.norm_sqr()]
            })
            .collect();
        let used = if self.setting.torque == Torque::Sine { [1.0, 0.0, 1.0] } else { [1.0; PARTS] };
        let variance = |parts: &[f64; PARTS], powers: &[f64; PARTS]| -> f64 {
            parts.iter().zip(powers).zip(used).map(|((part, power), used)| used * part * power).sum::<f64>()
        };
        for _ in 0..40 {
            let mut sums = [[0.0; 2]; PARTS];
            for (powers, [error, _]) in powers.iter().zip(errors) {
                let all = variance(parts, powers).max(f64::MIN_POSITIVE);
                for (sum, power) in sums.iter_mut().zip(powers) {
                    sum[0] += power * error.norm_sqr() / (all * all);
                    sum[1] += power / all;
                }
            }
            for (part, [found, expected]) in parts.iter_mut().zip(sums) {
                if found > 0.0 && expected > 0.0 {
                    *part *= (found / expected).sqrt();
                }
            }
        }
        powers.iter().map(|powers| variance(parts, powers).max(f64::MIN_POSITIVE)).collect()
    }

    /// Least squares from a point, at given deviations of the lines.
    fn descend(&self, mut x: DVector<f64>, deviations: &[f64]) -> DVector<f64> {
        let mut errors = self.weighted(&x, deviations);
        let mut damping = 1e-4;
        for _ in 0..20 {
            let jacobian = self.jacobian(&x, deviations);
            let columns = jacobian.ncols();
            let (information, slope) = (jacobian.transpose() * &jacobian, -(jacobian.transpose() * &errors));
            let mut gained = 0.0;
            while damping < 1e8 {
                let mut damped = information.clone();
                for column in 0..columns {
                    damped[(column, column)] *= 1.0 + damping;
                }
                let Some(mut step) = damped.cholesky().map(|factor| factor.solve(&slope)) else {
                    damping *= 10.0;
                    continue;
                };
                // a logarithm that moves by more than this has lost its way
                let far = step.rows(0, 3).amax() / 0.3;
                if far > 1.0 {
                    step /= far;
                }
                let mut tried = x.clone();
                for (value, change) in tried.iter_mut().zip(step.iter()) {
                    *value += change;
                }
                let after = self.weighted(&tried, deviations);
                let (old, new) = (errors.norm_squared(), after.norm_squared());
                if new < old {
                    gained = 1.0 - new / old;
                    (x, errors) = (tried, after);
                    damping *= 0.1;
                    break;
                }
                damping *= 10.0;
            }
            if gained < 1e-9 {
                break;
            }
        }
        x
    }
}

/// The likeliest machine behind lines, from a first guess, with the likelier of the settings. Lines whose torque is
/// hardly more than its own noise are left out: with them the machine would seem heavier than it is.
#[must_use]
pub fn estimate(lines: &[Line], start: Model, settings: &[Setting]) -> Option<(Estimate, Setting)> {
    let (setting, others) = settings.split_first()?;
    let mut thinned: Vec<Line> = lines.iter().step_by(lines.len().div_ceil(MOST).max(1)).copied().collect();
    let (mut found, mut noise) = once(&thinned, start, *setting, ROUNDS)?;
    for _ in 0..3 {
        let clear: Vec<Line> = thinned.iter().filter(|line| line.torque.norm_sqr() > CLEAR * noise).copied().collect();
        // likelihoods compare over the same lines alone: too few of them are not taken at all
        if clear.len() == thinned.len() || clear.len() < 2 * (TWO + start.transients()) {
            break;
        }
        thinned = clear;
        (found, noise) = once(&thinned, start, *setting, ROUNDS)?;
    }
    let other = |setting: &Setting| once(&thinned, start, *setting, ROUNDS).map(|(estimate, _)| (estimate, *setting));
    let all = [(found, *setting)].into_iter().chain(others.iter().filter_map(other));
    all.min_by(|(one, _), (other, _)| one.unlikely.total_cmp(&other.unlikely))
}

/// Two masses and three behind a part of the lines, the three from several places of the third: the likeliest.
#[must_use]
pub fn three(lines: &[Line], two: &Estimate, setting: Setting) -> Option<[Estimate; 2]> {
    let thinned: Vec<Line> = lines.iter().step_by(lines.len().div_ceil(FEW).max(1)).copied().collect();
    let Model { load, stiffness, damping, .. } = two.model;
    let starts = [0.3, 0.7].into_iter().flat_map(|share| [0.3, 1.0, 3.0].map(|ratio| (share, ratio)));
    let tried = starts.filter_map(|(share, ratio)| {
        let third = Third { inertia: share * load, stiffness: ratio * stiffness, damping };
        let start = Model { load: load - third.inertia, third: Some(third), ..two.model };
        Some(once(&thinned, start, setting, 1)?.0)
    });
    let nearest = tried.min_by(|one, other| one.unlikely.total_cmp(&other.unlikely))?;
    let refined = |model| Some(once(&thinned, model, setting, ROUNDS)?.0);
    Some([refined(two.model)?, refined(nearest.model)?])
}

/// Errors of lines over the sizes of the responses, their slopes over the parameters of a machine and of the transient,
/// and these sizes.
pub(super) fn slopes(lines: &[Line], model: &Model, setting: Setting) -> (DVector<f64>, DMatrix<f64>, Vec<f64>) {
    let parameters = Parameters { start: *model };
    let [_, friction, delay] = parameters.units();
    let mut x = parameters.begin();
    for (at, value) in [(4, model.friction[0] / friction), (5, model.friction[1] / friction), (6, model.delay / delay)]
    {
        x[at] = value;
    }
    let problem = Problem { lines, setting, parameters, transient: true };
    let sizes: Vec<f64> = problem.errors(&x).iter().map(|[_, response]| response.norm()).collect();
    (problem.weighted(&x, &sizes), problem.jacobian(&x, &sizes), sizes)
}

/// An estimate by so many rounds, and the variance of the torque's noise.
fn once(thinned: &[Line], start: Model, setting: Setting, rounds: usize) -> Option<(Estimate, f64)> {
    let transient = setting.torque != Torque::Sine;
    let problem = Problem { lines: thinned, setting, parameters: Parameters { start }, transient };
    let mut x = problem.parameters.begin();
    let mean = |of: &dyn Fn(&Line) -> f64| thinned.iter().map(of).sum::<f64>() / thinned.len().max(1) as f64;
    let mut parts = [
        1e-3 * mean(&|line| line.motion.norm_sqr() / line.noise.max(1e-12)),
        1e-3 * mean(&|line| line.torque.norm_sqr()),
        1e-2,
    ];
    // the first steps with a share of the response alone, which leaves no line out
    let errors = problem.errors(&x);
    let sizes = errors.iter().zip(thinned);
    let mut deviations: Vec<f64> =
        sizes.map(|([_, response], line)| 0.1 * (response * line.torque).norm() + 0.1 * line.motion.norm()).collect();
    let mut variances = Vec::new();
    for _ in 0..rounds {
        let before = x.clone();
        x = problem.descend(x, &deviations);
        variances = problem.variances(&problem.errors(&x), &mut parts);
        deviations = variances.iter().map(|variance| variance.sqrt()).collect();
        if (&x - &before).rows(0, problem.parameters.count()).amax() < 1e-6 {
            break;
        }
    }
    let errors = problem.errors(&x);
    let pairs = || errors.iter().zip(&variances);
    let unlikely = pairs().map(|([error, _], variance)| variance.ln() + error.norm_sqr() / variance).sum();
    let jacobian = problem.jacobian(&x, &deviations);
    // singular values of what is not finite are searched for ever
    if !jacobian.iter().all(|slope| slope.is_finite()) {
        return None;
    }
    let covariance = covariance(&jacobian, &problem.weighted(&x, &deviations))?;
    let torque: f64 = thinned.iter().map(|line| line.torque.norm_sqr()).sum();
    let missed: f64 = errors.iter().map(|[error, response]| error.norm_sqr() / response.norm_sqr()).sum();
    let model = problem.parameters.model(&x);
    let estimate = Estimate {
        model,
        figures: figures(&problem.parameters, &x, &covariance),
        unexplained: (missed / torque).sqrt(),
        misfit: parts[2].sqrt(),
        condition: condition(&jacobian),
        unlikely,
        lines: thinned.len(),
        band: [f64::min as fn(f64, f64) -> f64, f64::max]
            .map(|of| thinned.iter().map(|line| line.frequency).reduce(of).unwrap_or(f64::NAN)),
    };
    Some((estimate, parts[1]))
}

/// The covariance of the parameters: `A^-1 B A^-1` with the information A and the long-run variance B of the slopes.
fn covariance(jacobian: &DMatrix<f64>, errors: &DVector<f64>) -> Option<DMatrix<f64>> {
    let (rows, columns) = jacobian.shape();
    let lines = rows / 2;
    let information = (jacobian.transpose() * jacobian).try_inverse()?;
    let slope = |line: usize| {
        let mut slope = DVector::<f64>::zeros(columns);
        for row in [2 * line, 2 * line + 1] {
            slope += jacobian.row(row).transpose() * errors[row];
        }
        slope
    };
    let slopes: Vec<DVector<f64>> = (0..lines).map(slope).collect();
    let reach = (lines as f64).cbrt().ceil() as usize;
    let mut middle = DMatrix::zeros(columns, columns);
    for lag in 0..=reach {
        let weight = 1.0 - lag as f64 / (reach + 1) as f64;
        for (one, other) in slopes.iter().zip(slopes.iter().skip(lag)) {
            let product = one * other.transpose();
            middle += if lag == 0 { product } else { (&product + product.transpose()) * weight };
        }
    }
    // parameters take degrees of freedom from the errors
    let freedom = lines as f64 / (lines as f64 - 0.5 * columns as f64).max(1.0);
    let misspecified = &information * middle * &information * freedom;
    // a sample of slopes may say too little by chance; errors that are independent are the least there is
    let independent = &information * (errors.norm_squared() / (rows - columns).max(1) as f64);
    let (one, other) = (misspecified.diagonal(), independent.diagonal());
    let larger = one.zip_map(&other, |one, other| (other / one.max(f64::MIN_POSITIVE)).max(1.0).sqrt());
    let scale = DMatrix::from_diagonal(&larger);
    Some(&scale * misspecified * scale)
}

/// Condition of the information about the machine's first three parameters, the others left free.
fn condition(jacobian: &DMatrix<f64>) -> f64 {
    let others = jacobian.columns(3, jacobian.ncols() - 3).into_owned();
    let q = others.qr().q();
    let own = jacobian.columns(0, 3).into_owned();
    let free = &own - &q * (q.transpose() * &own);
    let values = free.singular_values();
    values.max() / values.min().max(f64::MIN_POSITIVE)
}

fn figures(parameters: &Parameters, x: &DVector<f64>, covariance: &DMatrix<f64>) -> Figures {
    let figure = |of: &dyn Fn(&Model) -> f64| {
        let slope = DVector::from_fn(covariance.nrows(), |k, _| {
            if k >= parameters.count() {
                return 0.0;
            }
            let moved = |by: f64| {
                let mut x = x.clone();
                x[k] += by;
                of(&parameters.model(&x))
            };
            (moved(1e-5) - moved(-1e-5)) / 2e-5
        });
        let (value, variance) = (of(&parameters.model(x)), slope.dot(&(covariance * &slope)));
        Figure { value, standard_deviation: variance.max(0.0).sqrt().hypot(SURE * value) }
    };
    Figures {
        motor_inertia: figure(&|model| model.motor),
        load_inertia: figure(&|model| model.load),
        stiffness: figure(&|model| model.stiffness),
        damping: figure(&|model| model.damping),
        motor_friction: figure(&|model| model.friction[0]),
        load_friction: figure(&|model| model.friction[1]),
        resonance: figure(&Model::resonance),
        antiresonance: figure(&Model::antiresonance),
        damping_ratio: figure(&Model::damping_ratio),
        swing_damping: figure(&Model::swing_damping),
        delay: figure(&|model| model.delay),
    }
}

#[cfg(test)]
mod tests {
    use driveline_solver::noise::Noise;

    use super::*;

    /// Of thirty lines ten hardly rise above the noise of their torque, and twenty are too few without them.
    #[test]
    fn settings_are_compared_over_the_same_lines() {
        let start = Model { motor: 2e-5, load: 5e-5, stiffness: 0.8, damping: 1e-4, ..Model::default() };
        let setting = Setting { motion: Motion::Speed, torque: Torque::Smooth, period: 1e-3 };
        let mut noise = Noise::new(5);
        let line = |index: u32| {
            let frequency = 20.0 * 60_f64.powf(f64::from(index) / 29.0);
            let torque = if index % 3 == 2 { 0.05 } else { 1.0 };
            let motion = start.response(frequency, setting.motion, setting.torque, setting.period) * torque;
            let torque = Complex::new(torque + 0.05 * noise.normal(), 0.05 * noise.normal());
            Line { frequency, torque, motion, noise: 1.0 }
        };
        let lines: Vec<Line> = (0..30).map(line).collect();
        let (all, noise) = once(&lines, start, setting, ROUNDS).unwrap();
        let clear: Vec<Line> = lines.iter().filter(|line| line.torque.norm_sqr() > CLEAR * noise).copied().collect();
        assert_eq!(clear.len(), 20);
        // a sum over fewer lines is smaller here, whatever the setting
        assert!(once(&clear, start, setting, ROUNDS).unwrap().0.unlikely < all.unlikely);
        let (found, _) = estimate(&lines, start, &[setting, setting]).unwrap();
        assert_eq!(found.lines, 30);
    }
}
