//! The same observer with other steps, on the host, over the inputs of a run: what the step is worth.

use driveline_firmware::Words;
use driveline_firmware::scenes::hoist;

use super::engine::Ran;
use super::scenario::Machine;
use super::units::Units;
use crate::report::Comparison;
use crate::sweep::{Recorded, comparisons, recorded};

/// The hoist's observer with the exact step, Tustin's and forward Euler's.
///
/// # Errors
/// A gear out of its range, which only a changed scene can bring.
pub fn of_hoist(machine: &Machine, rate_hz: u32, ran: &Ran) -> Result<Vec<Comparison>, driveline::constants::Error> {
    let units = Units::new(Words::Single, machine.bases);
    let counted = ran.traces.iter().zip(&machine.scenarios).filter(|(_, scenario)| scenario.counted);
    let run: Vec<Recorded> = counted.flat_map(|(trace, _)| recorded(trace, &units)).collect();
    comparisons(&hoist::observer(&hoist::REDUCED, rate_hz), &hoist::GEAR, &run, machine.rated_speed)
}
