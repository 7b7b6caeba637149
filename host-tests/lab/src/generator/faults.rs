//! A fault on every input in turn, and reaction.

use driveline::governor::Trip;
use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::generator::RATED_SPEED;

use super::run::{Broken, Moment, Program, run};
use super::set::Kind;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_solver::noise::Noise;

/// An input of the drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wire {
    /// The flywheel's angle.
    Angle,
    /// The rack's position.
    Torque,
    /// The speed setpoint.
    Setpoint,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Zero.
    Dropped,
    /// Its value before.
    Frozen,
    /// With noise: a degree of the angle, half the rated torque, 5 % of rated speed (standard deviations).
    Noisy,
    Negated,
    /// Not a number; every bit of an angle, the most negative number of fixed point.
    NotANumber,
}

/// Every wire.
pub const WIRES: [Wire; 3] = [Wire::Angle, Wire::Torque, Wire::Setpoint];
/// Every fault.
pub const FAULTS: [Fault; 5] = [Fault::Dropped, Fault::Frozen, Fault::Noisy, Fault::Negated, Fault::NotANumber];

/// Result of a fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Where.
    pub wire: Wire,
    /// What.
    pub fault: Fault,
    /// How long (s); none for good.
    pub lasting: Option<f64>,
    /// The trip and how long after the fault it came (s).
    pub trip: Option<(String, f64)>,
    /// Lowest and highest frequency from the fault to the trip or the end, of rated.
    pub frequency: [f64; 2],
    /// Least and largest torque commanded, of rated.
    pub torque: [f64; 2],
    /// Largest torque commanded after the trip.
    pub after: f64,
    /// Whether all that is what is documented.
    pub as_documented: bool,
}

/// Documented reaction of a drive to a fault, in `firmware/src/scenes/generator.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Documented {
    /// It rides through, and the frequency stays within these of rated.
    RidesThrough([f64; 2]),
    /// It trips for one of these reasons, within a time (s).
    Trips(&'static [Trip], f64),
}

/// Documented reaction to a lasting or a passing fault.
pub const fn documented(wire: Wire, fault: Fault, lasts: bool) -> Documented {
    match (wire, fault) {
        // 5 ms of coasting, or of another torque than the true one: within 1 %.
        _ if !lasts => Documented::RidesThrough([0.99, 1.01]),
        // The angle is lost after 15 ms; with noise, plausible angles come between.
        (Wire::Angle, _) => Documented::Trips(&[Trip::SensorLoss], 0.1),
        // The reading is still as expected.
        (Wire::Torque, Fault::Frozen) => Documented::RidesThrough([0.99, 1.01]),
        // 0.1 s.
        (Wire::Torque, Fault::NotANumber) => Documented::Trips(&[Trip::SensorLoss], 0.11),
        (Wire::Torque, Fault::Dropped | Fault::Negated) => Documented::Trips(&[Trip::Actuator], 0.11),
        // Half the rated torque of noise is beyond a fifth of it in two ticks of three: these less the others take
        // three times as long. Some are beyond what a rack can stand for.
        (Wire::Torque, Fault::Noisy) => Documented::Trips(&[Trip::Actuator, Trip::SensorLoss], 0.4),
        // A setpoint of zero or below is one: the set slows down by its ramp, to 80 % in a second, and 3 s of
        // underspeed trip it, unless its load of constant power overloads the coupling before.
        (Wire::Setpoint, Fault::Dropped | Fault::Negated) => {
            Documented::Trips(&[Trip::ShaftOverload, Trip::Underspeed], 4.5)
        }
        // The last good one stands.
        (Wire::Setpoint, Fault::Frozen | Fault::NotANumber) => Documented::RidesThrough([0.99, 1.01]),
        // 5 % of noise, of which the ramp lets 0.01 % through in a tick.
        (Wire::Setpoint, Fault::Noisy) => Documented::RidesThrough([0.98, 1.02]),
    }
}

/// Largest torque that may be commanded, of rated: the curve's, and its rounding in the words.
pub const MOST: f64 = 1.2001;

impl Outcome {
    fn is_documented(&self) -> bool {
        let within = self.torque[0] >= 0.0 && self.torque[1] <= MOST && self.after == 0.0;
        within
            && match (documented(self.wire, self.fault, self.lasting.is_none()), &self.trip) {
                (Documented::RidesThrough([least, most]), None) => {
                    self.frequency[0] >= least && self.frequency[1] <= most
                }
                (Documented::Trips(reasons, time), Some((name, after))) => {
                    reasons.iter().any(|reason| reason.to_string() == *name) && *after <= time
                }
                _ => false,
            }
    }
}

/// When the fault comes (s).
const AT: f64 = 3.0;
/// How long a passing one lasts (s).
pub const PASSING: f64 = 0.005;

/// A set at half load, found turning.
fn program(duration: f64) -> Program {
    Program { speed: RATED_SPEED, on: 0.2, constants: 0, loads: vec![(0.5, 0.5)], seizes: None, duration }
}

/// Runs the diesel with a fault that lasts so long.
pub fn outcome(
    words: Words,
    drive: &mut impl Ticks,
    wire: Wire,
    fault: Fault,
    lasting: Option<f64>,
) -> Result<Outcome, Broken> {
    let kind = Kind::Diesel;
    let units = Units::new(words, kind.constants().bases());
    let mut noise = Noise::new(2);
    let mut held = [0; 3];
    let spoil = |time: f64, input: &mut Input| {
        let faulty = time >= AT && lasting.is_none_or(|lasting| time < AT + lasting);
        let value = match wire {
            Wire::Angle => &mut input.angle,
            Wire::Torque => &mut input.torque,
            Wire::Setpoint => &mut input.setpoint,
        };
        if !faulty {
            held[wire as usize] = *value;
            return;
        }
        *value = match (fault, wire) {
            (Fault::Dropped, _) => 0,
            (Fault::Frozen, _) => held[wire as usize],
            (Fault::Noisy, Wire::Angle) => value.wrapping_add((noise.normal() * 4_294_967_296.0 / 360.0) as i64 as u32),
            (Fault::Noisy, Wire::Torque) => {
                units.torque_word(units.torque(*value) + 0.5 * kind.constants().rated_torque * noise.normal())
            }
            (Fault::Noisy, Wire::Setpoint) => {
                units.speed_word(units.speed(*value) + 0.05 * RATED_SPEED * noise.normal())
            }
            (Fault::Negated, Wire::Angle) => value.wrapping_neg(),
            (Fault::Negated, Wire::Torque) => units.torque_word(-units.torque(*value)),
            (Fault::Negated, Wire::Setpoint) => units.speed_word(-units.speed(*value)),
            (Fault::NotANumber, Wire::Angle) => u32::MAX,
            (Fault::NotANumber, _) if words == Words::Single => f32::NAN.to_bits(),
            (Fault::NotANumber, _) => 1 << 31,
        };
    };
    let duration = if lasting.is_some() { AT + 2.0 } else { AT + 6.0 };
    let moments = run(kind, words, &program(duration), drive, spoil)?;
    Ok(judge(&moments, wire, fault, lasting))
}

fn judge(moments: &[Moment], wire: Wire, fault: Fault, lasting: Option<f64>) -> Outcome {
    let tripped = moments.iter().find(|moment| moment.mode >= 16);
    let trip = tripped.map(|moment| {
        let name = Trip::NAMES.iter().find(|(trip, _)| *trip as u32 + 16 == moment.mode).map_or("", |(_, name)| name);
        (name.to_owned(), moment.time - AT)
    });
    let until = tripped.map_or(f64::INFINITY, |moment| moment.time);
    let mut outcome = Outcome {
        wire,
        fault,
        lasting,
        trip,
        frequency: [f64::INFINITY, 0.0],
        torque: [f64::INFINITY, f64::NEG_INFINITY],
        after: 0.0,
        as_documented: false,
    };
    for moment in moments {
        let [least, most] = outcome.torque;
        outcome.torque = [least.min(moment.command), most.max(moment.command)];
        if moment.time >= AT && moment.time <= until {
            let [low, high] = outcome.frequency;
            outcome.frequency = [low.min(moment.frequency), high.max(moment.frequency)];
        }
        if moment.time > until {
            outcome.after = outcome.after.max(moment.command.abs());
        }
    }
    outcome.as_documented = outcome.is_documented();
    outcome
}
