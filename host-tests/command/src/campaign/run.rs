//! The run of a draw: the library's own code on the host against the drawn machine.

use driveline_firmware::scene::{Input, Scene};

use super::blow::End;
use super::draw::Draw;
use super::drive::Drive;
use super::figure::{Gathering, Outcome, Scale};
use super::scenes::CampaignScene;
use driveline_closed_loop::actuator::ActuatorErrors;
use driveline_closed_loop::encoder_errors::EncoderErrors;
use driveline_closed_loop::lockstep::{Imperfections, LockStep, follow};
use driveline_closed_loop::scenario::{Machine, Scenario};
use driveline_closed_loop::ticks::OnHost;

/// Runs a draw. One that swings at the end runs again without noise and errors of the encoder, to find out whether the
/// loop sustains the swing or the sensors do.
pub fn run(scene: &CampaignScene, drive: &Drive, draw: &Draw) -> Result<Outcome, String> {
    let wrong = |error: &dyn core::fmt::Display| format!("draw {} of `{}`: {error}", draw.number, scene.name);
    let machine = scene.departing(&draw.departure()).map_err(|error| wrong(&error))?;
    let mut scenario = machine.scenarios.first().ok_or_else(|| wrong(&"the machine has no run"))?.clone();
    scenario.duration = scenario.duration.max(scene.free.1);
    let mut imperfections = draw.imperfections(scene.lines, scene.rated_torque);
    imperfections.actuator.delay += scene.actuator.delay * f64::from(drive.rate_hz());
    imperfections.actuator.lag += scene.actuator.lag;
    let prepared = scene.preparation(drive, &draw.departure()).map_err(|error| wrong(&error))?;
    let follow = |machine: &Machine, imperfections: &Imperfections| {
        let ticking = drive.start(scene, machine).map_err(|error| wrong(&error))?;
        follow_draw(scene, drive, machine, &prepared, &scenario, imperfections, ticking).map_err(|error| wrong(&error))
    };
    let (outcome, end) = follow(&machine, &imperfections)?;
    let decay = end.ring_down(scene, drive, &machine, &scenario).map_err(|error| wrong(&error))?;
    let outcome = outcome.with_ring_down(decay);
    if !outcome.swings() {
        return Ok(outcome);
    }
    let encoder = EncoderErrors::default();
    let actuator = ActuatorErrors { cogging: 0.0, ..imperfections.actuator };
    let quiet = Machine { torque_noise: 0.0, ..scene.departing(&draw.departure()).map_err(|error| wrong(&error))? };
    let (quiet, _) = follow(&quiet, &Imperfections { encoder, actuator, ..imperfections })?;
    Ok(outcome.with_sustained(&quiet, scene.free.1 - scene.free.0))
}

fn follow_draw(
    scene: &CampaignScene,
    drive: &Drive,
    machine: &Machine,
    prepared: &[Scenario],
    scenario: &Scenario,
    imperfections: &Imperfections,
    mut ticking: OnHost<Box<dyn Scene>>,
) -> std::io::Result<(Outcome, End)> {
    let units = drive.units(machine);
    let mut plant = scenario.plant.unrecorded();
    let mut gathering = Gathering::new(Scale {
        torque: scene.rated_torque,
        speed: machine.rated_speed,
        load_inertia: (machine.load..plant.nodes()).map(|node| plant.inertia(node)).sum(),
        free: scene.free,
    });
    let step = scene.ramp / f64::from(drive.rate_hz());
    let mut ramped = 0.0_f64;
    for (before, run) in (1..).zip(prepared) {
        // other noise in each run
        let imperfections = Imperfections { seed: imperfections.seed ^ before, ..*imperfections };
        let mut plant = run.plant.unrecorded();
        follow(machine, run, &units, drive.rate_hz(), &imperfections, &mut ticking, &mut plant, |_, _| {})?;
    }
    let each = |moment: &_, (input, _): (Input, _)| {
        let target = if input.flags & Input::RELEASED == 0 { ramped } else { units.speed(input.setpoint) };
        let change = (target - ramped).clamp(-step, step);
        ramped += change;
        gathering.add(moment, change / step * scene.ramp);
    };
    let mut between = LockStep::new(&plant, imperfections, drive.rate_hz());
    between.follow(machine, scenario, &units, &mut ticking, &mut plant, each)?;
    Ok((gathering.outcome(), End { plant, between, ticking, carried: gathering.carried() }))
}
