//! Data and bounds of the test.

use core::f64::consts::TAU;

use super::Error;
use crate::design::{Encoder, Rate};

/// Data and bounds of the test, referred to the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TestSettings {
    /// Ticks a second.
    pub rate: Rate,
    /// The encoder on the motor.
    pub encoder: Encoder,
    /// The most that the motor's torque may differ from `held` (N m); no more than `shaft_torque` leaves beside
    /// `held` is given, and half of that before the multisine, so that a load that is seized is not strained either.
    pub torque: f64,
    /// Largest shaft torque during the test, the holding torque included (N m): half of rated torque as a rule.
    pub shaft_torque: f64,
    /// Speed of the test (rad/s): eight turns in an hour at least; the motor's own swing stays below it.
    pub speed: f64,
    /// How far the motor may turn to either side of where it starts (rad).
    pub travel: f64,
    /// Torque that holds the load at the start (N m), to within `torque`; 0 for a load without weight.
    pub held: f64,
    /// First guess of the total inertia (kg m2), within a factor of two; the motor's, where no more is known.
    pub inertia: f64,
    /// Where the resonance and the antiresonance are looked for (Hz).
    pub band: [f64; 2],
    /// Standard deviation of the motor's torque from the command in a tick (N m).
    pub torque_accuracy: f64,
    /// Time from the sample to when the torque that it gives rise to begins to act (s): 0 where it acts at once.
    pub delay: f64,
}

/// Share of the room that a steady torque may take: a load that is seized would swing the shaft about it.
const STEADY: f64 = 0.5;

/// A lag that alone takes this share of the torque means that the motor does not follow.
const LAG: f64 = 0.5;

/// Longest run-up (s), and longest time for the eight turns that the encoder's test needs.
const LONGEST: [f64; 2] = [1_800.0, 3_600.0];

/// The most that the swing's watch takes for an acceleration, per radian of error and block^2: the sum of the sizes of
/// its impulse response.
const RINGING: f64 = 0.043;

/// Largest eccentricity of an encoder (rad): half a degree.
const ECCENTRIC: f64 = 0.01;

/// Blocks in a period of the band's upper end, at least.
const BLOCKS: f64 = 12.0;

/// The constants of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TestConfig {
    /// The settings that it was made from.
    pub(crate) settings: TestSettings,
    /// Time between two ticks (s).
    pub(crate) period: f64,
    /// Ticks in a block: angles are summed and the torque held over it.
    pub(crate) ticks: u32,
    /// Duration of a block (s).
    pub(crate) block: f64,
    /// The same, as the tick takes it.
    pub(crate) block_f32: f32,
    /// Radians in 2^-32 turn, over the ticks of a block.
    pub(crate) unit: f32,
    /// 2^-32 turns in a radian.
    pub(crate) units: f32,
    /// Largest plausible turn in a tick (2^-32 turn).
    pub(crate) jump: u32,
    /// Most that the motor may lag behind the reference (rad).
    pub(crate) lag: f32,
    /// Largest deviation from the holding torque (N m): under the multisine, and before.
    pub(crate) most: [f64; 2],
    /// The travel (2^-32 turn).
    pub(crate) travel: i64,
    /// Resolution of the encoder (rad).
    pub(crate) resolution: f64,
    /// Natural frequency of the servo (rad/s): a sixth of the band's lower end, and below a tenth of the torque's
    /// reach.
    pub(crate) servo: f64,
    /// Rate of change of the speed (rad/s2).
    pub(crate) acceleration: f64,
    /// Shaft torque beyond which it swings (N m): the largest one, and what the encoder may seem to add.
    pub(crate) swing: f32,
}

/// Finite in `f32` too, since the tick uses `f32`.
const fn finite(value: f64) -> bool {
    (value as f32).is_finite()
}

const fn positive(value: f64) -> bool {
    value > 0.0 && finite(value)
}

impl TestConfig {
    /// The constants of a test.
    ///
    /// # Errors
    /// The first setting that is out of range.
    pub const fn try_new(settings: &TestSettings) -> Result<Self, Error> {
        let Ok(period) = settings.rate.period() else { return Err(Error::Rate) };
        let Ok(resolution) = settings.encoder.resolution() else { return Err(Error::EncoderLines) };
        let [low, high] = settings.band;
        if resolution < TAU / 2_147_483_648.0 {
            return Err(Error::EncoderCounts);
        }
        if settings.encoder.variance().is_err() {
            return Err(Error::EncoderAccuracy);
        }
        if !positive(settings.torque) {
            return Err(Error::Torque);
        }
        if !finite(settings.held) {
            return Err(Error::Held);
        }
        if !(settings.shaft_torque > settings.held.abs() && finite(settings.shaft_torque)) {
            return Err(Error::ShaftTorque);
        }
        let [run_up, turns] = LONGEST;
        if !(settings.speed * turns >= 8.0 * TAU && settings.speed * period < 0.25 * TAU) {
            return Err(Error::Speed);
        }
        if !positive(settings.travel) || settings.travel > 1.0e9 {
            return Err(Error::Travel);
        }
        if !(positive(settings.inertia) && finite(1.0 / settings.inertia)) {
            return Err(Error::Inertia);
        }
        if !(low >= 0.01 && high > low && high * period <= 0.1) {
            return Err(Error::Band);
        }
        if !positive(settings.torque_accuracy) {
            return Err(Error::TorqueAccuracy);
        }
        if !(settings.delay >= 0.0 && settings.delay.is_finite()) {
            return Err(Error::Delay);
        }
        // A cast to an integer saturates, and the settings are in range.
        let ticks = 1.0 / (BLOCKS * high * period);
        let ticks = if ticks > 500.0 {
            500
        } else if ticks < 1.0 {
            1
        } else {
            ticks as u32
        };
        let block = ticks as f64 * period;
        let room = settings.shaft_torque - settings.held.abs();
        let most = if room < settings.torque { room } else { settings.torque };
        let slow = if STEADY * room < most { STEADY * room } else { most };
        let acceleration = 0.15 * most / settings.inertia;
        if !(acceleration * run_up >= settings.speed && acceleration.is_finite()) {
            return Err(Error::Torque);
        }
        let servo = TAU * low / 6.0;
        let turn = 4_294_967_296.0;
        // the largest turn in a tick: three times the speed, and eight counts
        let jump = (3.0 * settings.speed * period + 8.0 * resolution) / TAU * turn;
        let seeming = RINGING * 0.5 * resolution / (block * block) + ECCENTRIC * settings.speed * settings.speed;
        Ok(Self {
            settings: *settings,
            period,
            ticks,
            block,
            block_f32: block as f32,
            unit: (TAU / turn / ticks as f64) as f32,
            units: (turn / TAU) as f32,
            jump: jump as u32,
            lag: (LAG * slow / (settings.inertia * servo * servo)) as f32,
            most: [most, slow],
            travel: (settings.travel / TAU * turn) as i64,
            resolution,
            servo,
            acceleration,
            swing: (settings.shaft_torque + settings.inertia * seeming) as f32,
        })
    }

    /// The settings that it was made from.
    #[must_use]
    pub const fn settings(&self) -> &TestSettings {
        &self.settings
    }

    /// Blocks in a time (s), at least one.
    pub(crate) fn blocks(&self, time: f64) -> u32 {
        ((time / self.block) as u32).max(1)
    }

    /// Shaft torque available beside the held load (N m).
    pub(crate) fn room(&self, static_torque: f64) -> f64 {
        (self.settings.shaft_torque - static_torque.abs()).max(0.0)
    }
}
