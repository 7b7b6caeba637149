//! The test sequence on the tick, stage by stage.

mod stages;

use super::friction::{SEGMENTS, Segment};
use super::gap::{EASED, PUSHES, Push};
use super::harmonic::{HALVES, Harmonic};
use super::job::{Findings, Job, Known, Next};
use super::multisine::{Line, Window};
use super::reference::Reference;
use super::result::CommissioningResult;
use super::servo::{Deviation, Servo};
use super::swing::SwingWatch;
use super::{Error, Stage, TestConfig};
use crate::angle::Synchronous;

/// How often the torque may go from bound to bound in a stage: each time adds to a swing of the shaft.
const REVERSALS: u32 = 1;

/// Motion of the motor within a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
enum Phase {
    /// Goes to the speed.
    Goes,
    /// Waits until it is steady.
    Settles,
    /// Is measured.
    Measures,
    /// The excitation fades.
    Fades,
    /// Goes back to standstill.
    Stops,
    /// Stands until the job is solved.
    Waits,
    /// Is without torque for good.
    Lost,
}

/// A test under way. `L` lines of the multisine: 24 as a rule, 16 at least.
///
/// ```
/// use driveline::commissioning::{Commissioning, Stage, TestConfig, TestSettings};
/// use driveline::design::{Encoder, Rate};
///
/// let config = TestConfig::try_new(&TestSettings {
///     rate: Rate::hz(10_000),
///     encoder: Encoder::lines(2048),
///     torque: 300.0,
///     shaft_torque: 375.0,
///     speed: 15.0,
///     travel: 900.0,
///     held: 190.0,
///     inertia: 0.7,
///     band: [2.0, 12.0],
///     torque_accuracy: 7.5,
///     delay: 0.0,
/// })?;
/// let mut test = Commissioning::<24>::new(&config);
/// // in the timer's interrupt
/// let torque = test.tick(&config, 0);
/// // in the main loop
/// if let Some(job) = test.job() {
///     let findings = job.solve(&config);
///     test.accept(&config, findings);
/// }
/// assert_eq!(test.stage(), Stage::Holding);
/// # assert!((torque - 190.0).abs() < 1.0);
/// # Ok::<(), driveline::commissioning::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Commissioning<const L: usize> {
    stage: Stage,
    phase: Phase,
    /// Blocks left in the phase.
    left: u32,
    /// Segment, push.
    index: usize,
    /// The angle of the tick before; none before the first.
    last: Option<u32>,
    /// Angle from where the test began (2^-32 turn).
    angle: i64,
    /// Sum over the block, and over the one before.
    sum: i64,
    before: i64,
    /// The reference in the block before, times the ticks.
    meant: i64,
    ticks: u32,
    torque: f32,
    excitation: f32,
    /// Bound that the torque last met in the stage (N m); how often it met the other one next.
    bound: f32,
    reversals: u32,
    /// Size of the excitation, and how it changes in a block.
    fade: f32,
    fading: f32,
    /// Cosine and sine part of the eccentricity correction (rad), and the correction of the last block.
    eccentric: [f32; 2],
    taken: f32,
    servo: Servo,
    deviation: Deviation,
    swing: SwingWatch,
    reference: Reference,
    window: Window,
    lines: [Line; L],
    orders: [Harmonic; 3],
    segments: [Segment; SEGMENTS],
    pushes: [Push; PUSHES],
    /// Sums of a phase: of the torque, the window, the angle.
    total: f64,
    start: (i64, f32),
    /// Torque that is steady in a phase: it must not be taken for one of once a turn of a reading that is not quite the
    /// angle.
    carried: f32,
    known: Known<L>,
    next: Next,
}

impl<const L: usize> Commissioning<L> {
    /// A test whose motor stands, and whose torque holds the load from the first tick on. The angle of that tick is
    /// where it begins.
    #[must_use]
    pub fn new(config: &TestConfig) -> Self {
        let held = config.settings.held as f32;
        let deviation = Deviation { disturbance: -held, ..Deviation::default() };
        Self {
            stage: Stage::Holding,
            phase: Phase::Settles,
            left: config.blocks(8.0 / config.servo),
            index: 0,
            last: None,
            angle: 0,
            sum: 0,
            before: 0,
            meant: 0,
            ticks: 0,
            torque: held,
            excitation: 0.0,
            bound: 0.0,
            reversals: 0,
            fade: 0.0,
            fading: 0.0,
            eccentric: [0.0; 2],
            taken: 0.0,
            servo: Servo::new(config, config.settings.inertia),
            deviation,
            swing: SwingWatch::new(config, config.settings.inertia, deviation),
            reference: Reference::default(),
            window: Window::NONE,
            lines: [Line::NONE; L],
            orders: [Harmonic::default(); 3],
            segments: [Segment::default(); SEGMENTS],
            pushes: [(0.0, 0.0); PUSHES],
            total: 0.0,
            start: (0, 0.0),
            carried: 0.0,
            known: Known::new(config),
            next: Next::Segments,
        }
    }

    /// One tick: the motor's angle (2^-32 turn) in, the torque (N m) out, for the next tick.
    ///
    /// After an implausible angle, or beyond the travel, there is no torque: the brake must hold the load.
    #[inline]
    pub fn tick(&mut self, config: &TestConfig, angle: u32) -> f32 {
        let moved = angle.wrapping_sub(self.last.unwrap_or(angle)) as i32;
        self.last = Some(angle);
        self.angle = self.angle.wrapping_add(i64::from(moved));
        if moved.unsigned_abs() > config.jump {
            self.refuse(Error::AngleJump);
        }
        self.sum = self.sum.wrapping_add(self.angle);
        self.ticks += 1;
        if self.ticks >= config.ticks {
            self.ticks = 0;
            self.block(config);
        }
        self.torque
    }

    /// Where the test is.
    #[must_use]
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// A copy of the stage's data, to be solved outside the tick before the test goes on.
    #[must_use]
    pub fn job(&self) -> Option<Job<L>> {
        if self.phase != Phase::Waits || matches!(self.stage, Stage::Done | Stage::Refused) {
            return None;
        }
        Some(Job {
            stage: self.stage,
            known: self.known,
            next: self.next,
            lines: self.lines,
            orders: self.orders,
            segments: self.segments,
            pushes: self.pushes,
            mean_speed: self.total,
            angle: self.travelled(),
            zero: f64::from(self.last.unwrap_or(0).wrapping_sub(self.angle as u32))
                * (core::f64::consts::TAU / 4_294_967_296.0),
        })
    }

    /// Takes the results of a job and goes on. Like [`job`](Self::job) it only copies: both belong between two ticks.
    pub fn accept(&mut self, config: &TestConfig, findings: Findings<L>) {
        if self.phase != Phase::Waits || matches!(self.stage, Stage::Done | Stage::Refused) {
            return;
        }
        self.known = findings.known;
        self.next = findings.next;
        self.servo = findings.servo;
        self.swing = SwingWatch::new(config, self.known.motor_inertia(config), self.deviation);
        self.eccentric = self.known.eccentric.map(|part| part as f32);
        self.begin(config);
    }

    /// The answer, where the test has ended. Read it at once: further ticks hold the motor, and an event that ends the
    /// hold, as an angle jump, replaces it.
    #[must_use]
    pub fn outcome(&self) -> Option<Result<&CommissioningResult, Error>> {
        match (&self.next, self.stage) {
            (Next::Done(identified), Stage::Done) => Some(Ok(identified)),
            (Next::Refused(reason), Stage::Refused) => Some(Err(*reason)),
            _ => None,
        }
    }

    /// Responses that the resonance was last fitted to, upwards and downwards; zeros before.
    #[must_use]
    pub fn responses(&self) -> &[[super::Response; L]; 2] {
        &self.known.responses
    }

    /// Angle from where the test began (rad).
    #[must_use]
    pub fn travelled(&self) -> f64 {
        self.angle as f64 * (core::f64::consts::TAU / 4_294_967_296.0)
    }

    /// Ends the test without torque; later motion of the free motor does not change the error.
    fn refuse(&mut self, reason: Error) {
        if self.phase == Phase::Lost {
            return;
        }
        self.stage = Stage::Refused;
        self.phase = Phase::Lost;
        self.next = Next::Refused(reason);
        self.torque = 0.0;
        self.fade = 0.0;
    }

    fn block(&mut self, config: &TestConfig) {
        let ticks = i64::from(config.ticks);
        let meant = self.reference.angle.wrapping_mul(ticks);
        // Before the reference moves on: its value in the block that has just ended.
        let deviation = self.sum.wrapping_sub(meant);
        let step = deviation.wrapping_sub(self.before.wrapping_sub(self.meant));
        // The mean angle of the block, which the encoder's eccentricity depends on.
        let place = self.sum.checked_div(ticks).unwrap_or(self.angle);
        let [cosine, sine] = <f32 as Synchronous>::direction(place as u32 >> 6);
        let taken = self.eccentric[0] * cosine + self.eccentric[1] * sine;
        let measured = deviation as f32 * config.unit - taken;
        let increase = step as f32 * config.unit - (taken - self.taken);
        self.taken = taken;
        self.before = self.sum;
        self.meant = meant;
        self.sum = 0;
        if self.phase == Phase::Lost {
            return;
        }
        if self.angle.unsigned_abs() > config.travel.unsigned_abs() {
            self.refuse(Error::TravelExceeded);
            return;
        }
        let h = config.block_f32;
        self.servo.observe(&mut self.deviation, h, measured, self.torque, self.reference.acceleration);
        // Written so that a value that is not a number is not followed either.
        if !(self.deviation.angle.abs() <= config.lag) {
            self.refuse(Error::NotFollowed);
            return;
        }
        let swings = self.swing.observe(config, measured, self.torque, self.reference.acceleration);
        // in a gap the motor swings without the shaft
        if swings && self.stage != Stage::Backlash {
            self.refuse(Error::Unsteady);
            return;
        }
        let measures = self.phase == Phase::Measures;
        if self.stage == Stage::Encoder && measures {
            let window = self.window.step();
            for (order, halves) in self.orders.iter_mut().zip(HALVES) {
                order.take(halves, place, window, increase, self.torque - self.carried);
            }
        }
        if self.stage == Stage::Resonance {
            let window = if measures { self.window.step() } else { 0.0 };
            let mut sum = 0.0;
            for line in &mut self.lines {
                sum += line.step(window, increase, self.torque);
            }
            self.fade = (self.fade + self.fading).clamp(0.0, 1.0);
            self.excitation = self.fade * sum;
        } else {
            self.excitation = 0.0;
        }
        if measures && self.stage == Stage::Friction {
            self.total += f64::from(self.torque);
        }
        self.left = self.left.saturating_sub(1);
        if self.phase != Phase::Waits && self.is_over(config) {
            self.advance(config);
        }
        self.reference.step(config);
        let wanted = match self.next {
            // Against the flank without the servo, which would shake a load that friction holds on a spring.
            Next::Reversals { torque, .. }
                if self.stage == Stage::Backlash
                    && matches!(self.phase, Phase::Settles | Phase::Measures | Phase::Fades) =>
            {
                let way = if self.index.is_multiple_of(2) { torque } else { -torque };
                let push = match self.phase {
                    Phase::Fades => 0.0,
                    Phase::Measures => (EASED * way) as f32,
                    _ => way as f32,
                };
                // Slowly: a step would swing to twice its size, and one given in a bounce come back as an impact.
                let most = 0.125 * torque as f32 * config.servo as f32 * config.block_f32;
                self.torque + (push - self.torque).min(most).max(-most)
            }
            _ => self.servo.torque(&self.deviation, self.reference.acceleration) + self.excitation,
        };
        let (middle, most) = match self.next {
            Next::Reversals { torque, .. } if self.stage == Stage::Backlash => (0.0, torque as f32),
            _ => {
                let [most, slow] = config.most;
                let most = if self.stage == Stage::Resonance { most } else { slow };
                (config.settings.held as f32, most as f32)
            }
        };
        let given = (wanted - middle).min(most).max(-most);
        self.torque = given + middle;
        // Pushes against a flank may well go from bound to bound.
        if given.abs() >= most && self.stage != Stage::Backlash {
            self.reversals += u32::from(given * self.bound < 0.0);
            self.bound = given;
            if self.reversals > REVERSALS {
                self.refuse(Error::Unsteady);
            }
        }
    }
}
