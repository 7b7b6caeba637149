//! The speed loop with everything that is in it: machine, observer, governor, actuator, all sampled.
//!
//! Margins with estimates taken as exact are too large by up to a factor of ten: the observer follows a machine that
//! differs from its model with a lag. Here the observer is in the loop, and the machine may differ from its model.
//!
//! The loop is cut at the torque on the machine. A gain above 1 there is a torque constant that is larger than
//! described, or inertias and stiffness that are all smaller.
//!
//! `phi` and `omega` are the mean angle and speed, `delta` and `v` twist and twist rate. All states of the observer
//! follow by the model's own step from the torque `tau` of the ended tick and from the innovation `i`. Eliminating `i`
//! from `theta_m - theta_m^ = (1 - K_1) i` leaves the governor's torque as `u = -(Q tau + P theta_m)/D_o`. `D_o` is the
//! polynomial of the observer's poles; all of it is in closed form, in `z - 1`.

use super::margins::{Margins, OpenLoop};
use super::plant::{Plant, Twist};
use super::polynomial::Polynomial;
use super::{Actuator, Error, ExactStep, LoopObserver, PlacedObserver, RigidDesign, SpeedLoopDesign, TwoMassDesign};
use crate::machine::TwoMass;
use crate::math::{exp_m1, sin_cos, sqrt};

/// A speed loop and its observer, apart from the machine: from the motor's angle and back to its torque.
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

/// The observer's model and gains, in the coordinates of mean motion and twist.
struct Observer {
    period: f64,
    /// 1/J, 1/J_m, 1/J_l and J_l/J.
    inverse: [f64; 3],
    share: f64,
    step: ExactStep,
    twist: Twist,
    /// Whole angle of the motor, mean angle, mean speed, twist, twist rate, load torque, each per radian of innovation.
    angle: f64,
    mean_angle: f64,
    mean_speed: f64,
    twist_gain: f64,
    slip: f64,
    load_torque: f64,
}

impl Observer {
    const fn of_two_masses(machine: &TwoMass, step: &ExactStep, gains: [f64; 5], period: f64) -> Self {
        let [angle, motor_speed, twist, load_speed, load_torque] = gains;
        let (jm, jl, total) = (machine.motor_inertia, machine.load_inertia, machine.total_inertia());
        let share = jl / total;
        Self {
            period,
            inverse: [1.0 / total, 1.0 / jm, 1.0 / jl],
            share,
            step: *step,
            twist: Twist::of(step),
            angle,
            mean_angle: angle - share * twist,
            mean_speed: (jm * motor_speed + jl * load_speed) / total,
            twist_gain: twist,
            slip: motor_speed - load_speed,
            load_torque,
        }
    }

    /// A twist that nothing moves.
    const fn of_one_mass(design: &RigidDesign) -> Self {
        let [angle, speed, load_torque] = design.gains;
        Self {
            period: design.period,
            inverse: [1.0 / design.machine.inertia, 0.0, 0.0],
            share: 0.0,
            step: ExactStep { n11: 0.0, n12: 0.0, g1: 0.0, n21: 0.0, n22: 0.0, g2: 0.0, lag: 0.0 },
            twist: Twist { numerator: Polynomial::new([0.0]), denominator: Polynomial::ONE },
            angle,
            mean_angle: angle,
            mean_speed: speed,
            twist_gain: 0.0,
            slip: 0.0,
            load_torque,
        }
    }

    /// Denominator, and what it is divided into by torque and by motor angle, of the torque that the governor gives:
    /// `u = -(Q tau + P theta_m)/D`.
    const fn controller(&self, speed_loop: &SpeedLoopDesign) -> [Polynomial; 3] {
        let SpeedLoopDesign { proportional, integral, damping: slip, damping_lag, speed_lag, .. } = *speed_loop;
        let (t, [per_total, per_motor, per_load]) = (self.period, self.inverse);
        let n = &self.step;
        let square = &self.twist.denominator;
        // Of the mean speed, and of the twist rate, times delta: the governor's law.
        let (damps, lags_damping) = first_order(damping_lag, t);
        let (follows, lags_speed) = first_order(speed_lag, t);
        let law = Polynomial::new([integral * t, proportional + integral * t]).times(&follows).times(&lags_damping);
        let law_of_slip = law.scaled(self.share).plus(slip, &damps.times(&lags_speed).raised(1));

        // Effect of an innovation: mean angle times delta^3; twist and twist rate without the load torque's part; twist
        // rate.
        let glide = t * t * self.load_torque * per_total;
        let mean = Polynomial::new([-glide, t * self.mean_speed - 0.5 * glide, self.mean_angle]);
        let twisted = Polynomial::new([n.n12 * self.slip - n.n22 * self.twist_gain, self.twist_gain]);
        let slipped = Polynomial::new([
            n.g2 * self.load_torque * per_load + n.n21 * self.twist_gain - n.n11 * self.slip,
            self.slip,
        ]);
        // The observer's poles: (1 - K_1) delta^3 det + z N, N its angle's answer to an innovation.
        let answer = mean
            .times(square)
            .plus(self.share * self.load_torque * per_load, &self.twist.numerator.raised(2))
            .plus(self.share, &twisted.raised(3));
        let poles = square.raised(3).scaled(1.0 - self.angle).plus(1.0, &Polynomial::Z.times(&answer));

        // The governor's answer to torque and to innovation.
        let of_torque = law.times(square).scaled(t * per_total).plus(n.g2 * per_motor, &law_of_slip.raised(2));
        let of_innovation = law
            .times(&Polynomial::new([-t * per_total * self.load_torque, self.mean_speed]))
            .times(square)
            .plus(1.0, &law_of_slip.times(&slipped).raised(2));

        // What remains of the products of both, their common divisor delta^2 det taken out by hand.
        let joint =
            Polynomial::new([t * self.load_torque * per_total * (per_load + per_motor), -self.mean_speed * per_motor]);
        let by_twist = twisted.raised(1).scaled(t * per_total).plus(1.0, &self.twist.numerator.times(&joint));
        let by_slip =
            mean.scaled(n.g2 * per_motor).plus(-t * t * per_total, &Polynomial::new([1.0, 0.5]).times(&slipped));
        let both = law
            .times(square)
            .scaled(t * per_total * (self.mean_angle - 0.5 * t * self.mean_speed))
            .plus(self.share, &law.times(&by_twist))
            .plus(1.0, &law_of_slip.times(&by_slip))
            .plus(self.share * (n.g2 * self.twist_gain - n.g1 * self.slip) * per_motor, &law_of_slip.raised(2));
        let known = of_torque.raised(1).scaled(1.0 - self.angle).plus(1.0, &Polynomial::Z.times(&both));
        [lags_damping.times(&lags_speed).times(&poles), known, Polynomial::Z.times(&of_innovation)]
    }
}

/// Observer and speed loop between the motor's angle and the torque: `u = -(Q tau + P theta_m)/D`, polynomials in
/// `z - 1`, the constant first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Controller {
    /// D: the poles of the observer and of the lags on damping and speed.
    pub denominator: [f64; 9],
    /// Q, by the torque of the ended tick.
    pub of_torque: [f64; 9],
    /// P, by the motor's angle (N m/rad).
    pub of_angle: [f64; 9],
}

impl LoopObserver<'_> {
    /// This observer with a speed loop, apart from actuator and machine.
    #[must_use]
    pub const fn controller(&self, speed_loop: &SpeedLoopDesign) -> Controller {
        let observer = match self {
            Self::TwoMass(TwoMassDesign { machine, step, gains, period, .. })
            | Self::Placed(PlacedObserver { machine, step, gains, period, .. }) => {
                Observer::of_two_masses(machine, step, *gains, *period)
            }
            Self::Rigid(design) => Observer::of_one_mass(design),
        };
        let [denominator, of_torque, of_angle] = observer.controller(speed_loop);
        Controller { denominator: denominator.first(), of_torque: of_torque.first(), of_angle: of_angle.first() }
    }
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

    /// Response of the loop round a machine at a frequency (rad/s), as real and imaginary part: the torque that the
    /// drive gives against one that is added where the loop is cut. Its margins are [`margins`](Self::margins).
    #[must_use]
    pub const fn response(&self, plant: &Plant, frequency: f64) -> (f64, f64) {
        let (numerator, denominator) = self.open(plant);
        OpenLoop::Ratio(numerator, denominator, self.period).response(frequency)
    }

    /// Whether the loop round a machine is stable with its torque times `gain`.
    #[must_use]
    pub const fn is_stable(&self, plant: &Plant, gain: f64) -> bool {
        let (numerator, denominator) = self.open(plant);
        denominator.plus(gain, &numerator).is_stable()
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
        self.margins_at(plant, 1.0)
    }

    /// Margins with the torque times a factor.
    pub(super) const fn margins_at(&self, plant: &Plant, torque: f64) -> Result<Margins, Error> {
        let (numerator, denominator) = self.open(plant);
        let numerator = numerator.scaled(torque);
        if !denominator.plus(1.0, &numerator).is_stable() {
            return Err(Error::LoopUnstable);
        }
        let open = OpenLoop::Ratio(numerator, denominator, self.period);
        let nyquist = core::f64::consts::PI / self.period;
        let mut found = Margins::NONE;
        open.sweep(&mut found, 1e-2 * self.slowest, nyquist, 1000);
        // Finer about each resonance, where a lightly damped shaft turns the response quickly.
        let mut k = 0;
        while k < plant.count {
            let frequency = sqrt(plant.vibration[k].square);
            let (from, to) = (0.9 * frequency, 1.1 * frequency);
            if to < nyquist {
                open.sweep(&mut found, from, to, 1000);
            }
            k += 1;
        }
        // By the poles: a frequency response may miss a resonance that is sharp enough.
        found.gain_up = edge(&Varied::Gain(&numerator, &denominator), true);
        found.gain_down = edge(&Varied::Gain(&numerator, &denominator), false);
        Ok(found)
    }

    /// Ranges of motor inertia, load inertia and stiffness of two masses that the loop tolerates, one at a time, as
    /// factors from the least to the most. 0 and infinity stand where it tolerates a hundredth and a hundred times.
    #[must_use]
    pub const fn ranges(&self, machine: &TwoMass) -> Ranges {
        let mut range = [[1.0; 2]; 3];
        let mut k = 0;
        while k < 3 {
            let varied = Varied::Machine(self, machine, k);
            range[k] = [edge(&varied, false), edge(&varied, true)];
            k += 1;
        }
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
    /// Of the motor side's inertia.
    pub motor_inertia: [f64; 2],
    /// Of the load side's inertia.
    pub load_inertia: [f64; 2],
    /// Of the stiffness.
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
    let mut halving = 0;
    while halving < 30 {
        let middle = 0.5 * (good + bad);
        if varied.is_stable(middle) {
            good = middle;
        } else {
            bad = middle;
        }
        halving += 1;
    }
    good
}

/// A lag of first order of the samples: numerator and denominator.
const fn first_order(lag: f64, period: f64) -> (Polynomial, Polynomial) {
    if lag == 0.0 {
        return (Polynomial::ONE, Polynomial::ONE);
    }
    let share = -exp_m1(-period / lag);
    (Polynomial::new([share, share]), Polynomial::new([share, 1.0]))
}

/// The mean torque over a tick of an actuator of first order, its command held: numerator and denominator.
const fn lagged(lag: f64, period: f64) -> (Polynomial, Polynomial) {
    if lag == 0.0 {
        return (Polynomial::ONE, Polynomial::ONE);
    }
    let settled = -exp_m1(-period / lag);
    (Polynomial::new([settled, 1.0 - settled * lag / period]), Polynomial::new([settled, 1.0]))
}
