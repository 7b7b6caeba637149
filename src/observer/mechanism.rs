//! The observer of a machine with a mechanism: one mass whose inertia depends on the angle.

use super::{Observer, Prediction, RigidConfig, RigidObserver};
use crate::angle::{RotorAngle, RotorAngleConfig};
use crate::number::Number;
use crate::sample::Estimate;

/// Places of the table on a turn of the crank. A second harmonic of the inertia is off by 0.5 % of its amplitude at
/// most.
pub const TABLE_POINTS: usize = 64;

/// Binary places of an angle below the table's.
const BELOW: u32 = 32 - TABLE_POINTS.trailing_zeros();

/// The machine with its crank at one angle, but for its weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TablePoint<N> {
    /// Mean inertia over the inertia here.
    pub inertia_ratio: N,
    /// Torque that the turning crank takes at the base of the speed, or at 1 rad/s: half the derivative of the inertia
    /// (N m s2/rad2).
    pub inertia_slope: N,
}

/// The tool of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tool<N> {
    /// Leverage at the angles of the table, per unit of the largest.
    pub leverage: [N; TABLE_POINTS],
    /// Torque of the weight at the largest leverage (N m).
    pub weight: N,
}

/// Constants of [`MechanismObserver`]. Made by [`crate::settings`] from a design; the fields are in SI units for floats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MechanismConfig<N: Number, const TOOLS: usize = 0> {
    /// Constants of the rigid observer of the mean inertia.
    pub rigid: RigidConfig<N>,
    /// Turns of the crank to those of the motor.
    pub turning: RotorAngleConfig,
    /// The machine from the mechanism's zero on, a slider-crank's top dead centre.
    pub points: [TablePoint<N>; TABLE_POINTS],
    /// The tool with its weight; none of an observer without one.
    pub tool: [Tool<N>; TOOLS],
}

/// The observer of a machine with a mechanism, of one tool or none.
///
/// A press, a shear, a pump: inertia and weight torque at the motor swing with the crank's angle,
///
/// ```text
/// J(phi) omega' = tau_m - tau_L - 1/2 J'(phi) omega^2 - G y'(phi)
/// ```
///
/// [derived; J(phi): Wang 1989 (1-15)]. An observer of constant inertia takes the exchange of energy for load torque.
/// Here it is reckoned with: the rigid observer of the mean inertia J is given the torque
///
/// ```text
/// tau = tau_L + J/J(phi) (tau_m - tau_L - 1/2 J'(phi) omega^2 - G y'(phi))
/// ```
///
/// under which a machine of constant inertia would move as this one does. `J/J(phi)`, `1/2 J'(phi)` and, where it is
/// wanted, the torque of the weight come from a table of constants over a turn of the crank, straight between its
/// points: of any [`Mechanism`](crate::machine::Mechanism).
///
/// The crank's angle follows from the motor's, exactly whatever the gear, once it is known:
/// [`MechanismObserver::home`].
///
/// ```
/// use driveline::design::{Disturbance, Encoder, Rate};
/// use driveline::machine::{CrankSlider, DrivenMechanism, Inertia, Length, Mass, Mechanism};
/// use driveline::observer::{MechanismConfig, MechanismObserver, Observer};
/// use driveline::settings::Bases;
/// // a crank of 0.1 m and a long rod: 40 kg move as s = r (1 - cos phi), with J' = m r^2 sin 2 phi
/// const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(10.0), Inertia(1.0), Mass(40.0));
/// const PRESS: DrivenMechanism = DrivenMechanism::new(Inertia(2.0), &Mechanism::slider_crank(&RAM), 1, 1);
/// const LOAD: Disturbance = Disturbance { torque_accuracy: 1.0, load_torque_step: 50.0, within: 1.0 };
/// const CONFIG: MechanismConfig<f64> =
///     MechanismConfig::<f64>::new(&PRESS.observer(Rate::hz(1000), Encoder::lines(2048), LOAD), Bases::SI);
/// let mut observer = MechanismObserver::<f64>::steady(&CONFIG, 0, 0.0, 20.0);
/// observer.home(&CONFIG, 1 << 29); // 45 degrees behind the top dead centre
/// let known = 40.0 * 0.1 * 0.1 / 2.0 * 20.0 * 20.0; // J' omega^2/2
/// assert!((observer.known_torque(&CONFIG) / known - 1.0).abs() < 0.02);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MechanismObserver<N = f32, const TOOLS: usize = 0> {
    rigid: RigidObserver<N>,
    /// Motor torque less the torque that the rigid observer was given.
    inertia_torque: N,
    turning: RotorAngle,
}

/// The observer of a mechanism with a tool, its weight and the force at it.
///
/// ```
/// use driveline::design::{Disturbance, Encoder, Rate};
/// use driveline::machine::{CrankSlider, DrivenMechanism, Inertia, Length, Mass, Mechanism};
/// use driveline::observer::{MechanismConfig, Observer, ToolObserver};
/// use driveline::settings::Bases;
/// const RAM: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(10.0), Inertia(1.0), Mass(40.0));
/// const PRESS: DrivenMechanism = DrivenMechanism::new(Inertia(2.0), &Mechanism::slider_crank(&RAM), 1, 1);
/// const LOAD: Disturbance = Disturbance { torque_accuracy: 1.0, load_torque_step: 50.0, within: 1.0 };
/// const CONFIG: MechanismConfig<f64, 1> =
///     MechanismConfig::<f64, 1>::new(&PRESS.observer(Rate::hz(1000), Encoder::lines(2048), LOAD), Bases::SI);
/// let mut observer = ToolObserver::<f64>::at_rest(&CONFIG, 0, 0.0);
/// // the ram stands still in the dead centre, and moves most for an angle of the crank at about 90 degrees
/// assert!(observer.leverage(&CONFIG).abs() < 1e-9);
/// observer.home(&CONFIG, 1 << 30);
/// assert!((observer.leverage(&CONFIG) - 1.0).abs() < 1e-3);
/// ```
pub type ToolObserver<N = f32> = MechanismObserver<N, 1>;

impl<N: Number, const TOOLS: usize> MechanismObserver<N, TOOLS> {
    /// Homing: sets the crank's angle from the mechanism's zero (2^-32 turn), positive as the motor's.
    ///
    /// Until then it counts from where the observer was started. It stays valid as long as the motor's angle is
    /// measured at least every half turn. After [`crate::fault::Faults::ANGLE_LOST`] the shorter displacement is
    /// assumed: home a crank behind a gear again.
    pub fn home(&mut self, config: &MechanismConfig<N, TOOLS>, crank_angle: u32) {
        self.turning.set(&config.turning, crank_angle);
    }

    /// The crank's angle from the mechanism's zero (2^-32 turn), with the resolution of 2^-26 turns.
    pub fn crank_angle(&self, config: &MechanismConfig<N, TOOLS>) -> u32 {
        self.turning.angle(&config.turning)
    }

    /// Inertia ratio at the crank's angle, and the torque that inertia and weight take at a speed of the motor.
    #[inline(always)]
    fn taken(&self, config: &MechanismConfig<N, TOOLS>, motor_speed: N) -> (N, N) {
        let angle = self.turning.angle(&config.turning);
        let TablePoint { inertia_ratio, inertia_slope } = at(&config.points, angle);
        let mut taken = inertia_slope.scaled(motor_speed.scaled(motor_speed));
        if let Some(tool) = config.tool.first() {
            taken = taken + leverage(&tool.leverage, angle).scaled(tool.weight);
        }
        (inertia_ratio, taken)
    }

    /// Leverage of the tool at the crank's angle, per unit of the largest; zero of an observer without a tool.
    pub fn leverage(&self, config: &MechanismConfig<N, TOOLS>) -> N {
        let angle = self.crank_angle(config);
        config.tool.first().map_or(N::ZERO, |tool| leverage(&tool.leverage, angle))
    }

    #[inline(always)]
    fn follow(&mut self, config: &RotorAngleConfig, angle: u32) {
        if !self.turning.follow(config, angle) {
            self.turning.wrap(config);
        }
    }
}

/// Point of the table before an angle of the crank, and the part of the way to the next.
#[inline(always)]
fn place<N: Number>(angle: u32) -> (usize, N) {
    ((angle >> BELOW) as usize, N::fraction(angle << (32 - BELOW)))
}

/// Leverage at an angle of the crank.
#[inline(always)]
fn leverage<N: Number>(table: &[N; TABLE_POINTS], angle: u32) -> N {
    let (index, part) = place(angle);
    let at = |index: usize| table.get(index & (TABLE_POINTS - 1)).copied().unwrap_or_default();
    at(index) + (at(index + 1) - at(index)).scaled(part)
}

/// Inertia ratio and slope at an angle of the crank.
#[inline(always)]
fn at<N: Number>(points: &[TablePoint<N>; TABLE_POINTS], angle: u32) -> TablePoint<N> {
    let (index, part) = place(angle);
    let from = points.get(index).copied().unwrap_or_default();
    let to = points.get((index + 1) & (TABLE_POINTS - 1)).copied().unwrap_or_default();
    TablePoint {
        inertia_ratio: from.inertia_ratio + (to.inertia_ratio - from.inertia_ratio).scaled(part),
        inertia_slope: from.inertia_slope + (to.inertia_slope - from.inertia_slope).scaled(part),
    }
}

impl<N: Number, const TOOLS: usize> Observer<N> for MechanismObserver<N, TOOLS> {
    type Config = MechanismConfig<N, TOOLS>;
    type States = (<RigidObserver<N> as Observer<N>>::States, N);

    /// The crank is at the mechanism's zero.
    fn steady(config: &MechanismConfig<N, TOOLS>, angle: u32, torque: N, speed: N) -> Self {
        let mut observer = MechanismObserver {
            rigid: RigidObserver::steady(&config.rigid, angle, torque, speed),
            ..MechanismObserver::default()
        };
        observer.follow(&config.turning, angle);
        observer.home(config, 0);
        observer
    }

    /// The crank has turned with the motor since the last accepted angle.
    fn restart(&mut self, config: &MechanismConfig<N, TOOLS>, angle: u32, torque: N, speed: N) {
        self.rigid.restart(&config.rigid, angle, torque, speed);
        self.inertia_torque = N::ZERO;
        self.follow(&config.turning, angle);
    }

    fn speed_of_turn(config: &MechanismConfig<N, TOOLS>, turned: N) -> N {
        RigidObserver::speed_of_turn(&config.rigid, turned)
    }

    fn resync(&mut self, angle: u32) {
        self.rigid.resync(angle);
    }

    #[inline(always)]
    fn predict(&self, config: &MechanismConfig<N, TOOLS>, angle: u32, torque: N) -> Prediction<N, Self::States> {
        let Estimate { motor_speed, load_torque, .. } = self.rigid.estimate(&config.rigid);
        let (inertia_ratio, taken) = self.taken(config, motor_speed);
        let accelerating = (torque - load_torque - taken).saturated();
        let given = inertia_ratio.scaled(accelerating) + load_torque;
        self.rigid.predict(&config.rigid, angle, given).with(torque - given)
    }

    #[inline(always)]
    fn correct(&mut self, config: &MechanismConfig<N, TOOLS>, predicted: Prediction<N, Self::States>, angle: u32) {
        let (predicted, inertia_torque) = predicted.split();
        self.rigid.correct(&config.rigid, predicted, angle);
        self.inertia_torque = inertia_torque;
        self.follow(&config.turning, angle);
    }

    /// The crank's angle stays at the last accepted one.
    #[inline(always)]
    fn coast(&mut self, predicted: Prediction<N, Self::States>, angle: u32) {
        let (predicted, inertia_torque) = predicted.split();
        self.rigid.coast(predicted, angle);
        self.inertia_torque = inertia_torque;
    }

    #[inline(always)]
    fn known_torque(&self, config: &MechanismConfig<N, TOOLS>) -> N {
        self.taken(config, self.rigid.estimate(&config.rigid).motor_speed).1
    }

    /// The shaft is that between the motor and the mechanism: its torque is the motor's less that of the motor's own
    /// acceleration.
    #[inline(always)]
    fn estimate(&self, config: &MechanismConfig<N, TOOLS>) -> Estimate<N> {
        let rigid = self.rigid.estimate(&config.rigid);
        Estimate { shaft_torque: rigid.shaft_torque + self.inertia_torque, ..rigid }
    }

    #[inline(always)]
    fn angle(&self) -> u32 {
        self.rigid.angle()
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        Observer::<N>::beyond_base(&self.rigid)
    }
}
