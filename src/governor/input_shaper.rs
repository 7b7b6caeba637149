//! Input shaping of the setpoint: a swinging load is at rest when the drive is.

use crate::fault::Faults;
use crate::governor::Governor;
use crate::number::Number;
use crate::sample::Estimate;

/// A governor whose setpoint is given in `PARTS`, each a ramp half a period of the load's swing after the one before:
/// the swings that they excite cancel [Singer and Seering 1990; design:
/// [`InputShaperDesign`](crate::design::InputShaperDesign)].
///
/// Two parts (ZV) delay the end of a change by half a period; three (ZVD) delay it by a period, and tolerate a
/// frequency that is off by several percent. Any course of the setpoint is shaped, such as that of a joystick: it is
/// taken once in a slot, of which `SLOTS` make the whole delay. So the drive answers up to a slot late, and keeps
/// `SLOTS` setpoints. `SLOTS` is a multiple of `PARTS - 1`.
///
/// The ramp acts on each part. That of the governor is no steeper for the parts together, and so passes them.
/// A stop by the setpoint takes longer by the delay; an emergency stop belongs to the brake.
///
/// ```
/// use driveline::governor::{Governor, InputShaper, InputShaperConfig, SpeedLoop, SpeedLoopConfig};
/// use driveline::sample::Estimate;
/// // two equal parts, 50 ticks apart: half a period of an undamped swing; 1 N m s/rad shows the setpoint
/// const LOOP: SpeedLoopConfig<f64> = SpeedLoopConfig {
///     proportional: 1.0, damping: 0.0, reset: 0.0, torque_limit: 100.0, ramp: 100.0, filter: (),
/// };
/// const CONFIG: InputShaperConfig<f64, SpeedLoopConfig<f64>> =
///     InputShaperConfig { ramp: 100.0, slot: 50, share: 0.5, governor: LOOP };
/// let mut shaper = InputShaper::<SpeedLoop<(), f64>, 1, 2, f64>::default();
/// shaper.set_setpoint(10.0);
/// let torques: Vec<f64> = (0..120).map(|_| shaper.command(&CONFIG, &Estimate::default())).collect();
/// assert_eq!((torques[10], torques[119]), (5.0, 10.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// The order keeps the runs of words that a start clears short: for long ones the compiler calls a loop to clear them.
#[repr(C)]
#[doc(alias("notch", "anti-sway", "ZV", "ZVD"))]
pub struct InputShaper<G, const SLOTS: usize, const PARTS: usize = 3, N = f32> {
    setpoint: N,
    /// Speed at the start: the setpoint of the time before it.
    initial: N,
    at: usize,
    filled: usize,
    /// Ticks to the next slot.
    wait: u32,
    line: [N; SLOTS],
    governor: G,
    targets: [N; PARTS],
    ramped: [N; PARTS],
}

/// Constants of [`InputShaper`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct InputShaperConfig<N: Number, C> {
    /// Largest change of a part's setpoint in a tick (rad/s).
    pub ramp: N,
    /// Ticks of a slot, 1 or more.
    pub slot: u32,
    /// Share of the later of two parts.
    pub share: N::Coefficient,
    /// Constants of the governor.
    pub governor: C,
}

impl<N: Number, G: Default, const SLOTS: usize, const PARTS: usize> Default for InputShaper<G, SLOTS, PARTS, N> {
    fn default() -> Self {
        const {
            assert!(
                PARTS >= 2 && SLOTS >= 1 && SLOTS.is_multiple_of(PARTS - 1),
                "SLOTS must be a multiple of PARTS - 1"
            );
        }
        Self {
            governor: G::default(),
            setpoint: N::ZERO,
            initial: N::ZERO,
            line: [N::ZERO; SLOTS],
            at: 0,
            filled: 0,
            wait: 0,
            targets: [N::ZERO; PARTS],
            ramped: [N::ZERO; PARTS],
        }
    }
}

impl<N: Number, G, const SLOTS: usize, const PARTS: usize> InputShaper<G, SLOTS, PARTS, N> {
    /// The governor inside.
    pub fn governor(&self) -> &G {
        &self.governor
    }

    /// Takes the setpoint into the line, and each part's target from it.
    #[inline(always)]
    fn take(&mut self) {
        let (at, filled) = (self.at, self.filled);
        self.targets = core::array::from_fn(|part| {
            // in slots; the whole line for the last part, whose setpoint makes room for the new one
            let late = part * SLOTS / (PARTS - 1);
            let from = if at >= late { at - late } else { at + SLOTS - late };
            match self.line.get(from) {
                _ if part == 0 => self.setpoint,
                Some(setpoint) if filled >= late => *setpoint,
                _ => self.initial,
            }
        });
        if let Some(place) = self.line.get_mut(at) {
            *place = self.setpoint;
        }
        self.at = if at + 1 < SLOTS { at + 1 } else { 0 };
        self.filled = if filled < SLOTS { filled + 1 } else { SLOTS };
    }

    /// The parts' ramps one tick on, and their mixture.
    #[inline(always)]
    fn shaped(&mut self, ramp: N, slot: u32, share: N::Coefficient) -> N {
        if self.wait == 0 {
            self.take();
            self.wait = slot;
        }
        self.wait = self.wait.wrapping_sub(1);
        for (ramped, target) in self.ramped.iter_mut().zip(self.targets) {
            *ramped = *ramped + (target - *ramped).limited(ramp);
        }
        let mut mixed = self.ramped;
        for _ in 1..PARTS {
            // each with the next one; the last stays
            mixed = core::array::from_fn(|part| match (mixed.get(part), mixed.get(part + 1)) {
                (Some(earlier), Some(later)) => *earlier + (*later - *earlier).times(share),
                (Some(last), None) => *last,
                _ => N::ZERO,
            });
        }
        mixed.first().copied().unwrap_or(N::ZERO)
    }

    /// As though the machine had run at this speed for long.
    fn settle(&mut self, speed: N) {
        (self.setpoint, self.initial) = (N::ZERO, speed);
        (self.at, self.filled, self.wait) = (0, 0, 0);
        (self.targets, self.ramped) = ([speed; PARTS], [speed; PARTS]);
    }
}

impl<N: Number, G: Governor<N>, const SLOTS: usize, const PARTS: usize> Governor<N>
    for InputShaper<G, SLOTS, PARTS, N>
{
    type Config = InputShaperConfig<N, G::Config>;

    const COMMANDS: bool = G::COMMANDS;

    #[inline(always)]
    fn set_setpoint(&mut self, setpoint: N) {
        self.setpoint = setpoint;
    }

    #[inline(always)]
    fn set_steady_speed(&mut self, steady_speed: Option<N>) {
        self.governor.set_steady_speed(steady_speed);
    }

    #[inline(always)]
    fn set_known_torque(&mut self, known_torque: N) {
        self.governor.set_known_torque(known_torque);
    }

    #[inline(always)]
    fn set_response(&mut self, config: &Self::Config, torque: N, innovation: N) {
        self.governor.set_response(&config.governor, torque, innovation);
    }

    #[inline(always)]
    fn is_to_judge(&self) -> bool {
        self.governor.is_to_judge()
    }

    fn judge(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        self.governor.judge(&config.governor, estimate);
    }

    #[inline(always)]
    fn set_turn_in_hold(&mut self, config: &Self::Config, turned: N) {
        self.governor.set_turn_in_hold(&config.governor, turned);
    }

    #[inline(always)]
    fn faults(&self) -> Faults {
        self.governor.faults()
    }

    #[inline(always)]
    fn command(&mut self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        let setpoint = self.shaped(config.ramp, config.slot, config.share);
        self.governor.set_setpoint(setpoint);
        self.governor.command(&config.governor, estimate)
    }

    fn permitted(&self, config: &Self::Config, estimate: &Estimate<N>, torque: N) -> N {
        self.governor.permitted(&config.governor, estimate, torque)
    }

    fn start(&mut self, config: &Self::Config, estimate: &Estimate<N>, torque: N) {
        self.settle(estimate.motor_speed);
        self.governor.start(&config.governor, estimate, torque);
    }

    fn switch(&mut self, from: &Self::Config, to: &Self::Config, estimate: &Estimate<N>) {
        self.governor.switch(&from.governor, &to.governor, estimate);
    }

    #[inline(always)]
    fn angle_lost(&mut self, config: &Self::Config, estimate: &Estimate<N>) {
        self.settle(estimate.motor_speed);
        self.governor.angle_lost(&config.governor, estimate);
    }
}
