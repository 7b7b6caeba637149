//! The job of a stage, solved outside the tick, and the next stage.

use core::f64::consts::TAU;

use super::excitation::{about, lines, over_band, peak, set, time};
use super::figure::Figure;
use super::fit::{Derived, Fit, fit};
use super::friction::{SEGMENTS, Segment};
use super::gap::{PUSH, PUSHES, Push, gap};
use super::harmonic::Harmonic;
use super::multisine::{Line, Window};
use super::result::CommissioningResult;
use super::servo::Servo;
use super::{Eccentricity, Error, Friction, Response, Stage, TestConfig};
use crate::math::sqrt;

/// The next stage.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(
    clippy::large_enum_variant,
    reason = "without allocation the answer has no other place, and there is one of it"
)]
pub(crate) enum Next {
    /// The test of friction.
    Segments,
    /// The test of the encoder.
    Turns,
    /// The test of backlash: with this torque (N m), creeping at this speed (rad/s), no further than this (rad).
    Reversals { torque: f64, speed: f64, widest: f64 },
    /// A record of the multisine: blocks of it and before it, and which way.
    Record { blocks: u32, settle: u32, way: f64 },
    /// There is an answer.
    Done(CommissioningResult),
    /// There is a reason.
    Refused(Error),
}

/// Results so far.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Known<const L: usize> {
    /// The servo's inertia (kg m2).
    pub inertia: f64,
    pub friction: Friction,
    pub eccentricity: Eccentricity,
    /// Cosine and sine part of the eccentricity, from where the test began (rad).
    pub eccentric: [f64; 2],
    gap: Result<Figure, Error>,
    /// Ways that have a fit that is good enough.
    fits: [Option<Fit>; 2],
    /// The last fit that shows a resonance.
    last: Option<Fit>,
    pub responses: [[Response; L]; 2],
    /// Lines of the next record.
    pub lines: [Line; L],
    /// Window of the next measurement.
    pub window: Window,
    /// Records so far, and how long the last one was (s).
    records: u32,
    time: f64,
    /// Amplitude of each line of the records that look for the resonance (N m).
    level: f64,
}

impl<const L: usize> Known<L> {
    pub(crate) fn new(config: &TestConfig) -> Self {
        Self {
            inertia: config.settings.inertia,
            friction: Friction::default(),
            eccentricity: Eccentricity::default(),
            eccentric: [0.0; 2],
            gap: Err(Error::LoadNotHeld),
            fits: [None; 2],
            last: None,
            responses: [[Response::default(); L]; 2],
            lines: [Line::NONE; L],
            window: Window::NONE,
            records: 0,
            time: 0.0,
            level: 0.0,
        }
    }

    /// Inertia on the motor's side (kg m2), as far as it is known.
    pub(crate) fn motor_inertia(&self, config: &TestConfig) -> f64 {
        self.last.map_or(config.settings.inertia, |fit| fit.derived().motor)
    }
}

/// The data of a stage, to be solved outside the tick.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Job<const L: usize> {
    pub(crate) stage: Stage,
    pub(crate) known: Known<L>,
    pub(crate) next: Next,
    pub(crate) lines: [Line; L],
    pub(crate) orders: [Harmonic; 3],
    pub(crate) segments: [Segment; SEGMENTS],
    pub(crate) pushes: [Push; PUSHES],
    pub(crate) mean_speed: f64,
    /// Angle from where the test began, and of that from the encoder's zero (rad).
    pub(crate) angle: f64,
    pub(crate) zero: f64,
}

/// Results of a job.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Findings<const L: usize> {
    pub(crate) known: Known<L>,
    pub(crate) next: Next,
    /// The servo from now on.
    pub(crate) servo: Servo,
}

/// Share of the room that a swing may take: transients come on top.
const SHARE: f64 = 0.6;
/// Records at most.
const RECORDS: u32 = 12;
/// Ratio of variances from which a resonance is significant: by chance less than once in 10,000 with 3 and 40 degrees
/// of freedom [Fisher].
const BELIEVED: f64 = 12.0;
/// Standard deviation of resonance and of the load's inertia: the target, and the largest accepted.
const AIM: [f64; 2] = [0.002, 0.01];
const ENOUGH: [f64; 2] = [0.01, 0.05];
/// Share of the friction that a swing may take where there is a gap: the load's friction holds the flanks together
/// while the motor turns.
const PRELOAD: f64 = 0.63;

impl<const L: usize> Job<L> {
    /// The stage whose data these are.
    #[must_use]
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// Solves it, off the tick: on a Cortex-M4F, without `f64` in hardware, 0.12 and 0.96 million instructions for
    /// friction and encoder, and 163 million for each record.
    #[must_use]
    pub fn solve(&self, config: &TestConfig) -> Findings<L> {
        let mut known = self.known;
        let next = match self.stage {
            Stage::Friction => self.friction(&mut known, config),
            Stage::Encoder => self.encoder(&mut known, config),
            Stage::Backlash => self.backlash(&mut known, config),
            Stage::Resonance => self.resonance(&mut known, config),
            Stage::Holding | Stage::Done | Stage::Refused => self.next,
        };
        let servo = match next {
            Next::Reversals { .. } => Servo::slow(config, known.inertia),
            _ => Servo::new(config, known.inertia),
        };
        Findings { known, next, servo }
    }

    fn friction(&self, known: &mut Known<L>, config: &TestConfig) -> Next {
        match super::friction::fit(&self.segments) {
            Ok(friction) => {
                known.friction = friction;
                known.inertia = friction.inertia.value;
                let needed = f64::from(config.turns()) * config.block * config.settings.speed;
                if needed + self.angle.abs() > 0.8 * config.settings.travel {
                    return Next::Refused(Error::Travel);
                }
                known.window = Window::over(config.turns());
                Next::Turns
            }
            Err(reason) => Next::Refused(reason),
        }
    }

    fn encoder(&self, known: &mut Known<L>, config: &TestConfig) -> Next {
        let blocks = config.turns();
        let (found, parts) =
            super::eccentricity::of(&self.orders, self.mean_speed, known.inertia, config.block, blocks, self.zero);
        known.eccentricity = found;
        // An eccentricity within the noise is not corrected.
        known.eccentric =
            if found.amplitude.value > 3.0 * found.amplitude.standard_deviation { parts } else { [0.0; 2] };
        let friction = &known.friction;
        let (coulomb, weight) = (friction.coulomb, friction.weight.value.abs());
        if weight > coulomb.value.max(config.settings.torque_accuracy) {
            known.gap = Err(Error::Preloaded);
        } else if coulomb.value < 5.0 * coulomb.standard_deviation || coulomb.value < config.settings.torque_accuracy {
            known.gap = Err(Error::LoadNotHeld);
        } else {
            let torque = PUSH * coulomb.value;
            // So slow that the flanks meet with a tenth of the push, for the stiffest shaft whose resonance is in the
            // band.
            let speed = 0.4 * torque / (known.inertia * TAU * config.settings.band[1]);
            return Next::Reversals { torque, speed, widest: WIDEST };
        }
        self.first(known, config)
    }

    fn backlash(&self, known: &mut Known<L>, config: &TestConfig) -> Next {
        known.gap = gap(&self.pushes, WIDEST, config);
        self.first(known, config)
    }

    /// Largest swing of the shaft (N m): within its margin, and with a gap below the friction that keeps the flanks
    /// in contact.
    fn swing(known: &Known<L>, config: &TestConfig) -> f64 {
        let friction = &known.friction;
        let room = SHARE * config.room(friction.weight.value.abs() + friction.coulomb.value.max(0.0));
        match known.gap {
            // One whose ends did not repeat may be there.
            Ok(_) | Err(Error::GapUnclear) => room.min(PRELOAD * friction.coulomb.value),
            Err(_) => room,
        }
    }

    /// The first record: small, over the whole band.
    fn first(&self, known: &mut Known<L>, config: &TestConfig) -> Next {
        let hertz = over_band::<L>(config.settings.band);
        // A tenth of the shaft's swing, were it rigid.
        known.level = 0.1 * Self::swing(known, config) / peak((0..L).map(|_| 1.0));
        known.time = time(&hertz).max(2000.0 * config.block);
        self.search(known, config)
    }

    /// A record over the whole band at the level that has been reached.
    fn search(&self, known: &mut Known<L>, config: &TestConfig) -> Next {
        let hertz = over_band::<L>(config.settings.band);
        let level = known.level;
        self.record(known, config, &hertz, time(&hertz), |_| level)
    }

    /// A record at these frequencies (Hz), the other way than the last one; `needed` (s) separates its lines; half
    /// of that is still accepted.
    fn record(
        &self,
        known: &mut Known<L>,
        config: &TestConfig,
        hertz: &[f64; L],
        needed: f64,
        amplitude: impl Fn(f64) -> f64,
    ) -> Next {
        let way = if known.records.is_multiple_of(2) { 1.0 } else { -1.0 };
        known.records += 1;
        if known.records > RECORDS {
            return Next::Refused(known.last.map_or(Error::Rigid, |_| Error::ResonanceUnclear));
        }
        let steady = 6.0 / config.servo;
        let speed = config.settings.speed;
        // Where there is a fit: five times the time in which a swing decays to 1/e.
        let decay = known.last.map_or(0.3 * known.time, |fit| {
            let derived = fit.derived();
            5.0 / (derived.damping_ratio * derived.resonance).max(1.0e-9)
        });
        let settle = decay.min(known.time).max(steady);
        // Going there, fading out and stopping, and the ramp of a tenth.
        let aside = speed * (settle + steady + 2.0 * speed / config.acceleration);
        let room = config.settings.travel - way * self.angle - aside;
        let most = 0.95 * room / speed;
        if most < 0.5 * needed || most < steady {
            return Next::Refused(Error::TravelTooShort);
        }
        known.time = known.time.min(most);
        let blocks = config.blocks(known.time);
        known.lines = lines(hertz, blocks, config);
        known.window = Window::over(blocks);
        set(&mut known.lines, amplitude);
        Next::Record { blocks, settle: config.blocks(settle), way }
    }

    fn resonance(&self, known: &mut Known<L>, config: &TestConfig) -> Next {
        let Next::Record { blocks, way, .. } = self.next else { return Next::Refused(Error::ResonanceUnclear) };
        let viscous = known.friction.viscous;
        // A friction within its uncertainty counts as none.
        let viscous = if viscous.value > 3.0 * viscous.standard_deviation { viscous.value } else { 0.0 };
        let mut responses = [Response::default(); L];
        for (response, line) in responses.iter_mut().zip(&self.lines) {
            *response = super::response::of(line, config, blocks, viscous);
        }
        let side = usize::from(way < 0.0);
        if let Some(place) = known.responses.get_mut(side) {
            *place = responses;
        }
        let band = config.settings.band;
        let between = match known.last {
            Some(last) => {
                let w = last.derived().resonance;
                [0.85 * w, 1.15 * w]
            }
            None => [TAU * band[0], TAU * band[1]],
        };
        let fitted = fit(&responses, known.inertia, between).filter(|fit| fit.improvement > BELIEVED);
        let Some(fitted) = fitted else { return self.again(known, &responses, config) };
        let [_, _, load, resonance, ..] = fitted.figures();
        if resonance.relative() > 0.05 {
            return self.again(known, &responses, config);
        }
        let was_fine = known.last.is_some();
        if !fitted.within(band) {
            return Next::Refused(Error::ResonanceOutside);
        }
        known.last = Some(fitted);
        let missed = (resonance.relative() / AIM[0]).max(load.relative() / AIM[1]);
        if was_fine {
            let derived = fitted.derived();
            known.inertia = derived.total;
            let enough = resonance.relative() < ENOUGH[0] && load.relative() < ENOUGH[1];
            let last_chance = known.records + 2 > RECORDS;
            if missed <= 1.0 || (enough && last_chance) {
                if let Some(place) = known.fits.get_mut(side) {
                    *place = Some(fitted);
                }
                if let [Some(up), Some(down)] = known.fits {
                    return Self::identify(known, &up, &down);
                }
            } else if last_chance {
                return Next::Refused(if resonance.relative() >= ENOUGH[0] {
                    Error::ResonanceUnclear
                } else {
                    Error::AntiresonanceUnclear
                });
            }
        }
        self.about(known, &fitted, if was_fine { missed } else { 1.0 }, config)
    }

    /// A record about the resonance that is known, as large as the shaft may swing, longer where the last one has
    /// `missed` its aim.
    fn about(&self, known: &mut Known<L>, fitted: &Fit, missed: f64, config: &TestConfig) -> Next {
        let (hertz, needed) = about::<L>(fitted, config.settings.band);
        let longer = (missed * missed).clamp(1.0, 4.0);
        let time = needed.max(2000.0 * config.block).max(known.time * longer);
        known.time = time;
        // Every line swings the shaft alike, but none takes more than three times the mean of the torque.
        let mut probe = lines(&hertz, config.blocks(time), config);
        let even = |frequency: f64| (1.0 / fitted.shaft(frequency)).min(3.0);
        set(&mut probe, even);
        let each = || probe.iter().map(|line| (line.frequency, even(line.frequency)));
        let shaft = peak(each().map(|(w, a)| a * fitted.shaft(w)));
        let torque = peak(each().map(|(_, a)| a));
        let speed = peak(each().map(|(w, a)| a * sqrt(fitted.response(w).square()) / w));
        let level = (Self::swing(known, config) / shaft)
            .min(SHARE * config.most[0] / torque)
            .min(0.6 * config.settings.speed / speed);
        self.record(known, config, &hertz, needed, |frequency| level * even(frequency))
    }

    /// A search that found nothing: larger if the shaft may swing more, else longer.
    fn again(&self, known: &mut Known<L>, responses: &[Response; L], config: &TestConfig) -> Next {
        if let Some(fit) = known.last {
            return self.about(known, &fit, 2.0, config);
        }
        // The shaft carries T - J_m a: no more than the larger of T and T - J a, as measured, noise included.
        let carried = |response: &Response| {
            let [re, im] = response.acceleration;
            let (re, im) = (1.0 - known.inertia * re, known.inertia * im);
            response.torque * sqrt(re * re + im * im).max(1.0)
        };
        let swing = peak(responses.iter().map(carried));
        let torque = peak(responses.iter().map(|response| response.torque));
        let more = (Self::swing(known, config) / swing).min(SHARE * config.most[0] / torque);
        if more > 1.2 {
            known.level *= more.min(4.0);
        } else if known.records < 6 {
            known.time *= 2.0;
        } else {
            return Next::Refused(Error::Rigid);
        }
        self.search(known, config)
    }

    fn identify(known: &Known<L>, up: &Fit, down: &Fit) -> Next {
        let mut mean = [Figure::default(); Derived::COUNT];
        for ((mean, up), down) in mean.iter_mut().zip(up.figures()).zip(down.figures()) {
            *mean = up.mean(down);
        }
        let [total_inertia, motor_inertia, load_inertia, resonance, antiresonance, stiffness, damping, damping_ratio] =
            mean;
        Next::Done(CommissioningResult {
            total_inertia,
            motor_inertia,
            load_inertia,
            resonance,
            antiresonance,
            stiffness,
            damping,
            damping_ratio,
            friction: known.friction,
            gap: known.gap,
            eccentricity: known.eccentricity,
        })
    }
}

/// No gap is wider (rad): a tenth of a turn of the motor.
const WIDEST: f64 = 0.1 * TAU;
