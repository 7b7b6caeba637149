//! The hoist's drive with parts left out, to measure the cost of each: an observer alone, with a governor, under
//! supervision, with a measurement of the fluctuation.

use driveline::drive::{ConfigOf, Drive};
use driveline::fluctuation::{Extremes, Waveform};
use driveline::governor::{SpeedLoop, Supervised};
use driveline::observer::{GearedObserver, RigidObserver, SemiImplicitObserver, TwoMassObserver};

use super::hoist::Hoist;
use crate::scene::composed::{Beside, Composed, OverWords, output, sample};
use crate::scene::table::variants;
use crate::scene::{Input, Output};

/// A tick and nothing else: the drive is always at work.
pub struct AtWork;

impl<D: OverWords> Beside<D> for AtWork {
    fn start(_: &mut D, _: &ConfigOf<D>) -> Self {
        AtWork
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut D, config: &ConfigOf<D>, input: &Input) -> Output {
        let command = drive.tick(config, &sample(input));
        output(&command, &drive.estimate(config))
    }
}

/// A drive of these parts.
pub type Parts<N, O, G = (), F = ()> = Composed<Drive<N, O, G, F>, AtWork>;

/// One mass, observed.
pub type Rigid<N> = Parts<N, RigidObserver>;
/// One mass, governed.
pub type RigidGoverned<N> = Parts<N, RigidObserver, SpeedLoop>;
/// Two masses, semi-implicit step, observed.
pub type SemiImplicit<N> = Parts<N, SemiImplicitObserver>;
/// Two masses, semi-implicit step, governed.
pub type SemiImplicitGoverned<N> = Parts<N, SemiImplicitObserver, SpeedLoop>;
/// Two masses, exact step, observed.
pub type TwoMass<N> = Parts<N, TwoMassObserver>;
/// Two masses, exact step, governed.
pub type TwoMassGoverned<N> = Parts<N, TwoMassObserver, SpeedLoop>;
/// Two masses, exact step, governed under supervision.
pub type TwoMassSupervised<N> = Parts<N, TwoMassObserver, Supervised<SpeedLoop>>;
/// Two masses behind a gear, observed.
pub type Geared<N> = Parts<N, GearedObserver<TwoMassObserver>>;
/// Two masses behind a gear, governed.
pub type GearedGoverned<N> = Parts<N, GearedObserver<TwoMassObserver>, SpeedLoop>;
/// Two masses, and the extremes of the speed.
pub type TwoMassExtremes<N> = Parts<N, TwoMassObserver, (), Extremes>;
/// Two masses, and the waveform of the speed.
pub type TwoMassWaveform<N> = Parts<N, TwoMassObserver, (), Waveform<64>>;

variants! {
    "rigid-observer": Rigid for Hoist<10_000>;
    "rigid-governed": RigidGoverned for Hoist<10_000>;
    "semi-implicit-observer": SemiImplicit for Hoist<10_000>;
    "semi-implicit-governed": SemiImplicitGoverned for Hoist<10_000>;
    "two-mass-observer": TwoMass for Hoist<10_000>;
    "two-mass-governed": TwoMassGoverned for Hoist<10_000>;
    "two-mass-supervised": TwoMassSupervised for Hoist<10_000>;
    "two-mass-geared-observer": Geared for Hoist<10_000>;
    "two-mass-geared-governed": GearedGoverned for Hoist<10_000>;
    "two-mass-extremes": TwoMassExtremes for Hoist<10_000>;
    "two-mass-waveform": TwoMassWaveform for Hoist<10_000>;
}
