//! The library's phasors over a recorded vibration: reading after reading.

use std::f64::consts::{PI, TAU};

use driveline::angle::OncePerTurn;
use driveline::balancing::{Balancer, Phasors, PhasorsConfig, Reading, ReadingFault};
use driveline::settings::{PhasorError, PhasorSettings};
use nalgebra::Complex;

use super::signals::turned;

/// Blocks of a reading, and one edge more.
const EDGES: usize = 6;

/// What tells the rotor's angle.
#[derive(Clone, Copy, Debug)]
pub enum Turning<'r> {
    /// Its angle (rad), and where its zero is.
    Angle(&'r [f64], f64),
    /// The samples that first show a mark, and how long before each that passed (step).
    Marks(&'r [(usize, f64)]),
}

/// A reading with its place in the recording.
#[derive(Clone, Debug)]
pub struct Taken {
    /// When it ends (s).
    pub until: f64,
    /// Turns of the rotor a second; none where nothing was measured.
    pub speed: Option<f64>,
    /// As it was measured.
    pub measured: Result<Reading, ReadingFault>,
    /// Why it is not to be used.
    pub refused: Option<ReadingFault>,
}

impl Taken {
    /// The phasor, where the reading is to be used.
    pub fn phasor(&self) -> Option<Complex<f64>> {
        if self.refused.is_some() { None } else { Some(self.measured.as_ref().ok()?.phasor.into()) }
    }
}

/// All readings of samples from `start` (s) on, a `period` apart; the one that the recording's end cut off is there,
/// refused as incomplete, where there is no other.
pub fn readings(
    vibration: &[f64],
    turning: Turning<'_>,
    settings: &PhasorSettings,
    range: f64,
    [start, period]: [f64; 2],
) -> Result<Vec<Taken>, PhasorError> {
    let config = PhasorsConfig::<f32, 1>::try_new(settings, [range])?;
    let mut phasors = Phasors::<1, EDGES, f32>::default();
    let (mut tacho, mut taken, mut marks) = (OncePerTurn::new(), Vec::new(), 0);
    let mut was_lost = true;
    for (at, &value) in vibration.iter().enumerate() {
        let angle = match turning {
            Turning::Angle(angle, zero) => Some(turned(angle[at] - zero)),
            Turning::Marks(rows) => {
                let passes = rows.get(marks).filter(|(row, _)| *row == at);
                marks += usize::from(passes.is_some());
                tacho.tick(passes.map(|(_, since)| (since * 4_294_967_296.0) as u32))
            }
        };
        let Some(angle) = angle else {
            was_lost = true;
            continue;
        };
        // where the angle begins is no motion
        if std::mem::take(&mut was_lost) {
            phasors.align(&config, angle, angle);
        }
        phasors.measure(&config, angle, &[value as f32]);
        if phasors.is_complete() {
            let (refused, measured) = (phasors.reading(&config, 0).err(), phasors.unjudged(&config, 0));
            // the ticks are those of a period of the order
            let turn = |reading: &Reading| f64::from(reading.ticks) * f64::from(settings.order) * period;
            let speed = measured.as_ref().ok().map(|reading| 1.0 / turn(reading));
            taken.push(Taken { until: start + at as f64 * period, speed, measured, refused });
            phasors.begin();
        }
    }
    if taken.is_empty() {
        let fault = phasors.reading(&config, 0).err();
        let until = start + vibration.len() as f64 * period;
        taken.extend(fault.map(|fault| Taken { until, speed: None, measured: Err(fault), refused: Some(fault) }));
    }
    Ok(taken)
}

/// Where the angle (rad) stands as the mark passes, on average, whether or not it comes round between two samples; none
/// where it is at no one place, or passes more than once a turn: two marks, or a shaft's angle behind a gear.
pub fn zero(angle: &[f64], marks: &[(usize, f64)]) -> Option<f64> {
    let step = |row: usize| (angle[row] - angle[row - 1] + PI).rem_euclid(TAU) - PI;
    let at = |(row, since): &(usize, f64)| angle[*row] - since * step(*row);
    let turns = (1..angle.len()).map(step).sum::<f64>().abs() / TAU;
    if marks.len() as f64 > turns + 2.0 {
        return None;
    }
    let sum: Complex<f64> = marks.iter().map(at).map(|angle| Complex::from_polar(1.0, angle)).sum();
    // a scatter of a quarter of a radian leaves 0.97
    (sum.norm() > 0.97 * marks.len() as f64).then_some(sum.arg())
}

/// Mean of the readings that are to be used, and the largest distance of one from it.
pub fn mean(taken: &[Taken]) -> Option<(Complex<f64>, f64)> {
    let phasors: Vec<Complex<f64>> = taken.iter().filter_map(Taken::phasor).collect();
    let mean = phasors.iter().sum::<Complex<f64>>() / phasors.len() as f64;
    let apart = phasors.iter().map(|phasor| (phasor - mean).norm()).fold(0.0, f64::max);
    (!phasors.is_empty()).then_some((mean, apart))
}
