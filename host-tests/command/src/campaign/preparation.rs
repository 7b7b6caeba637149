//! Runs before that of a draw, in which a drive's learners find its machine.

use driveline_firmware::scenes::{blooming_mill, crane_travel, hoist};
use driveline_solver::plant::PlantError;

use super::drive::Drive;
use crate::drivetrains;
use crate::drivetrains::departure::Departure;
use crate::drivetrains::scenario::Scenario;

/// The runs of a drive with learners, with known loads or without load; none of another drive.
///
/// # Errors
/// Values that no plant can have.
pub fn preparation(scene: &str, drive: &Drive, by: &Departure) -> Result<Vec<Scenario>, PlantError> {
    let learns = matches!(drive, Drive::Variant(row) if row.name.split('/').nth(2) == Some("learnt"));
    match scene {
        hoist::SCENE if learns => drivetrains::hoist::test_lifts(by),
        crane_travel::SCENE if learns => {
            Ok(vec![drivetrains::crane_travel::empty_hook(by)?, drivetrains::crane_travel::test_weight(by)?])
        }
        blooming_mill::SCENE if learns => Ok(vec![drivetrains::blooming_mill::uncoupled(by)?]),
        _ => Ok(Vec::new()),
    }
}
