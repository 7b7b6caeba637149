//! Machines that are commissioned: a hoist with a test load, the blooming mill without a bar, the spindle.
//!
//! | machine | state in which it is commissioned |
//! |---|---|
//! | hoist | a quarter of a load (3 t) on the hook, 4 m over the ground: 12 t would take more than half of rated torque at rest |
//! | mill | rolls apart, nothing between them: held by the friction of their bearings |
//! | spindle | with its tool, in the air |
//!
//! The test's data on a machine are on its name plates: rates, torques, speeds, the motor's inertia, and where
//! about the resonance is looked for.

use driveline::commissioning::{Commissioning, CommissioningResult, Error, Figure, TestConfig, TestSettings};
use driveline::configure::Machine;
use driveline::design::{Disturbance, Rate, SpeedLoopTuning};
use driveline::machine::TwoMass;

use super::blooming_mill::BloomingMill;
use super::hoist::Hoist;
use super::spindle::Spindle;
use crate::scene::table::variants;
use crate::scene::{Input, Output, Scene, Variant};

/// Lines of the multisine.
pub const LINES: usize = 24;

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;

/// Torque of the hoist's test load at the motor (N m), as the crane's driver reckons it: 3 t of 9.80665 m/s2 on a drum
/// of 0.8 m, two falls and a gear of 31.5.
pub const HELD: f64 = 3_000.0 * 9.80665 * 0.8 / (2.0 * 2.0 * 31.5);

/// Data on the hoist.
pub const HOIST: TestSettings = TestSettings {
    rate: Rate::hz(RATE_HZ),
    encoder: Hoist::<RATE_HZ>::ENCODER,
    torque: 0.25 * Hoist::<RATE_HZ>::RATING.torque.0,
    shaft_torque: 0.5 * Hoist::<RATE_HZ>::RATING.torque.0,
    speed: 12.0,
    // 6 m of the load's way
    travel: 950.0,
    held: HELD,
    inertia: 0.62,
    band: [2.5, 12.0],
    torque_accuracy: 0.01 * Hoist::<RATE_HZ>::RATING.torque.0,
    delay: 0.0,
};

/// Data on the mill.
pub const MILL: TestSettings = TestSettings {
    rate: Rate::hz(RATE_HZ),
    encoder: BloomingMill::ENCODER,
    torque: 0.3 * BloomingMill::RATING.torque.0,
    shaft_torque: 0.5 * BloomingMill::RATING.torque.0,
    speed: 3.0,
    travel: 1.0e4,
    held: 0.0,
    inertia: 1.1e5,
    band: [6.0, 30.0],
    torque_accuracy: 0.01 * BloomingMill::RATING.torque.0,
    delay: 0.0,
};

/// Data on the spindle.
pub const SPINDLE: TestSettings = TestSettings {
    rate: Rate::hz(RATE_HZ),
    encoder: Spindle::ENCODER,
    torque: 0.4 * Spindle::RATING.torque.0,
    shaft_torque: 0.5 * Spindle::RATING.torque.0,
    speed: 200.0,
    travel: 1.0e5,
    held: 0.0,
    inertia: 0.012,
    band: [200.0, 1_000.0],
    torque_accuracy: 0.01 * Spindle::RATING.torque.0,
    delay: 0.0,
};

/// The same for the tick: a setting that is out of range stops the compiler here.
const fn config(settings: &TestSettings) -> TestConfig {
    match TestConfig::try_new(settings) {
        Ok(config) => config,
        Err(reason) => panic!("{}", reason.message()),
    }
}

/// The machines by their numbers, with their names.
pub const MACHINES: [(&str, TestSettings); 3] = [("hoist", HOIST), ("mill", MILL), ("spindle", SPINDLE)];

static CONFIGS: [TestConfig; 3] = [config(&HOIST), config(&MILL), config(&SPINDLE)];

/// Requests to the panel, with a value.
pub mod panel {
    /// The machine is that of this number, before it is released.
    pub const MACHINE: u32 = 6;
    /// The stage, by its number.
    pub const STAGE: u32 = 1;
    /// A figure of the result, by its place in [`figures`](super::figures), as the bits of an `f32`; all ones where
    /// there is none.
    pub const FIGURE: u32 = 2;
    /// Its standard deviation.
    pub const DEVIATION: u32 = 3;
    /// The number of the reason for which the test, or (with value 1) the gap, has no answer: see
    /// [`reason`](super::reason).
    pub const REASON: u32 = 4;
    /// Of the lines' last responses, one part: line times 8, upwards or downwards times 4, and frequency, real part,
    /// imaginary part or deviation.
    pub const RESPONSE: u32 = 5;
    /// A gain of the design for the identified machine, by its place in [`design`](super::design).
    pub const GAIN: u32 = 7;
    /// No answer.
    pub const NONE: u32 = u32::MAX;
}

/// The figures by their numbers.
pub fn figures(identified: &CommissioningResult) -> [Figure; 14] {
    let none = Figure { value: f64::NAN, standard_deviation: f64::NAN };
    let friction = &identified.friction;
    let eccentricity = &identified.eccentricity;
    [
        identified.total_inertia,
        identified.motor_inertia,
        identified.load_inertia,
        identified.resonance,
        identified.antiresonance,
        identified.stiffness,
        identified.damping,
        identified.damping_ratio,
        friction.coulomb,
        friction.viscous,
        friction.weight,
        identified.gap.unwrap_or(none),
        eccentricity.amplitude,
        Figure {
            value: eccentricity.phase,
            standard_deviation: eccentricity.amplitude.standard_deviation / eccentricity.amplitude.value,
        },
    ]
}

/// Gains for a machine, by the functions that the compiler uses for the other scenes; `None` where it cannot be
/// controlled. The observer's five are per radian: rad, rad/s, rad, rad/s, N m. The speed loop's three are proportional
/// (N m s/rad), integral (N m/rad) and active damping (N m s/rad).
pub fn design(machine: &TwoMass, settings: &TestSettings) -> Option<[f64; 8]> {
    let disturbance = Disturbance {
        torque_accuracy: settings.torque_accuracy,
        load_torque_step: settings.shaft_torque,
        within: 10.0,
    };
    let tuning = SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.1 };
    let [a, b, c, d, e] = machine.try_observer(settings.rate, settings.encoder, disturbance).ok()?.gains;
    let speed_loop = machine.try_speed_loop(settings.rate, tuning).ok()?;
    Some([a, b, c, d, e, speed_loop.proportional, speed_loop.integral, speed_loop.damping])
}

/// A commissioning under way, as a scene: the tick gives the torque, the panel's turn solves a stage's data.
///
/// One image serves all three machines: the panel selects one before the drive is released.
pub struct Commission {
    config: &'static TestConfig,
    test: Commissioning<LINES>,
    /// Whether it has been released, ever.
    begun: bool,
    gains: Option<[f64; 8]>,
}

impl Commission {
    /// The commissioning of any machine.
    pub fn of(config: &'static TestConfig) -> Self {
        Commission { config, test: Commissioning::new(config), begun: false, gains: None }
    }
}

impl Scene for Commission {
    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        self.begun |= input.flags & Input::RELEASED != 0;
        let torque = if self.begun { self.test.tick(self.config, input.angle) } else { 0.0 };
        Output { torque: torque.to_bits(), ..Output::default() }
    }

    fn panel(&mut self, asked: [u32; 2]) -> u32 {
        if !self.begun {
            if let [panel::MACHINE, number] = asked
                && let Some(config) = CONFIGS.get(number as usize)
            {
                *self = Self::of(config);
            }
            return panel::NONE;
        }
        let test = &mut self.test;
        if let Some(job) = test.job() {
            let findings = job.solve(self.config);
            test.accept(self.config, findings);
            if let Some(Ok(identified)) = test.outcome() {
                self.gains = identified.machine().ok().and_then(|machine| design(&machine, self.config.settings()));
            }
        }
        let [key, value] = asked;
        let figure = || match test.outcome() {
            Some(Ok(identified)) => figures(identified).get(value as usize).copied(),
            _ => None,
        };
        let bits = |number: Option<f64>| number.map_or(panel::NONE, |number| (number as f32).to_bits());
        match key {
            panel::STAGE => test.stage() as u32,
            panel::FIGURE => bits(figure().map(|figure| figure.value)),
            panel::DEVIATION => bits(figure().map(|figure| figure.standard_deviation)),
            panel::GAIN => bits(self.gains.and_then(|gains| gains.get(value as usize).copied())),
            panel::REASON => match test.outcome() {
                Some(Err(reason)) if value == 0 => reason as u32 + 1,
                Some(Ok(identified)) if value == 1 => identified.gap.err().map_or(0, |reason| reason as u32 + 1),
                _ => 0,
            },
            panel::RESPONSE => {
                let [up, down] = test.responses();
                let way = if value & 4 == 0 { up } else { down };
                bits(way.get(value as usize >> 3).map(|response| match value & 3 {
                    0 => response.frequency,
                    1 => response.acceleration[0],
                    2 => response.acceleration[1],
                    _ => response.standard_deviation,
                }))
            }
            _ => 0,
        }
    }
}

impl Variant for Commission {
    type Scene = Commission;
    const NAME: &'static str = "commission/f32/two-mass/10000";
    const RATE_HZ: u32 = RATE_HZ;

    fn start() -> Self {
        let [first, ..] = &CONFIGS;
        Self::of(first)
    }
}

variants! { Commission }

/// The reason of a number that the panel gave.
pub fn reason(number: u32) -> Option<Error> {
    Error::ALL.get(number.checked_sub(1)? as usize).copied()
}
