//! Runs before that of a draw, in which a drive's learners find its machine.

use driveline_firmware::scenes::hoist;
use driveline_solver::plant::PlantError;

use super::drive::Drive;
use crate::drivetrains;
use crate::drivetrains::departure::Departure;
use crate::drivetrains::scenario::Scenario;

/// The runs of a drive with learners, with known loads where it needs them; none of another drive.
///
/// # Errors
/// Values that no plant can have.
pub fn preparation(scene: &str, drive: &Drive, by: &Departure) -> Result<Vec<Scenario>, PlantError> {
    match drive {
        Drive::Variant(row) if scene == hoist::SCENE && row.name.split('/').nth(2) == Some("learnt") => {
            drivetrains::hoist::test_lifts(by)
        }
        _ => Ok(Vec::new()),
    }
}
