//! Observer of two masses by pole placement: for the points of a gain schedule, or from a bandwidth.

use super::observer::transition;
use super::tuning::{Disturbance, Encoder, Rate, Variances};
use super::{Error, ExactStep, Matrix, TwoMassDesign, eigenvalues};
use crate::machine::TwoMass;
use crate::math::{exp, exp_m1, hypot, ln, sin_cos, sqrt};

/// Gains of an observer of two masses, without its covariances.
///
/// A schedule has dozens of points, and the Riccati equation of each would cost the compiler a third of a second. In a
/// schedule the poles are those of the continuous Kalman filter, which are the left roots of a polynomial in `X = s^2`
/// (symmetric root locus [Kwakernaak and Sivan 1972, Linear Optimal Control Systems, §5.5]),
///
/// ```text
/// X^3 ((X + w^2)^2 - (2a)^2 X) + q_m X ((X/J_m + c)^2 - e^2 X) - q_l (c^2 - e^2 X) = 0,
/// c = k/(J_m J_l),  e = d/(J_m J_l)
/// ```
///
/// with q_m and q_l the intensities of the motor's and the load's torque over that of the angle's noise. The gains put
/// the poles of the exact sampled machine there (Ackermann's formula), so the observer is stable. Gains whose poles
/// rounding has moved are refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlacedObserver {
    /// Time between two ticks (s).
    pub period: f64,
    /// The machine that it observes.
    pub machine: TwoMass,
    /// The exact step of twist and twist rate.
    pub step: ExactStep,
    /// Filter gain K, correction of motor angle, motor speed, twist, load speed and load torque per radian of
    /// innovation.
    pub gains: [f64; 5],
    /// Poles of the estimate's error, real and imaginary part, each less one.
    pub poles: [(f64, f64); 5],
}

impl PlacedObserver {
    /// The gains of a Kalman filter, without its covariances.
    #[must_use]
    pub const fn of(observer: &TwoMassDesign) -> Self {
        let TwoMassDesign { period, machine, step, gains, mut poles, .. } = *observer;
        each!(k, 0..5, {
            poles[k].0 -= 1.0;
        });
        PlacedObserver { period, machine, step, gains, poles }
    }
}

impl TwoMass {
    /// Gains at the poles of the continuous Kalman filter: those of [`observer`](Self::observer) to a few percent, at a
    /// fraction of its cost.
    ///
    /// # Errors
    /// A value out of range; [`Error::Unobservable`] without stiffness; [`Error::SampleRate`] where the resonance lies
    /// above half the rate; [`Error::NotStabilising`] where no poles are found.
    pub const fn try_placed_observer(
        &self,
        rate: Rate,
        encoder: Encoder,
        disturbance: Disturbance,
    ) -> Result<PlacedObserver, Error> {
        get!(self.check(), Error::Machine);
        let variances = get!(Variances::of(rate, encoder, &disturbance));
        if self.stiffness == 0.0 {
            return Err(Error::Unobservable);
        }
        let period = variances.period;
        if self.resonance() * period >= core::f64::consts::PI {
            return Err(Error::SampleRate);
        }
        // Intensities over that of the angle's noise, whose variance in a tick is r: intensity r T.
        let motor = variances.torque / variances.angle;
        let load = variances.load_torque / (variances.angle * period * period);
        let (unit, mut poles) = self.filter_poles(motor, load);
        each!(k, 0..5, {
            poles[k] = sampled(poles[k], period);
        });
        match self.observer_of_poles(period, unit, poles) {
            Some(observer) => Ok(observer),
            None => Err(Error::NotStabilising),
        }
    }

    /// Gains by one number: five poles in Butterworth's pattern [Butterworth 1930, Experimental Wireless 7, 536] at a
    /// radius of `bandwidth` (rad/s).
    ///
    /// For an observer that is tuned by hand, where neither the encoder's errors nor the disturbances are known. A
    /// larger bandwidth follows the load faster and lets more noise through. The pattern is that of the increment over
    /// a tick, `z = 1 + s T`, whose outer pair leaves the unit circle at 0.618 of the rate (twice the sine of 18
    /// degrees): the bandwidth is between zero and that. Below two thousandths of the resonance rounding may move the
    /// poles; gains are refused where it changes a coefficient of their polynomial by more than a thousandth.
    ///
    /// # Errors
    /// A value out of range; [`Error::ObserverBandwidth`]; [`Error::Unobservable`] without stiffness;
    /// [`Error::SampleRate`] where the resonance lies above half the rate.
    ///
    /// ```
    /// use driveline::design::Rate;
    /// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
    ///
    /// const ROLL: TwoMass = TwoMass::new(Inertia(0.4), Inertia(0.5), Stiffness(2e4), Damping(1.0));
    /// let slow = ROLL.try_observer_of_bandwidth(Rate::hz(10_000), 100.0)?;
    /// let fast = ROLL.try_observer_of_bandwidth(Rate::hz(10_000), 400.0)?;
    /// assert!(fast.gains[4].abs() > slow.gains[4].abs());
    /// # Ok::<(), driveline::design::Error>(())
    /// ```
    pub const fn try_observer_of_bandwidth(&self, rate: Rate, bandwidth: f64) -> Result<PlacedObserver, Error> {
        // cosine and sine of 36 and 72 degrees
        const POLES: [(f64, f64); 5] = [
            (-1.0, 0.0),
            (-0.809_016_994_374_947_4, 0.587_785_252_292_473_1),
            (-0.809_016_994_374_947_4, -0.587_785_252_292_473_1),
            (-0.309_016_994_374_947_4, 0.951_056_516_295_153_5),
            (-0.309_016_994_374_947_4, -0.951_056_516_295_153_5),
        ];
        get!(self.check(), Error::Machine);
        let period = get!(rate.period());
        if !(bandwidth > 0.0 && bandwidth * period < 0.618_033_988_749_894_8) {
            return Err(Error::ObserverBandwidth);
        }
        if self.stiffness == 0.0 {
            return Err(Error::Unobservable);
        }
        if self.resonance() * period >= core::f64::consts::PI {
            return Err(Error::SampleRate);
        }
        let (mut poles, tick) = (POLES, bandwidth * period);
        each!(k, 0..5, {
            poles[k] = (poles[k].0 * tick, poles[k].1 * tick);
        });
        match self.observer_of_poles(period, bandwidth, poles) {
            Some(observer) => Ok(observer),
            None => Err(Error::ObserverBandwidth),
        }
    }

    /// Gains at these poles, each less one; `unit` is their scale (rad/s), for conditioning. None where rounding moves
    /// the poles.
    const fn observer_of_poles(&self, period: f64, unit: f64, poles: [(f64, f64); 5]) -> Option<PlacedObserver> {
        let step = ExactStep::new(self, period);
        match placed(self, &step, period, unit, &poles) {
            Some(gains) => Some(PlacedObserver { period, machine: *self, step, gains, poles }),
            None => None,
        }
    }

    /// The unit of frequency (rad/s), and the poles of the continuous Kalman filter (1/s).
    const fn filter_poles(&self, motor: f64, load: f64) -> (f64, [(f64, f64); 5]) {
        let (jm, jl, reduced) = (self.motor_inertia, self.load_inertia, self.reduced_inertia());
        let (w2, two_a) = (self.stiffness / reduced, self.damping / reduced);
        let (c, e) = (self.stiffness / (jm * jl), self.damping / (jm * jl));
        let (c2, e2) = (c * c, e * e);
        // The product of the roots X is q_l c^2: their geometric mean is the unit's square.
        let square = exp(ln(load * c2) / 5.0);
        let unit = sqrt(square);
        let (s2, s4) = (square * square, square * square * square * square);
        let companion = Matrix([
            [
                -(2.0 * w2 - two_a * two_a) / square,
                -(w2 * w2 + motor / (jm * jm)) / s2,
                -motor * (2.0 * c / jm - e2) / (s2 * square),
                -(motor * c2 + load * e2) / s4,
                1.0,
            ],
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, 0.0],
        ]);
        let mut poles = eigenvalues(&companion);
        each!(k, 0..5, {
            let (re, im) = poles[k];
            let size = hypot(re, im);
            // The root with a negative real part; next to a negative X, without cancellation.
            let left = if re >= 0.0 { sqrt(0.5 * (size + re)) } else { im.abs() / sqrt(2.0 * (size - re)) };
            poles[k] = (-left * unit, -0.5 * im / left * unit);
        });
        (unit, poles)
    }
}

/// `exp(s T) - 1`, without cancellation.
const fn sampled(s: (f64, f64), period: f64) -> (f64, f64) {
    let decay = exp_m1(s.0 * period);
    let (sine, _) = sin_cos(0.5 * s.1 * period);
    let versine = 2.0 * sine * sine;
    (decay - (1.0 + decay) * versine, (1.0 + decay) * sin_cos(s.1 * period).0)
}

/// How far a coefficient of the poles' polynomial may be out: the poles of a well-damped pattern move by as much.
const ROUNDING: f64 = 1e-3;

/// The characteristic polynomial of a matrix, from its highest coefficient on, by the method of Leverrier and Faddeev.
const fn characteristic(matrix: &Matrix<5, 5>) -> [f64; 6] {
    let mut polynomial = [1.0; 6];
    let mut sum = Matrix::<5, 5>::IDENTITY;
    each!(n, 1..6, {
        let product = matrix.times(&sum);
        let mut trace = 0.0;
        each!(k, 0..5, {
            trace += product.0[k][k];
        });
        polynomial[n] = -trace / n as f64;
        sum = product.plus(polynomial[n], &Matrix::IDENTITY);
    });
    polynomial
}

/// The filter gains that put the poles of `(1 - K C) F` at these places, each less one.
const fn placed(
    machine: &TwoMass,
    step: &ExactStep,
    period: f64,
    unit: f64,
    poles: &[(f64, f64); 5],
) -> Option<[f64; 5]> {
    // States in units in which F - 1 has entries of the order of its rates, which are counted in units of their own.
    let torque = machine.total_inertia() * unit * unit;
    let units = [1.0, unit, 1.0, unit, torque];
    let per = [1.0, 1.0 / unit, 1.0, 1.0 / unit, 1.0 / torque];
    let (whole, _) = transition(machine, step, period);
    let mut change = whole;
    each!(k, 0..5, {
        change.0[k][k] -= 1.0;
    });
    let tick = unit * period;
    let mut rates = change.scaled(&per, &per);
    each!(i, 0..5, {
        each!(j, 0..5, {
            rates.0[i][j] /= tick;
        });
    });
    // The polynomial of the poles, from its highest coefficient on; conjugates leave it real.
    let mut wanted = [(0.0, 0.0); 6];
    wanted[0] = (1.0, 0.0);
    each!(k, 0..5, {
        let (re, im) = (poles[k].0 / tick, poles[k].1 / tick);
        let mut n = k + 1;
        while n > 0 {
            let (a, b) = wanted[n - 1];
            wanted[n].0 -= a * re - b * im;
            wanted[n].1 -= a * im + b * re;
            n -= 1;
        }
    });
    // Ackermann: L = wanted(rates) O^-1 e_5.
    let mut row = Matrix([[1.0, 0.0, 0.0, 0.0, 0.0]]);
    let mut observability = Matrix::<5, 5>::ZERO;
    each!(k, 0..5, {
        observability.0[k] = row.0[0];
        row = row.times(&rates);
    });
    let Some(last) = observability.solve(&Matrix([[0.0], [0.0], [0.0], [0.0], [1.0]])) else {
        return None;
    };
    let mut predictor = last;
    each!(n, 1..6, {
        predictor = rates.times(&predictor).plus(wanted[n].0, &last);
    });
    // From the predictor's gain to the filter's: F K = L.
    let transition = whole.scaled(&per, &per);
    let Some(gain) = transition.solve(&predictor) else {
        return None;
    };
    // What rounding has left of the polynomial; where the resonance is far beyond the poles, that is little.
    let mut error = rates;
    let placed = transition.times(&gain);
    each!(k, 0..5, {
        error.0[k][0] -= placed.0[k][0];
    });
    let found = characteristic(&error);
    each!(n, 1..6, {
        if !((found[n] - wanted[n].0).abs() <= ROUNDING * wanted[n].0.abs()) {
            return None;
        }
    });
    let mut gains = [0.0; 5];
    each!(k, 0..5, {
        gains[k] = gain.0[k][0] * tick * units[k];
        if !gains[k].is_finite() {
            return None;
        }
    });
    Some(gains)
}
