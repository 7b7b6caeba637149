//! Load sharing of several motors on one gear, with a torque bias against backlash.

use crate::number::Number;

/// Constants of [`LoadSharing`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadSharingConfig<N: Number> {
    /// A motor's share 1/n, on the [widened](Number::widened) torque.
    pub share: N::Coefficient,
    /// Torque at which the holding motors stay on their flank (N m).
    pub preload: N,
    /// Share of the shaft torque above which all motors share equally (N m).
    pub equal_above: N,
    /// Share of the shaft torque below which they are biased again (N m).
    pub bias_below: N,
    /// Largest change of the bias in a tick (N m); more only where the torque limit needs its room.
    pub step: N,
    /// Largest torque of a motor, either way (N m).
    pub torque_limit: N,
    /// Damping against the mean, negative: torque per angle that the lag has not followed.
    pub damping: N::Coefficient,
    /// Lag of the damping: 2^lag ticks.
    pub lag: u32,
    /// Largest plausible deviation of a motor from the first (2^-32 turn).
    pub max_deviation: i32,
}

/// Load sharing of `MOTORS` motors, an even number of them.
///
/// A ring gear has `n` pinions, each with a motor, a gearbox and backlash of its own. The governor commands one torque
/// `tau` for all of them, from the mean of their angles. Each motor gets its share; every other one gets a bias `b`
/// more, the ones between get as much less:
///
/// ```text
/// tau_k = tau/n +- b - d_k,     b towards |tau_s|/n + preload,     tau_s the estimated shaft torque
/// ```
///
/// So one half of the pinions carries the load on the forward flanks and the other half stays on its backward flanks
/// with the preload, or the other way round, whatever sign the load has: the torque reverses and no flank is left. The
/// sum is `tau` whatever the bias, but where a motor's damping is cut at its limit. The price is that half of the
/// motors carry the load, twice its share each.
///
/// Above a limit of `|tau_s|/n` all motors share the load equally, until it has fallen below another limit. Then the
/// holding pinions cross their backlash, while the others carry the load. The bias changes by a slew, so that they
/// cross it slowly; where a motor's torque limit leaves it less room, it falls at once.
///
/// Motors that swing against each other are not seen in their mean, and no governor of the mean damps them. `d_k` does:
/// a damping of the speed by which motor `k` deviates from the mean, `k_d w/(s + w) s`, from its angle.
///
/// [Derived; heading: Huang 1987 ch. 8 and 12.]
///
/// ```
/// use driveline::governor::{LoadSharing, LoadSharingConfig};
/// // two pinions on a ring gear, 10 N m of bias that changes by 1 N m a tick, no damping against each other
/// const CONFIG: LoadSharingConfig<f64> = LoadSharingConfig {
///     share: 0.5, preload: 10.0, equal_above: 200.0, bias_below: 150.0, step: 1.0, torque_limit: 100.0,
///     damping: 0.0, lag: 4, max_deviation: 1 << 24,
/// };
/// let mut sharing = LoadSharing::<f64, 2>::default();
/// let torques = (0..20).map(|_| sharing.torques(&CONFIG, 0.0, 0.0)).last().unwrap();
/// // the mount stands still, and each pinion presses on a flank of its own
/// assert_eq!((torques[0] + torques[1], torques[0].abs()), (0.0, 10.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
// The order keeps the runs of words that a start clears short: for long ones the compiler calls a loop to clear them.
#[repr(C)]
pub struct LoadSharing<N, const MOTORS: usize> {
    bias: N,
    /// Deviation of each motor from the mean (2^-32 turn).
    deviation: [i32; MOTORS],
    /// The encoders' zeros, less the first one's (2^-32 turn).
    zero: [u32; MOTORS],
    /// The deviation after the lag (2^-32 turn).
    lagged: [i32; MOTORS],
    equal: bool,
    /// Bit k: the angle of motor k was left out.
    left_out: u32,
}

impl<N: Number, const MOTORS: usize> Default for LoadSharing<N, MOTORS> {
    fn default() -> Self {
        LoadSharing {
            bias: N::ZERO,
            equal: false,
            zero: [0; MOTORS],
            deviation: [0; MOTORS],
            lagged: [0; MOTORS],
            left_out: 0,
        }
    }
}

impl<N: Number, const MOTORS: usize> LoadSharing<N, MOTORS> {
    const EVEN: () = assert!(
        MOTORS >= 2 && MOTORS <= 32 && MOTORS.is_multiple_of(2),
        "the bias of a load sharing needs an even number of motors, from 2 to 32"
    );

    /// Takes the angles (2^-32 turn) of the motors at rest for zero deviation, without bias: in every tick with the
    /// brake closed. Gives the angle of the drive, that of the first motor.
    #[inline]
    pub fn hold(&mut self, angles: &[u32; MOTORS]) -> u32 {
        let Some(&first) = angles.first() else { return 0 };
        self.zero = angles.map(|angle| angle.wrapping_sub(first));
        (self.bias, self.equal, self.left_out) = (N::ZERO, false, 0);
        (self.deviation, self.lagged) = ([0; MOTORS], [0; MOTORS]);
        first
    }

    /// The mean angle (2^-32 turn) of the motors: that of the drive. Once a tick.
    ///
    /// An angle that deviates implausibly from the first motor's is left out, and its motor goes on beside the first
    /// one as it last did: [`left_out`](Self::left_out). The drive itself screens the mean, and so the first motor's
    /// angle.
    #[inline(always)]
    pub fn mean_angle(&mut self, config: &LoadSharingConfig<N>, angles: &[u32; MOTORS]) -> u32 {
        let () = Self::EVEN;
        let Some(&first) = angles.first() else { return 0 };
        let mut sum = 0_i32;
        self.left_out = 0;
        let before = self.deviation.first().copied().unwrap_or_default();
        for (k, ((deviation, angle), zero)) in self.deviation.iter_mut().zip(angles).zip(&self.zero).enumerate() {
            let turned = angle.wrapping_sub(first).wrapping_sub(*zero) as i32;
            let plausible = turned <= config.max_deviation && turned >= -config.max_deviation;
            *deviation = if plausible { turned } else { deviation.wrapping_sub(before) };
            self.left_out |= u32::from(!plausible) << (k & 31);
            sum = sum.wrapping_add(*deviation);
        }
        let mean = sum / const { MOTORS as i32 };
        for (deviation, lagged) in self.deviation.iter_mut().zip(&mut self.lagged) {
            *deviation = deviation.wrapping_sub(mean);
            *lagged = lagged.wrapping_add(deviation.wrapping_sub(*lagged) >> (config.lag & 31));
        }
        first.wrapping_add(mean as u32)
    }

    /// The motors' torques for the tick that begins, from the governor's `torque` and the estimated `shaft_torque` of
    /// them all. Once a tick, after [`mean_angle`](Self::mean_angle).
    #[inline(always)]
    pub fn torques(&mut self, config: &LoadSharingConfig<N>, torque: N, shaft_torque: N) -> [N; MOTORS] {
        let share = torque.saturated().widened().times(config.share);
        let load = shaft_torque.saturated().widened().times(config.share).magnitude();
        if load > config.equal_above {
            self.equal = true;
        } else if load < config.bias_below {
            self.equal = false;
        }
        let wanted = if self.equal { N::ZERO } else { load + config.preload };
        let bias = self.bias + (wanted - self.bias).limited(config.step);
        // at once: what is cut off one motor must not be missing from the sum
        let room = config.torque_limit - share.magnitude();
        let bias = if bias > room { room } else { bias };
        self.bias = if bias > N::ZERO { bias } else { N::ZERO };
        let mut torques = [share; MOTORS];
        for (k, (torque, (deviation, lagged))) in
            torques.iter_mut().zip(self.deviation.iter().zip(&self.lagged)).enumerate()
        {
            // 5.6 degrees: what an operand holds in fixed point
            let moved = deviation.wrapping_sub(*lagged).clamp(-(1 << 26) + 1, (1 << 26) - 1);
            let damping = N::from_angle(moved).innovation_operand().times(config.damping);
            let biased = if k & 1 == 0 { *torque + self.bias } else { *torque - self.bias };
            *torque = (biased + damping).limited(config.torque_limit);
        }
        torques
    }

    /// The motors give no torque and may have left their flanks: the bias begins at zero, the encoders' zeros stand. In
    /// every tick with a lost angle.
    #[inline]
    pub fn release(&mut self) {
        (self.bias, self.equal, self.lagged) = (N::ZERO, false, self.deviation);
    }

    /// The bias (N m).
    pub fn bias(&self) -> N {
        self.bias
    }

    /// Bit k: the angle of motor k was implausible in the last tick, and was left out. All bits but the first: the
    /// first motor's own angle is the likely fault.
    #[inline(always)]
    pub fn left_out(&self) -> u32 {
        self.left_out
    }
}

#[cfg(test)]
mod tests {
    use super::{LoadSharing, LoadSharingConfig};

    const CONFIG: LoadSharingConfig<f64> = LoadSharingConfig {
        share: 0.25,
        preload: 2.0,
        equal_above: 10.0,
        bias_below: 8.0,
        step: 1.0,
        torque_limit: 20.0,
        damping: -0.5,
        lag: 4,
        max_deviation: 1000,
    };

    /// Steady torques of motors that do not deviate.
    fn steady(sharing: &mut LoadSharing<f64, 4>, torque: f64, shaft_torque: f64) -> [f64; 4] {
        (0..100).map(|_| sharing.torques(&CONFIG, torque, shaft_torque)).last().unwrap_or_default()
    }

    #[test]
    fn one_pair_carries_the_load_and_the_other_holds_the_preload_whatever_the_sign() {
        let mut sharing = LoadSharing::default();
        assert_eq!(steady(&mut sharing, 0.0, 0.0), [2.0, -2.0, 2.0, -2.0]);
        assert_eq!(steady(&mut sharing, 24.0, 24.0), [14.0, -2.0, 14.0, -2.0]);
        assert_eq!(steady(&mut sharing, -24.0, -24.0), [2.0, -14.0, 2.0, -14.0]);
    }

    #[test]
    fn above_the_limit_all_share_equally_until_below_the_other() {
        let mut sharing = LoadSharing::default();
        assert_eq!(steady(&mut sharing, 44.0, 44.0), [11.0; 4]);
        assert_eq!(steady(&mut sharing, 36.0, 36.0), [9.0; 4]);
        assert!(sharing.equal);
        assert_eq!(steady(&mut sharing, 28.0, 28.0), [16.0, -2.0, 16.0, -2.0]);
        assert!(!sharing.equal);
        assert_eq!(steady(&mut sharing, 36.0, 36.0), [20.0, -2.0, 20.0, -2.0]);
    }

    #[test]
    fn after_a_lost_angle_the_bias_begins_at_zero_and_the_zeros_stand() {
        let mut sharing = LoadSharing::<f64, 2>::default();
        let config = LoadSharingConfig { share: 0.5, ..CONFIG };
        sharing.hold(&[0, 1000]);
        sharing.mean_angle(&config, &[100, 1300]);
        sharing.torques(&config, 8.0, 8.0);
        assert_eq!(sharing.bias(), 1.0);
        sharing.release();
        assert_eq!(sharing.bias(), 0.0);
        // standing as they last stood: no damping, the bias rises by its step
        assert_eq!(sharing.mean_angle(&config, &[100, 1300]), 200);
        assert_eq!(sharing.torques(&config, 8.0, 8.0), [5.0, 3.0]);
    }

    /// The sum is the governor's torque in every tick, also while the bias changes and in tick 60, in which the torque
    /// limit leaves it less room at once.
    #[test]
    fn the_bias_leaves_the_sum_alone_and_changes_by_its_step() {
        let mut sharing = LoadSharing::<f64, 4>::default();
        let mut last = 0.0;
        for tick in 0..200 {
            let torque = if tick < 60 { 39.0 } else { -70.0 };
            let torques = sharing.torques(&CONFIG, torque, torque);
            assert_eq!(torques.iter().sum::<f64>(), torque, "{tick}");
            let change: f64 = sharing.bias() - last;
            assert!(change.abs() <= 1.0 || (tick == 60 && change < 0.0), "{tick}: {change}");
            assert!(sharing.bias() >= 0.0, "{tick}");
            assert!(torques.iter().all(|torque| torque.abs() <= 20.0), "{tick}");
            last = sharing.bias();
        }
        assert!(sharing.equal);
    }

    #[test]
    fn the_mean_wraps_and_the_encoders_zeros_do_not_matter() {
        let mut sharing = LoadSharing::<f64, 4>::default();
        let zeros = [u32::MAX - 10, 5, 1 << 31, 77];
        assert_eq!(sharing.hold(&zeros), zeros[0]);
        let turned = [100_u32, 300, 0, 400];
        let mut angles = zeros;
        for (angle, turned) in angles.iter_mut().zip(turned) {
            *angle = angle.wrapping_add(turned);
        }
        assert_eq!(sharing.mean_angle(&CONFIG, &angles), zeros[0].wrapping_add(200));
        assert_eq!(sharing.left_out(), 0);
        angles[2] = angles[2].wrapping_add(5000);
        // 100 behind the first, as before: the mean does not move
        assert_eq!(sharing.mean_angle(&CONFIG, &angles), zeros[0].wrapping_add(200));
        assert_eq!(sharing.left_out(), 0b100);
        angles = angles.map(|angle| angle.wrapping_add(50));
        assert_eq!(sharing.mean_angle(&CONFIG, &angles), zeros[0].wrapping_add(250));
    }

    /// A motor that moves on evenly by `v` a tick lags by `v 2^lag` less a tick's own: the damping is that of a speed,
    /// and of a standing deviation there is none.
    #[test]
    fn the_damping_is_of_the_speed_against_the_mean_and_not_of_the_deviation() {
        let mut sharing = LoadSharing::<f64, 2>::default();
        let config = LoadSharingConfig { preload: 0.0, share: 0.5, max_deviation: i32::MAX, ..CONFIG };
        sharing.hold(&[0; 2]);
        let mut angles = [0_u32; 2];
        for _ in 0..500 {
            angles[1] += 4;
            sharing.mean_angle(&config, &angles);
        }
        // 2 a tick from the mean, 2^4 ticks: 30 = 2 (16 - 1), and a floor of 16 parts
        let [first, second] = sharing.torques(&config, 0.0, 0.0);
        assert!((first - 15.0).abs() <= 8.0 && (second + 15.0).abs() <= 8.0, "{first} {second}");
        for _ in 0..500 {
            sharing.mean_angle(&config, &angles);
        }
        let [first, second] = sharing.torques(&config, 0.0, 0.0);
        assert!(first.abs() <= 8.0 && second.abs() <= 8.0, "{first} {second}");
    }
}
