//! The run of a draw: the library's own code on the host against the drawn machine.

use driveline_firmware::scene::Input;
use driveline_firmware::scenes::{Row, find};

use super::draw::Draw;
use super::figure::{Gathering, Outcome, Scale};
use super::scenes::CampaignScene;
use crate::closed_loop::actuator::ActuatorErrors;
use crate::closed_loop::encoder_errors::EncoderErrors;
use crate::closed_loop::ticks::OnHost;
use crate::closed_loop::units::Units;
use crate::drivetrains::lockstep::{Imperfections, follow};
use crate::drivetrains::scenario::{Machine, Scenario};

/// The variant of a scene that a campaign runs: the design's choice in `f32`, or the one with this number, observer
/// and rate.
///
/// # Errors
/// A sentence: no such variant.
pub fn variant(machine: &Machine, name: Option<&str>) -> Result<&'static Row, String> {
    let (observer, rate) = machine.chosen;
    let usual = format!("f32/{observer}/{rate}");
    let name = name.unwrap_or(&usual);
    find(&format!("{}/{name}", machine.name)).ok_or_else(|| {
        format!("`{}` has no variant `{name}`; expected NUMBER/OBSERVER/RATE, such as {usual}", machine.name)
    })
}

/// Runs a draw. One that swings at the end runs again without noise and errors of the encoder, to find out whether the
/// loop sustains the swing or the sensors do.
///
/// # Errors
/// A sentence: values that no plant can have.
pub fn run(scene: &CampaignScene, variant: &Row, draw: &Draw) -> Result<Outcome, String> {
    let wrong = |error: &dyn core::fmt::Display| format!("draw {} of `{}`: {error}", draw.number, scene.name);
    let machine = (scene.departing)(&draw.departure()).map_err(|error| wrong(&error))?;
    let scenario = machine.scenarios.first().ok_or_else(|| wrong(&"the machine has no run"))?;
    let imperfections = draw.imperfections(scene.lines, scene.rated_torque);
    let follow = |machine: &Machine, imperfections: &Imperfections| {
        follow_draw(scene, variant, machine, scenario, imperfections).map_err(|error| wrong(&error))
    };
    let outcome = follow(&machine, &imperfections)?;
    if !outcome.swings() {
        return Ok(outcome);
    }
    let encoder = EncoderErrors::default();
    let actuator = ActuatorErrors { cogging: 0.0, ..imperfections.actuator };
    let quiet = Machine { torque_noise: 0.0, ..(scene.departing)(&draw.departure()).map_err(|error| wrong(&error))? };
    let quiet = follow(&quiet, &Imperfections { encoder, actuator, ..imperfections })?;
    Ok(outcome.with_sustained(&quiet, scene.free.1 - scene.free.0))
}

fn follow_draw(
    scene: &CampaignScene,
    variant: &Row,
    machine: &Machine,
    scenario: &Scenario,
    imperfections: &Imperfections,
) -> std::io::Result<Outcome> {
    let units = Units::new(variant.words(), machine.bases);
    let mut plant = scenario.plant.unrecorded();
    let mut gathering = Gathering::new(Scale {
        torque: scene.rated_torque,
        speed: machine.rated_speed,
        load_inertia: (machine.load..plant.nodes()).map(|node| plant.inertia(node)).sum(),
        free: scene.free,
    });
    let step = scene.ramp / f64::from(variant.rate_hz);
    let mut ramped = 0.0_f64;
    let mut drive = OnHost(variant.start());
    let each = |moment: &_, (input, _): (Input, _)| {
        let target = if input.flags & Input::RELEASED == 0 { ramped } else { units.speed(input.setpoint) };
        let change = (target - ramped).clamp(-step, step);
        ramped += change;
        gathering.add(moment, change / step * scene.ramp);
    };
    follow(machine, scenario, &units, variant.rate_hz, imperfections, &mut drive, &mut plant, each)?;
    Ok(gathering.outcome())
}
