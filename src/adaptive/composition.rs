//! An adaptive drive as a drive: its constants and its ticks.

use core::marker::PhantomData;

use super::{Adaptive, AdaptiveConfig, INTERRUPTED, Learning, Scheduling};
use crate::configure::{Configure, Machine, Refusal, Units};
use crate::drive::{Composition, ConfigOf, GovernorConfigOf, MADE_UP, ObserverConfigOf, VibrationOf, handed_on, own};
use crate::fault::Faults;
use crate::number::Part;
use crate::sample::{Command, Estimate, Sample};

impl<M, D, S, L> Configure<M, D::Number> for Adaptive<M, D, S, L>
where
    M: Machine,
    D: Composition<Number: Units, Config: Copy> + Configure<M, D::Number, Config = ConfigOf<D>>,
    S: Part<D::Number, State: Scheduling<M, D>>,
    L: Part<D::Number, State: Learning<M, D>>,
{
    type Config = ConfigOf<Self>;
    const CONFIG: Self::Config = AdaptiveConfig {
        drive: <D as Configure<M, D::Number>>::CONFIG,
        schedule: <S::State as Scheduling<M, D>>::CONFIG,
        machine: PhantomData,
    };
    const REFUSED: Option<Refusal> = D::REFUSED;
}

impl<M, D, S, L> Adaptive<M, D, S, L>
where
    M: Machine,
    D: Composition<Number: Units, Config: Copy>,
    S: Part<D::Number, State: Scheduling<M, D>>,
    L: Part<D::Number, State: Learning<M, D>>,
{
    /// A drive whose machine stands still at `angle` (2^-32 turn), without torque in its shaft, with load and rope of
    /// [`Machine::CHAIN`].
    pub fn new(config: &ConfigOf<Self>, angle: u32) -> Self {
        Adaptive {
            drive: D::new(&config.drive, angle),
            config: config.drive,
            learners: L::State::start(),
            passed: super::fresh(M::RATE_HZ),
            ticks: [0; 3],
            interrupted: true,
            load: None,
            schedule: S::State::start(angle),
            machine: PhantomData,
        }
    }

    /// One tick, as [`Drive::tick`](crate::drive::Drive::tick).
    #[inline(always)]
    pub fn tick(&mut self, _config: &ConfigOf<Self>, sample: &Sample<D::Number>) -> Command<D::Number> {
        let torque = self.learners.calibrated(sample.torque);
        let command = self.drive.tick(&self.config, &Sample { torque, ..*sample });
        self.count(command)
    }

    /// One tick against a closed brake, as [`Drive::hold`](crate::drive::Drive::hold).
    pub fn hold(&mut self, _config: &ConfigOf<Self>, angle: u32, torque: D::Number) -> Command<D::Number> {
        let command = self.drive.hold(&self.config, angle, torque);
        self.passed |= INTERRUPTED;
        self.count(command)
    }

    /// The present estimate.
    #[inline(always)]
    pub fn estimate(&self, _config: &ConfigOf<Self>) -> Estimate<D::Number> {
        self.drive.estimate(&self.config)
    }
}

impl<M, D, S, L> Composition for Adaptive<M, D, S, L>
where
    M: Machine,
    D: Composition<Number: Units, Config: Copy>,
    S: Part<D::Number, State: Scheduling<M, D>>,
    L: Part<D::Number, State: Learning<M, D>>,
{
    type Number = D::Number;
    type Config = AdaptiveConfig<ConfigOf<D>, <S::State as Scheduling<M, D>>::Config, M>;
    type Observer = D::Observer;
    type Governor = D::Governor;
    type Fluctuation = D::Fluctuation;
    type Balancer = D::Balancer;

    handed_on!(mut);

    own! { Adaptive:
        fn new(config: &Self::Config, angle: u32) -> Self;
        fn tick(&mut self, config: &Self::Config, sample: &Sample<D::Number>) -> Command<D::Number>;
        fn hold(&mut self, config: &Self::Config, angle: u32, torque: D::Number) -> Command<D::Number>;
        fn estimate(&self, config: &Self::Config) -> Estimate<D::Number>;
    }

    #[inline(always)]
    fn tick_after(&mut self, _: &Self::Config, sample: &Sample<D::Number>, missed: u32) -> Command<D::Number> {
        let torque = self.learners.calibrated(sample.torque);
        let command = self.drive.tick_after(&self.config, &Sample { torque, ..*sample }, missed);
        self.count_missed(missed);
        // Ticks that are made up hang together; more of them lack the angle, which is a fault of its own.
        let missed = command.faults.bits() & Faults::TICK_MISSED.bits();
        let faults = Faults::from_bits(command.faults.bits() ^ missed);
        let command = self.count(Command { faults, ..command });
        Command { faults: command.faults | Faults::from_bits(missed), ..command }
    }

    fn make_up(&mut self, _: &Self::Config, torque: D::Number, missed: u32) -> Faults {
        let torque = self.learners.calibrated(torque);
        let faults = self.drive.make_up(&self.config, torque, missed);
        self.count_missed(missed);
        if missed > MADE_UP {
            self.passed |= INTERRUPTED;
        }
        faults
    }

    fn coast(&mut self, _: &Self::Config, torque: D::Number, setpoint: D::Number) -> Command<D::Number> {
        let torque = self.learners.calibrated(torque);
        let command = self.drive.coast(&self.config, torque, setpoint);
        self.count(command)
    }

    fn engage(&mut self, _: &Self::Config) {
        self.drive.engage(&self.config);
        self.passed |= INTERRUPTED;
    }

    /// From now on the constants follow from `to`.
    fn switch(&mut self, _: &Self::Config, to: &Self::Config) {
        self.transfer(to);
    }

    fn parts(config: &mut Self::Config) -> (&mut ObserverConfigOf<Self>, &mut GovernorConfigOf<Self>) {
        D::parts(&mut config.drive)
    }

    fn vibration(&mut self, _: &Self::Config, vibration: &VibrationOf<Self>) {
        self.drive.vibration(&self.config, vibration);
    }
}
