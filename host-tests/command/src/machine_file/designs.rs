//! The designs for a machine of a file, and the errors predicted over its tolerances.

use std::f64::consts::PI;
use std::fmt;

use driveline::configure::Rating;
use driveline::design::{
    Actuator, Disturbance, Encoder, Error, LoadCycle, LoopGears, LoopObserver, ObserverChoice, ObserverSelection,
    Operation, Plant, PredictedErrors, Rate, Requirement, RigidDesign, Robustness, SpeedLoopDesign, SpeedLoopTuning,
    Spread, StepChoice, Tolerance, TwoMassDesign,
};
use driveline::machine::{Losses, Match, Speed, Torque, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{GearedConfig, LoadGearConfig};
use driveline::settings::{self, Bases, Gear, LoadGear};
use serde::Serialize;

use super::factor::Factor;
use super::quantity::Quantity;
use super::{Duty, MachineFile};

/// Why there is no drive of a machine with branches.
pub const BRANCHES: &str = "it has branches; leave them out, or write its constants by hand";
/// Errors of an observer and what its loop lacks, or why there is none.
pub type AtRate = Result<([f64; 3], Option<&'static str>), String>;

/// Why there is none of a machine without a shaft.
pub const NO_SHAFT: &str = "it has no shaft, and a drive needs one between motor and load";

/// Designs for a machine of two masses.
#[derive(Clone, Copy, Debug)]
pub struct Designs {
    /// The two masses.
    pub two: TwoMass,
    /// The observer of two masses.
    pub two_masses: TwoMassDesign,
    /// The observer of one mass.
    pub rigid: RigidDesign,
    pub speed_loop: SpeedLoopDesign,
    /// Acceleration of the setpoint (rad/s2).
    pub ramp: f64,
    /// Errors of the observer of two masses over the tolerances.
    pub two_masses_errors: PredictedErrors,
    /// Errors of the observer of one mass over the tolerances.
    pub rigid_errors: PredictedErrors,
    /// The observer that the load cycle needs.
    pub nominal: ObserverSelection,
    /// The observer over the tolerances: of those whose loop has the usual margins, where one has them.
    pub selected: ObserverSelection,
    /// What the speed loop on two masses lacks of the usual margins, with all the machine's vibrations; `None` where it
    /// has all.
    pub two_masses_lack: Option<Lack>,
    /// The same with the observer of one mass.
    pub rigid_lacks: Option<Lack>,
    /// Whether the errors of one mass would do, but its loop lacks margins that two masses have.
    pub is_rigid_refused: bool,
}

/// How wide a speed loop may be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Widest {
    /// Its natural frequency over the antiresonance, within a hundredth.
    pub share: f64,
    /// What a wider one lacks; `null` up to 0.99, beyond which no loop is designed.
    pub cause: Option<&'static str>,
}

/// The widest loop that is tried, over the antiresonance, and the step.
const WHOLE: f64 = 0.99;
const STEP: f64 = 0.01;

/// What a speed loop lacks, and a remedy in the words of a machine file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lack {
    /// What is not there.
    pub cause: &'static str,
    /// What gives it all margins, as tried.
    remedy: Option<Remedy>,
    /// Whether it gives them to the observer of two masses alone, which is then selected.
    is_of_two: bool,
    /// Whether remedies were tried.
    is_tried: bool,
}

/// A change of the file that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Remedy {
    /// `bandwidth` of `[speed_loop]`.
    Bandwidth(f64),
    /// `within` of `[disturbance]` (s).
    Within(f64),
    /// Share of every deviation of `[tolerance]`.
    Tolerance(f64),
    /// `rate_hz` of `[control]`.
    Rate(u32),
}

impl Remedy {
    /// Those that are tried for a machine, the mildest of a kind first.
    fn all(machine: &MachineFile) -> impl Iterator<Item = Self> {
        let (bandwidth, within) = (machine.bandwidth, machine.disturbance.within);
        let slower = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05];
        let slower = slower.into_iter().map(move |share| Self::Bandwidth(short(share * bandwidth)));
        let faster = [0.5, 0.2, 0.1, 0.05, 0.02, 0.01];
        let faster = faster.into_iter().map(move |share| Self::Within(short(share * within)));
        let oftener = [2, 5, 10].map(|times| machine.control.rate_hz.saturating_mul(times)).into_iter();
        let oftener = oftener.filter(|&rate| Quantity::RATE.allows(f64::from(rate))).map(Self::Rate);
        slower.chain(faster).chain([0.75, 0.5, 0.25].map(Self::Tolerance)).chain(oftener)
    }

    fn on(self, machine: &MachineFile) -> MachineFile {
        let mut changed = machine.clone();
        match self {
            Self::Bandwidth(bandwidth) => changed.bandwidth = bandwidth,
            Self::Within(within) => changed.disturbance.within = within,
            Self::Rate(rate) => changed.control.rate_hz = rate,
            Self::Tolerance(share) => {
                for one in &mut changed.tolerances {
                    let nominal = one.factor.about(0.0).low;
                    one.low = nominal + share * (one.low - nominal);
                    one.high = nominal + share * (one.high - nominal);
                }
            }
        }
        changed
    }
}

/// The same in two digits, as a message has it.
fn short(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

impl fmt::Display for Remedy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bandwidth(bandwidth) => write!(f, "with `bandwidth = {bandwidth}` in `[speed_loop]`"),
            Self::Within(within) => {
                write!(f, "with `within = {within}` in `[disturbance]`, a faster observer,")
            }
            Self::Tolerance(share) => {
                write!(f, "with {:.0} % of every deviation in `[tolerance]`", 100.0 * share)
            }
            Self::Rate(rate) => write!(f, "with `rate_hz = {rate}` in `[control]`"),
        }
    }
}

impl Lack {
    /// Two masses are stable, the machine is not.
    const NEGLECTED: Self = Self {
        cause: "the speed loop with its observer is unstable by a vibration that the two masses leave out",
        remedy: None,
        is_of_two: false,
        is_tried: false,
    };

    /// What the library says of a loop.
    pub fn of(error: Error) -> Self {
        let sentence = match error {
            Error::LoopGain => "the speed loop with its observer has a gain margin below 6 dB",
            Error::LoopPhase => "the speed loop with its observer has a phase margin below 30 degrees",
            Error::LoopLate => {
                "the speed loop with its observer is unstable with `delay` and `lag` of `[tolerance]` in the torque"
            }
            Error::LoopUndescribed => {
                "the speed loop with its observer is unstable, or has a gain margin below 6 dB, with a resonance that \
                 the elements leave out, from eight times theirs on"
            }
            other => other.message(),
        };
        let cause = sentence.split_once(": ").map_or(sentence, |(cause, _)| cause);
        Self { cause, remedy: None, is_of_two: false, is_tried: false }
    }

    /// With the first remedy that leaves nothing lacking.
    fn with_remedy(self, machine: &MachineFile, two: &TwoMass, is_rigid: bool) -> Self {
        let helps = |remedy: &Remedy| matches!(remedy.on(machine).lack_with(two, is_rigid), Ok(None));
        Self { remedy: Remedy::all(machine).find(helps), is_tried: true, ..self }
    }
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.remedy {
            Some(remedy) => {
                let observer = if self.is_of_two { "the observer of two masses" } else { "it" };
                write!(f, "{}: {remedy} {observer} has all margins", self.cause)
            }
            None if self.is_tried => write!(
                f,
                "{}: neither less `bandwidth` in `[speed_loop]`, a shorter `within` in `[disturbance]`, a quarter of \
                 the deviations in `[tolerance]` nor ten times the rate mends it alone; the shafts may need damping",
                self.cause
            ),
            None => f.write_str(self.cause),
        }
    }
}

impl Designs {
    /// Of a machine as two masses.
    ///
    /// # Errors
    /// The library's sentence for a machine that cannot be observed or governed so.
    pub fn of(machine: &MachineFile, two: &TwoMass) -> Result<Self, Error> {
        let (rate, encoder, disturbance) = machine.tuning();
        let two_masses = two.try_observer(rate, encoder, disturbance)?;
        let rigid = machine.rigid()?.try_observer(rate, encoder, disturbance)?;
        let speed_loop = two.try_speed_loop(rate, machine.speed_loop_tuning(two))?;
        let ramp = machine.ramp(two.total_inertia());
        let (drawn, tolerance) = (machine.drawn_encoder(), machine.tolerance());
        let operation = machine.operation(two, ramp);
        let errors = |observer| two.predicted_errors(observer, drawn, &tolerance, &operation);
        let two_masses_errors = errors(LoopObserver::TwoMass(&two_masses));
        let rigid_errors = errors(LoopObserver::Rigid(&rigid));
        let period = 1.0 / f64::from(machine.control.rate_hz);
        let nominal = two.select_observer(&operation.cycle, &Requirement::USUAL, period);
        let lack = |observer, is_rigid| {
            let lack = machine.lacks(two, observer, &speed_loop)?;
            Ok::<_, Error>(lack.map(|lack| lack.with_remedy(machine, two, is_rigid)))
        };
        let two_masses_lack = lack(LoopObserver::TwoMass(&two_masses), false)?;
        let mut rigid_lacks = lack(LoopObserver::Rigid(&rigid), true)?;
        if let (Some(one), Some(Lack { remedy: Some(remedy), .. })) = (&mut rigid_lacks, two_masses_lack)
            && one.remedy.is_none()
        {
            *one = Lack { remedy: Some(remedy), is_of_two: true, ..*one };
        }
        let as_good = nominal.over_tolerances(&rigid_errors.total(), &two_masses_errors.total());
        let is_rigid_refused =
            as_good.chosen == ObserverChoice::Rigid && rigid_lacks.is_some() && two_masses_lack.is_none();
        let chosen = match two_masses.chosen {
            _ if !is_rigid_refused => as_good.chosen,
            StepChoice::SemiImplicit => ObserverChoice::SemiImplicit,
            StepChoice::Exact => ObserverChoice::Exact,
        };
        Ok(Self {
            two: *two,
            two_masses,
            rigid,
            speed_loop,
            ramp,
            two_masses_errors,
            rigid_errors,
            nominal,
            selected: ObserverSelection { chosen, ..as_good },
            two_masses_lack,
            rigid_lacks,
            is_rigid_refused,
        })
    }

    /// What the library says of a machine that cannot be observed or governed, with a remedy that was tried in place of
    /// its own where one helps.
    pub fn refusal(machine: &MachineFile, error: Error) -> String {
        let lack = Lack { is_of_two: true, ..Lack::of(error) };
        match machine.two_masses().map(|two| lack.with_remedy(machine, &two, false)) {
            Some(lack) if lack.remedy.is_some() => lack.to_string(),
            _ => error.to_string(),
        }
    }

    /// What the selected observer's loop lacks of the usual margins; `None` where it has all.
    pub const fn lack(&self) -> Option<Lack> {
        if self.is_rigid() { self.rigid_lacks } else { self.two_masses_lack }
    }

    /// Which observers' loops lack margins, without the remedies: one mass that would do otherwise, or both.
    pub fn remark(&self) -> Option<String> {
        match (self.rigid_lacks.map(|lack| lack.cause), self.two_masses_lack.map(|lack| lack.cause)) {
            (Some(one), None) if self.is_rigid_refused => {
                Some(format!("one mass would do, but lacks margin: with it, {one}"))
            }
            (Some(one), Some(two)) => Some(format!("neither has the margins: with one mass, {one}; with two, {two}")),
            _ => None,
        }
    }

    /// Whether one mass is chosen over the tolerances.
    pub const fn is_rigid(&self) -> bool {
        matches!(self.selected.chosen, ObserverChoice::Rigid)
    }
}

impl MachineFile {
    /// The machine as two masses; `None` where it has no shaft.
    pub fn two_masses(&self) -> Option<TwoMass> {
        self.reduce(Match::ResonanceAntiresonance).ok()
    }

    /// The gears before and behind the shaft as an observer takes them: inertias at the motor's and the load's side (kg
    /// m2), a count of the encoder (rad).
    pub const fn gears(&self, [motor, load]: [f64; 2], count: f64) -> (Gear, LoadGear) {
        let Losses { before: [efficiency, _], behind: [driving, driven] } = self.chain.losses();
        // a gear with a loss sticks within a few counts
        let deadband = if efficiency < 1.0 { 8.0 * count } else { 0.0 };
        let gear = Gear { efficiency, inertia: motor, deadband };
        (gear, LoadGear { efficiency: driving, back_efficiency: driven, inertia: load })
    }

    /// What a loop has of them.
    pub const fn loop_gears(&self) -> LoopGears {
        LoopGears { losses: self.chain.losses(), friction: self.gears([1.0; 2], 0.0).0.friction(), behind: true }
    }

    /// The same for the file's rate and encoder, as constants of a drive can hold them.
    ///
    /// # Errors
    /// Losses that no constants hold, in fixed point too where the drive has it.
    pub fn drive_gears(&self, two: &TwoMass, is_fixed: bool) -> Result<(Gear, LoadGear), String> {
        let (rate, encoder, _) = self.tuning();
        let count = encoder.resolution().map_err(|error| error.to_string())?;
        let (gear, behind) = self.gears([two.motor_inertia, two.load_inertia], count);
        let period = rate.period().map_err(|error| error.to_string())?;
        let is_lossy = [gear.efficiency, behind.efficiency, behind.back_efficiency].map(|share| share != 1.0);
        // the bases of a drive follow from the gear
        let bases = Bases { torque: f64::MIN_POSITIVE.sqrt(), ..Bases::SI };
        let held = || -> Result<(), settings::Error> {
            if is_lossy[0] {
                GearedConfig::<f32, _>::try_new((), &gear, period, Bases::SI)?;
                if is_fixed {
                    GearedConfig::<Fixed, _>::try_new((), &gear, period, bases)?;
                }
            }
            if is_lossy[1] || is_lossy[2] {
                LoadGearConfig::<f32, _>::try_new((), &behind, period, Bases::SI)?;
                if is_fixed {
                    LoadGearConfig::<Fixed, _>::try_new((), &behind, period, bases)?;
                }
            }
            Ok(())
        };
        held().map_err(|error| error.to_string())?;
        Ok((gear, behind))
    }

    /// The tuning in the library's words.
    pub fn tuning(&self) -> (Rate, Encoder, Disturbance) {
        let disturbance = Disturbance {
            torque_accuracy: self.disturbance.torque_accuracy,
            load_torque_step: self.disturbance.load_torque_step,
            within: self.disturbance.within,
        };
        let accuracy = self.encoder.accuracy;
        let encoder = self.encoder_of(accuracy.interpolation, accuracy.eccentricity, accuracy.jitter);
        (Rate::hz(self.control.rate_hz), encoder, disturbance)
    }

    /// The encoder with an interpolation error, an eccentricity and a jitter, that of the angle at the largest speed.
    fn encoder_of(&self, interpolation: f64, eccentricity: f64, jitter: f64) -> Encoder {
        Encoder::lines(self.encoder.lines)
            .interpolation(self.encoder.accuracy.signal_periods, interpolation)
            .eccentricity(eccentricity)
            .jitter(jitter, self.limits.speed)
    }

    /// The encoder with the errors of the tolerances, each the root of its mean square.
    fn drawn_encoder(&self) -> Encoder {
        let rms = |factor: Factor| self.range(factor).map_or(0.0, |(low, high)| rms(low, high));
        self.encoder_of(rms(Factor::Interpolation), rms(Factor::Eccentricity), rms(Factor::Jitter))
    }

    /// Acceleration of the speed's setpoint (rad/s2), with this inertia at the motor: that of the file, or of the
    /// rating.
    pub fn ramp(&self, inertia: f64) -> f64 {
        self.ramp.unwrap_or_else(|| self.rating().ramp(inertia))
    }

    /// The speed loop's tuning: [`SpeedLoopTuning::with_bandwidth`].
    fn speed_loop_tuning(&self, two: &TwoMass) -> SpeedLoopTuning {
        SpeedLoopTuning::with_bandwidth(two, self.bandwidth)
    }

    /// Rating of the motor.
    pub fn rating(&self) -> Rating {
        Rating {
            torque: Torque(self.limits.rated_torque),
            speed: Speed(self.limits.speed),
            torque_limit: Torque(self.limits.torque),
        }
    }

    /// Delay and lag of the torque.
    pub fn actuator(&self) -> Actuator {
        let bandwidth = self.actuator.bandwidth;
        let lag = bandwidth.map_or(0.0, |bandwidth| 1.0 / (2.0 * PI * bandwidth));
        Actuator { delay: self.actuator.delay, lag }
    }

    /// What a speed loop lacks: 6 dB and 30 degrees at the nominal machine, with two masses and with the rings of its
    /// dampers; stability within the tolerances, with two masses; stability with all the machine's vibrations. `None`
    /// where it has all.
    fn lacks(
        &self,
        two: &TwoMass,
        observer: LoopObserver<'_>,
        speed_loop: &SpeedLoopDesign,
    ) -> Result<Option<Lack>, Error> {
        let closed = observer.close(speed_loop, self.actuator())?;
        let robust = two.try_robust(observer, speed_loop, self.actuator(), &self.tolerance(), &Robustness::USUAL);
        let gears = self.loop_gears();
        let robust =
            robust.and_then(|()| gears.try_robust(two, observer, speed_loop, self.actuator(), &Robustness::USUAL));
        let plant = Plant::of_modes(two.total_inertia(), &self.modes());
        let mut neglected = (!closed.is_stable(&plant, 1.0)).then_some(Lack::NEGLECTED);
        // the rings of dampers and branches may swing within the loop's bandwidth
        if neglected.is_none() && self.train.is_some() {
            let (margins, usual) = (closed.margins(&plant)?, Robustness::USUAL);
            let least = margins.gain_up.min(1.0 / margins.gain_down);
            let low = if least < usual.gain { Some(Error::LoopGain) } else { None };
            neglected = low.or((margins.phase < usual.phase).then_some(Error::LoopPhase)).map(Lack::of);
        }
        // two masses that are unstable themselves leave nothing out; tolerances come after the machine as it is
        Ok(match robust.err() {
            Some(Error::LoopUnstable) => Some(Lack::of(Error::LoopUnstable)),
            error => neglected.or(error.map(Lack::of)),
        })
    }

    /// It at another rate, with the density of the torque's noise as it was.
    pub fn with_rate(&self, rate_hz: u32) -> Self {
        let mut machine = self.clone();
        let share = (f64::from(rate_hz) / f64::from(self.control.rate_hz)).sqrt();
        machine.control.rate_hz = rate_hz;
        machine.disturbance.torque_accuracy *= share;
        machine.disturbance.torque_noise = machine.disturbance.torque_noise.map(|noise| noise * share);
        machine
    }

    /// The observers of one and of two masses at another rate, the noise of the torque in a tick at the same density:
    /// errors of shaft torque, load speed and load torque over the tolerances, and what the loop lacks.
    pub fn at_rate(&self, two: &TwoMass, rate_hz: u32) -> [(&'static str, AtRate); 2] {
        let machine = self.with_rate(rate_hz);
        let (rate, encoder, disturbance) = machine.tuning();
        let (drawn, tolerance) = (machine.drawn_encoder(), machine.tolerance());
        let operation = machine.operation(two, machine.ramp(two.total_inertia()));
        let predicted = |observer: LoopObserver<'_>| {
            let speed_loop = two.try_speed_loop(rate, machine.speed_loop_tuning(two))?;
            let error = two.predicted_errors(observer, drawn, &tolerance, &operation).total();
            let (torque, speed) = (machine.limits.rated_torque, machine.limits.speed);
            let errors = [error.shaft_torque / torque, error.load_speed / speed, error.load_torque / torque];
            Ok::<_, Error>((errors, machine.lacks(two, observer, &speed_loop)?.map(|lack| lack.cause)))
        };
        let said = |error: Error| error.to_string();
        let one = || predicted(LoopObserver::Rigid(&machine.rigid()?.try_observer(rate, encoder, disturbance)?));
        let both = two.try_observer(rate, encoder, disturbance);
        let step = match both.as_ref().map(|design| design.chosen) {
            Ok(StepChoice::SemiImplicit) => "semi-implicit",
            Ok(StepChoice::Exact) => "exact",
            Err(_) => "two-mass",
        };
        [
            ("rigid", one().map_err(said)),
            (step, both.and_then(|design| predicted(LoopObserver::TwoMass(&design))).map_err(said)),
        ]
    }

    /// The widest speed loop that lacks nothing; `None` where that of the file lacks something.
    pub fn widest(&self, two: &TwoMass, is_rigid: bool) -> Option<Widest> {
        let mut changed = self.clone();
        let mut lack = |bandwidth: f64| {
            changed.bandwidth = bandwidth;
            match changed.lack_with(two, is_rigid) {
                Ok(lack) => lack.map(|lack| lack.cause),
                Err(error) => Some(Lack::of(error).cause),
            }
        };
        let mut widest = Widest { share: self.bandwidth, cause: None };
        if lack(widest.share).is_some() {
            return None;
        }
        while widest.cause.is_none() && widest.share < WHOLE {
            // in millionths, since sums of hundredths have an end in binary
            let next = (((widest.share + STEP) * 1e6).round() / 1e6).min(WHOLE);
            widest.cause = lack(next);
            if widest.cause.is_none() {
                widest.share = next;
            }
        }
        Some(widest)
    }

    /// What the loop of a machine lacks with one of its observers.
    fn lack_with(&self, two: &TwoMass, is_rigid: bool) -> Result<Option<Lack>, Error> {
        let (rate, encoder, disturbance) = self.tuning();
        let speed_loop = two.try_speed_loop(rate, self.speed_loop_tuning(two))?;
        if is_rigid {
            let rigid = self.rigid()?.try_observer(rate, encoder, disturbance)?;
            return self.lacks(two, LoopObserver::Rigid(&rigid), &speed_loop);
        }
        let two_masses = two.try_observer(rate, encoder, disturbance)?;
        self.lacks(two, LoopObserver::TwoMass(&two_masses), &speed_loop)
    }

    /// Range of a factor, where it has one.
    fn range(&self, factor: Factor) -> Option<(f64, f64)> {
        let found = self.tolerances.iter().find(|tolerance| tolerance.factor == factor);
        found.map(|tolerance| (tolerance.low, tolerance.high))
    }

    /// The tolerances in the library's words.
    pub fn tolerance(&self) -> Tolerance {
        let spread = |factor: Factor| {
            let (low, high) = self.range(factor).unwrap_or((1.0, 1.0));
            Spread::between(low.min(1.0), high.max(1.0))
        };
        let most = |factor: Factor| self.range(factor).map_or(0.0, |(low, high)| low.abs().max(high.abs()));
        let (inertia, load) = (spread(Factor::LoadInertia), spread(Factor::Load));
        Tolerance {
            motor_inertia: spread(Factor::MotorInertia),
            load_inertia: Spread::between(inertia.min * load.min, inertia.max * load.max),
            stiffness: spread(Factor::Stiffness),
            torque: spread(Factor::TorqueConstant),
            late: most(Factor::Delay).ceil() as u32,
            lag: most(Factor::Lag),
            offset: most(Factor::TorqueOffset),
            efficiency: most(Factor::Efficiency),
            gap: spread(Factor::Gap),
            damping: self.range(Factor::Damping).map_or(Tolerance::USUAL.damping, |_| spread(Factor::Damping)),
            ..Tolerance::USUAL
        }
    }

    /// The load cycle: that of `[duty]`, or three tenths of rated torque in a tenth of a second every two seconds. A
    /// weight that is heavier than the change keeps a gap closed.
    pub fn cycle(&self, gravity_torque: f64) -> LoadCycle {
        let usual = Duty { change: 0.3 * self.limits.rated_torque, rise: 0.1, every: 2.0 };
        let Duty { change, rise, every } = self.duty.unwrap_or(usual);
        let reverses = gravity_torque.abs() < change;
        LoadCycle { speed: self.limits.speed, torque: self.limits.torque, change, rise, every, reverses }
    }

    /// The conditions that errors are predicted for: the weight or half of rated torque, half of the ramp on average,
    /// the largest speed.
    fn operation(&self, two: &TwoMass, ramp: f64) -> Operation {
        let rated_torque = self.limits.rated_torque;
        Operation {
            rated_torque,
            torque: two.gravity_torque.abs().max(0.5 * rated_torque),
            acceleration: 0.5 * ramp,
            speed: self.limits.speed,
            torque_noise: self.disturbance.noise(),
            cycle: self.cycle(two.gravity_torque),
        }
    }
}

/// Root of the mean square of what is uniform between two values.
fn rms(low: f64, high: f64) -> f64 {
    ((low * low + low * high + high * high) / 3.0).sqrt()
}
