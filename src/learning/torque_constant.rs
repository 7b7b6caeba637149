//! Torque constant and offset of the motor, from known loads up and down.

use super::Finding;
use super::steady::{Pairs, Steady, Window, check, frictions};
use crate::number::{Magnitude, Number};

/// Largest departure of the gain from 1.
const GAIN: f32 = 0.1;
/// Largest offset, of rated torque.
const OFFSET: f32 = 0.03;
/// Drift within a window, of rated torque: a noise of 1 % of rated is 0.3 % in the difference of two means of 25.
const STEADY_TORQUE: f32 = 0.01;
/// Difference of two findings that confirm each other, of rated torque.
const AGREEMENT: f32 = 0.005;
/// Loads that differ by this, of rated torque, give gain and offset.
const APART: f32 = 0.3;

/// Constants of [`TorqueConstant`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TorqueConstantConfig {
    /// Updates in a window.
    pub window: u32,
    /// Updates between the windows of a pair, at the most.
    pub pause: u32,
    /// Least speed, either way (rad/s).
    pub least_speed: f32,
    /// Rated torque (N m).
    pub torque: f32,
    /// Load torque from which on the gear's loss is taken off and checked (N m).
    pub weight: f32,
    /// Smallest and largest half difference over the mean, up to down.
    pub loss: [f32; 2],
}

impl TorqueConstantConfig {
    /// For a motor of rated `torque` (N m) and `speed` (rad/s), a gear whose efficiency lies within a range, and
    /// an update every so many seconds: windows of half a second from a quarter of the rated speed on, pairs within ten
    /// seconds.
    ///
    /// # Panics
    /// At compile time in a constant, for an interval that leaves fewer than ten updates in a window. Also for a rating
    /// that is not positive and for efficiencies that do not rise within 0 to 1.
    pub const fn new(torque: f64, speed: f64, efficiency: [f64; 2], every: f64) -> Self {
        check(torque, speed, every);
        TorqueConstantConfig {
            window: (0.5 / every) as u32,
            pause: (10.0 / every) as u32,
            least_speed: (0.25 * speed) as f32,
            torque: torque as f32,
            weight: (0.2 * torque) as f32,
            loss: frictions(efficiency),
        }
    }
}

/// A known load and the torque that carries it, as reported (N m).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Point {
    load: f32,
    reported: f32,
}

/// Gain and offset of the motor's torque, learnt.
///
/// The motor gives `gain tau + offset` where its inverter reports tau. Under a known load torque W at a steady speed
/// the motor carries `W/eta` upwards and `eta W` downwards [Huang 1987 tables 1-2 to 1-4]. Of the reported torques up
/// and down, the mean m and half of the difference d, follows
///
/// ```text
/// gain x + offset = W,   x = sqrt(m^2 - d^2);   x = m for a light load or none
/// ```
///
/// The gear's loss cancels out. One known weight gives the gain with the present offset; a run without load gives the
/// offset, since friction changes its sign with the direction and the offset does not. Two loads, such as the empty
/// hook and a test weight, give both.
///
/// Windows and pairs are those of [`GearLoss`](super::GearLoss). A pair under a weight counts only with a loss that the
/// gear can have: a slipping brake is none. A result out of the bounds is left out. A wrong weight within the bounds,
/// or a load that drifts by less than 4 % of rated a second, cannot be told from a torque constant.
///
/// ```
/// use driveline::learning::{TorqueConstant, TorqueConstantConfig};
/// const CONFIG: TorqueConstantConfig = TorqueConstantConfig::new(300.0, 150.0, [0.8, 1.0], 0.01);
/// let mut learner = TorqueConstant::new(&CONFIG, 1.0, 0.0);
/// // a test weight of 150 N m behind a gear of 95 %, an inverter that reports 4 % too little
/// learner.set_load(Some(150.0));
/// for lift in 0..8 {
///     let (torque, speed) = if lift % 2 == 0 { (150.0 / 0.95, 100.0) } else { (150.0 * 0.95, -100.0) };
///     (0..200).for_each(|_| { learner.update(&CONFIG, torque / 1.04, speed); });
/// }
/// assert!((learner.gain() - 1.04).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TorqueConstant {
    gain: f32,
    offset: f32,
    load: Option<f32>,
    window: Window,
    pairs: Pairs,
    unconfirmed: Option<f32>,
    points: [Option<Point>; 2],
}

impl TorqueConstant {
    /// From a gain and an offset (N m) to begin with: 1 and 0, or what was learnt. A value out of bounds is moved to
    /// its end, NaN counts as 1 and 0.
    pub fn new(config: &TorqueConstantConfig, gain: f32, offset: f32) -> Self {
        let offset_bound = OFFSET * config.torque;
        TorqueConstant {
            gain: if gain.is_nan() { 1.0 } else { gain.clamp(1.0 - GAIN, 1.0 + GAIN) },
            offset: if offset.is_nan() { 0.0 } else { offset.max(-offset_bound).min(offset_bound) },
            load: None,
            window: Window::default(),
            pairs: Pairs::default(),
            unconfirmed: None,
            points: [None; 2],
        }
    }

    /// Torque at the shaft over the reported one.
    pub fn gain(&self) -> f32 {
        self.gain
    }

    /// Torque at the shaft where none is reported (N m).
    pub fn offset(&self) -> f32 {
        self.offset
    }

    /// Begins with a known load torque at the motor (N m), zero without load; none ends it. Nothing is learnt under a
    /// load that is not known.
    pub fn set_load(&mut self, load: Option<f32>) {
        self.load = load.filter(|load| load.is_finite());
        self.interrupt();
    }

    /// The brake has closed, or the load may have changed: the windows so far have no partner.
    pub fn interrupt(&mut self) {
        (self.window, self.pairs, self.unconfirmed) = Default::default();
    }

    /// Takes the motor's torque as reported, before any calibration (N m), and speed (rad/s), between the ticks at
    /// a steady rate.
    pub fn update(&mut self, config: &TorqueConstantConfig, torque: f32, speed: f32) -> Finding {
        self.update_after(config, 1.0, torque, speed)
    }

    /// [`update`](Self::update), so many times its interval after the last one. Windows need an update every tenth of
    /// their length.
    pub fn update_after(&mut self, config: &TorqueConstantConfig, elapsed: f32, torque: f32, speed: f32) -> Finding {
        if !(torque.is_finite() && speed.is_finite()) {
            self.interrupt();
            return Finding::None;
        }
        let Some(load) = self.load else { return Finding::None };
        self.pairs.age(config.pause, elapsed);
        let Some(steady) = self.window.update(config.window, config.least_speed, elapsed, torque, speed) else {
            return Finding::None;
        };
        if steady.drift > STEADY_TORQUE * config.torque {
            return Finding::None;
        }
        let Some(pair) = self.pairs.of(steady) else { return Finding::None };
        let Some(found) = carried(config, load, pair) else {
            self.unconfirmed = None;
            return Finding::Rejected;
        };
        match self.unconfirmed.replace(found) {
            Some(before) if (found - before).abs() <= AGREEMENT * config.torque => {
                self.unconfirmed = None;
                self.take(config, Point { load, reported: 0.5 * (before + found) })
            }
            Some(_) => Finding::Rejected,
            None => Finding::Unconfirmed,
        }
    }

    fn take(&mut self, config: &TorqueConstantConfig, point: Point) -> Finding {
        let apart = APART * config.torque;
        let partner = self.points.into_iter().flatten().find(|other| (other.load - point.load).abs() >= apart);
        let (gain, offset) = match partner {
            Some(other) => {
                let gain = (point.load - other.load) / (point.reported - other.reported);
                (gain, point.load - gain * point.reported)
            }
            None if point.load.abs() >= config.weight => ((point.load - self.offset) / point.reported, self.offset),
            None => (self.gain, point.load - self.gain * point.reported),
        };
        if !((gain - 1.0).abs() <= GAIN && offset.abs() <= OFFSET * config.torque) {
            return Finding::Rejected;
        }
        self.points = [Some(point), partner];
        (self.gain, self.offset) = (gain, offset);
        Finding::Changed
    }
}

/// The reported torque that carries a load, without the gear's loss; none for a loss that the gear cannot have.
fn carried(config: &TorqueConstantConfig, load: f32, [one, other]: [Steady; 2]) -> Option<f32> {
    let (up, down) = if one.speed > 0.0 { (one.torque, other.torque) } else { (other.torque, one.torque) };
    let (mean, half) = (0.5 * (up + down), 0.5 * (up - down));
    if load.abs() < config.weight {
        return Some(mean);
    }
    let [least, most] = config.loss;
    let share = half / mean.abs();
    (share >= least && share <= most).then(|| mean * crate::math::sqrt(f64::from(1.0 - share * share)) as f32)
}

/// A calibration of the reported torque: gain and offset, for the tick.
///
/// ```
/// use driveline::learning::TorqueCalibration;
/// // what was learnt, on each report: 4 % more, and 1.5 N m
/// let calibration = TorqueCalibration::<f64>::new(1.04, 1.5);
/// assert!((calibration.torque(100.0) - (104.0 + 1.5)).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TorqueCalibration<N: Number> {
    excess: N::Coefficient,
    offset: N,
}

impl<N: Number<Coefficient: Magnitude>> TorqueCalibration<N> {
    /// A gain and an offset, in the units of the number.
    pub fn new(gain: f32, offset: N) -> Self {
        TorqueCalibration { excess: N::Coefficient::of(gain - 1.0), offset }
    }

    /// The torque at the shaft.
    #[inline(always)]
    #[must_use]
    pub fn torque(&self, reported: N) -> N {
        reported + reported.times(self.excess) + self.offset
    }
}
