//! Observer and speed loop as one controller, from the motor's angle to the torque.

use super::complex::{Complex, over, plus, scaled, times};
use super::plant::Twist;
use super::polynomial::Polynomial;
use super::{ExactStep, LoopObserver, PlacedObserver, RigidDesign, SpeedLoopDesign, TwoMassDesign};
use crate::machine::TwoMass;
use crate::math::exp_m1;

/// The observer's model and gains, in the coordinates of mean motion and twist.
#[derive(Clone, Copy)]
pub(super) struct Observer {
    pub period: f64,
    /// 1/J, 1/J_m, 1/J_l and J_l/J.
    inverse: [f64; 3],
    share: f64,
    /// Stiffness and damping of the shaft.
    shaft: [f64; 2],
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
    pub const fn of_two_masses(machine: &TwoMass, step: &ExactStep, gains: [f64; 5], period: f64) -> Self {
        let [angle, motor_speed, twist, load_speed, load_torque] = gains;
        let (jm, jl, total) = (machine.motor_inertia, machine.load_inertia, machine.total_inertia());
        let share = jl / total;
        Self {
            period,
            inverse: [1.0 / total, 1.0 / jm, 1.0 / jl],
            share,
            shaft: [machine.stiffness, machine.damping],
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
    pub const fn of_one_mass(design: &RigidDesign) -> Self {
        let [angle, speed, load_torque] = design.gains;
        Self {
            period: design.period,
            inverse: [1.0 / design.machine.inertia, 0.0, 0.0],
            share: 0.0,
            shaft: [0.0; 2],
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

    /// Motion of the model under torques of motor and load, with the corrections by so much innovation.
    const fn motion(&self, torque: Complex, load: Complex, innovation: Complex, d: Complex) -> Motion {
        let (t, n, [per_total, per_motor, per_load]) = (self.period, &self.step, self.inverse);
        let moves = scaled(per_total, plus(torque, scaled(-1.0, load)));
        let mean = over(plus(scaled(t, moves), scaled(self.mean_speed, innovation)), d);
        let glides = plus(scaled(t, mean), scaled(0.5 * t * t, moves));
        let angle = over(plus(glides, scaled(self.mean_angle, innovation)), d);
        let forced = plus(scaled(per_motor, torque), scaled(per_load, load));
        let twists = plus(scaled(n.g1, forced), scaled(self.twist_gain, innovation));
        let slips = plus(scaled(n.g2, forced), scaled(self.slip, innovation));
        let (a, b) = ((d.0 - n.n11, d.1), (d.0 - n.n22, d.1));
        let determinant = plus(times(a, b), (-n.n12 * n.n21, 0.0));
        let twist = over(plus(times(b, twists), scaled(n.n12, slips)), determinant);
        let slip = over(plus(scaled(n.n21, twists), times(a, slips)), determinant);
        Motion {
            angle: plus(angle, scaled(self.share, twist)),
            speed: plus(mean, scaled(self.share, slip)),
            shaft_torque: plus(scaled(self.shaft[0], twist), scaled(self.shaft[1], slip)),
            load_torque: load,
        }
    }

    /// Response of the motion to a torque of the motor.
    pub const fn driven(&self, d: Complex) -> Motion {
        self.motion((1.0, 0.0), (0.0, 0.0), (0.0, 0.0), d)
    }

    /// Response of the estimates to the motor's angle beyond the model's.
    pub const fn corrected(&self, z: Complex, d: Complex) -> Motion {
        let load = over(scaled(self.load_torque, z), d);
        let seen = self.motion((0.0, 0.0), load, z, d);
        let innovation = over((1.0, 0.0), (1.0 - self.angle + seen.angle.0, seen.angle.1));
        Motion {
            angle: times(innovation, seen.angle),
            speed: times(innovation, seen.speed),
            shaft_torque: times(innovation, seen.shaft_torque),
            load_torque: times(innovation, seen.load_torque),
        }
    }

    /// Denominator, and what it is divided into by torque and by motor angle, of the torque that the governor gives:
    /// `u = -(Q tau + P theta_m)/D`.
    pub const fn controller(&self, speed_loop: &SpeedLoopDesign) -> [Polynomial; 3] {
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

/// Responses of the motor's angle and speed and of the torques in shaft and load.
#[derive(Clone, Copy)]
pub(super) struct Motion {
    pub angle: Complex,
    pub speed: Complex,
    pub shaft_torque: Complex,
    pub load_torque: Complex,
}

/// Observer and speed loop between the motor's angle and the torque: `u = -(Q tau + P theta_m)/D`, polynomials in
/// `z - 1`, the constant first.
///
/// `phi` and `omega` are the mean angle and speed, `delta` and `v` twist and twist rate. All states of the observer
/// follow by the model's own step from the torque `tau` of the ended tick and from the innovation `i`. Eliminating `i`
/// from `theta_m - theta_m^ = (1 - K_1) i` leaves the governor's torque as `u = -(Q tau + P theta_m)/D_o`. `D_o` is the
/// polynomial of the observer's poles; all of it is in closed form, in `z - 1`.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::design::{Controller, LoopObserver};
/// // for a simulation elsewhere: u = -(Q tau + P theta)/D in powers of z - 1
/// const CONTROLLER: Controller = LoopObserver::TwoMass(&Roll::OBSERVER).controller(&Roll::SPEED_LOOP);
/// // D has the observer's poles p: without lags it is their product (z - p), at z = 1 that of 1 - p
/// let (re, _) = Roll::OBSERVER.poles.iter().fold((1.0, 0.0), |(a, b), (re, im)| {
///     (a * (1.0 - re) + b * im, b * (1.0 - re) - a * im)
/// });
/// assert!((CONTROLLER.denominator[0] / re - 1.0).abs() < 1e-6);
/// ```
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
        let [denominator, of_torque, of_angle] = self.model().controller(speed_loop);
        Controller { denominator: denominator.first(), of_torque: of_torque.first(), of_angle: of_angle.first() }
    }

    /// Its model and gains.
    pub(super) const fn model(&self) -> Observer {
        match self {
            Self::TwoMass(TwoMassDesign { machine, step, gains, period, .. })
            | Self::Placed(PlacedObserver { machine, step, gains, period, .. }) => {
                Observer::of_two_masses(machine, step, *gains, *period)
            }
            Self::Rigid(design) => Observer::of_one_mass(design),
        }
    }
}

/// A lag of first order of the samples: numerator and denominator.
const fn first_order(lag: f64, period: f64) -> (Polynomial, Polynomial) {
    if lag == 0.0 {
        return (Polynomial::ONE, Polynomial::ONE);
    }
    let share = -exp_m1(-period / lag);
    (Polynomial::new([share, share]), Polynomial::new([share, 1.0]))
}
