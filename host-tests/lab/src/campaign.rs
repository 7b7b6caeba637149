//! The scenes that campaigns are run of, with their tolerances: those of a class of machines, and their own.

mod real;

use cargo_driveline::campaign::scenes::{CampaignScene, Firmware};
use cargo_driveline::campaign::{Factor, Tolerance};
use cargo_driveline::machine_file::class::{Class, usual};
use driveline::design::Tolerance as Usual;
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::scenario::Scenario;
use driveline_firmware::scenes::blooming_mill::{self, BloomingMill};
use driveline_firmware::scenes::crane_travel::{self, CraneTravel};
use driveline_firmware::scenes::hoist::{self, Hoist};
use driveline_firmware::scenes::spindle::{self, Spindle};
use driveline_firmware::scenes::strip_mill::{self, StripMill};
use driveline_solver::plant::PlantError;

use crate::drivetrains;

pub use real::{SEED, sample};

/// The hoist's: 0.5 to 13 t on 5 to 30 m of rope, where the design has 12 t on 12 m; the oil is cold or warm.
const LIFTS: &[Tolerance] = &[
    usual(Factor::Stiffness, Usual::USUAL.stiffness),
    Tolerance::new(Factor::Load, 0.5 / 12.0, 13.0 / 12.0),
    Tolerance::new(Factor::Rope, 5.0 / 12.0, 30.0 / 12.0),
    Tolerance::new(Factor::Efficiency, -0.03, 0.03),
];

/// The crane's: load and length of the pendulum, to the accuracy of the drive's constants.
const SWINGS: &[Tolerance] = &[Tolerance::new(Factor::Load, 0.9, 1.1), Tolerance::new(Factor::Rope, 0.9, 1.1)];

/// Rolls and tools are changed.
const CHANGED: &[Tolerance] =
    &[usual(Factor::Stiffness, Usual::USUAL.stiffness), usual(Factor::LoadInertia, Usual::USUAL.load_inertia)];

/// The same, and the spindles' gap wears.
const GAP: &[Tolerance] = &[
    usual(Factor::Stiffness, Usual::USUAL.stiffness),
    usual(Factor::LoadInertia, Usual::USUAL.load_inertia),
    usual(Factor::Gap, Usual::USUAL.gap),
];

/// Without a load, then with a known one.
fn crane_travel_preparation(by: &Departure) -> Result<Vec<Scenario>, PlantError> {
    Ok(vec![drivetrains::crane_travel::empty_hook(by)?, drivetrains::crane_travel::test_weight(by)?])
}

/// Uncoupled from the rolls.
fn blooming_mill_preparation(by: &Departure) -> Result<Vec<Scenario>, PlantError> {
    Ok(vec![drivetrains::blooming_mill::uncoupled(by)?])
}

pub static SCENES: &[CampaignScene] = &[
    CampaignScene::of::<Hoist<10_000>>(
        hoist::SCENE,
        Firmware {
            departing: drivetrains::hoist::departing,
            preparation: drivetrains::hoist::test_lifts,
            class: Class::Crane,
            tolerances: LIFTS,
            variants: hoist::ROWS,
        },
        2048.0,
        (6.1, 8.0),
    ),
    CampaignScene::of::<StripMill>(
        strip_mill::SCENE,
        Firmware {
            departing: drivetrains::strip_mill::departing,
            preparation: Firmware::unprepared,
            class: Class::Mill,
            tolerances: CHANGED,
            variants: strip_mill::ROWS,
        },
        4096.0,
        (7.1, 9.0),
    ),
    CampaignScene::of::<Spindle>(
        spindle::SCENE,
        Firmware {
            departing: drivetrains::spindle::departing,
            preparation: Firmware::unprepared,
            class: Class::MachineTool,
            tolerances: CHANGED,
            variants: spindle::ROWS,
        },
        512.0,
        (1.503, 1.56),
    ),
    CampaignScene::of::<BloomingMill>(
        blooming_mill::SCENE,
        Firmware {
            departing: drivetrains::blooming_mill::departing,
            preparation: blooming_mill_preparation,
            class: Class::Mill,
            tolerances: GAP,
            variants: blooming_mill::ROWS,
        },
        8192.0,
        (5.8, 6.6),
    ),
    CampaignScene::of::<CraneTravel>(
        crane_travel::SCENE,
        Firmware {
            departing: drivetrains::crane_travel::departing,
            preparation: crane_travel_preparation,
            class: Class::Crane,
            tolerances: SWINGS,
            variants: crane_travel::ROWS,
        },
        1024.0,
        (32.0, 40.0),
    ),
];
