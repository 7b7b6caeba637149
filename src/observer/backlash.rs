//! The two-mass observer of a machine with backlash: contact on either flank, free flight between, the crossing split
//! within the tick.
//!
//! With delta the twist from the middle of the gap and h half the gap, the shaft's stretch is x = delta - h on the
//! right flank, delta + h on the left one, and zero between. In contact the pair of stretch and twist rate v moves as
//! in [`TwoMassObserver`](super::TwoMassObserver); in free flight, with s the twist forcing,
//!
//! ```text
//! delta' = delta + T v + T^2/2 s        v' = v + T s
//! ```
//!
//! A tick in which a flank is met or left is predicted by the law that it begins with; that leaves the twist y beyond
//! the flank, after the share rho = y/(delta' - delta) of the tick. What the other law would have done in that share is
//! then put right, by
//!
//! ```text
//! v' -+ (2 a y + (T w^2/2) rho y)       delta' -+ b rho y
//! ```
//!
//! with coefficients that are exact for small shares and, on a flank from which the tick begins, for the whole tick. It
//! is one division and no loop.
//!
//! # Where in the gap
//! The twist is one state through all regimes, and is kept through free flight. The side is its sign, so a wrong side
//! is put right by the same innovations that put the twist right.
//!
//! # The gains
//! In a gap the motor's angle says nothing of the load. What is known of the load then decays, and the impact brings it
//! back at once: it is the innovations just after an impact that say when it came. Two sets of constant gains do this.
//! *Settled* gains are those of the shaft in contact. *Searching* gains are the Kalman gains of the shaft in contact
//! whose twist wanders besides; they stand in the gap, where they draw the twist to a flank as soon as the motor feels
//! one, and for part of a period of the resonance after it. Which set a tick takes is counted, not computed.

use super::{Observer, Predicted};
use crate::number::Number;
use crate::sample::Estimate;

/// The law of motion in contact with a flank.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Contact<N: Number> {
    /// Increment of the twist from stretch, v and s.
    pub twist: [N::Coefficient; 3],
    /// Increment of v from stretch, v and s.
    pub twist_rate: [N::Coefficient; 3],
    /// What is put right where the tick ends in the gap: v from y and rho y, the twist from rho y.
    pub leaving: [N::Coefficient; 3],
}

/// The law of motion in the gap.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FreeFlight<N: Number> {
    /// Increment of the twist from v and s.
    pub twist: [N::Coefficient; 2],
    /// Increment of v from s.
    pub twist_rate: N::Coefficient,
    /// What is put right where the tick ends in contact: v from y and rho y, the twist from rho y.
    pub meeting: [N::Coefficient; 3],
}

/// Corrections per innovation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Correction<N: Number> {
    /// Of mean speed, v, twist and load torque.
    pub states: [N::Coefficient; 4],
    /// The share of an innovation that is taken off the residual.
    pub angle: N::Coefficient,
}

/// Constants of [`BacklashObserver`]. Made by [`crate::settings`] from a design; the fields are in SI units for floats.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashConfig<N: Number> {
    /// Twist forcing s from the motor's and the load's torque [rad/s2 per N m].
    pub forcing: [N::Coefficient; 2],
    /// Half the gap \[rad\].
    pub half_gap: N,
    /// In contact with a flank.
    pub contact: Contact<N>,
    /// In free flight.
    pub free: FreeFlight<N>,
    /// Increment of the mean speed from the accelerating torque, T/(J_m + J_l).
    pub acceleration: N::Coefficient,
    /// Turn of the motor from the sum of two mean speeds and from the twist's increment [2^-32 turn].
    pub turn: [N::Coefficient; 2],
    /// Gains of a shaft that has been in contact for some time.
    pub settled: Correction<N>,
    /// Gains in the gap, and for [`hold`](Self::hold) ticks after it.
    pub searching: Correction<N>,
    /// Ticks for which the searching gains stand after the gap has closed.
    pub hold: u32,
    /// Speed from a turn in a tick [rad/s per 2^-32 turn].
    pub speed: N::Coefficient,
    /// Motor speed above the mean, load speed below it, both per v.
    pub share: [N::Coefficient; 2],
    /// Shaft torque from stretch and v: stiffness and damping.
    pub shaft: [N::Coefficient; 2],
    /// Stretch from shaft torque at rest: compliance.
    pub compliance: N::Coefficient,
}

/// State of the observer of backlash.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashObserver<N> {
    twist: N,
    twist_rate: N,
    load_torque: N,
    speed: N,
    residual: N,
    angle: u32,
    /// Ticks for which the searching gains still stand.
    searching: u32,
}

/// The state of [`BacklashObserver`] at the end of a tick as the torque alone would have it.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BacklashPrediction<N: Number> {
    twist: N,
    twist_rate: N,
    speed: N,
    turn: N,
    innovation: N,
    carry: N::Carry,
    searching: u32,
}

impl<N: Number> Predicted<N> for BacklashPrediction<N> {
    #[inline(always)]
    fn innovation(&self) -> N {
        self.innovation
    }

    #[inline(always)]
    fn turn(&self) -> N {
        self.turn
    }
}

/// Twist and v of a tick that ends `beyond` the flank that it has met or left, the twist having come from `before`.
#[inline(always)]
fn put_right<N: Number>(
    carry: &mut N::Carry,
    [late, share, catch_up]: [N::Coefficient; 3],
    [twist, twist_rate]: [N; 2],
    beyond: N,
    before: N,
) -> (N, N) {
    let passed = beyond.passed(twist.minus(before));
    let twist_rate = twist_rate.accumulate2(carry, [late, share], [beyond.widened(), passed]);
    (twist.accumulate(carry, catch_up, passed), twist_rate)
}

impl<N: Number> BacklashObserver<N> {
    /// The twist from the middle of the gap \[rad\]: beyond half the gap the shaft is stretched.
    pub fn twist(&self) -> N {
        self.twist
    }

    /// Whether the gap is open: the shaft carries nothing.
    #[inline(always)]
    pub fn is_open(&self, config: &BacklashConfig<N>) -> bool {
        !self.twist.exceeds(config.half_gap)
    }
}

impl<N: Number> Observer<N> for BacklashObserver<N> {
    type Config = BacklashConfig<N>;
    type Prediction = BacklashPrediction<N>;

    /// Without torque the twist is taken to be in the middle of the gap, and is found at the first contact.
    fn steady(config: &BacklashConfig<N>, angle: u32, torque: N, speed: N) -> Self {
        let stretch = N::product(&mut { N::CARRY }, config.compliance, torque.widened());
        let flank = if torque == N::ZERO { N::ZERO } else { torque.flank(config.half_gap) };
        BacklashObserver {
            twist: stretch.plus(flank),
            load_torque: torque,
            speed: speed.saturated(),
            angle,
            searching: config.hold,
            ..BacklashObserver::default()
        }
    }

    fn speed_of_turn(config: &BacklashConfig<N>, turned: N) -> N {
        turned.speed_of_turn(config.speed)
    }

    fn resync(&mut self, angle: u32) {
        self.angle = angle;
        self.residual = N::ZERO;
    }

    #[inline(always)]
    fn predict(&self, config: &BacklashConfig<N>, angle: u32, torque: N) -> BacklashPrediction<N> {
        let mut carry = N::CARRY;
        let forcing = N::times2(config.forcing, [torque, self.load_torque]);
        let (rate, drive) = (self.twist_rate.widened(), forcing.widened());
        let (twist, twist_rate, searching);
        if self.twist.exceeds(config.half_gap) {
            let law = &config.contact;
            let flank = self.twist.flank(config.half_gap);
            let stretch = self.twist.minus(flank);
            let motion = [stretch.widened(), rate, drive];
            let moved = self.twist.accumulate3(&mut carry, law.twist, motion);
            let turning = self.twist_rate.accumulate3(&mut carry, law.twist_rate, motion);
            let beyond = moved.minus(flank);
            if beyond.opposes(stretch) {
                (twist, twist_rate) = put_right(&mut carry, law.leaving, [moved, turning], beyond, self.twist);
                searching = config.hold;
            } else {
                (twist, twist_rate) = (moved, turning);
                searching = self.searching.saturating_sub(1);
            }
        } else {
            let law = &config.free;
            let moved = self.twist.accumulate2(&mut carry, law.twist, [rate, drive]);
            let turning = self.twist_rate.accumulate(&mut carry, law.twist_rate, drive);
            if moved.exceeds(config.half_gap) {
                let beyond = moved.minus(moved.flank(config.half_gap));
                (twist, twist_rate) = put_right(&mut carry, law.meeting, [moved, turning], beyond, self.twist);
            } else {
                (twist, twist_rate) = (moved, turning);
            }
            searching = config.hold;
        }
        let accelerating = torque.minus(self.load_torque);
        let speed = self.speed.accumulate(&mut carry, config.acceleration, accelerating);
        let path = [self.speed.plus(speed), twist.minus(self.twist).widened()];
        let turn = N::sum2(&mut carry, config.turn, path);
        let turned = N::from_angle(angle.wrapping_sub(self.angle) as i32).plus(self.residual);
        BacklashPrediction { twist, twist_rate, speed, turn, innovation: turned.less_turn(turn), carry, searching }
    }

    #[inline(always)]
    fn correct(&mut self, config: &BacklashConfig<N>, predicted: BacklashPrediction<N>, angle: u32) {
        let mut carry = predicted.carry;
        let innovation = predicted.innovation;
        let operand = innovation.innovation_operand();
        let gains = if predicted.searching != 0 { &config.searching } else { &config.settled };
        let [speed, twist_rate, twist, load_torque] = gains.states;
        self.angle = angle;
        self.speed = predicted.speed.accumulate(&mut carry, speed, operand).saturated();
        self.twist_rate = predicted.twist_rate.accumulate(&mut carry, twist_rate, operand).saturated();
        self.twist = predicted.twist.accumulate(&mut carry, twist, operand).saturated();
        self.load_torque = self.load_torque.accumulate(&mut carry, load_torque, operand).saturated();
        self.residual = innovation.accumulate(&mut carry, gains.angle, operand);
        self.searching = predicted.searching;
    }

    /// The angle stays where it was last believed, and the residual runs on.
    #[inline(always)]
    fn coast(&mut self, predicted: BacklashPrediction<N>, angle: u32) {
        self.speed = predicted.speed.saturated();
        self.twist_rate = predicted.twist_rate.saturated();
        self.twist = predicted.twist.saturated();
        self.residual = predicted.innovation.minus(N::from_angle(angle.wrapping_sub(self.angle) as i32));
        self.searching = predicted.searching;
    }

    #[inline(always)]
    fn estimate(&self, config: &BacklashConfig<N>) -> Estimate<N> {
        let mut carry = N::CARRY;
        let rate = self.twist_rate.widened();
        let shaft_torque = if self.is_open(config) {
            N::ZERO
        } else {
            let stretch = self.twist.minus(self.twist.flank(config.half_gap));
            N::times2(config.shaft, [stretch.widened(), rate])
        };
        Estimate {
            motor_speed: self.speed.accumulate(&mut carry, config.share[0], rate),
            shaft_torque,
            load_speed: self.speed.accumulate(&mut carry, config.share[1], rate),
            load_torque: self.load_torque,
        }
    }

    #[inline(always)]
    fn angle(&self) -> u32 {
        self.angle
    }

    #[inline(always)]
    fn beyond_base(&self) -> u32 {
        N::beyond_base([self.twist, self.speed, self.load_torque])
    }
}
