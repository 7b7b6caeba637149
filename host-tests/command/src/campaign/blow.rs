//! A blow on the load at the end of a run, and the decay of the swing that answers it.
//!
//! Two copies of the run go on, in one of which the load is given a short blow of torque. Noise, errors of the encoder,
//! cogging and whatever still settles are the same in both. The difference of the plants' own shaft torques is the
//! answer to the blow alone.
//!
//! A machine with a gap is first struck as it is. A swing of which more than half is left after two thirds of the time
//! is sustained: the decay is that of its rms, but at most zero. Where it dies away, the machine is struck again under
//! a load that keeps the gap closed.
//!
//! A hoist that carries next to nothing is struck by next to nothing, so that its rope stays taut. The blow then moves
//! the motor by less than a count of the encoder. Now and then one copy reads a count more, its torque differs, and the
//! shaft carries the load's share of that. A swing below this floor is the reading's, not the blow's, and is left out.
//! A light load on its rope swings by more than its share. So a blow this small is given in both directions. What
//! answers both alike is no answer to the blow, and its largest value is the floor.

use core::f64::consts::TAU;

use driveline_firmware::scene::Scene;

use super::drive::Drive;
use super::ring_down::slowest;
use super::scenes::CampaignScene;
use driveline_closed_loop::lockstep::{LockStep, Moment};
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_closed_loop::ticks::OnHost;

/// Most of the answer's swing, of rated torque: the drive's torque stays within its limit.
const SWING: f64 = 0.2;
/// The same, of the shaft torque that is carried, where a rope would go slack.
const OF_CARRIED: f64 = 0.5;
/// Load that keeps a gap closed, of rated torque.
const CLOSING: f64 = 0.3;
/// Periods of the resonance that it settles for: at a damping ratio of 0.05 to a twentieth.
const SETTLING: f64 = 10.0;
/// Samples of a period of the resonance, where its ticks are so many.
const OF_PERIOD: f64 = 24.0;
/// Swing of the torque that noise makes at the most, rms of rated torque. A count of the encoder is a part of it.
const NOISE: f64 = 0.02;
/// Samples of an answer: ten periods of the resonance or more.
const SAMPLES: usize = 240;

/// A run at its end.
pub struct End {
    pub plant: Body,
    /// What it and the drive have between them.
    pub between: LockStep,
    /// The drive.
    pub ticking: OnHost<Box<dyn Scene>>,
    /// Mean of the shaft torque before the end (N m).
    pub carried: f64,
}

impl End {
    /// Decay of the slowest swing after a blow (1/s): zero or below where it is sustained, NaN where the answer is not
    /// finite. None where nothing swings.
    ///
    /// # Errors
    /// What the drive says; a load torque that follows the motion, in whose place the blow would come.
    pub fn ring_down(
        &self,
        scene: &CampaignScene,
        drive: &Drive,
        machine: &Machine,
        scenario: &Scenario,
    ) -> Result<Option<f64>, String> {
        if scenario.law.is_some() {
            return Err(format!("`{}` has a load torque that follows the motion: expected none", scenario.name));
        }
        let (rate, gap) = (f64::from(drive.rate_hz()), self.plant.has_backlash());
        let period = TAU / scene.resonance;
        // an eighth of a period excites machines of up to four times the resonance
        let lasts = period / 8.0;
        let ticks = (period * rate / OF_PERIOD).round().max(1.0) as usize;
        let after = |closing: f64, blow: f64| {
            let settled = if closing == 0.0 { 0.0 } else { SETTLING * period };
            let load = |torque: f64| Action::Load(machine.load, scenario.held + closing + torque);
            let skipped = ((settled + lasts) * rate).ceil() as usize;
            let after = Scenario {
                actions: vec![(0.0, load(0.0)), (settled, load(blow)), (settled + lasts, load(0.0))],
                duration: (skipped + SAMPLES * ticks) as f64 / rate,
                ..scenario.clone()
            };
            let torques = self.go_on(drive, machine, &after)?;
            let mean = |ticks: &[f64]| ticks.iter().sum::<f64>() / ticks.len() as f64;
            Ok::<Vec<f64>, String>(torques[skipped..].chunks_exact(ticks).map(mean).collect())
        };
        let every = ticks as f64 / rate;
        let most = SWING * scene.rated_torque;
        if gap {
            let swing = after(0.0, 0.5 * most)?;
            let [first, last] = [&swing[..SAMPLES / 3], &swing[SAMPLES - SAMPLES / 3..]].map(deviation);
            if last > NOISE * scene.rated_torque && last > 0.5 * first {
                let decay = (first / last).ln() / ((SAMPLES - SAMPLES / 3) as f64 * every);
                return Ok(Some(decay.min(0.0)));
            }
        }
        let (closing, most) = match (gap, scenario.held != 0.0) {
            (true, _) => ((CLOSING * scene.rated_torque).copysign(self.carried), most),
            (false, true) => (0.0, most.min(OF_CARRIED * self.carried.abs())),
            (false, false) => (0.0, most),
        };
        // a load torque b swings the shaft by at most 2 b
        let (struck, left) = (after(closing, 0.5 * most)?, after(closing, 0.0)?);
        let answer: Vec<f64> = struck.iter().zip(&left).map(|(struck, left)| struck - left).collect();
        let inertia = |from: usize| (from..self.plant.nodes()).map(|node| self.plant.inertia(node)).sum::<f64>();
        let mut floor = NOISE * scene.rated_torque * inertia(machine.load) / inertia(0);
        if most < NOISE * scene.rated_torque {
            let mirrored = after(closing, -0.5 * most)?;
            let alike = struck.iter().zip(&mirrored).zip(&left).map(|((one, other), left)| 0.5 * (one + other) - left);
            // a NaN stays out of the floor; the answer has one then
            floor = alike.fold(floor, |floor, torque| floor.max(torque.abs()));
        }
        Ok(slowest(&answer, every, floor))
    }

    /// The shaft torques of a copy that goes on with a scenario (N m), one for each tick: that before it for a tick
    /// that does not run, NaN before the first that does.
    fn go_on(&self, drive: &Drive, machine: &Machine, scenario: &Scenario) -> Result<Vec<f64>, String> {
        let mut ticking = OnHost(self.ticking.0.copy().ok_or("a drive whose state cannot be copied")?);
        let (mut plant, mut between) = (self.plant.clone(), self.between.clone());
        let rate = f64::from(drive.rate_hz());
        let mut seen = vec![None; (scenario.duration * rate).round() as usize];
        let each = |moment: &Moment, _| seen[(moment.time * rate).round() as usize] = Some(moment.truth[0]);
        let followed = between.follow(machine, scenario, &drive.units(machine), &mut ticking, &mut plant, each);
        followed.map_err(|error| error.to_string())?;
        let mut last = f64::NAN;
        let held = |torque: Option<f64>| {
            last = torque.unwrap_or(last);
            last
        };
        Ok(seen.into_iter().map(held).collect())
    }
}

/// Standard deviation.
fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}
