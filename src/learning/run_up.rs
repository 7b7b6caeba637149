//! Inertia, from run-ups between two steady speeds.

use super::Finding;
use super::steady::{Steady, Window, check};

/// Drift within a window, of rated torque.
const STEADY_TORQUE: f32 = 0.01;
/// Difference of the torques at the two speeds, of rated torque.
const SAME_TORQUE: f32 = 0.03;
/// Difference of two findings that confirm each other, as a fraction.
const AGREEMENT: f32 = 0.1;
/// Pairs of findings in the mean, at the most.
const FINDINGS: u32 = 8;

/// Constants of [`RunUp`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RunUpConfig {
    /// Updates in a window.
    pub window: u32,
    /// Updates from one window to the other, at the most.
    pub pause: u32,
    /// Least speed, either way (rad/s).
    pub least_speed: f32,
    /// Least change of the speed (rad/s).
    pub least_change: f32,
    /// Rated torque (N m).
    pub torque: f32,
    /// Interval of the updates (s).
    pub every: f32,
    /// Smallest and largest inertia that is accepted (kg m2).
    pub range: [f32; 2],
}

impl RunUpConfig {
    /// For a motor of rated `torque` (N m) and `speed` (rad/s), an inertia within a range (kg m2), and an update
    /// every so many seconds: windows of half a second from a tenth of the rated speed on, changes of half of the
    /// rated speed within ten seconds.
    ///
    /// # Panics
    /// At compile time in a constant, for an interval that leaves fewer than ten updates in a window. Also for a rating
    /// that is not positive and for inertias that do not rise from above zero.
    pub const fn new(torque: f64, speed: f64, range: [f64; 2], every: f64) -> Self {
        check(torque, speed, every);
        assert!(
            range[0] > 0.0 && range[1] > range[0] && range[1].is_finite(),
            "the inertia must lie between two rising finite values above 0 kg m2"
        );
        RunUpConfig {
            window: (0.5 / every) as u32,
            pause: (10.0 / every) as u32,
            least_speed: (0.1 * speed) as f32,
            least_change: (0.5 * speed) as f32,
            torque: torque as f32,
            every: every as f32,
            range: [range[0] as f32, range[1] as f32],
        }
    }
}

/// Inertia of the whole drivetrain at the motor, learnt.
///
/// Between two steady speeds under one load the motor's torque above that of the steady motion accelerates the whole
/// inertia:
///
/// ```text
/// J = integral(tau - tau_steady) dt / (omega_2 - omega_1 - integral(alpha_steady) dt)
/// ```
///
/// tau_steady is the mean torque of the two speeds, and alpha_steady the mean acceleration that is left there: a slow
/// loop creeps into its setpoint. It is the change of the load torque's estimate per acceleration, without the
/// observer's lag. Behind a gear with losses the load's share of J is larger by the friction per shaft
/// torque. Where the load's inertia is known by its weight, the rest is the motor's.
///
/// Only speeds of one direction count, with equal torques: otherwise the load has changed. A finding while the motor
/// accelerates needs one while it decelerates that agrees: a brake that drags on the way makes the one larger and the
/// other smaller.
///
/// ```
/// use driveline::learning::{RunUp, RunUpConfig};
/// const CONFIG: RunUpConfig = RunUpConfig::new(300.0, 150.0, [0.5, 4.0], 0.01);
/// let mut learner = RunUp::new(&CONFIG, 1.0);
/// // 2 kg m2 between 40 and 140 rad/s at 25 rad/s2, 60 N m of load, a hundred updates a second
/// let mut speed = 40.0_f32;
/// for target in [40.0, 140.0, 40.0, 140.0, 40.0] {
///     for _ in 0..600 {
///         let step = (target - speed).clamp(-0.25, 0.25);
///         speed += step;
///         learner.update(&CONFIG, 60.0 + 2.0 * step / 0.01, speed);
///     }
/// }
/// assert!(learner.is_learnt() && (learner.inertia() - 2.0).abs() < 0.02);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RunUp {
    inertia: f32,
    window: Window,
    last: Option<Steady>,
    /// Since the last window: sum of the torques and their number.
    sum: f32,
    count: f32,
    /// A finding, and whether the motor accelerated.
    unconfirmed: Option<(f32, bool)>,
    /// Pairs of findings in the mean.
    findings: u32,
}

impl RunUp {
    /// From an inertia to begin with (kg m2). A value out of range is moved to its end, NaN to its start.
    pub fn new(config: &RunUpConfig, inertia: f32) -> Self {
        let [least, most] = config.range;
        RunUp {
            inertia: if inertia >= least { inertia.min(most) } else { least },
            window: Window::default(),
            last: None,
            sum: 0.0,
            count: 0.0,
            unconfirmed: None,
            findings: 0,
        }
    }

    /// Inertia of the whole drivetrain at the motor (kg m2).
    pub fn inertia(&self) -> f32 {
        self.inertia
    }

    /// Whether two findings under this load have agreed.
    pub fn is_learnt(&self) -> bool {
        self.findings > 0
    }

    /// The brake has closed under the same load. Another load needs [`RunUp::restart`].
    pub fn interrupt(&mut self) {
        (self.window, self.last, self.sum, self.count) = Default::default();
    }

    /// Begins anew with another load: findings under the last one do not count.
    pub fn restart(&mut self) {
        self.interrupt();
        (self.unconfirmed, self.findings) = (None, 0);
    }

    /// Takes the motor's torque (N m) and speed (rad/s), between the ticks at a steady rate.
    pub fn update(&mut self, config: &RunUpConfig, torque: f32, speed: f32) -> Finding {
        self.update_after(config, 1.0, torque, speed)
    }

    /// [`update`](Self::update), so many times its interval after the last one. Windows need an update every tenth of
    /// their length.
    pub fn update_after(&mut self, config: &RunUpConfig, elapsed: f32, torque: f32, speed: f32) -> Finding {
        if !(torque.is_finite() && speed.is_finite()) {
            self.interrupt();
            return Finding::None;
        }
        self.sum += torque * elapsed;
        self.count += elapsed;
        let Some(now) = self.window.update(config.window, config.least_speed, elapsed, torque, speed) else {
            return Finding::None;
        };
        let (sum, count) = (self.sum, self.count);
        (self.sum, self.count) = (0.0, 0.0);
        let last = self.last.take();
        if now.drift > STEADY_TORQUE * config.torque {
            return Finding::None;
        }
        self.last = Some(now);
        let Some(last) = last else { return Finding::None };
        let change = now.end - last.end;
        if count > config.pause as f32 || last.speed * now.speed <= 0.0 || change.abs() < config.least_change {
            return Finding::None;
        }
        if (now.torque - last.torque).abs() > SAME_TORQUE * config.torque {
            // another load: nothing confirms what was found under the last one
            self.unconfirmed = None;
            return Finding::Rejected;
        }
        // the windows' own torque and change of the speed, for as long as this motion
        let windows = count / (2 * config.window) as f32;
        let steady = (now.torque + last.torque) * windows * config.window as f32;
        let beyond = change - (now.change + last.change) * windows;
        self.confirm(config, (sum - steady) * config.every / beyond, change * now.speed > 0.0)
    }

    fn confirm(&mut self, config: &RunUpConfig, found: f32, accelerating: bool) -> Finding {
        let [least, most] = config.range;
        if !(found >= least && found <= most) {
            self.unconfirmed = None;
            return Finding::Rejected;
        }
        let agrees = |with: f32| (found - with).abs() <= AGREEMENT * with;
        match self.unconfirmed.replace((found, accelerating)) {
            Some((before, other)) if other != accelerating => {
                if !agrees(before) || (self.findings > 0 && !agrees(self.inertia)) {
                    return Finding::Rejected;
                }
                self.unconfirmed = None;
                let mean = 0.5 * (before + found);
                self.findings = (self.findings + 1).min(FINDINGS);
                self.inertia +=
                    if self.findings == 1 { mean - self.inertia } else { (mean - self.inertia) / self.findings as f32 };
                Finding::Changed
            }
            _ => Finding::Unconfirmed,
        }
    }
}
