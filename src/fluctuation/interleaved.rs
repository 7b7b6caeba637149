//! Waveform and extremes together, their work spread so that no tick does that of both.
//!
//! In a pair each part takes its slice of work in the same ticks. Here of four ticks two look at the speeds, one does a
//! slice of the waveform's work, and one a slice of the extremes'. Each end of a cycle takes twice as long: a cycle,
//! and a turn of a longer one, must have 160 ticks.

use super::{Extremes, Fluctuation, Ranked, Summed, Waveform, WaveformConfig};
use crate::sample::Estimate;

/// [`Waveform`] and [`Extremes`] of the same cycle, at less than the cost of the pair.
///
/// ```
#[doc = include_str!("ripple.txt")]
/// const CONFIG: WaveformConfig = WaveformConfig::new::<32>(CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI), 4);
/// let mut both = Interleaved::<32, f64>::default();
/// for (angle, motor_speed) in turning().take(4_000) {
///     both.measure(&CONFIG, angle, 0.0, &Estimate { motor_speed, ..Estimate::default() });
/// }
/// // two measurements of one ripple of 4 %
/// let turn = both.extremes().reading(&CONFIG.cycle).map(|turn| turn.motor.delta);
/// let four = both.waveform_mut().take().and_then(|window| window.ripple(&CONFIG, 4).ok());
/// for delta in [turn, four.map(|ripple| ripple.motor.delta)] {
///     assert!(delta.is_some_and(|delta| (delta - 0.04).abs() < 1e-3));
/// }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Interleaved<const BINS: usize, N: Summed + Ranked = f32> {
    waveform: Waveform<BINS, N>,
    extremes: Extremes<N>,
}

impl<N: Summed + Ranked, const BINS: usize> Fluctuation<N> for Interleaved<BINS, N> {
    type Config = WaveformConfig;

    #[inline(always)]
    fn measure(&mut self, config: &WaveformConfig, angle: u32, torque: N, estimate: &Estimate<N>) {
        let tick = self.waveform.next_tick();
        if tick & 1 == 0 {
            self.extremes.look(tick & 2 != 0, angle, estimate);
        } else if tick & 2 != 0 && !(self.extremes.is_taking() && self.waveform.is_watching()) {
            self.waveform.slice(config, angle, tick, estimate);
        } else {
            self.extremes.slice(&config.cycle, angle, tick, estimate);
        }
        self.waveform.fill(config, angle, torque);
    }

    fn disturb(&mut self) {
        self.waveform.disturb();
        self.extremes.disturb();
    }
}

impl<N: Summed + Ranked, const BINS: usize> Interleaved<BINS, N> {
    /// The waveform, to take its finished windows.
    pub fn waveform_mut(&mut self) -> &mut Waveform<BINS, N> {
        &mut self.waveform
    }

    /// The extremes; their constants are those of the waveform's cycle.
    pub fn extremes(&self) -> &Extremes<N> {
        &self.extremes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fluctuation::CycleConfig;
    use crate::sample::Estimate;
    use crate::settings::{Bases, Cycle};

    const CYCLE: CycleConfig = CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI);
    const CONFIG: WaveformConfig = WaveformConfig::new::<32>(CYCLE, 16);

    /// Of four ticks the first is a slice of the extremes' work, the third one of the waveform's.
    #[test]
    fn ticks_take_turns() {
        let estimate = Estimate { motor_speed: 3.0, load_speed: 2.0, ..Estimate::default() };
        let (mut both, mut extremes) = (Interleaved::<32, f32>::default(), Extremes::default());
        for tick in 1..=8 {
            both.measure(&CONFIG, 7, 0.0, &estimate);
            match tick % 4 {
                1 => extremes.slice(&CYCLE, 7, tick, &estimate),
                2 => extremes.look(true, 7, &estimate),
                3 => {}
                _ => extremes.look(false, 7, &estimate),
            }
            assert_eq!(both.extremes, extremes, "{tick}");
            // from its first slice on
            assert_eq!(both.waveform.is_watching(), tick >= 3, "{tick}");
        }
    }

    /// From rest anywhere, in both directions: no window and no reading before a whole turn, and each of them right.
    #[test]
    #[cfg_attr(miri, ignore = "an interpreter takes half an hour")]
    fn the_first_turn_may_begin_anywhere() {
        for (start, sign) in (0..64).flat_map(|start| [(start, 1.0), (start, -1.0)]) {
            let mut both = Interleaved::<32, f32>::default();
            let (begin, mut windows) = (core::f64::consts::TAU * (f64::from(start) + 0.7) / 64.0, 0);
            let (mut phi, mut mean) = (begin, 0.0_f64);
            for tick in 0..30_000 {
                // at rest for a while, then up to its speed in 0.2 s
                mean = if tick < 123 { 0.0 } else { (mean + 150.0 / 2000.0).min(150.0) };
                let speed = sign * mean * (1.0 + 0.01 * (2.0 * phi).cos());
                let estimate = Estimate { motor_speed: speed as f32, load_speed: speed as f32, ..Estimate::default() };
                phi += 1e-4 * speed;
                let angle = (phi / core::f64::consts::TAU).rem_euclid(1.0) * 4_294_967_296.0;
                both.measure(&CONFIG, angle as u32, 0.0, &estimate);
                let has_turned = (phi - begin).abs() / core::f64::consts::TAU;
                if let Some(turn) = both.extremes().reading(&CYCLE) {
                    assert!(has_turned > 1.0, "{start}, {sign}: {turn:?} after {has_turned} turns");
                    // a turn of the run-up has a mean between rest and 150 rad/s
                    let mean = sign * f64::from(turn.mean);
                    assert!(mean > 0.0 && mean < 150.1, "{start}, {sign}: {turn:?}");
                }
                if let Some(window) = both.waveform_mut().take() {
                    windows += 1;
                    let Ok(ripple) = window.ripple(&CONFIG, 4) else {
                        // a window with a run-up in it
                        assert_eq!(windows, 1);
                        continue;
                    };
                    let mean = sign * f64::from(ripple.mean);
                    assert!(mean > 0.0 && mean < 150.1, "{start}, {sign}: {ripple:?}");
                    if windows > 1 {
                        assert!((ripple.motor.delta - 0.02).abs() < 1e-4, "{start}, {sign}: {ripple:?}");
                    }
                }
            }
            assert!(windows >= 2, "{start}, {sign}: {windows}");
        }
    }

    /// As few ticks to a turn as there may be, of both alone and together, in both directions and from anywhere.
    #[test]
    fn a_turn_may_have_few_ticks() {
        fn run<F: Fluctuation<f32> + Default>(
            config: &F::Config,
            ticks: f64,
            reading: fn(&F) -> Option<crate::fluctuation::CycleReading<f32>>,
        ) {
            // an interpreter takes a thousand times as long
            let (every, last) = if cfg!(miri) { (49, 1_502) } else { (1, 3_000) };
            for (start, sign) in (0..50).step_by(every).flat_map(|start| [(start, 1.0), (start, -1.0)]) {
                let (mut measured, w) = (F::default(), core::f64::consts::TAU / ticks / 1e-4);
                let mut phi = core::f64::consts::TAU * (f64::from(start) + 0.7) / 50.0;
                for tick in 0..last {
                    let speed = sign * w * (1.0 + 0.01 * phi.cos());
                    let estimate =
                        Estimate { motor_speed: speed as f32, load_speed: speed as f32, ..Estimate::default() };
                    phi += 1e-4 * speed;
                    let angle = (phi / core::f64::consts::TAU).rem_euclid(1.0) * 4_294_967_296.0;
                    measured.measure(config, angle as u32, 0.0, &estimate);
                    // found by then: eight turns and more
                    if tick > 1_500 {
                        let turn = reading(&measured).unwrap();
                        // a thousandth of the swing's angle, and the parabola's 0.06 % with 24 samples to a period
                        assert!(
                            (f64::from(turn.mean) / (sign * w) - 1.0).abs() < 1e-4,
                            "{ticks}, {start}, {sign}: {turn:?}"
                        );
                        assert!((turn.motor.delta - 0.02).abs() < 1e-4, "{ticks}, {start}, {sign}: {turn:?}");
                    }
                }
            }
        }
        run::<crate::fluctuation::Extremes<f32>>(&CYCLE, 96.0, |one| one.reading(&CYCLE));
        run::<Interleaved<32>>(&CONFIG, 160.0, |both| both.extremes().reading(&CYCLE));
    }

    /// An angle that is lost as the end of a segment is being dealt with: no turn of it is a reading.
    #[test]
    fn a_turn_with_a_gap_is_none() {
        let every = if cfg!(miri) { 420 } else { 1 };
        for (begin, gap) in (2_000..2_420).step_by(every).flat_map(|begin| [110, 150, 190, 260].map(|gap| (begin, gap)))
        {
            let mut both = Interleaved::<32, f32>::default();
            for tick in 0..4_000_u32 {
                let phi = 0.015 * f64::from(tick);
                let angle = (phi / core::f64::consts::TAU).fract() * 4_294_967_296.0;
                // a quarter of a turn to 0.6
                if (begin..begin + gap).contains(&tick) {
                    both.disturb();
                    continue;
                }
                let estimate = Estimate { motor_speed: 150.0, load_speed: 150.0, ..Estimate::default() };
                both.measure(&CONFIG, angle as u32, 0.0, &estimate);
                if let Some(turn) = both.extremes().reading(&CYCLE) {
                    // single precision of a sum of ticks
                    assert!((turn.mean - 150.0).abs() < 1e-3, "{begin}, {gap}, {tick}: {turn:?}");
                }
            }
            assert!(both.extremes().reading(&CYCLE).is_some(), "{begin}, {gap}");
        }
    }

    /// A motor at 2 % from peak to peak twice a turn, its load at half of it: closed forms. 419 ticks on a turn.
    /// Windows that are asked for in every tick, an angle that is lost for a while, and both directions.
    #[test]
    #[cfg_attr(miri, ignore = "an interpreter takes half an hour")]
    fn waveform_and_extremes_are_those_of_the_speed() {
        for sign in [1.0, -1.0] {
            let mut both = Interleaved::<32, f32>::default();
            let (mut phi, mut windows) = (0.0_f64, 0);
            for tick in 0..40_000 {
                let speed = |share: f64| sign * 150.0 * (1.0 + share * (2.0 * phi).cos());
                let estimate = Estimate {
                    motor_speed: speed(0.01) as f32,
                    load_speed: speed(0.005) as f32,
                    ..Estimate::default()
                };
                phi += 1e-4 * speed(0.01);
                let angle = (phi / core::f64::consts::TAU).rem_euclid(1.0) * 4_294_967_296.0;
                if (9_000..9_100).contains(&tick) {
                    both.disturb();
                    continue;
                }
                both.measure(&CONFIG, angle as u32, 0.0, &estimate);
                if let Some(window) = both.waveform_mut().take() {
                    windows += 1;
                    let ripple = window.ripple(&CONFIG, 4).unwrap();
                    // As the waveform alone, whose figures are in the text of `fluctuation`.
                    assert!((ripple.motor.delta - 0.02).abs() < 1e-4, "{}", ripple.motor.delta);
                    assert!((ripple.speed.order(2).amplitude() - 1.5).abs() < 0.01);
                }
            }
            // 94 turns: 21 before the angle is lost, 72 after it. Windows of 16 begin a turn after the last.
            assert_eq!(windows, 1 + 4);
            let turn = both.extremes().reading(&CYCLE).unwrap();
            // The vertex of the parabola: 0.06 % of the amplitude with 64 ticks to a period, here 209.
            assert!((turn.motor.delta - 0.02).abs() < 2e-5, "{turn:?}");
            assert!((turn.load.delta - 0.01).abs() < 2e-5, "{turn:?}");
            assert!((f64::from(turn.mean) - sign * 150.0).abs() < 0.05, "{turn:?}");
        }
    }
}
