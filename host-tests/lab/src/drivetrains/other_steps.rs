//! The errors of observers with other steps on a run that was recorded.

use driveline::configure::Machine as _;
use driveline::design::{Rate, TwoMassDesign};
use driveline::settings::{Error, Gear};
use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::hoist::Hoist;
use driveline_report::{Comparison, Deviation};

use super::approximate::{ApproximateObserver, StepOf};
use super::engine::Ran;
use driveline_closed_loop::lockstep::Trace;
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::units::Units;

/// One tick of a recorded run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recorded {
    /// Motor angle as the drive read it (2^-32 turn).
    pub angle: u32,
    /// Torque reported to the drive, or held against the brake (N m).
    pub torque: f64,
    /// The governor was released.
    pub released: bool,
    /// Shaft torque, load speed, load torque as the plant had them [N m, rad/s, N m].
    pub truth: [f64; 3],
}

/// The errors of an observer with this step on a recorded run, torques of their peaks in the run, the speed of the
/// rated one (rad/s). An estimate that is no longer finite makes them infinite.
///
/// # Errors
/// For a gear out of its range.
pub fn comparison(
    design: &TwoMassDesign,
    step: StepOf,
    gear: &Gear,
    run: &[Recorded],
    rated_speed: f64,
) -> Result<Comparison, Error> {
    let mut observer = ApproximateObserver::new(design, step, gear)?;
    let peak = |index: usize| run.iter().map(|tick| tick.truth[index].abs()).fold(0.0, f64::max);
    let scales = [peak(0), rated_speed, peak(2)];
    let (mut squares, mut largest) = ([0.0_f64; 3], [0.0_f64; 3]);
    for tick in run {
        let estimate =
            if tick.released { observer.tick(tick.angle, tick.torque) } else { observer.hold(tick.angle, tick.torque) };
        for index in 0..3 {
            let error = (estimate[index] - tick.truth[index]).abs() / scales[index];
            let error = if error.is_finite() { error } else { f64::INFINITY };
            squares[index] += error * error;
            largest[index] = largest[index].max(error);
        }
    }
    let deviation = |index: usize| Deviation { rms: (squares[index] / run.len() as f64).sqrt(), max: largest[index] };
    Ok(Comparison {
        step: step.name().to_owned(),
        observer: "two-mass".to_owned(),
        rate_hz: (1.0 / design.period).round() as u32,
        shaft_torque: deviation(0),
        load_speed: deviation(1),
        load_torque: deviation(2),
    })
}

/// Every step of [`StepOf::ALL`] on a recorded run; see [`comparison`].
///
/// # Errors
/// For a gear out of its range.
pub fn comparisons(
    design: &TwoMassDesign,
    gear: &Gear,
    run: &[Recorded],
    rated_speed: f64,
) -> Result<Vec<Comparison>, Error> {
    StepOf::ALL.into_iter().map(|step| comparison(design, step, gear, run, rated_speed)).collect()
}

/// Inputs of a drive in a run, and true values.
pub fn recorded(trace: &Trace, units: &Units) -> Vec<Recorded> {
    let ticks = trace.words.iter().zip(&trace.moments);
    ticks
        .map(|((input, _), moment)| {
            let released = input.flags & Input::RELEASED != 0;
            Recorded {
                angle: input.angle,
                torque: units.torque(if released { input.torque } else { input.setpoint }),
                released,
                truth: moment.truth,
            }
        })
        .collect()
}

/// The hoist's observer with the exact step, Tustin's and forward Euler's.
///
/// # Errors
/// A gear out of its range, which only a changed scene can bring.
pub fn of_hoist(machine: &Machine, rate_hz: u32, ran: &Ran) -> Result<Vec<Comparison>, Error> {
    let units = Units::new(Words::Single, machine.bases);
    let counted = ran.traces.iter().zip(&machine.scenarios).filter(|(_, scenario)| scenario.counted);
    let run: Vec<Recorded> = counted.flat_map(|(trace, _)| recorded(trace, &units)).collect();
    type Constants = Hoist<10_000>;
    let design = Constants::TWO_MASS.observer(Rate::hz(rate_hz), Constants::ENCODER, Constants::DISTURBANCE);
    comparisons(&design, &Constants::GEAR, &run, machine.rated_speed)
}
