//! A bridge crane's hoist: 12 t on two falls of rope.
//!
//! A 116 kW, four-pole motor at 1480 r/min drives a 0.8 m drum through a gearbox of 31.5 and lifts 12 t at 0.98 m/s. On
//! the motor's shaft sits the drum of the holding brake. The rope's stiffness at the load is that of the hoist in
//! [Huang 1987 ch. 1] (2.87 MN/m for 8.7 t on two falls); inertias and efficiency are of the size that makers' tables
//! give for such a motor (frame size 315, 0.6 kg m2) and a two-stage gearbox. They are not those of one machine.

mod learnt;
mod machine;

use driveline::configure::Machine;
use driveline::design::{SemiImplicitStep, StepChoice};
use driveline::observer::{self, GearedObserver, SemiImplicitObserver};

use crate::scene::composed::Governed;
use crate::scene::table::variants;

pub use learnt::{Learnt, panel};
pub use machine::{CutAtRope, Hoist, TRAVEL};

/// The design chooses the cheap step from 4 kHz on; a change that makes it too coarse stops here.
const _: () = {
    let step = SemiImplicitStep::new(&Hoist::<4_000>::TWO_MASS, Hoist::<4_000>::PERIOD);
    assert!(matches!(StepChoice::choose(&step, StepChoice::THRESHOLD), StepChoice::SemiImplicit));
};

/// One mass.
pub type Rigid<N> = Governed<N, GearedObserver<observer::RigidObserver>>;
/// Two masses, exact step: the design's choice overruled.
pub type Exact<N> = Governed<N, GearedObserver<observer::TwoMassObserver>>;
/// Two masses, semi-implicit step: the design's choice.
pub type Reduced<N> = Governed<N, GearedObserver<SemiImplicitObserver>>;

variants! {
    "rigid": Rigid for Hoist<1_000>, Hoist<4_000>, Hoist<10_000>;
    "cut": Exact for CutAtRope<1_000>, CutAtRope<4_000>, CutAtRope<10_000>;
    "exact": Exact for Hoist<1_000>, Hoist<4_000>, Hoist<10_000>;
    "reduced": Reduced for Hoist<1_000>, Hoist<4_000>, Hoist<10_000>;
    "learnt": Learnt for Hoist<10_000>;
}
