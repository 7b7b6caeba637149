//! Inputs and outputs of a tick.

use crate::fault::Faults;

/// One measurement, taken at the beginning of a tick.
///
/// Fixed point has torque and speed per unit of [`Bases::torque`](crate::settings::Bases::torque) and
/// [`Bases::speed`](crate::settings::Bases::speed).
///
/// ```
#[doc = include_str!("roll.txt")]
/// // a quarter of a turn, 30 N m in the last tick, 100 rad/s wanted: in SI units whatever the number
/// let sample = Sample::<Fixed>::si::<Roll>(1 << 30, 30.0, 100.0);
/// assert!((sample.torque.to_f64() * Roll::BASES.torque - 30.0).abs() < 1e-4);
/// // in floats the fields are in SI units themselves
/// let single = Sample { angle: 1 << 30, torque: 30.0, setpoint: 100.0 };
/// assert_eq!(Sample::<f32>::si::<Roll>(1 << 30, 30.0, 100.0), single);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample<N> {
    /// Motor angle (2^-32 turn); it wraps, and its zero does not matter.
    pub angle: u32,
    /// Air-gap torque of the motor over the tick that has just ended (N m; per unit in fixed point); positive
    /// accelerates forwards.
    pub torque: N,
    /// Speed setpoint of the motor (rad/s; per unit in fixed point).
    pub setpoint: N,
}

/// The observer's estimate at the beginning of a tick, referred to the motor; per unit of the bases of [`Sample`] in
/// fixed point.
///
/// ```
#[doc = include_str!("roll.txt")]
/// type RollDrive = Drive<Fixed, TwoMassObserver, SpeedLoop>;
/// static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
/// // held by its brake, the shaft carries the torque that the motor gives (N m, in whatever number)
/// let mut drive = RollDrive::new(&CONFIG, 0);
/// drive.hold(&CONFIG, 0, Fixed::from_f64(30.0 / Roll::BASES.torque));
/// let estimate = drive.estimate(&CONFIG).si::<Roll>();
/// assert!((estimate.shaft_torque - 30.0).abs() < 1e-3 && estimate.load_speed == 0.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Estimate<N> {
    /// Speed of the motor (rad/s; per unit in fixed point).
    pub motor_speed: N,
    /// Torque in the shaft (N m; per unit in fixed point), the softest one of the chain: that of its twist, without the
    /// loss of a gear on either side; positive where the motor drives the load.
    pub shaft_torque: N,
    /// Speed of the load (rad/s; per unit in fixed point).
    pub load_speed: N,
    /// Torque that the load opposes to its motion (N m; per unit in fixed point); positive decelerates.
    pub load_torque: N,
}

/// Output of a tick.
///
/// ```
#[doc = include_str!("roll.txt")]
/// use driveline::fault::Faults;
/// type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
/// static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();
/// let mut drive = RollDrive::new(&CONFIG, 0);
/// // the torque report is broken: the fault is told, the drive goes on within its limit
/// let command = drive.tick(&CONFIG, &Sample { angle: 0, torque: f32::NAN, setpoint: 100.0 });
/// assert_eq!(command.faults, Faults::TORQUE);
/// assert!(command.torque_si::<Roll>() > 0.0 && command.torque_si::<Roll>() <= 550.0);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Command<N> {
    /// Torque command for the tick that begins (N m; per unit in fixed point): within the governor's limit, or the
    /// torque of [`crate::drive::Drive::hold`].
    pub torque: N,
    /// Faults of this tick.
    pub faults: Faults,
}
