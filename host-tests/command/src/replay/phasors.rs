//! The library's phasors over a recorded vibration: reading after reading.

use std::f64::consts::TAU;

use driveline::angle::OncePerTurn;
use driveline::balancing::{Balancer, Phasors, PhasorsConfig, Reading, ReadingFault};
use driveline::settings::{PhasorError, PhasorSettings};
use nalgebra::Complex;

/// Blocks of a reading, and one edge more.
const EDGES: usize = 6;

/// What tells the rotor's angle.
#[derive(Clone, Copy, Debug)]
pub enum Turning<'r> {
    /// Its angle \[rad\].
    Angle(&'r [f64]),
    /// The samples that first show a mark.
    Marks(&'r [usize]),
}

/// A reading with its place in the recording.
#[derive(Clone, Debug)]
pub struct Taken {
    /// Sample that ends it.
    pub until: usize,
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

/// All readings, and the last one that the recording's end cut off, refused as incomplete where there is no other.
///
/// # Errors
/// Settings that the library refuses.
pub fn readings(
    vibration: &[f64],
    turning: Turning<'_>,
    settings: &PhasorSettings,
    range: f64,
) -> Result<Vec<Taken>, PhasorError> {
    let config = PhasorsConfig::<f32, 1>::try_new(settings, [range])?;
    let mut phasors = Phasors::<f32, 1, EDGES>::default();
    let (mut tacho, mut taken, mut marks) = (OncePerTurn::new(), Vec::new(), 0);
    let mut was_lost = false;
    for (at, &value) in vibration.iter().enumerate() {
        let angle = match turning {
            Turning::Angle(angle) => Some(((angle[at] / TAU).rem_euclid(1.0) * 4_294_967_296.0) as u64 as u32),
            Turning::Marks(rows) => {
                let passes = rows.get(marks) == Some(&at);
                marks += usize::from(passes);
                // between two samples: half a tick ago on average
                tacho.tick(passes.then_some(1 << 31))
            }
        };
        let Some(angle) = angle else {
            was_lost = true;
            continue;
        };
        if std::mem::take(&mut was_lost) {
            phasors.begin();
        }
        phasors.measure(&config, angle, &[value as f32]);
        if phasors.is_complete() {
            let refused = phasors.reading(&config, 0).err();
            taken.push(Taken { until: at, measured: phasors.unjudged(&config, 0), refused });
            phasors.begin();
        }
    }
    if taken.is_empty() {
        let fault = phasors.reading(&config, 0).err();
        taken.extend(fault.map(|fault| Taken { until: vibration.len(), measured: Err(fault), refused: Some(fault) }));
    }
    Ok(taken)
}

/// Mean of the readings that are to be used, and the largest distance of one from it.
pub fn mean(taken: &[Taken]) -> Option<(Complex<f64>, f64)> {
    let phasors: Vec<Complex<f64>> = taken.iter().filter_map(Taken::phasor).collect();
    let mean = phasors.iter().sum::<Complex<f64>>() / phasors.len() as f64;
    let apart = phasors.iter().map(|phasor| (phasor - mean).norm()).fold(0.0, f64::max);
    (!phasors.is_empty()).then_some((mean, apart))
}
