//! Backlash take-up: a limit around another one that closes an open gap with little torque, ramps the torque up on the
//! flank that it drives, and damps the shaft.

use super::Limit;
use crate::number::Number;
use crate::sample::Estimate;

/// Constants of [`BacklashTakeUp`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashTakeUpConfig<N: Number, L> {
    /// Least reach: largest torque in the gap and on the flank that is not driven (N m).
    pub torque: N,
    /// Damping of the twist rate while the gap is open (N m s/rad), negative.
    pub braking: N::Coefficient,
    /// Rise of the reach per tick on the driven flank (N m).
    pub step: N,
    /// Fall of the reach per tick in the gap and on the other flank (N m), negative.
    pub fall: N,
    /// Largest reach (N m).
    pub max_torque: N,
    /// Active damping -k_d (N m s/rad), on the twist rate, in contact.
    pub damping: N::Coefficient,
    /// Ramp tracking: setpoint per torque withheld, 1/k_p (rad/(s N m)).
    pub tracking: N::Coefficient,
    /// Constants of the other limit.
    pub limit: L,
}

/// Another limit, and an open gap is closed with little torque.
///
/// A motor that accelerates freely through a gap meets the load at a relative speed delta omega, and the impact adds
/// `delta omega sqrt(k J_m J_l/(J_m + J_l))` to the shaft's torque [derived; headings: Huang 1987 ch. 3 to 7]; a torque
/// applied at once adds its share of the load's inertia a second time. So
///
/// - the reach, the largest torque of the governor, rises by a step a tick while the shaft is on the flank that the
///   governor's torque drives. Then the torque builds up over part of a period of the resonance, and a shaft in contact
///   for longer is not limited;
/// - in the gap and on the other flank the reach falls, down to a small torque;
/// - in the gap a damping of the twist rate brakes: the gap closes at about the approach speed, torque over damping, at
///   most;
/// - in contact, `-k_d (omega_m - omega_l)` damps the shaft.
///
/// The gap counts as open where the estimated shaft torque is exactly zero, as in
/// [`BacklashObserver`](crate::observer::BacklashObserver). An observer of a motor that is heavier than described finds
/// contact too early, mostly on the flank that the motor leaves: there the torque must not build up.
///
/// The limit does not wind up the integral of its [`SpeedGovernor`](super::SpeedGovernor), and its ramp tracks: while
/// the reach withholds torque, the ramped setpoint waits. Otherwise the error grows through the gap, and the motor
/// meets the flank under its largest torque.
///
/// ```
/// use driveline::governor::{BacklashTakeUp, BacklashTakeUpConfig, Limit, SymmetricLimit, SymmetricLimitConfig};
/// use driveline::sample::Estimate;
/// // 50 N m in the gap; on the driven flank 1 N m a tick more, up to 550 N m
/// const CONFIG: BacklashTakeUpConfig<f64, SymmetricLimitConfig<f64>> = BacklashTakeUpConfig {
///     torque: 50.0, braking: -25.0, step: 1.0, fall: -2.0, max_torque: 550.0, damping: 0.0, tracking: 0.0,
///     limit: SymmetricLimitConfig { torque: 550.0 },
/// };
/// let mut limit = BacklashTakeUp::<SymmetricLimit, f64>::default();
/// let [open, driven] = [0.0, 10.0].map(|shaft_torque| Estimate { shaft_torque, ..Estimate::default() });
/// let mut most = |estimate| (0..100).map(|_| limit.limit(&CONFIG, estimate, 400.0)).last();
/// assert_eq!((most(&open), most(&driven)), (Some(50.0), Some(150.0)));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashTakeUp<L, N = f32> {
    reach: N,
    limit: L,
}

impl<N: Number, L: Limit<N>> Limit<N> for BacklashTakeUp<L, N> {
    type Config = BacklashTakeUpConfig<N, L::Config>;

    #[inline(always)]
    fn most(&self, config: &Self::Config, estimate: &Estimate<N>) -> N {
        self.limit.most(&config.limit, estimate)
    }

    #[inline(always)]
    fn permitted(&self, config: &Self::Config, estimate: &Estimate<N>, wanted: N) -> N {
        self.limit.permitted(&config.limit, estimate, wanted)
    }

    #[inline(always)]
    fn limit(&mut self, config: &Self::Config, estimate: &Estimate<N>, wanted: N) -> N {
        let twist_rate = estimate.motor_speed - estimate.load_speed;
        // positive where the torque drives the flank that the shaft is on
        let driven = estimate.shaft_torque.scaled(wanted);
        let (reach, damping) = if driven > N::ZERO {
            let reach = self.reach + config.step;
            (if reach < config.max_torque { reach } else { config.max_torque }, config.damping)
        } else {
            let reach = self.reach + config.fall;
            let damping = if estimate.shaft_torque == N::ZERO { config.braking } else { config.damping };
            (if reach > config.torque { reach } else { config.torque }, damping)
        };
        self.reach = reach;
        let allowed = (wanted.limited(self.reach) + twist_rate.gained::<4>(damping)).saturated();
        self.limit.limit(&config.limit, estimate, allowed)
    }

    #[inline(always)]
    fn track(&self, config: &Self::Config, setpoint: N, wanted: N) -> N {
        // at most twice the base in fixed point, as is what the governor wants
        setpoint + (wanted.limited(self.reach) - wanted).widened().times(config.tracking)
    }

    #[inline(always)]
    fn start(&mut self, torque: N) {
        self.reach = torque.magnitude();
        self.limit.start(torque);
    }
}
