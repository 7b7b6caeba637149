//! The phasor of each vibration channel, by integration over the rotor's angle.

use super::reading::{Edge, Reading};
use super::{Balancer, PhasorsConfig, ReadingFault, Steadiness};
use crate::angle::Passed;
use crate::angle::{RotorAngle, Synchronous};
use crate::fault::Faults;

/// A measurement of `CHANNELS` channels that ends after `EDGES - 1` blocks, and the reading until the next one is
/// begun.
///
/// The integral of `v e^{-i theta}` over the angle is the sum of `v` times the change of `e^{-i theta}` over each tick:
/// no multiplication by the step, and no time in it, so a swing of the speed changes nothing, and a constant vanishes
/// exactly over a turn. Where a block of turns ends the tick is cut at the rotor's zero: `e^{-i theta}` is one there,
/// so the fraction of the tick at either end costs no division. The hold of a sample over the tick before it is
/// corrected when the reading is taken, with the mean step.
///
/// The sums run on; at the end of each block of turns they are noted down. Divisions are left to [`Phasors::reading`].
///
/// ```
/// use driveline::balancing::{Balancer, Phasors, PhasorsConfig};
/// use driveline::settings::PhasorSettings;
/// // one sensor of a range of 1 mm/s, eight blocks of eight turns
/// static CONFIG: PhasorsConfig<f64, 1> = PhasorsConfig::<f64, 1>::new(&PhasorSettings::DIRECT, [1e-3]);
/// let mut phasors = Phasors::<1, 9, f64>::default();
/// phasors.begin();
/// let mut ticks = 0;
/// while !phasors.is_complete() {
///     ticks += 1;
///     let turn = f64::from(ticks) / 200.0; // 200 ticks a turn, 0.5 mm/s, greatest a quarter of a turn behind the zero
///     let vibration = 0.5e-3 * (core::f64::consts::TAU * (turn - 0.25)).cos();
///     phasors.measure(&CONFIG, ((turn % 1.0) * 4_294_967_296.0) as u32, &[vibration]);
/// }
/// let reading = phasors.reading(&CONFIG, 0)?;
/// assert!((reading.phasor.amplitude() - 0.5e-3).abs() < 1e-6 && reading.phasor.im < 0.0 && reading.turns == 64);
/// # Ok::<(), driveline::balancing::ReadingFault>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("vibration analysis", "synchronous averaging", "unbalance"))]
pub struct Phasors<const CHANNELS: usize, const EDGES: usize, N: Synchronous = f32> {
    turning: RotorAngle,
    /// Cosine and sine of the rotor's angle at the last tick.
    direction: [N::Part; 2],
    sums: [[N::Sum; 2]; CHANNELS],
    ticks: u32,
    /// Zeros to pass until the next edge; runs on where the reading is complete.
    left: u32,
    /// Edges noted down.
    noted: u32,
    /// The last sample of each channel that was clipped or no number; zero for none.
    clipped: [N; CHANNELS],
    /// Ticks without a sound sample.
    missing: u32,
    /// Times that the rotor passed its zero backwards.
    back: u32,
    edges: [Edge<N, CHANNELS>; EDGES],
}

impl<N: Synchronous, const CHANNELS: usize, const EDGES: usize> Default for Phasors<CHANNELS, EDGES, N> {
    fn default() -> Self {
        Phasors {
            turning: RotorAngle::default(),
            direction: N::AHEAD,
            sums: [[N::Sum::default(); 2]; CHANNELS],
            ticks: 0,
            left: 1,
            noted: 0,
            clipped: [N::ZERO; CHANNELS],
            missing: 0,
            back: 0,
            edges: [Edge::default(); EDGES],
        }
    }
}

impl<N: Synchronous, const CHANNELS: usize, const EDGES: usize> Balancer<N> for Phasors<CHANNELS, EDGES, N> {
    type Config = PhasorsConfig<N, CHANNELS>;
    type Vibration = [N; CHANNELS];

    #[inline(always)]
    fn measure(&mut self, config: &Self::Config, angle: u32, vibration: &[N; CHANNELS]) {
        for ((sample, limit), clipped) in vibration.iter().zip(&config.limits).zip(&mut self.clipped) {
            if sample.exceeds(*limit) {
                *clipped = *sample;
            }
        }
        let passed = self.turning.advance(&config.turning, angle);
        let (ticks, left) = (self.ticks.wrapping_add(1), self.left);
        // In every tick, so that both are one store.
        (self.ticks, self.left) = (ticks, left.wrapping_sub(u32::from(passed == Passed::Zero)));
        if passed != Passed::Not {
            if passed == Passed::Astray {
                return self.restart();
            }
            if self.left == 0 {
                let noted = self.noted;
                // complete: later samples are in no block
                let Some(edge) = self.edges.get_mut(noted as usize) else { return };
                // The tick ends at the zero; the next one takes over the rest, so no tick does the work of two.
                (self.left, self.noted) = (config.block, noted + 1);
                let sums = added(&self.sums, vibration, N::AHEAD, self.direction);
                self.sums = sums;
                *edge = Edge { sums, ticks, past: self.turning.units() };
                self.direction = N::AHEAD;
                return;
            }
        }
        let direction = N::direction(self.turning.direction(&config.turning));
        self.sums = added(&self.sums, vibration, direction, self.direction);
        self.direction = direction;
    }

    /// The next sample stands for the gap; a reading with one in it is rejected. A complete one stays.
    fn missed(&mut self, faults: Faults) {
        if self.is_complete() {
            return;
        }
        if faults.contains(Faults::VIBRATION_CLIPPED) {
            self.clipped = [N::ONE; CHANNELS];
        } else {
            self.missing = self.missing.saturating_add(1);
        }
    }
}

/// The sums and each sample times the change of direction.
#[inline(always)]
fn added<N: Synchronous, const CHANNELS: usize>(
    sums: &[[N::Sum; 2]; CHANNELS],
    samples: &[N; CHANNELS],
    to: [N::Part; 2],
    from: [N::Part; 2],
) -> [[N::Sum; 2]; CHANNELS] {
    let change = [N::change(to[0], from[0]), N::change(to[1], from[1])];
    let mut after = *sums;
    for (sum, sample) in after.iter_mut().zip(samples) {
        *sum = [sample.added(sum[0], change[0]), sample.added(sum[1], change[1])];
    }
    after
}

impl<N: Synchronous, const CHANNELS: usize, const EDGES: usize> Phasors<CHANNELS, EDGES, N> {
    /// Begins a new reading at the rotor's next zero and discards the old one.
    pub fn begin(&mut self) {
        self.sums = [[N::Sum::default(); 2]; CHANNELS];
        self.ticks = 0;
        self.clipped = [N::ZERO; CHANNELS];
        self.missing = 0;
        self.back = 0;
        (self.noted, self.left) = (0, 1);
    }

    /// Sets the rotor's angle (2^-32 turn) at an angle of the motor (2^-32 turn), as an index mark on the rotor shows
    /// it, and begins a new reading.
    ///
    /// An incremental encoder has its zero where it was switched on; without this, so has the phase.
    pub fn align(&mut self, config: &PhasorsConfig<N, CHANNELS>, motor: u32, angle: u32) {
        self.turning.set_at(&config.turning, motor, angle);
        self.direction = N::direction(self.turning.direction(&config.turning));
        self.begin();
    }

    /// The rotor's angle, times the order (2^-32 turn).
    pub fn angle(&self, config: &PhasorsConfig<N, CHANNELS>) -> u32 {
        self.turning.angle(&config.turning)
    }

    /// Ticks since the reading was begun, with those without a sound sample; runs on where it is complete.
    pub fn ticks(&self) -> u32 {
        self.ticks.wrapping_add(self.missing)
    }

    /// Blocks measured so far, `EDGES - 1` of them when the reading is complete.
    pub fn blocks(&self) -> u32 {
        self.noted.saturating_sub(1)
    }

    /// Whether the reading is complete. It may still be one that [`Phasors::reading`] refuses.
    pub fn is_complete(&self) -> bool {
        self.noted as usize == EDGES
    }

    /// The phasor of a channel and how far it is to be trusted.
    ///
    /// # Errors
    /// [`ReadingFault`]: why this reading cannot be used. The measurement goes on or stands;
    /// [`Phasors::begin`] begins another.
    pub fn reading(&self, config: &PhasorsConfig<N, CHANNELS>, channel: usize) -> Result<Reading, ReadingFault> {
        self.reading_within(config, channel, &config.steadiness)
    }

    /// The same within other limits.
    pub(crate) fn reading_within(
        &self,
        config: &PhasorsConfig<N, CHANNELS>,
        channel: usize,
        steadiness: &Steadiness,
    ) -> Result<Reading, ReadingFault> {
        if self.back > 0 && !self.is_complete() {
            return Err(ReadingFault::Backwards { times: self.back });
        }
        if !self.is_complete() || EDGES < 2 {
            let turns = self.blocks() * config.block;
            return Err(ReadingFault::Incomplete { turns, of: (EDGES as u32).saturating_sub(1) * config.block });
        }
        let clipped = *self.clipped.get(channel).ok_or(ReadingFault::NoChannel)? != N::ZERO;
        let reading = Reading::between(&self.edges, channel, config)?;
        if self.missing > 0 && !clipped {
            return Err(ReadingFault::Missing { samples: self.missing });
        }
        reading.accept(clipped, steadiness)
    }

    /// The same, whatever its quality: for a display, or to judge otherwise.
    ///
    /// # Errors
    /// [`ReadingFault::Incomplete`], [`ReadingFault::NoChannel`], [`ReadingFault::TooFast`].
    pub fn unjudged(&self, config: &PhasorsConfig<N, CHANNELS>, channel: usize) -> Result<Reading, ReadingFault> {
        if !self.is_complete() {
            return self.reading(config, channel);
        }
        Reading::between(&self.edges, channel, config)
    }

    #[inline(always)]
    fn restart(&mut self) {
        if (self.noted as usize) < EDGES {
            (self.noted, self.left) = (0, 1);
            self.back = self.back.wrapping_add(1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::PhasorSettings;

    /// Sixteen ticks on a turn, begun a sixteenth after the zero, with nothing to measure.
    fn turned<const EDGES: usize>(ticks: u32) -> (Phasors<1, EDGES, f64>, PhasorsConfig<f64, 1>) {
        let mut config = PhasorsConfig::<f64, 1>::new(&PhasorSettings::DIRECT, [1.0]);
        config.block = 3;
        let mut phasors = Phasors::default();
        for tick in 1..=ticks {
            phasors.measure(&config, tick << 28, &[0.0]);
        }
        (phasors, config)
    }

    /// The first zero after 16 ticks, blocks of three turns every 48.
    #[test]
    fn blocks_are_counted() {
        let (phasors, config) = turned::<4>(16 + 2 * 48 + 1);
        assert_eq!(phasors.blocks(), 2);
        let incomplete = Err(ReadingFault::Incomplete { turns: 6, of: 9 });
        assert_eq!(phasors.reading(&config, 0), incomplete);
        assert_eq!(phasors.unjudged(&config, 0), incomplete);
    }

    /// The rotor on the motor's shaft is where the motor is, or as far from it as an index mark showed.
    #[test]
    fn the_rotor_is_where_its_mark_says() {
        let (mut phasors, config) = turned::<4>(16 + 48 + 3);
        // a turn is counted in 2^26 units, rounded down
        let is_at = |phasors: &Phasors<1, 4, f64>, angle: u32| angle - phasors.angle(&config) <= 64;
        assert!(is_at(&phasors, 3 << 28) && phasors.blocks() == 1);
        phasors.align(&config, 3 << 28, 8 << 28);
        // and the reading begins anew
        assert!(is_at(&phasors, 8 << 28) && phasors.blocks() == 0);
        phasors.measure(&config, 4 << 28, &[0.0]);
        assert!(is_at(&phasors, 9 << 28));
    }

    /// One block is a reading, and stays when the rotor turns back.
    #[test]
    fn a_complete_reading_stays() {
        let (mut phasors, config) = turned::<2>(16 + 48 + 1);
        let measured = |reading: Result<Reading, ReadingFault>| reading.map(|reading| (reading.turns, reading.ticks));
        assert_eq!(measured(phasors.reading(&config, 0)), Ok((3, 16.0)));
        assert_eq!(measured(phasors.unjudged(&config, 0)), Ok((3, 16.0)));
        for tick in [64_u32, 63, 62] {
            phasors.measure(&config, tick.wrapping_shl(28), &[0.0]);
        }
        assert_eq!(measured(phasors.reading(&config, 0)), Ok((3, 16.0)));
    }

    /// A rotor that passes its zero backwards twice has no reading, and says how often. A new one knows nothing of that,
    /// nor of clipped and missing samples.
    #[test]
    fn a_new_reading_forgets_the_old_one() {
        let (mut phasors, config) = turned::<2>(17);
        for tick in [15_u32, 17, 15] {
            phasors.measure(&config, tick << 28, &[2.0]);
        }
        phasors.missed(Faults::NONE);
        assert_eq!(phasors.reading(&config, 0), Err(ReadingFault::Backwards { times: 2 }));
        assert_eq!((phasors.blocks(), phasors.ticks()), (0, 21));
        phasors.begin();
        assert_eq!(phasors.ticks(), 0);
        assert_eq!(phasors.reading(&config, 0), Err(ReadingFault::Incomplete { turns: 0, of: 3 }));
        for tick in 16..=16 + 48_u32 {
            phasors.measure(&config, tick.wrapping_shl(28), &[0.5]);
        }
        let reading = phasors.reading(&config, 0).map(|reading| (reading.turns, reading.ticks));
        assert_eq!(reading, Ok((3, 16.0)));
    }
}
