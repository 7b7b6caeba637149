//! A drive whose torque comes from an actuator: a fuel rack, a steam valve.

use super::{Composition, ConfigOf, GovernorConfigOf, ObserverConfigOf, VibrationOf, handed_on, own};
use crate::configure::{Configure, GainSource, HasActuator, Machine, Refusal};
use crate::design::Actuator;
use crate::fault::Faults;
use crate::governor::{
    ActuatorMonitor, ActuatorMonitorConfig, HasRunSequence, RunRequest, RunState, TransportDelay, TransportDelayConfig,
    Trip,
};
use crate::number::Number;
use crate::sample::{Command, Estimate, Sample};

/// A drive `D` behind an actuator of `LAGS` lags in a row, whose torque acts up to `RING - 1` ticks after its position.
///
/// The sample's torque is that of the actuator's position. The [monitor](ActuatorMonitor) compares it with the command,
/// the [delay](TransportDelay) takes it to the time at which it acts on the machine, and an actuator that does not
/// follow trips the run sequence. A delay of zero needs a ring of one place.
///
/// It is a [`Composition`] as the drive inside is, and takes its place in an [`Axis`](crate::axis::Axis). The machine
/// [`HasActuator`].
///
/// ```
#[doc = include_str!("../generator_set.txt")]
/// impl HasActuator<1> for Set {
///     const LAGS: [f64; 1] = [0.02];
///     const TORQUE_DELAY: f64 = 0.0065;
/// }
/// type SetDrive = Actuated<Drive<f32, TwoMassObserver, SpeedGovernor<(), (), SymmetricLimit, Sequencer>>, 1, 32>;
/// static CONFIG: ConfigOf<SetDrive> = SetDrive::configure::<Set>();
/// let mut drive = SetDrive::new(&CONFIG, 0);
/// drive.request(RunRequest::Start);
/// // the rack sticks: the governor is in its limit, the sample reports nothing
/// let stuck = |_| { drive.tick(&CONFIG, &Sample::si::<Set>(0, 0.0, 157.08)); drive.state() };
/// assert_eq!((0..2_400).map(stuck).last(), Some(RunState::Tripped(Trip::Actuator))); // within a second
/// ```
#[derive(Clone, Copy, Debug)]
#[repr(C)]
// Not logged: it holds the drive, whose estimates are.
pub struct Actuated<D: Composition, const LAGS: usize = 1, const RING: usize = 1> {
    drive: D,
    monitor: ActuatorMonitor<D::Number, LAGS>,
    delay: TransportDelay<D::Number, RING>,
}

/// The constants of an [`Actuated`] drive.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ActuatedConfig<C, N: Number, const LAGS: usize, const RING: usize> {
    /// Constants of the drive.
    pub drive: C,
    /// Constants of the actuator's monitor.
    pub monitor: ActuatorMonitorConfig<N, LAGS>,
    /// Delay of the actuator's torque.
    pub delay: TransportDelayConfig<RING>,
}

/// Why the actuator of a machine is refused: the governor's gains allow for less than its lags and delay, or the ring
/// is too short.
const fn refused<const LAGS: usize, const RING: usize, M: HasActuator<LAGS>>() -> Option<Refusal> {
    let Actuator { delay, lag } = match M::GAINS {
        GainSource::Governor(design) => design.actuator,
        GainSource::SpeedLoop(_) => M::ACTUATOR,
    };
    let (mut sum, mut k) = (M::TORQUE_DELAY, 0);
    while k < LAGS {
        sum += M::LAGS[k];
        k += 1;
    }
    // half a period: rounding of the given figures
    if !(sum <= delay + lag + 0.5 * M::PERIOD) {
        return Some(
            Refusal::new("ACTUATOR: LAGS and TORQUE_DELAY of HasActuator are ")
                .figure(sum)
                .and(" s together, the speed loop allows for ")
                .figure(delay + lag)
                .and(" s: give ACTUATOR at least their sum, and GAINS the same ACTUATOR"),
        );
    }
    match TransportDelayConfig::<RING>::try_new(M::TORQUE_DELAY, M::PERIOD) {
        Ok(_) => None,
        Err(error) => Some(
            Refusal::new("TORQUE_DELAY: ")
                .and(error.message())
                .and(": `Actuated<_, LAGS, RING>` needs a RING of more than ")
                .figure(M::TORQUE_DELAY / M::PERIOD)
                .and(" ticks, a power of two"),
        ),
    }
}

impl<M, D, const LAGS: usize, const RING: usize> Configure<M, D::Number> for Actuated<D, LAGS, RING>
where
    M: HasActuator<LAGS>,
    D: Composition<Governor: HasRunSequence> + Configure<M, D::Number, Config = ConfigOf<D>>,
    ActuatorMonitor<D::Number, LAGS>: Configure<M, D::Number, Config = ActuatorMonitorConfig<D::Number, LAGS>>,
{
    type Config = ConfigOf<Self>;
    const CONFIG: Self::Config = ActuatedConfig {
        drive: <D as Configure<M, D::Number>>::CONFIG,
        monitor: <ActuatorMonitor<D::Number, LAGS> as Configure<M, D::Number>>::CONFIG,
        delay: TransportDelayConfig::new(M::TORQUE_DELAY, M::PERIOD),
    };
    const REFUSED: Option<Refusal> = match D::REFUSED {
        None => refused::<LAGS, RING, M>(),
        refused => refused,
    };
}

impl<D: Composition<Governor: HasRunSequence>, const LAGS: usize, const RING: usize> Actuated<D, LAGS, RING> {
    /// The constants of this drive for the machine `M`, as [`Drive::configure`](super::Drive::configure).
    pub const fn configure<M: Machine>() -> ConfigOf<Self>
    where
        Self: Configure<M, D::Number, Config = ConfigOf<Self>>,
    {
        crate::configure::stop_refused::<Self, M, D::Number>();
        crate::configure::constants::<Self, M, D::Number>()
    }

    /// A drive whose machine stands still at `angle` (2^-32 turn), with the actuator at zero torque.
    pub fn new(config: &ConfigOf<Self>, angle: u32) -> Self {
        Actuated { drive: D::new(&config.drive, angle), monitor: ActuatorMonitor::new(), delay: TransportDelay::new() }
    }

    /// One tick, as [`Drive::tick`](super::Drive::tick), with the torque of the actuator's position (N m).
    #[inline(always)]
    pub fn tick(&mut self, config: &ConfigOf<Self>, sample: &Sample<D::Number>) -> Command<D::Number> {
        let (torque, faults) = self.acting(config, sample.torque);
        let command = self.drive.tick(&config.drive, &Sample { torque, ..*sample });
        self.commands(config, command, faults)
    }

    /// The present estimate.
    #[inline(always)]
    pub fn estimate(&self, config: &ConfigOf<Self>) -> Estimate<D::Number> {
        self.drive.estimate(&config.drive)
    }

    /// Requests another state of the run sequence, as [`Sequencer::request`](crate::governor::Sequencer::request).
    #[inline(always)]
    pub fn request(&mut self, request: RunRequest) -> bool {
        self.drive.governor_mut().sequencer_mut().request(request)
    }

    /// State of the run sequence.
    pub fn state(&self) -> RunState {
        self.drive.governor().sequencer().state()
    }

    /// The drive inside.
    pub fn drive(&self) -> &D {
        &self.drive
    }

    /// The torque that acts on the machine now, for that of the actuator's position.
    #[inline(always)]
    fn acting(&mut self, config: &ConfigOf<Self>, reported: D::Number) -> (D::Number, Faults) {
        let (torque, faults) = self.monitor.check(&config.monitor, reported);
        if let Some(reason) = self.monitor.trip(&config.monitor) {
            self.trip(reason);
        }
        (self.delay.delayed(&config.delay, torque), faults)
    }

    #[cold]
    fn trip(&mut self, reason: Trip) {
        self.drive.governor_mut().sequencer_mut().trip(reason);
    }

    #[inline(always)]
    fn commands(
        &mut self,
        config: &ConfigOf<Self>,
        mut command: Command<D::Number>,
        faults: Faults,
    ) -> Command<D::Number> {
        command.faults |= faults;
        self.monitor.advance(&config.monitor, command.torque);
        command
    }

    /// The actuator goes on in ticks that did not run, up to those that fill its ring.
    #[cold]
    fn pass(&mut self, config: &ConfigOf<Self>, missed: u32) {
        let commanded = self.drive.commanded();
        for _ in 0..missed.min(RING as u32) {
            self.delay.delayed(&config.delay, self.monitor.expected());
            self.monitor.advance(&config.monitor, commanded);
        }
    }
}

impl<D: Composition<Governor: HasRunSequence>, const LAGS: usize, const RING: usize> Composition
    for Actuated<D, LAGS, RING>
{
    type Number = D::Number;
    type Config = ActuatedConfig<ConfigOf<D>, D::Number, LAGS, RING>;
    type Observer = D::Observer;
    type Governor = D::Governor;
    type Fluctuation = D::Fluctuation;
    type Balancer = D::Balancer;

    handed_on!(mut);

    own! { Actuated:
        fn new(config: &Self::Config, angle: u32) -> Self;
        fn tick(&mut self, config: &Self::Config, sample: &Sample<D::Number>) -> Command<D::Number>;
        fn estimate(&self, config: &Self::Config) -> Estimate<D::Number>;
    }

    fn tick_after(&mut self, config: &Self::Config, sample: &Sample<D::Number>, missed: u32) -> Command<D::Number> {
        if missed != 0 {
            self.pass(config, missed);
        }
        let (torque, faults) = self.acting(config, sample.torque);
        let command = self.drive.tick_after(&config.drive, &Sample { torque, ..*sample }, missed);
        self.commands(config, command, faults)
    }

    fn make_up(&mut self, config: &Self::Config, torque: D::Number, missed: u32) -> Faults {
        self.pass(config, missed);
        self.drive.make_up(&config.drive, torque, missed)
    }

    fn coast(&mut self, config: &Self::Config, torque: D::Number, setpoint: D::Number) -> Command<D::Number> {
        let (torque, faults) = self.acting(config, torque);
        let command = self.drive.coast(&config.drive, torque, setpoint);
        self.commands(config, command, faults)
    }

    fn hold(&mut self, config: &Self::Config, angle: u32, torque: D::Number) -> Command<D::Number> {
        self.delay.delayed(&config.delay, self.monitor.expected());
        let command = self.drive.hold(&config.drive, angle, torque);
        self.commands(config, command, Faults::NONE)
    }

    fn engage(&mut self, config: &Self::Config) {
        self.drive.engage(&config.drive);
    }

    fn switch(&mut self, from: &Self::Config, to: &Self::Config) {
        self.drive.switch(&from.drive, &to.drive);
    }

    fn parts(config: &mut Self::Config) -> (&mut ObserverConfigOf<Self>, &mut GovernorConfigOf<Self>) {
        D::parts(&mut config.drive)
    }

    fn vibration(&mut self, config: &Self::Config, vibration: &VibrationOf<Self>) {
        self.drive.vibration(&config.drive, vibration);
    }
}
