//! Cyclic speed fluctuation: extremes, waveform, orders, flywheel.
//!
//! Everything is synchronous in angle. The cycle is a turn of the motor, two for a four-stroke engine, or any ratio of
//! whole numbers; where in it the motor is follows from its wrapped angle in integers, so that nothing drifts however
//! long the machine runs.
//!
//! | part | a tick does | gives |
//! |---|---|---|
//! | [`Extremes`] | compares the observer's speeds | every cycle: mean, extremes and delta of both speeds |
//! | [`Waveform`] | counts itself in the bin of its angle | every few cycles: waveform, orders, delta, energy |
//! | [`CycleMean`] | work at the ends of segments only | several times a cycle: the speed without its ripple |
//! | [`GearMesh`] | one order of the motor's angle | a gear's mesh and its sidebands, one after the other |
//! | a pair of any | both | both |
//! | [`Interleaved`] | the waveform's and the extremes' work by turns | both, at less than the cost of the pair |
//!
//! [`ToothWindow`] takes the times of a [toothed wheel](crate::wheel)'s teeth instead of the angles of ticks and gives
//! the same [`Ripple`]. From a ripple and the machine's constants follow speed and torque of the load
//! ([`Ripple::load_side`]) and the required flywheel ([`Ripple::flywheel`]). From that of an engine follows the
//! contribution of each cylinder ([`Ripple::cylinders`]).
//!
//! Lengthy calculations (divisions, sines, the waveform from its bins) are done by a `reading` between the ticks, in
//! `f32`; those of an `f64` drive and of a toothed wheel in `f64`.
//!
//! # Measurement by time
//! An observer follows a ripple with delay and reduced amplitude, and the quantisation of the encoder increases every
//! maximum. The time that the motor spends at each angle has neither error: counting ticks samples dt/dphi = 1/omega,
//! and over several cycles the counts of an encoder average out. With 2048 lines and 10,000 ticks a second a hundred
//! turns give an amplitude of 1/1000 of the speed to 0.5 % at the first order of a turn; the error grows with the
//! order, and falls with the root of the turns.
//!
//! # Where the cycle begins
//! At the angle 0 of the encoder. A cycle of several turns begins in the turn that the machine was switched on in, and
//! in any turn after the angle was lost: where half orders must have a phase, the phase of a cam is to be added.
//!
//! ```
//! use driveline::settings::{Bases, Cycle};
//! use driveline::fluctuation::{CycleConfig, Fluctuation, MachineClass, Waveform, WaveformConfig};
//! use driveline::sample::Estimate;
//!
//! /// A turn of the motor, in ticks of 100 us; 64 bins, over 16 turns.
//! const CYCLE: CycleConfig = CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI);
//! const CONFIG: WaveformConfig = WaveformConfig::new::<64>(CYCLE, 16);
//!
//! // in a drive: `Drive<f32, TwoMassObserver, .., Waveform<64>>`
//! let mut waveform = Waveform::<64, f32>::default();
//! let mut phi = 0.0_f64;
//! let ripple = loop {
//!     phi += 1e-4 * 150.0 * (1.0 + 0.01 * (2.0 * phi).cos()); // 2 % from peak to peak, twice a turn
//!     let angle = (phi / core::f64::consts::TAU * 4_294_967_296.0) as u64 as u32;
//!     waveform.measure(&CONFIG, angle, 0.0, &Estimate::default()); // in a drive: `drive.tick(..)`
//!     if let Some(window) = waveform.take() { // in a drive: `drive.fluctuation_mut().take()`, between two ticks
//!         break window.ripple(&CONFIG, 4).unwrap(); // four orders; and this in its own time
//!     }
//! };
//! assert!((ripple.motor.delta - 0.02).abs() < 1e-4);
//! assert!((ripple.speed.order(2).amplitude() - 1.5).abs() < 0.01);
//! assert!(f64::from(ripple.motor.delta) > MachineClass::Generator.permissible()[1]);
//! ```
//!
//! # Terms
//! *Slowness*: dt/dphi, the inverse of the speed. *Order*: multiples of a cycle's frequency; order 1 of a cycle of two
//! turns is the half order of the engine. *Delta*: coefficient of speed fluctuation (omega_max - omega_min)/omega_m
//! [Notes ch. 5]. *Ripple*: part of the speed that is periodic in the cycle; *trend*: the rest.

mod bin;
mod cycle_mean;
mod cylinders;
mod deviation;
mod extremes;
mod flywheel;
mod gear_mesh;
mod interleaved;
mod load_side;
mod position;
mod quality;
mod series;
mod teeth;
mod waveform;
mod window;

pub use bin::{Bin, Summed, WaveformConfig};
pub use cycle_mean::{CycleMean, CycleMeanConfig};
pub use cylinders::{Coupling, CylinderReading, CylinderVerdict, Engine};
pub use extremes::{CycleReading, Extreme, Extremes, Fluctuations, Ranked, SpeedErrors};
pub use flywheel::{Balance, Flywheel, MachineClass, Remedy};
pub use gear_mesh::{GearMesh, GearMeshConfig, GearMeshError, MeshReading, Sideband};
pub use interleaved::Interleaved;
pub use load_side::{Drivetrain, LoadSide};
pub use position::{CycleConfig, Edge};
pub use quality::{Quality, Unusable};
pub use series::{FourierSeries, Order};
pub use teeth::{ToothErrors, ToothWindow};
pub(crate) use waveform::PLACES;
pub use waveform::Waveform;
pub use window::{MAX_ORDER, Ripple, Window};

use crate::number::Number;
use crate::sample::Estimate;

/// A measurement of the speed's fluctuation, advanced once a tick.
///
/// ```
/// use driveline::fluctuation::{CycleConfig, Extremes, Fluctuation, Waveform, WaveformConfig};
/// use driveline::sample::Estimate;
/// use driveline::settings::{Bases, Cycle};
/// // a pair is one measurement, each with its constants
/// const CYCLE: CycleConfig = CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI);
/// const CONFIG: (CycleConfig, WaveformConfig) = (CYCLE, WaveformConfig::new::<64>(CYCLE, 1));
/// let mut both = <(Extremes<f64>, Waveform<64, f64>)>::default();
/// for tick in 0..2_000_u32 {
///     // 200 ticks a turn
///     let estimate = Estimate { motor_speed: 314.16, ..Estimate::default() };
///     both.measure(&CONFIG, tick.wrapping_mul(21_474_836), 0.0, &estimate);
/// }
/// assert!(both.0.cycles() >= 5 && both.1.take().is_some());
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` measures no fluctuation in `{N}`",
    note = "the order is `Drive<Number, Observer, Governor, Fluctuation, Balancer>`, with `()` for a part left out"
)]
#[doc(alias("cyclic irregularity", "coefficient of fluctuation"))]
pub trait Fluctuation<N: Number>: Default {
    /// Its constants, shared and immutable.
    type Config;

    /// Takes one tick's angle (2^-32 turn), the torque that the motor gave in it and the estimate into account.
    fn measure(&mut self, config: &Self::Config, angle: u32, torque: N, estimate: &Estimate<N>);

    /// This tick's angle cannot be used: the present measurement is void.
    fn disturb(&mut self);

    /// The motor's speed without its ripple, where it is known: input of a governor that is not to act on the ripple,
    /// by [`CycleAverage`](crate::governor::CycleAverage).
    #[inline(always)]
    fn steady_speed(&self) -> Option<N> {
        None
    }
}

/// Not measured.
impl<N: Number> Fluctuation<N> for () {
    type Config = ();

    #[inline(always)]
    fn measure(&mut self, _config: &(), _angle: u32, _torque: N, _estimate: &Estimate<N>) {}

    #[inline(always)]
    fn disturb(&mut self) {}
}

/// Both.
impl<N: Number, A: Fluctuation<N>, B: Fluctuation<N>> Fluctuation<N> for (A, B) {
    type Config = (A::Config, B::Config);

    #[inline(always)]
    fn measure(&mut self, config: &Self::Config, angle: u32, torque: N, estimate: &Estimate<N>) {
        self.0.measure(&config.0, angle, torque, estimate);
        self.1.measure(&config.1, angle, torque, estimate);
    }

    #[inline(always)]
    fn disturb(&mut self) {
        self.0.disturb();
        self.1.disturb();
    }

    #[inline(always)]
    fn steady_speed(&self) -> Option<N> {
        self.0.steady_speed().or(self.1.steady_speed())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Default)]
    struct Known(Option<f32>);

    impl Fluctuation<f32> for Known {
        type Config = ();

        fn measure(&mut self, _config: &(), _angle: u32, _torque: f32, _estimate: &Estimate<f32>) {}

        fn disturb(&mut self) {}

        fn steady_speed(&self) -> Option<f32> {
            self.0
        }
    }

    /// Of two measurements the first that knows it; one that knows none has none.
    #[test]
    fn a_steady_speed_is_that_of_the_first_that_knows_it() {
        let both = |first: Option<f32>, second: Option<f32>| (Known(first), Known(second)).steady_speed();
        assert_eq!([both(Some(1.0), Some(2.0)), both(None, Some(2.0)), both(None, None)], [Some(1.0), Some(2.0), None]);
        assert_eq!(Fluctuation::<f32>::steady_speed(&()), None);
    }
}
