//! Rotor balancing: vibration phasors on the tick; influence coefficients, correction weights and the field procedure
//! off it.
//!
//! # On the tick
//! [`Phasors`] measures the vibration at a multiple of the rotor's speed, as one complex number for each channel.
//! Several orders, or rotors behind different gears, are a tuple of them. [`Reading`] is the result, with its spread,
//! drift and variance.
//!
//! # Off the tick
//! With the feature `balancing`. [`Influence`] identifies the influence coefficients from trial runs and computes the
//! [`Correction`]: by least squares, weighted, min-max or within limits, without planes that
//! depend on others. [`Influence::modal`] balances a flexible rotor by its modes, in N or N + 2 planes.
//!
//! [`RigidUnbalance`] is the static and the couple unbalance of a rigid rotor; [`two_planes`] separates the planes of a
//! balancing machine. [`Holes`] splits a weight between holes and stock weights, [`BalanceTolerance`] grades the
//! residual unbalance (ISO 21940-11), [`from_amplitudes`] needs no phase. [`Procedure`] leads through the runs, rejects
//! impossible entries, and resumes after a power cut from a record; with the feature `parameters` the record is kept in
//! flash. [`BalancingTask`] does without trial runs, by a [`BalancingHead`] while the machine turns, and by itself;
//! [`InRun`] is its rule for the moves. Take [`Procedure`] for weights that are fitted by hand between runs,
//! [`BalancingTask`] where such a device moves them.
//!
//! # Terms
//! - **phasor**: amplitude and phase of the vibration at the rotor's order: `v = Re(X e^{i order theta})`, `theta` the
//!   rotor's angle; unit of the channel
//! - **order**: periods of the vibration on a turn of the rotor
//! - **block**: a number of whole turns that gives one phasor of its own
//! - **row**: a reading of a run: a sensor at a speed
//! - **plane**: where a weight can be put; a weight is its mass, or mass times radius, at an angle; kg, kg m
//! - **influence coefficient**: change of a row per unit weight in a plane; row per weight
//! - **run-out**: signal of a displacement sensor on a shaft that does not vibrate but is not round; unit of the
//!   channel

use crate::fault::Faults;
use crate::number::Number;

#[cfg(feature = "balancing")]
mod aim;
#[cfg(feature = "balancing")]
mod amplitude_only;
#[cfg(feature = "balancing")]
mod correction;
#[cfg(feature = "balancing")]
mod entry;
#[cfg(feature = "balancing")]
mod error;
#[cfg(feature = "balancing")]
mod head;
#[cfg(feature = "balancing")]
mod holes;
#[cfg(feature = "balancing")]
mod in_run;
#[cfg(feature = "balancing")]
mod influence;
#[cfg(feature = "balancing")]
mod matrix;
#[cfg(feature = "balancing")]
mod memory;
#[cfg(feature = "balancing")]
mod min_max;
#[cfg(feature = "balancing")]
mod modal;
mod phasor;
#[cfg(feature = "balancing")]
mod procedure;
#[cfg(feature = "balancing")]
mod qr;
mod reading;
#[cfg(all(feature = "balancing", feature = "parameters"))]
mod record;
#[cfg(feature = "balancing")]
mod rigid;
#[cfg(feature = "balancing")]
mod scalar;
#[cfg(feature = "balancing")]
mod task;
#[cfg(feature = "balancing")]
mod tolerance;

#[cfg(feature = "balancing")]
pub use aim::{Aim, Objective};
#[cfg(feature = "balancing")]
pub use amplitude_only::{FromAmplitudes, from_amplitudes};
#[cfg(feature = "balancing")]
pub use correction::{Correction, LeftOut};
#[cfg(feature = "balancing")]
pub use entry::{Entry, degrees};
#[cfg(feature = "balancing")]
pub use error::Error;
#[cfg(feature = "balancing")]
pub use head::{BalancingHead, HeadPosition};
#[cfg(feature = "balancing")]
pub use holes::{CorrectionMethod, Fitted, Holes};
#[cfg(feature = "balancing")]
pub use in_run::{AbortReason, Action, BalancingRecord, InRun, InRunConfig};
#[cfg(feature = "balancing")]
pub use influence::Influence;
#[cfg(feature = "balancing")]
pub use memory::BalancingMemory;
pub use phasor::Phasors;
#[cfg(feature = "balancing")]
pub use procedure::{CORRECTIONS, Plan, Procedure, ProcedureStep, Run};
pub use reading::{Phasor, PhasorsConfig, Reading, ReadingFault, Steadiness};
#[cfg(all(feature = "balancing", feature = "parameters"))]
pub use record::ProcedureRecord;
#[cfg(feature = "balancing")]
pub use rigid::{RigidUnbalance, one_plane_suffices};
#[cfg(feature = "balancing")]
pub use scalar::{Complex, Scalar};
#[cfg(feature = "balancing")]
pub use task::{BalancingDesign, BalancingDesignError, BalancingFault, BalancingState, BalancingTask, Look};
#[cfg(feature = "balancing")]
pub use tolerance::{BalanceTolerance, GRADES, Verdict, resultant, two_planes};

/// A measurement of the rotor's unbalance, advanced once a tick.
///
/// ```
/// use driveline::balancing::{Balancer, Phasors, PhasorsConfig};
/// use driveline::settings::PhasorSettings;
/// // a pair is one balancer: the rotor's own order and twice it, of one sensor each
/// const TWICE: PhasorSettings = PhasorSettings { order: 2, ..PhasorSettings::DIRECT };
/// static CONFIG: (PhasorsConfig<f32, 1>, PhasorsConfig<f32, 1>) = (
///     PhasorsConfig::<f32, 1>::new(&PhasorSettings::DIRECT, [0.02]),
///     PhasorsConfig::<f32, 1>::new(&TWICE, [0.02]),
/// );
/// let mut both = <(Phasors<1, 9>, Phasors<1, 9>)>::default();
/// (both.0.begin(), both.1.begin());
/// // 20 turns of 64 ticks: two whole blocks of eight turns each
/// for tick in 1..=20 * 64_u32 {
///     both.measure(&CONFIG, tick << 26, &([0.0], [0.0]));
/// }
/// assert_eq!((both.0.blocks(), both.1.blocks()), (2, 2));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` measures no vibration in `{N}`",
    note = "the order is `Drive<Number, Observer, Governor, Fluctuation, Balancer>`, with `()` for a part left out"
)]
pub trait Balancer<N: Number>: Default {
    /// Its constants, shared and immutable.
    type Config;
    /// The samples of a tick, one for each channel.
    type Vibration: Copy;

    /// Takes one tick's angle [2^-32 turn of the motor] and vibration into account.
    fn measure(&mut self, config: &Self::Config, angle: u32, vibration: &Self::Vibration);

    /// Counts a tick without a valid vibration sample: clipped or missing.
    fn missed(&mut self, faults: Faults);
}

/// Not balanced.
impl<N: Number> Balancer<N> for () {
    type Config = ();
    type Vibration = ();

    #[inline(always)]
    fn measure(&mut self, _config: &(), _angle: u32, _vibration: &()) {}

    fn missed(&mut self, _faults: Faults) {}
}

/// Two measurements side by side: two orders, or two rotors.
impl<N: Number, A: Balancer<N>, B: Balancer<N>> Balancer<N> for (A, B) {
    type Config = (A::Config, B::Config);
    type Vibration = (A::Vibration, B::Vibration);

    #[inline(always)]
    fn measure(&mut self, config: &Self::Config, angle: u32, vibration: &Self::Vibration) {
        self.0.measure(&config.0, angle, &vibration.0);
        self.1.measure(&config.1, angle, &vibration.1);
    }

    fn missed(&mut self, faults: Faults) {
        self.0.missed(faults);
        self.1.missed(faults);
    }
}

/// Three measurements side by side.
impl<N: Number, A: Balancer<N>, B: Balancer<N>, C: Balancer<N>> Balancer<N> for (A, B, C) {
    type Config = (A::Config, B::Config, C::Config);
    type Vibration = (A::Vibration, B::Vibration, C::Vibration);

    #[inline(always)]
    fn measure(&mut self, config: &Self::Config, angle: u32, vibration: &Self::Vibration) {
        self.0.measure(&config.0, angle, &vibration.0);
        self.1.measure(&config.1, angle, &vibration.1);
        self.2.measure(&config.2, angle, &vibration.2);
    }

    fn missed(&mut self, faults: Faults) {
        self.0.missed(faults);
        self.1.missed(faults);
        self.2.missed(faults);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum of the vibration, and the ticks without one.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    struct Counted(u32, u32);

    impl Balancer<f64> for Counted {
        type Config = u32;
        type Vibration = u32;

        fn measure(&mut self, config: &u32, angle: u32, vibration: &u32) {
            self.0 += config * angle + vibration;
        }

        fn missed(&mut self, _faults: Faults) {
            self.1 += 1;
        }
    }

    /// Each one of a tuple takes every tick, with its own constants and vibration.
    #[test]
    fn a_tuple_is_side_by_side() {
        let mut two = (Counted::default(), Counted::default());
        two.measure(&(1, 2), 10, &(3, 4));
        two.missed(Faults::VIBRATION_CLIPPED);
        assert_eq!(two, (Counted(13, 1), Counted(24, 1)));
        let mut three = (Counted::default(), Counted::default(), Counted::default());
        three.measure(&(1, 2, 3), 10, &(4, 5, 6));
        three.missed(Faults::VIBRATION_CLIPPED);
        assert_eq!(three, (Counted(14, 1), Counted(25, 1), Counted(36, 1)));
    }
}
