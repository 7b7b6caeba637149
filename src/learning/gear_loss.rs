//! Friction of a gear, from the motor's torque up and down.

use super::Finding;
use super::steady::{Pairs, Steady, Window, check, frictions};

/// Constants of [`GearLoss`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearLossConfig {
    /// Updates in a window.
    pub window: u32,
    /// Updates between the windows of a pair, at the most.
    pub pause: u32,
    /// Least speed, either way (rad/s).
    pub least_speed: f32,
    /// Least torque (N m): below it the friction without load counts for more than the loss.
    pub least_torque: f32,
    /// Smallest and largest friction per shaft torque that is accepted.
    pub range: [f32; 2],
}

impl GearLossConfig {
    /// For a motor of rated `torque` (N m) and `speed` (rad/s), a gear whose efficiency lies within a range, and
    /// an update every so many seconds: windows of half a second from a quarter of the rated speed and a fifth of the
    /// rated torque on, pairs within ten seconds.
    ///
    /// # Panics
    /// At compile time in a constant, for an interval that leaves fewer than ten updates in a window. Also for a rating
    /// that is not positive and for efficiencies that do not rise within 0 to 1.
    pub const fn new(torque: f64, speed: f64, efficiency: [f64; 2], every: f64) -> Self {
        check(torque, speed, every);
        GearLossConfig {
            window: (0.5 / every) as u32,
            pause: (10.0 / every) as u32,
            least_speed: (0.25 * speed) as f32,
            least_torque: (0.2 * torque) as f32,
            range: frictions(efficiency),
        }
    }
}

/// Difference of the torques of a window's halves, as a fraction: a noise of 1 % of rated is below 0.5 % in the mean of
/// ten updates.
const STEADY_TORQUE: f32 = 0.02;
/// Difference of two findings that confirm each other.
const AGREEMENT: f32 = 0.01;

/// Friction of a gear per torque, learnt.
///
/// At a steady speed under a load torque T the motor carries `T/eta` where it drives the load, and `eta T` where the
/// load drives it [Huang 1987 tables 1-2 to 1-4]. From the two means,
///
/// ```text
/// lambda = (up - down)/(up + down) = (1 - eta^2)/(1 + eta^2)
/// ```
///
/// the friction per torque of [`GearedObserver`](crate::observer::GearedObserver). The load cancels out, and so does
/// the torque constant.
///
/// Only windows count in which speed and torque are steady, and only a pair that lies close in time without a closed
/// brake between: a change of the load would be taken for a loss. A finding changes the friction once a second pair
/// agrees with it.
///
/// ```
/// use driveline::learning::{GearLoss, GearLossConfig};
/// // 300 N m, 150 rad/s, an efficiency from 80 to 99 %, a hundred updates a second
/// const CONFIG: GearLossConfig = GearLossConfig::new(300.0, 150.0, [0.8, 0.99], 0.01);
/// let mut learner = GearLoss::new(&CONFIG, 0.05);
/// // a load of 100 N m up and down behind 90 %: the motor carries 100/0.9 and 100 0.9 N m, for two seconds each
/// for lift in 0..6 {
///     let (torque, speed) = if lift % 2 == 0 { (100.0 / 0.9, 100.0) } else { (90.0, -100.0) };
///     (0..200).for_each(|_| { learner.update(&CONFIG, torque, speed); });
/// }
/// assert!((learner.friction() - (1.0 - 0.81) / (1.0 + 0.81)).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearLoss {
    friction: f32,
    window: Window,
    pairs: Pairs,
    unconfirmed: Option<f32>,
}

impl GearLoss {
    /// From a friction to begin with: that of the data sheet, or one that was learnt. A value out of range is moved to
    /// its end.
    pub fn new(config: &GearLossConfig, friction: f32) -> Self {
        let [least, most] = config.range;
        GearLoss {
            friction: if friction >= least { friction.min(most) } else { least },
            window: Window::default(),
            pairs: Pairs::default(),
            unconfirmed: None,
        }
    }

    /// The friction per torque, for [`GearFriction::of`](crate::observer::GearFriction::of).
    pub fn friction(&self) -> f32 {
        self.friction
    }

    /// The brake has closed, or the load may have changed: the windows so far have no partner.
    pub fn interrupt(&mut self) {
        (self.window, self.pairs) = Default::default();
    }

    /// Takes the motor's reported torque (N m) and speed (rad/s), between the ticks at a steady rate.
    pub fn update(&mut self, config: &GearLossConfig, torque: f32, speed: f32) -> Finding {
        self.update_after(config, 1.0, torque, speed)
    }

    /// [`update`](Self::update), so many times its interval after the last one. Windows need an update every tenth of
    /// their length.
    pub fn update_after(&mut self, config: &GearLossConfig, elapsed: f32, torque: f32, speed: f32) -> Finding {
        if !(torque.is_finite() && speed.is_finite()) {
            self.interrupt();
            return Finding::None;
        }
        self.pairs.age(config.pause, elapsed);
        let Some(steady) = self.window.update(config.window, config.least_speed, elapsed, torque, speed) else {
            return Finding::None;
        };
        if steady.drift > STEADY_TORQUE * steady.torque.abs() || steady.torque.abs() < config.least_torque {
            return Finding::None;
        }
        match self.pairs.of(steady) {
            Some(pair) => self.pair(config, pair),
            None => Finding::None,
        }
    }

    /// Two windows of opposite directions.
    fn pair(&mut self, config: &GearLossConfig, [one, other]: [Steady; 2]) -> Finding {
        let (driving, driven) = if one.torque * one.speed > 0.0 { (one, other) } else { (other, one) };
        let [up, down] = [driving.torque.abs(), driven.torque.abs()];
        if one.torque * other.torque <= 0.0 {
            return Finding::None;
        }
        let found = (up - down) / (up + down);
        let [least, most] = config.range;
        if !(found >= least && found <= most) {
            self.unconfirmed = None;
            return Finding::Rejected;
        }
        match self.unconfirmed.replace(found) {
            Some(before) if (found - before).abs() <= AGREEMENT => {
                self.friction = 0.5 * (before + found);
                Finding::Changed
            }
            Some(_) => Finding::Rejected,
            None => Finding::Unconfirmed,
        }
    }
}
