//! Result of `design` for a machine: step, observer, governor.

use std::fmt;

use driveline::configure::Rating;
use driveline::design::{
    ClosedLoop, Error, EstimateError, LoopObserver, ObserverChoice, ObserverSelection, Penalty, Plant, PredictedErrors,
    RigidDesign, StepChoice,
};
use driveline::machine::{Match, Mode, Train, TwoMass};
use driveline_report::format::{percent, significant};
use serde::Serialize;

use crate::machine_file::designs::{Designs, Lack};
use crate::machine_file::{DamperKind, DamperRing, MachineFile};

/// The controller of a machine, in SI units at the motor.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Plan {
    /// The machine's name.
    pub name: String,
    /// `two-mass`, or `rigid` where the machine has no shaft.
    pub observer: &'static str,
    /// Ticks a second.
    pub rate_hz: u32,
    /// Inertias (kg m2): motor's side and load's side, or one.
    pub inertias: Vec<f64>,
    /// The shaft between the two masses and the step that follows it.
    pub shaft: Option<Shaft>,
    /// The states, in the order of gains and standard deviations.
    pub states: Vec<State>,
    /// Poles of the estimate's error.
    pub poles: Vec<Pole>,
    /// Largest size of a pole.
    pub spectral_radius: f64,
    /// Predicted standard deviation of the innovation (rad).
    pub innovation: f64,
    /// The speed loop, for two masses.
    pub speed_loop: Option<SpeedLoop>,
    /// The selected observer, for two masses whose file has a `[duty]`.
    pub need: Option<Needed>,
    /// Errors over the tolerances, for two masses.
    pub predicted: Option<Predicted>,
    /// What the machine's dampers change of the two masses; `null` where it has none.
    pub dampers: Option<Damped>,
    /// Reasons why the design may not do for this machine.
    pub warnings: Vec<String>,
}

/// Selection of an observer.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Needed {
    /// `rigid`, `semi-implicit`, `exact` or `backlash`.
    pub observer: &'static str,
    /// Error without the shaft: rms of shaft torque and load speed, over the limits.
    pub without_shaft: [f64; 2],
    /// Error without the gap.
    pub without_gap: [f64; 2],
}

/// Errors that are predicted over the tolerances, rms, and the observer that is selected by them.
#[derive(Clone, Debug, Serialize)]
pub struct Predicted {
    /// The selected observer: `rigid` where one mass is as good. Drives of the file have it.
    pub observer: &'static str,
    /// What its speed loop lacks; `null` where it has all margins.
    pub lack: Option<String>,
    /// Whether it is simpler than the one that the load cycle alone asks for.
    pub is_simpler: bool,
    /// Which observers' loops lack margins: one mass that would do otherwise, or both; `null` otherwise.
    pub remark: Option<String>,
    /// Of the observer of two masses.
    pub two_masses: Causes,
    /// Of the observer of one mass.
    pub one_mass: Causes,
}

/// Errors of shaft torque, load speed and load torque by their causes, over rated torque and the largest speed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Causes {
    /// Torque constant, offset, efficiency, inertias.
    pub statics: [f64; 3],
    /// Periodic errors of the encoder.
    pub encoder: [f64; 3],
    /// Noise of torque and angle.
    pub noise: [f64; 3],
    /// Swings of the shaft.
    pub swing: [f64; 3],
    /// All together.
    pub total: [f64; 3],
}

impl Predicted {
    fn of(machine: &MachineFile, designs: &Designs) -> Self {
        let (torque, speed) = (machine.limits.rated_torque, machine.limits.speed);
        let three =
            |error: EstimateError| [error.shaft_torque / torque, error.load_speed / speed, error.load_torque / torque];
        let causes = |errors: &PredictedErrors| Causes {
            statics: three(errors.statics),
            encoder: three(errors.encoder),
            noise: three(errors.noise),
            swing: three(errors.swing),
            total: three(errors.total()),
        };
        Self {
            observer: name(designs.selected.chosen),
            lack: designs.lack().map(|lack| lack.to_string()),
            is_simpler: designs.selected.chosen == ObserverChoice::Rigid
                && designs.nominal.chosen != ObserverChoice::Rigid,
            remark: designs.remark(),
            two_masses: causes(&designs.two_masses_errors),
            one_mass: causes(&designs.rigid_errors),
        }
    }
}

/// The shaft between the two masses.
#[derive(Clone, Debug, Serialize)]
pub struct Shaft {
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Damping (N m s/rad).
    pub damping: f64,
    /// Whole free angle (rad).
    pub gap: f64,
    /// Resonance (rad/s).
    pub resonance: f64,
    /// Antiresonance (rad/s).
    pub antiresonance: f64,
    /// Worst-case error of the reduction, over the first jump of the motor's speed.
    pub reduction_error: f64,
    /// Step that the design takes: `exact` or `semi-implicit`.
    pub step: &'static str,
    /// Error bound of the semi-implicit step over a period of the resonance; `null` where it is unstable.
    pub semi_implicit_error: Option<f64>,
    /// The bound up to which the semi-implicit step is taken.
    pub semi_implicit_threshold: f64,
    /// Predicted standard deviation of the shaft torque (N m).
    pub torque_standard_deviation: f64,
}

impl Shaft {
    /// The reduction error above which `design` warns: a third of what the motor does after a blow is then not in the
    /// model.
    pub const LARGE_REDUCTION_ERROR: f64 = 1.0 / 3.0;
}

/// A state of the observer.
#[derive(Clone, Debug, Serialize)]
pub struct State {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Correction per radian of innovation.
    pub gain: f64,
    /// Predicted standard deviation after the measurement of a tick.
    pub standard_deviation: f64,
}

/// A pole of the estimate's error.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Pole {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

/// The speed loop.
#[derive(Clone, Debug, Serialize)]
pub struct SpeedLoop {
    /// The selected observer, which the margins are with: `rigid` or `two-mass`.
    pub observer: &'static str,
    /// Gain on the error of the motor's speed (N m s/rad).
    pub proportional: f64,
    /// Integral gain (N m/rad).
    pub integral: f64,
    /// Gain on the damping (N m s/rad).
    pub damping: f64,
    /// Natural frequency of the speed (rad/s).
    pub bandwidth: f64,
    /// Margins with the observer and all the machine's vibrations in the loop; `null` where it is unstable.
    pub margins: Option<Margins>,
    /// Why there are no margins.
    pub no_margins: Option<String>,
    /// Margins of the two masses with the losses of the gears, the motor driving; `null` without losses.
    pub margins_motor_driving: Option<LeastMargins>,
    /// The same with the load driving; `null` where a gear locks as well.
    pub margins_load_driving: Option<LeastMargins>,
    /// The least margins within the tolerances; `null` where the loop is unstable within them.
    pub least_margins: Option<LeastMargins>,
    /// What the loop has not within the tolerances: 6 dB, 30 degrees, stability. `null` where it has all.
    pub not_robust: Option<String>,
    /// Largest size of a pole of the closed loop.
    pub spectral_radius: f64,
}

impl SpeedLoop {
    fn of(machine: &MachineFile, designs: &Designs) -> Result<Self, Error> {
        let Designs { two, speed_loop: governor, .. } = designs;
        let (actuator, tolerance, lack) = (machine.actuator(), &machine.tolerance(), designs.lack());
        let (name, observer) = match designs.is_rigid() {
            true => ("rigid", LoopObserver::Rigid(&designs.rigid)),
            false => ("two-mass", LoopObserver::TwoMass(&designs.two_masses)),
        };
        let margins = Margins::of(machine, two, &observer.close(governor, actuator)?);
        let least = two.least_margins(observer, governor, actuator, tolerance);
        let with_losses = machine.loop_gears().margins(two, observer, governor, actuator).unwrap_or_default();
        let [motor_driving, load_driving] = with_losses.map(|found| found.as_ref().map(LeastMargins::of));
        let no_margins = margins.as_ref().err().map(|&error| lack.unwrap_or(Lack::of(error)).to_string());
        Ok(Self {
            observer: name,
            proportional: governor.proportional,
            integral: governor.integral,
            damping: governor.damping,
            bandwidth: governor.bandwidth,
            margins: margins.ok(),
            // with two masses as the machine: they mean nothing where the whole machine is unstable
            least_margins: least.ok().filter(|_| no_margins.is_none()).map(|least| LeastMargins::of(&least)),
            no_margins,
            margins_motor_driving: motor_driving,
            margins_load_driving: load_driving,
            not_robust: lack.map(|lack| lack.to_string()),
            spectral_radius: governor.spectral_radius,
        })
    }
}

/// How far the speed loop is from instability.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Margins {
    /// Over all crossings.
    #[serde(flatten)]
    pub least: LeastMargins,
    /// Factors of the motor side's inertia that the loop of two masses tolerates, from and to; `null` where any.
    pub motor_inertia: [Option<f64>; 2],
    /// The same for the load side's inertia.
    pub load_inertia: [Option<f64>; 2],
    /// The same for the stiffness.
    pub stiffness: [Option<f64>; 2],
}

/// The least of each margin, over crossings and over tolerances.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LeastMargins {
    /// Factor by which the gain may grow; `null` where no growth destabilises.
    pub gain_up: Option<f64>,
    /// Factor by which the gain may shrink.
    pub gain_down: f64,
    /// Phase margin (rad); `null` where the gain crosses 1 nowhere.
    pub phase: Option<f64>,
    /// Dead time more that destabilises (s); `null` as well.
    pub delay: Option<f64>,
    /// Smallest distance of the response from -1.
    pub modulus: f64,
}

impl LeastMargins {
    fn of(margins: &driveline::design::Margins) -> Self {
        Self {
            gain_up: finite(margins.gain_up),
            gain_down: margins.gain_down,
            phase: finite(margins.phase),
            delay: finite(margins.delay),
            modulus: margins.modulus,
        }
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl Margins {
    fn of(machine: &MachineFile, two: &TwoMass, closed: &ClosedLoop) -> Result<Self, Error> {
        let plant = Plant::of_modes(two.total_inertia(), &machine.modes());
        let margins = closed.margins(&plant)?;
        let ranges = closed.ranges(two);
        let range = |[down, up]: [f64; 2]| [(down > 0.0).then_some(down), finite(up)];
        Ok(Self {
            least: LeastMargins::of(&margins),
            motor_inertia: range(ranges.motor_inertia),
            load_inertia: range(ranges.load_inertia),
            stiffness: range(ranges.stiffness),
        })
    }
}

/// What the dampers of a machine change of its two masses.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Damped {
    /// Antiresonance (rad/s) with the dampers.
    pub antiresonance: f64,
    /// Resonance (rad/s) with the dampers.
    pub resonance: f64,
    /// Antiresonance and resonance without them; `null` where the machine then has no shaft.
    pub without: Option<[f64; 2]>,
    /// Share by which they enlarge the inertia.
    pub inertia: f64,
    /// Label of the mass whose ring swings most in the vibration that the two masses keep; `null` where a mass of the
    /// machine does.
    pub ring: Option<String>,
}

impl Damped {
    /// Of a machine and the same with its dampers; none where that has no observable shaft.
    fn of(machine: &MachineFile, damped: &MachineFile) -> Option<Self> {
        let two = damped.two_masses()?;
        // by the same rule as with the dampers: a chain's own keeps another mode
        let train = machine.train.unwrap_or_else(|| Train::of(machine.chain));
        let bare = train.try_reduce(Match::ResonanceAntiresonance).ok();
        let modes = damped.modes();
        let off = |mode: &Mode| (mode.frequency / two.resonance() - 1.0).abs();
        let kept = modes.resonances().iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let energy = |mass: usize| damped.masses()[mass] * kept.shape[mass] * kept.shape[mass];
        let most = (0..damped.masses().len()).max_by(|&a, &b| energy(a).total_cmp(&energy(b)))?;
        // rings that are masses of their own follow the machine's
        let is_mass =
            |ring: &&DamperRing| !matches!(ring.kind, DamperKind::Friction { .. } | DamperKind::Viscous { .. });
        let ring =
            most.checked_sub(machine.masses().len()).and_then(|at| machine.dampers.iter().filter(is_mass).nth(at));
        Some(Self {
            antiresonance: two.antiresonance(),
            resonance: two.resonance(),
            without: bare.map(|bare| [bare.antiresonance(), bare.resonance()]),
            inertia: two.total_inertia() / machine.masses().iter().sum::<f64>() - 1.0,
            ring: ring.map(|ring| ring.at.clone()),
        })
    }
}

impl fmt::Display for Damped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hertz = |omega: f64| significant(omega / core::f64::consts::TAU);
        let (held, free, larger) = (hertz(self.antiresonance), hertz(self.resonance), percent(self.inertia));
        match (&self.ring, self.without.map(|without| without.map(hertz))) {
            (None, Some([bare_held, bare_free])) => write!(
                f,
                "with the dampers the antiresonance is {held} Hz instead of {bare_held} Hz, the resonance {free} Hz \
                 instead of {bare_free} Hz, and the inertia {larger} larger"
            ),
            (Some(ring), Some([_, bare_free])) => write!(
                f,
                "the two masses have the vibration of the damper of `{ring}` at {free} Hz, its antiresonance at {held} \
                 Hz, and the inertia {larger} larger; that of the machine without its dampers, at {bare_free} Hz, is \
                 left out"
            ),
            (_, None) => write!(
                f,
                "without the dampers the machine has no shaft; with them the antiresonance is {held} Hz, the resonance \
                 {free} Hz, and the inertia {larger} larger"
            ),
        }
    }
}

impl Plan {
    /// Designs observer and governor of the machine with its dampers.
    ///
    /// # Errors
    /// As [`MachineFile::with_dampers`], and the library's sentence for a machine that cannot be observed or governed.
    pub fn with_dampers(machine: &MachineFile) -> Result<Self, String> {
        let damped = machine.with_dampers()?;
        if let Some(two) = damped.two_masses() {
            damped.drive_gears(&two, false)?;
        }
        let plan = Self::of(&damped).map_err(|error| Designs::refusal(&damped, error))?;
        let dampers = if machine.dampers.is_empty() { None } else { Damped::of(machine, &damped) };
        Ok(Self { dampers, ..plan })
    }

    /// Designs observer and governor of the machine without its dampers.
    ///
    /// # Errors
    /// The library's sentence for a machine that cannot be observed or governed so.
    pub fn of(machine: &MachineFile) -> Result<Self, Error> {
        let (rate, encoder, disturbance) = machine.tuning();
        match machine.two_masses() {
            Some(two) => {
                let designs = Designs::of(machine, &two)?;
                let speed_loop = SpeedLoop::of(machine, &designs)?;
                Ok(Self::two_mass(machine, &designs, speed_loop).warned(machine))
            }
            None => {
                Ok(Self::rigid(machine, &machine.rigid()?.try_observer(rate, encoder, disturbance)?).warned(machine))
            }
        }
    }

    fn warned(mut self, machine: &MachineFile) -> Self {
        let (weight, torque) = (machine.gravity_torque().abs(), machine.limits.torque);
        if weight >= torque {
            self.warnings.push(format!(
                "the weight of {} N m at the motor is not held by `limits.torque`, {} N m: a larger torque or a \
                 lighter load is expected",
                significant(weight),
                significant(torque)
            ));
        }
        let speed = machine.limits.speed;
        if !machine.rating().is_within(machine.chain.masses()[0], Rating::PERIPHERAL_SPEED) {
            self.warnings.push(format!(
                "`limits.speed`, {0} rad/s, is too fast for a rotor of the motor's inertia, {1} kg m²: {0} r/min are {2} rad/s",
                significant(speed),
                significant(machine.chain.masses()[0]),
                significant(speed * core::f64::consts::TAU / 60.0)
            ));
        }
        if let Some(shaft) = self.shaft.as_ref().filter(|shaft| shaft.reduction_error > Shaft::LARGE_REDUCTION_ERROR) {
            self.warnings.push(format!(
                "two masses are a poor model of this machine: the neglected modes may be {} of a step of the motor's \
                 speed; see the modes with `cargo driveline modes`",
                percent(shaft.reduction_error)
            ));
        }
        self
    }

    fn two_mass(machine: &MachineFile, designs: &Designs, speed_loop: SpeedLoop) -> Self {
        let Designs { two, two_masses: observer, .. } = designs;
        let deviation = &observer.standard_deviation;
        let of = [
            deviation.motor_angle,
            deviation.motor_speed,
            deviation.twist,
            deviation.load_speed,
            deviation.load_torque,
        ];
        let names = [
            ("motor angle", "rad"),
            ("motor speed", "rad/s"),
            ("twist", "rad"),
            ("load speed", "rad/s"),
            ("load torque", "N m"),
        ];
        Self {
            name: machine.name.clone(),
            need: machine.duty.map(|_| needed(&designs.nominal)),
            predicted: Some(Predicted::of(machine, designs)),
            observer: "two-mass",
            rate_hz: machine.control.rate_hz,
            inertias: vec![two.motor_inertia, two.load_inertia],
            shaft: Some(Shaft {
                stiffness: two.stiffness,
                damping: two.damping,
                gap: two.gap,
                resonance: two.resonance(),
                antiresonance: two.antiresonance(),
                reduction_error: two.error.worst,
                step: if observer.chosen == StepChoice::Exact { "exact" } else { "semi-implicit" },
                semi_implicit_error: finite(observer.semi_implicit.fidelity.error_bound),
                semi_implicit_threshold: StepChoice::THRESHOLD,
                torque_standard_deviation: deviation.shaft_torque,
            }),
            states: states(&names, &observer.gains, &of),
            poles: poles(&observer.poles),
            spectral_radius: observer.spectral_radius,
            innovation: observer.innovation,
            speed_loop: Some(speed_loop),
            ..Self::default()
        }
    }

    fn rigid(machine: &MachineFile, observer: &RigidDesign) -> Self {
        let names = [("motor angle", "rad"), ("motor speed", "rad/s"), ("load torque", "N m")];
        Self {
            name: machine.name.clone(),
            observer: "rigid",
            rate_hz: machine.control.rate_hz,
            inertias: vec![observer.machine.inertia],
            states: states(&names, &observer.gains, &observer.standard_deviation),
            poles: poles(&observer.poles),
            spectral_radius: observer.spectral_radius,
            innovation: observer.innovation,
            ..Self::default()
        }
    }
}

/// Selection by the load cycle alone.
fn needed(need: &ObserverSelection) -> Needed {
    let cost = |cost: Penalty| [cost.shaft_torque, cost.load_speed];
    Needed { observer: name(need.chosen), without_shaft: cost(need.without_shaft), without_gap: cost(need.without_gap) }
}

const fn name(choice: ObserverChoice) -> &'static str {
    match choice {
        ObserverChoice::Rigid => "rigid",
        ObserverChoice::SemiImplicit => "semi-implicit",
        ObserverChoice::Exact => "exact",
        ObserverChoice::Backlash => "backlash",
    }
}

fn states(names: &[(&'static str, &'static str)], gains: &[f64], deviations: &[f64]) -> Vec<State> {
    let state = |((&(name, unit), &gain), &standard_deviation)| State { name, unit, gain, standard_deviation };
    names.iter().zip(gains).zip(deviations).map(state).collect()
}

fn poles(poles: &[(f64, f64)]) -> Vec<Pole> {
    poles.iter().map(|&(re, im)| Pole { re, im }).collect()
}
