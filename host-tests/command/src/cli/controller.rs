//! Result of `design` for a machine: step, observer, governor.

use driveline::design::{
    Actuator, ClosedLoop, Disturbance, Encoder, Error, LoopObserver, ObserverChoice, Penalty, Plant, Rate, Requirement,
    RigidDesign, Robustness, SpeedLoopDesign, SpeedLoopTuning, StepChoice, Tolerance, TwoMassDesign,
};
use driveline::machine::{Match, TwoMass};
use serde::Serialize;

use crate::machine_file::{Duty, MachineFile};

/// The controller of a machine, in SI units at the motor.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// The machine's name.
    pub name: String,
    /// `two-mass`, or `rigid` where the machine has no shaft.
    pub observer: &'static str,
    /// Ticks a second.
    pub rate_hz: u32,
    /// Inertias \[kg m2\]: motor's side and load's side, or one.
    pub inertias: Vec<f64>,
    /// The shaft between the two masses and the step that follows it.
    pub shaft: Option<Shaft>,
    /// The states, in the order of gains and standard deviations.
    pub states: Vec<State>,
    /// Poles of the estimate's error.
    pub poles: Vec<Pole>,
    /// Largest size of a pole.
    pub spectral_radius: f64,
    /// Predicted standard deviation of the innovation \[rad\].
    pub innovation: f64,
    /// The speed loop, for two masses.
    pub speed_loop: Option<SpeedLoop>,
    /// The selected observer, for two masses whose file has a `[duty]`.
    pub need: Option<Needed>,
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

/// The shaft between the two masses.
#[derive(Clone, Debug, Serialize)]
pub struct Shaft {
    /// Stiffness \[N m/rad\].
    pub stiffness: f64,
    /// Damping \[N m s/rad\].
    pub damping: f64,
    /// Whole free angle \[rad\].
    pub gap: f64,
    /// Resonance \[rad/s\].
    pub resonance: f64,
    /// Antiresonance \[rad/s\].
    pub antiresonance: f64,
    /// Worst-case error of the reduction, over the first jump of the motor's speed.
    pub reduction_error: f64,
    /// Step that the design takes: `exact` or `semi-implicit`.
    pub step: &'static str,
    /// Error bound of the semi-implicit step over a period of the resonance; `null` where it is unstable.
    pub semi_implicit_error: Option<f64>,
    /// The bound up to which the semi-implicit step is taken.
    pub semi_implicit_threshold: f64,
    /// Predicted standard deviation of the shaft torque \[N m\].
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
    /// Gain on the error of the motor's speed \[N m s/rad\].
    pub proportional: f64,
    /// Integral gain \[N m/rad\].
    pub integral: f64,
    /// Gain on the damping \[N m s/rad\].
    pub damping: f64,
    /// Natural frequency of the speed \[rad/s\].
    pub bandwidth: f64,
    /// Margins with the observer and all the machine's vibrations in the loop; `null` where it is unstable.
    pub margins: Option<Margins>,
    /// Why there are no margins.
    pub no_margins: Option<&'static str>,
    /// The least margins within the usual tolerances of two masses; `null` where the loop is unstable within them.
    pub least_margins: Option<LeastMargins>,
    /// What the loop has not within the usual tolerances: 6 dB, 30 degrees, stability. `null` where it has all.
    pub not_robust: Option<&'static str>,
    /// Largest size of a pole of the closed loop.
    pub spectral_radius: f64,
}

/// Two masses are stable, the machine is not.
const NEGLECTED: &str = "the speed loop with its observer is unstable by a vibration that the two masses leave out: \
    give its shafts their damping, or take less bandwidth";

impl SpeedLoop {
    fn of(
        machine: &MachineFile,
        two: &TwoMass,
        observer: &TwoMassDesign,
        governor: &SpeedLoopDesign,
    ) -> Result<Self, Error> {
        const TOLERANCE: &Tolerance = &Tolerance::USUAL;
        let closed = ClosedLoop::of(observer, governor, Actuator::DIRECT)?;
        let margins = Margins::of(machine, two, &closed);
        let observer = LoopObserver::TwoMass(observer);
        let least = two.least_margins(observer, governor, Actuator::DIRECT, TOLERANCE);
        let robust = two.try_robust(observer, governor, Actuator::DIRECT, TOLERANCE, &Robustness::USUAL);
        let no_margins = margins.as_ref().err().map(|error| match robust {
            Ok(()) => NEGLECTED,
            Err(_) => error.message(),
        });
        Ok(Self {
            proportional: governor.proportional,
            integral: governor.integral,
            damping: governor.damping,
            bandwidth: governor.bandwidth,
            no_margins,
            margins: margins.ok(),
            // those of two masses, which mean nothing where the whole machine is unstable
            least_margins: least.ok().filter(|_| no_margins.is_none()).map(|least| LeastMargins::of(&least)),
            not_robust: robust.err().map(Error::message).or(no_margins),
            spectral_radius: governor.spectral_radius,
        })
    }
}

/// How far the speed loop is from instability.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Margins {
    /// Factor by which the gain may grow; `null` where no growth destabilises.
    pub gain_up: Option<f64>,
    /// Factor by which the gain may shrink.
    pub gain_down: f64,
    /// Phase margin \[rad\]; `null` where the gain crosses 1 nowhere.
    pub phase: Option<f64>,
    /// Dead time more that destabilises \[s\]; `null` as well.
    pub delay: Option<f64>,
    /// Smallest distance of the response from -1.
    pub modulus: f64,
    /// Factors of the motor side's inertia that the loop of two masses bears, from and to; `null` where any.
    pub motor_inertia: [Option<f64>; 2],
    /// The same for the load side's inertia.
    pub load_inertia: [Option<f64>; 2],
    /// The same for the stiffness.
    pub stiffness: [Option<f64>; 2],
}

/// The least of each margin over tolerances.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LeastMargins {
    /// As in [`Margins`].
    pub gain_up: Option<f64>,
    /// As in [`Margins`].
    pub gain_down: f64,
    /// As in [`Margins`].
    pub phase: Option<f64>,
    /// As in [`Margins`].
    pub delay: Option<f64>,
    /// As in [`Margins`].
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
            gain_up: finite(margins.gain_up),
            gain_down: margins.gain_down,
            phase: finite(margins.phase),
            delay: finite(margins.delay),
            modulus: margins.modulus,
            motor_inertia: range(ranges.motor_inertia),
            load_inertia: range(ranges.load_inertia),
            stiffness: range(ranges.stiffness),
        })
    }
}

/// The tuning of a file in the library's words.
pub fn tuning(machine: &MachineFile) -> (Rate, Encoder, Disturbance) {
    let disturbance = Disturbance {
        torque_accuracy: machine.disturbance.torque_accuracy,
        load_torque_step: machine.disturbance.load_torque_step,
        within: machine.disturbance.within,
    };
    let accuracy = machine.encoder.accuracy;
    // a jitter is that of the angle at the largest speed
    let encoder = Encoder::lines(machine.encoder.lines)
        .interpolation(accuracy.signal_periods, accuracy.interpolation)
        .eccentricity(accuracy.eccentricity)
        .jitter(accuracy.jitter, machine.limits.speed);
    (Rate::hz(machine.control.rate_hz), encoder, disturbance)
}

/// The machine as two masses; `None` where it has no shaft.
pub fn two_masses(machine: &MachineFile) -> Option<TwoMass> {
    machine.reduce(Match::ResonanceAntiresonance).ok()
}

impl Plan {
    /// Designs observer and governor.
    ///
    /// # Errors
    /// The library's sentence for a machine that cannot be observed or governed so.
    pub fn of(machine: &MachineFile) -> Result<Self, Error> {
        let (rate, encoder, disturbance) = tuning(machine);
        match two_masses(machine) {
            Some(two) => {
                let observer = two.try_observer(rate, encoder, disturbance)?;
                let governor = two.try_speed_loop(rate, SpeedLoopTuning::of(&two))?;
                Ok(Self::two_mass(machine, &two, &observer, &SpeedLoop::of(machine, &two, &observer, &governor)?))
            }
            None => Ok(Self::rigid(machine, &machine.rigid()?.try_observer(rate, encoder, disturbance)?)),
        }
    }

    fn two_mass(machine: &MachineFile, two: &TwoMass, observer: &TwoMassDesign, speed_loop: &SpeedLoop) -> Self {
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
            need: machine.duty.map(|duty| needed(machine, two, duty)),
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
            speed_loop: Some(speed_loop.clone()),
        }
    }

    fn rigid(machine: &MachineFile, observer: &RigidDesign) -> Self {
        let names = [("motor angle", "rad"), ("motor speed", "rad/s"), ("load torque", "N m")];
        Self {
            name: machine.name.clone(),
            need: None,
            observer: "rigid",
            rate_hz: machine.control.rate_hz,
            inertias: vec![observer.machine.inertia],
            shaft: None,
            states: states(&names, &observer.gains, &observer.standard_deviation),
            poles: poles(&observer.poles),
            spectral_radius: observer.spectral_radius,
            innovation: observer.innovation,
            speed_loop: None,
        }
    }
}

/// Which observer two masses need. A weight that is heavier than the change keeps a gap closed.
fn needed(machine: &MachineFile, two: &TwoMass, duty: Duty) -> Needed {
    let Duty { change, rise, every } = duty;
    let reverses = two.gravity_torque.abs() < change;
    let (speed, torque) = (machine.limits.speed, machine.limits.torque);
    let duty = driveline::design::LoadCycle { speed, torque, change, rise, every, reverses };
    let need = two.select_observer(&duty, &Requirement::USUAL, 1.0 / f64::from(machine.control.rate_hz));
    let cost = |cost: Penalty| [cost.shaft_torque, cost.load_speed];
    Needed {
        observer: match need.chosen {
            ObserverChoice::Rigid => "rigid",
            ObserverChoice::SemiImplicit => "semi-implicit",
            ObserverChoice::Exact => "exact",
            ObserverChoice::Backlash => "backlash",
        },
        without_shaft: cost(need.without_shaft),
        without_gap: cost(need.without_gap),
    }
}

fn states(names: &[(&'static str, &'static str)], gains: &[f64], deviations: &[f64]) -> Vec<State> {
    let state = |((&(name, unit), &gain), &standard_deviation)| State { name, unit, gain, standard_deviation };
    names.iter().zip(gains).zip(deviations).map(state).collect()
}

fn poles(poles: &[(f64, f64)]) -> Vec<Pole> {
    poles.iter().map(|&(re, im)| Pole { re, im }).collect()
}
