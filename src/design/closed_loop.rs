//! The speed loop with everything that is in it: machine, observer, governor, actuator, all sampled.

use super::controller::Observer;
use super::margins::{CutLoop, Margins, OpenLoop};
use super::plant::Plant;
use super::polynomial::Polynomial;
use super::{Actuator, Error, PlacedObserver, RigidDesign, Robustness, SpeedLoopDesign, TwoMassDesign};
use crate::machine::TwoMass;
use crate::math::{exp_m1, sin_cos, sqrt};

/// A speed loop and its observer, apart from the machine: from the motor's angle and back to its torque.
///
/// Margins with estimates taken as exact are too large by up to a factor of ten: the observer follows a machine that
/// differs from its model with a lag. Here the observer is in the loop, and the machine may differ from its model.
///
/// The loop is cut at the torque on the machine. A gain above 1 there is a torque constant that is larger than
/// described, or inertias and stiffness that are all smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ClosedLoop {
    /// Time between two ticks (s).
    pub period: f64,
    /// Frequency of the integral (rad/s): below it nothing is decided.
    slowest: f64,
    numerator: Polynomial,
    denominator: Polynomial,
}

impl ClosedLoop {
    /// Most whole ticks of dead time that the torque may have.
    pub const MAX_DELAY_TICKS: f64 = 12.0;

    /// A speed loop on the estimates of two masses, its torque within the tick.
    ///
    /// # Errors
    /// [`Error::Period`] where the two are not designed for the same rate; [`Error::Actuator`] for one that is out of
    /// range or later than [`ClosedLoop::MAX_DELAY_TICKS`].
    pub const fn of(observer: &TwoMassDesign, speed_loop: &SpeedLoopDesign, actuator: Actuator) -> Result<Self, Error> {
        let TwoMassDesign { machine, step, gains, period, .. } = observer;
        Self::close(&Observer::of_two_masses(machine, step, *gains, *period), speed_loop, actuator)
    }

    /// A speed loop at a point of a gain schedule.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub const fn of_placed(
        observer: &PlacedObserver,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
    ) -> Result<Self, Error> {
        let PlacedObserver { machine, step, gains, period, .. } = observer;
        Self::close(&Observer::of_two_masses(machine, step, *gains, *period), speed_loop, actuator)
    }

    /// A speed loop on the estimates of one mass, which has no twist rate.
    ///
    /// # Errors
    /// As [`of`](Self::of).
    pub const fn of_rigid(
        observer: &RigidDesign,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
    ) -> Result<Self, Error> {
        Self::close(&Observer::of_one_mass(observer), speed_loop, actuator)
    }

    const fn close(o: &Observer, speed_loop: &SpeedLoopDesign, actuator: Actuator) -> Result<Self, Error> {
        let (t, Actuator { delay, lag }) = (o.period, actuator);
        if (t - speed_loop.period).abs() > 1e-9 * t {
            return Err(Error::Period);
        }
        // A millionth of a tick for rounding.
        let ticks = delay / t - 1e-6;
        if !(delay >= 0.0 && ticks <= Self::MAX_DELAY_TICKS && lag >= 0.0 && lag.is_finite()) {
            return Err(Error::Actuator);
        }
        let [poles, known, of_innovation] = o.controller(speed_loop);
        let (acts, lags) = lagged(lag, t);
        let mut late = lags.times(&poles);
        let mut tick = 0.0;
        while tick < ticks {
            late = late.times(&Polynomial::Z);
            tick += 1.0;
        }
        Ok(Self {
            period: t,
            slowest: speed_loop.integral / speed_loop.proportional,
            numerator: acts.times(&of_innovation),
            denominator: late.plus(1.0, &acts.times(&known)),
        })
    }

    /// Numerator and denominator of the loop that is closed round a machine.
    const fn open(&self, plant: &Plant) -> (Polynomial, Polynomial) {
        let (numerator, denominator) = plant.sampled(self.period);
        (numerator.times(&self.numerator), denominator.times(&self.denominator))
    }

    /// Numerator of the controller times the machine's denominator, and both of the [`open`](Self::open) loop.
    pub(super) const fn parts(
        &self,
        numerator: &Polynomial,
        denominator: &Polynomial,
    ) -> (Polynomial, Polynomial, Polynomial) {
        let controller = self.numerator.times(denominator);
        (controller, self.numerator.times(numerator), self.denominator.times(denominator))
    }

    /// The loop round a machine, cut at the torque on it.
    #[must_use]
    pub const fn cut(&self, plant: &Plant) -> CutLoop {
        let (numerator, denominator) = self.open(plant);
        CutLoop { numerator, denominator, period: self.period }
    }

    /// Whether the loop round a machine is stable with its torque times `gain`.
    #[must_use]
    pub const fn is_stable(&self, plant: &Plant, gain: f64) -> bool {
        let (numerator, denominator) = self.open(plant);
        denominator.plus(gain, &numerator).is_stable()
    }

    /// Whether the loop has the required margins: stable with the gain at both ends of its margin, and with the phase
    /// at its margin.
    pub(super) const fn try_margins(&self, plant: &Plant, robustness: &Robustness) -> Result<(), Error> {
        if !self.is_stable(plant, 1.0) {
            return Err(Error::LoopUnstable);
        }
        if !(self.is_stable(plant, robustness.gain) && self.is_stable(plant, 1.0 / robustness.gain)) {
            return Err(Error::LoopGain);
        }
        if !self.is_stable_turned(plant, robustness.phase) {
            return Err(Error::LoopPhase);
        }
        Ok(())
    }

    /// The same for tests with many machines.
    pub(super) const fn mapped(&self) -> Mapped {
        Mapped::of(&self.numerator, &self.denominator)
    }

    /// Whether the loop is stable with its response turned by an angle (rad) either way: `|D + e^(j phi) N|^2` has
    /// real coefficients.
    pub(super) const fn is_stable_turned(&self, plant: &Plant, angle: f64) -> bool {
        let (numerator, denominator) = self.open(plant);
        let (_, cosine) = sin_cos(angle);
        let both = denominator.plus(2.0 * cosine, &numerator).times(&denominator);
        both.plus(1.0, &numerator.times(&numerator)).is_stable()
    }

    /// Margins of the loop round a machine.
    ///
    /// # Errors
    /// [`Error::LoopUnstable`] where there are none.
    pub const fn margins(&self, plant: &Plant) -> Result<Margins, Error> {
        self.margins_at(plant, [1.0])
    }

    /// The least margins with the torque times each of the factors.
    pub(super) const fn margins_at<const N: usize>(&self, plant: &Plant, torques: [f64; N]) -> Result<Margins, Error> {
        let (numerator, denominator) = self.open(plant);
        each!(k, 0..N, {
            if !denominator.plus(torques[k], &numerator).is_stable() {
                return Err(Error::LoopUnstable);
            }
        });
        let open = OpenLoop::Ratio(CutLoop { numerator, denominator, period: self.period });
        let nyquist = core::f64::consts::PI / self.period;
        let mut found = Margins::NONE;
        open.sweep(&mut found, torques, 0.0, [1e-2 * self.slowest, nyquist], 1000);
        each!(k, 0..plant.count, {
            open.sweep_about(&mut found, torques, sqrt(plant.vibration[k].square), nyquist);
        });
        // By the poles: a frequency response may miss a resonance that is sharp enough.
        (found.gain_up, found.gain_down) = (f64::INFINITY, 0.0);
        each!(k, 0..N, {
            let numerator = numerator.scaled(torques[k]);
            found.gain_up = found.gain_up.min(edge(&Varied::Gain(&numerator, &denominator), true));
            found.gain_down = found.gain_down.max(edge(&Varied::Gain(&numerator, &denominator), false));
        });
        Ok(found)
    }

    /// Ranges of motor inertia, load inertia and stiffness of two masses that the loop tolerates, one at a time, as
    /// factors from the least to the most. 0 and infinity stand where it tolerates a hundredth and a hundred times.
    #[must_use]
    pub const fn ranges(&self, machine: &TwoMass) -> Ranges {
        let mut range = [[1.0; 2]; 3];
        each!(k, 0..3, {
            let varied = Varied::Machine(self, machine, k);
            range[k] = [edge(&varied, false), edge(&varied, true)];
        });
        Ranges { motor_inertia: range[0], load_inertia: range[1], stiffness: range[2] }
    }
}

/// A ratio of polynomials in the variable w of the bilinear map, of a controller or of a machine. The map of a product
/// is that of its factors, so each is mapped once for all loops that it is in.
#[derive(Clone, Copy)]
pub(super) struct Mapped {
    numerator: Polynomial,
    denominator: Polynomial,
}

impl Mapped {
    const fn of(numerator: &Polynomial, denominator: &Polynomial) -> Self {
        let (n, d) = (numerator.order(), denominator.order());
        let degree = if n > d { n } else { d };
        Self { numerator: numerator.mapped(degree), denominator: denominator.mapped(degree) }
    }

    /// A machine, sampled.
    pub(super) const fn of_plant(plant: &Plant, period: f64) -> Self {
        let (numerator, denominator) = plant.sampled(period);
        Self::of(&numerator, &denominator)
    }

    /// Whether the loop of two such, closed, is stable with either gain.
    pub(super) const fn is_stable(&self, other: &Self, gains: [f64; 2]) -> bool {
        let numerator = self.numerator.times(&other.numerator);
        let denominator = self.denominator.times(&other.denominator);
        denominator.plus(gains[0], &numerator).is_hurwitz() && denominator.plus(gains[1], &numerator).is_hurwitz()
    }
}

/// Factors that a loop tolerates, down and up.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Ranges {
    /// Inertia on the motor side.
    pub motor_inertia: [f64; 2],
    /// Inertia on the load side.
    pub load_inertia: [f64; 2],
    /// Stiffness.
    pub stiffness: [f64; 2],
}

/// What a factor is applied to.
enum Varied<'a> {
    Gain(&'a Polynomial, &'a Polynomial),
    Machine(&'a ClosedLoop, &'a TwoMass, usize),
}

impl Varied<'_> {
    const fn is_stable(&self, factor: f64) -> bool {
        match self {
            Self::Gain(numerator, denominator) => denominator.plus(factor, numerator).is_stable(),
            Self::Machine(closed, machine, which) => {
                let mut machine = **machine;
                match which {
                    0 => machine.motor_inertia *= factor,
                    1 => machine.load_inertia *= factor,
                    _ => machine.stiffness *= factor,
                }
                closed.is_stable(&Plant::of(&machine), 1.0)
            }
        }
    }
}

/// The first factor from 1 on, up or down, at which what is varied turns unstable; infinity, or 0, beyond a hundred or
/// a hundredth.
const fn edge(varied: &Varied, up: bool) -> f64 {
    // Steps of 2 %: an island of instability narrower than that is passed over.
    let step = if up { 1.02 } else { 1.0 / 1.02 };
    let mut good = 1.0;
    let mut bad = step;
    while varied.is_stable(bad) {
        good = bad;
        bad *= step;
        if bad > 100.0 {
            return f64::INFINITY;
        }
        if bad < 0.01 {
            return 0.0;
        }
    }
    each!(halving, 0..30, {
        let middle = 0.5 * (good + bad);
        if varied.is_stable(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    });
    good
}

/// The mean torque over a tick of an actuator of first order, its command held: numerator and denominator.
const fn lagged(lag: f64, period: f64) -> (Polynomial, Polynomial) {
    if lag == 0.0 {
        return (Polynomial::ONE, Polynomial::ONE);
    }
    let settled = -exp_m1(-period / lag);
    (Polynomial::new([settled, 1.0 - settled * lag / period]), Polynomial::new([settled, 1.0]))
}
