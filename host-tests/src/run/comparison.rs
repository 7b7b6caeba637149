//! The same observer with other steps, on the host, over the inputs of a run: what the step is worth.

use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::hoist;

use super::engine::Ran;
use super::scenario::Machine;
use super::units::Units;
use crate::report::Comparison;
use crate::sweep::{Recorded, StepOf, comparison};

/// The hoist's observer with the exact step, Tustin's and forward Euler's.
///
/// # Errors
/// A gear out of its range, which only a changed scene can bring.
pub fn of_hoist(machine: &Machine, rate_hz: u32, ran: &Ran) -> Result<Vec<Comparison>, driveline::constants::Error> {
    let units = Units::new(Words::Single, machine.bases);
    let mut recorded = Vec::new();
    for (trace, scenario) in ran.traces.iter().zip(&machine.scenarios).filter(|(_, scenario)| scenario.counted) {
        for (moment, (input, _)) in trace.moments.iter().zip(&trace.words) {
            let released = input.flags & Input::RELEASED != 0;
            let torque = if released { units.torque(input.torque) } else { scenario.held };
            recorded.push(Recorded { angle: input.angle, torque, released, truth: moment.truth });
        }
    }
    let design = hoist::observer(&hoist::REDUCED, rate_hz);
    StepOf::ALL
        .into_iter()
        .map(|step| comparison(&design, step, &hoist::GEAR, &recorded, machine.rated_speed))
        .collect()
}
