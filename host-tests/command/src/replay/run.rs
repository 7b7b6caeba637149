//! The observer, tick by tick.

use driveline::design::{RigidDesign, TwoMassDesign};
use driveline::drive::{Config, Drive, Limits};
use driveline::fault::Faults;
use driveline::number::{Fixed, Number, Part, StateOf};
use driveline::observer::{
    GearedConfig, GearedObserver, LoadGearConfig, LoadGearObserver, Observer, RigidConfig, RigidObserver,
    TwoMassConfig, TwoMassObserver,
};
use driveline::sample::Sample;
use driveline::settings::{Bases, Error, Gear, LoadGear, Screening};

use super::signals::Signals;

/// The estimates of one number over the recording, in SI units.
#[derive(Clone, Debug, Default)]
pub struct Course {
    /// `f32` or `fixed`.
    pub number: &'static str,
    /// Speed of the motor (rad/s).
    pub motor_speed: Vec<f64>,
    /// Torque of the shaft (N m).
    pub shaft_torque: Vec<f64>,
    /// Speed of the load (rad/s).
    pub load_speed: Vec<f64>,
    /// Load torque (N m).
    pub load_torque: Vec<f64>,
    /// Measured less predicted angle of the motor (rad); NaN without an angle, and at the first one.
    pub innovation: Vec<f64>,
    /// Faults of each tick.
    pub faults: Vec<Faults>,
}

/// A recording with its estimates.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// The recording.
    pub signals: Signals,
    /// The estimates of each number.
    pub courses: Vec<Course>,
    /// Why there are none in fixed point.
    pub no_fixed: Option<Error>,
    /// Deviation of the innovation that the design predicts (rad).
    pub predicted: f64,
    /// Ticks at the start that errors leave out: those before the first angle, then ten time constants of the
    /// observer's slowest pole, a tenth of the recording at most.
    pub settling: usize,
}

/// The observer of a design.
// one of it in a run
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug)]
pub enum Design {
    /// Of two masses.
    TwoMass(TwoMassDesign),
    /// Of one, and the load's share of its inertia.
    Rigid(RigidDesign, f64),
}

/// What numbers are in SI units.
#[derive(Clone, Copy)]
struct Units {
    name: &'static str,
    torque: f64,
    speed: f64,
    /// Of [`Number::to_real`] of an innovation (rad).
    angle: f64,
}

/// Radians to 2^-32 turn.
const STEP: f64 = std::f64::consts::TAU / 4_294_967_296.0;
/// Units in the last place to the base of a fixed-point number.
const UNIT: f64 = 268_435_456.0;
/// Doublings of the bases of torque and speed, together.
const DOUBLINGS: i32 = 12;

/// Runs the observer over a recording, in `f32` and in fixed point, between gears with losses and with the time between
/// samples (s) where there are some. `tick` counts.
pub fn replay(
    signals: Signals,
    design: &Design,
    gear: Option<&(Gear, LoadGear, f64)>,
    screening: &Screening,
    most: [f64; 2],
    mut tick: impl FnMut(),
) -> Result<Replayed, Error> {
    let single = Units { name: "f32", torque: 1.0, speed: 1.0, angle: STEP };
    let fixed = |bases: &Bases| Units { name: "fixed", torque: bases.torque, speed: bases.speed, angle: STEP * UNIT };
    let limits = Limits::<f32>::try_new(screening, Bases::SI)?;
    macro_rules! course {
        ($number:ty, $observer:ident, $config:expr, $bases:expr, $limits:expr, $units:expr) => {
            match gear {
                None => run::<$number, $observer>(&signals, $config, $limits, $units, &mut tick),
                Some((gear, behind, period)) => {
                    let config = GearedConfig::<$number, _>::try_new($config, gear, *period, $bases)?;
                    let config = LoadGearConfig::<$number, _>::try_new(config, behind, *period, $bases)?;
                    run::<$number, LoadGearObserver<GearedObserver<$observer>>>(
                        &signals, config, $limits, $units, &mut tick,
                    )
                }
            }
        };
    }
    let ((single, fixed), predicted, radius): ((Course, Result<Course, Error>), _, _) = match design {
        Design::TwoMass(design) => {
            let of = |torque: f64, speed: f64| Bases::of(design, torque, speed);
            let fits = |bases: &Bases| TwoMassConfig::<Fixed>::try_new(design, *bases).is_ok();
            let bases = fitting(of, fits, most);
            let config = TwoMassConfig::<f32>::try_new(design, Bases::SI)?;
            let one = course!(f32, TwoMassObserver, config, Bases::SI, limits, single);
            let mut other = || {
                let config = TwoMassConfig::<Fixed>::try_new(design, bases)?;
                let limits = Limits::<Fixed>::try_new(screening, bases)?;
                Ok(course!(Fixed, TwoMassObserver, config, bases, limits, fixed(&bases)))
            };
            ((one, other()), design.innovation, design.spectral_radius)
        }
        Design::Rigid(design, share) => {
            let fits = |bases: &Bases| RigidConfig::<Fixed>::try_new(design, *share, *bases).is_ok();
            let bases = fitting(Bases::rigid, fits, most);
            let config = RigidConfig::<f32>::try_new(design, *share, Bases::SI)?;
            let one = course!(f32, RigidObserver, config, Bases::SI, limits, single);
            let mut other = || {
                let config = RigidConfig::<Fixed>::try_new(design, *share, bases)?;
                let limits = Limits::<Fixed>::try_new(screening, bases)?;
                Ok(course!(Fixed, RigidObserver, config, bases, limits, fixed(&bases)))
            };
            ((one, other()), design.innovation, design.spectral_radius)
        }
    };
    let slowest = -10.0 / radius.ln();
    let settling = if slowest.is_finite() { (slowest as usize).min(signals.time.len() / 10) } else { 0 };
    let settling = settling + signals.angle.iter().position(Option::is_some).unwrap_or(0);
    let no_fixed = fixed.as_ref().err().copied();
    let courses = [single].into_iter().chain(fixed).collect();
    Ok(Replayed { signals, courses, no_fixed, predicted, settling })
}

/// The smallest bases that hold the observer's coefficients, from twice the torque and a third over the speed on. A
/// fine encoder or a light machine has large gains. Each doubling takes one of 28 bits.
fn fitting(of: impl Fn(f64, f64) -> Bases, fits: impl Fn(&Bases) -> bool, [torque, speed]: [f64; 2]) -> Bases {
    let doubled = |torques: i32, speeds: i32| of(2.0 * torque * 2_f64.powi(torques), 1.34 * speed * 2_f64.powi(speeds));
    let all = (0..=DOUBLINGS).flat_map(|sum| (0..=sum).map(move |speeds| doubled(sum - speeds, speeds)));
    all.into_iter().find(fits).unwrap_or_else(|| doubled(0, 0))
}

fn run<N, O>(
    signals: &Signals,
    config: <StateOf<O, N> as Observer<N>>::Config,
    limits: Limits<N>,
    units: Units,
    tick: &mut impl FnMut(),
) -> Course
where
    N: Number + OfReal,
    O: Part<N, State: Observer<N>>,
{
    let config = Config { limits, observer: config, fluctuation: (), governor: (), balancer: () };
    let mut drive = Drive::<N, O>::new(&config, 0);
    let first = signals.angle.iter().position(Option::is_some);
    let mut course = Course { number: units.name, ..Course::default() };
    for (at, (angle, torque)) in signals.angle.iter().zip(&signals.torque).enumerate() {
        let torque = N::of_real(torque / units.torque);
        let (innovation, faults) = match *angle {
            Some(angle) if first == Some(at) => {
                // a machine that turns already: the recorded speed, or that of its first two angles
                let next = signals.angle.get(at + 1).copied().flatten().unwrap_or(angle);
                let turned =
                    || <StateOf<O, N>>::speed_of_turn(&config.observer, N::from_angle(next.wrapping_sub(angle) as i32));
                let recorded = signals.motor_speed.as_ref().and_then(|speed| speed.get(at));
                let speed = recorded.map_or_else(turned, |speed| N::of_real(speed / units.speed));
                drive = Drive::new(&config, angle);
                drive.observer_mut().restart(&config.observer, angle, N::ZERO, speed);
                (f64::NAN, Faults::NONE)
            }
            Some(angle) => {
                let innovation = drive.observer().predict(&config.observer, angle, torque).innovation();
                let command = drive.tick(&config, &Sample { angle, torque, setpoint: N::ZERO });
                (units.angle * innovation.to_real(), command.faults)
            }
            None => (f64::NAN, drive.coast(&config, torque, N::ZERO).faults),
        };
        let estimate = drive.estimate(&config);
        course.motor_speed.push(units.speed * estimate.motor_speed.to_real());
        course.shaft_torque.push(units.torque * estimate.shaft_torque.to_real());
        course.load_speed.push(units.speed * estimate.load_speed.to_real());
        course.load_torque.push(units.torque * estimate.load_torque.to_real());
        course.innovation.push(innovation);
        course.faults.push(faults);
        tick();
    }
    course
}

/// From a real number, which the tick itself never needs.
pub trait OfReal {
    /// The nearest.
    fn of_real(value: f64) -> Self;
}

impl OfReal for f32 {
    fn of_real(value: f64) -> Self {
        value as Self
    }
}

impl OfReal for Fixed {
    fn of_real(value: f64) -> Self {
        Self::from_f64(value)
    }
}
