//! The variants that can be flashed, and the one that this image holds.
//!
//! One line a variant: its name (the scene's [`Scene::NAME`](crate::scene::Scene::NAME): scene, number, observer,
//! ticks a second) and its type. `DRIVELINE_VARIANT` chooses the line at build time; [`Selected`] is the type.

use driveline::governor::SpeedLoop;
use driveline::number::Fixed;
use driveline::observer::{Geared, Rigid, SemiImplicit, TwoMass};

use crate::balanced::Balanced;
use crate::governed::Governed;
use crate::scenes::balanced_fan::BalancedFan;
use crate::scenes::composition::{ByHand, Composed, Of};
use crate::scenes::empty::Empty;
use crate::scenes::flexible::Flexible;
use crate::scenes::grinding_spindle::GrindingSpindle;
use crate::scenes::hoist::{Hoist, with};
use crate::variants::variants;

variants! {
    "empty/f32/none/10000" => Empty,
    "composition/f32/rigid-observer/10000" => Composed<Of<f32, Rigid<f32>, ()>>,
    "composition/f32/rigid-governed/10000" => Composed<Of<f32, Rigid<f32>, SpeedLoop<f32>>>,
    "composition/f32/semi-implicit-observer/10000" => Composed<Of<f32, SemiImplicit<f32>, ()>>,
    "composition/f32/semi-implicit-governed/10000" => Composed<Of<f32, SemiImplicit<f32>, SpeedLoop<f32>>>,
    "composition/f32/two-mass-observer/10000" => Composed<Of<f32, TwoMass<f32>, ()>>,
    "composition/f32/two-mass-governed/10000" => Composed<Of<f32, TwoMass<f32>, SpeedLoop<f32>>>,
    "composition/f32/two-mass-geared-observer/10000" => Composed<Of<f32, Geared<TwoMass<f32>>, ()>>,
    "composition/f32/two-mass-geared-governed/10000" => Composed<Of<f32, Geared<TwoMass<f32>>, SpeedLoop<f32>>>,
    "composition/f32/two-mass-by-hand/10000" => ByHand<f32, TwoMass<f32>>,
    "composition/fixed/rigid-observer/10000" => Composed<Of<Fixed, Rigid<Fixed>, ()>>,
    "composition/fixed/rigid-governed/10000" => Composed<Of<Fixed, Rigid<Fixed>, SpeedLoop<Fixed>>>,
    "composition/fixed/semi-implicit-observer/10000" => Composed<Of<Fixed, SemiImplicit<Fixed>, ()>>,
    "composition/fixed/semi-implicit-governed/10000" => Composed<Of<Fixed, SemiImplicit<Fixed>, SpeedLoop<Fixed>>>,
    "composition/fixed/two-mass-observer/10000" => Composed<Of<Fixed, TwoMass<Fixed>, ()>>,
    "composition/fixed/two-mass-governed/10000" => Composed<Of<Fixed, TwoMass<Fixed>, SpeedLoop<Fixed>>>,
    "composition/fixed/two-mass-geared-observer/10000" => Composed<Of<Fixed, Geared<TwoMass<Fixed>>, ()>>,
    "composition/fixed/two-mass-geared-governed/10000" => Composed<Of<Fixed, Geared<TwoMass<Fixed>>, SpeedLoop<Fixed>>>,
    "composition/fixed/two-mass-by-hand/10000" => ByHand<Fixed, TwoMass<Fixed>>,
    "balanced-fan/f32/two-mass/4000" => Balanced<BalancedFan<f32>>,
    "balanced-fan/fixed/two-mass/4000" => Balanced<BalancedFan<Fixed>>,
    "flexible/f32/two-mass/4000" => Balanced<Flexible<f32>>,
    "flexible/fixed/two-mass/4000" => Balanced<Flexible<Fixed>>,
    "hoist/f32/rigid/1000" => Governed<Hoist<f32, with::Rigid, 1000>>,
    "hoist/f32/rigid/4000" => Governed<Hoist<f32, with::Rigid, 4000>>,
    "hoist/f32/rigid/10000" => Governed<Hoist<f32, with::Rigid, 10000>>,
    "hoist/f32/cut/1000" => Governed<Hoist<f32, with::Cut, 1000>>,
    "hoist/f32/cut/4000" => Governed<Hoist<f32, with::Cut, 4000>>,
    "hoist/f32/cut/10000" => Governed<Hoist<f32, with::Cut, 10000>>,
    "hoist/f32/exact/1000" => Governed<Hoist<f32, with::Exact, 1000>>,
    "hoist/f32/exact/4000" => Governed<Hoist<f32, with::Exact, 4000>>,
    "hoist/f32/exact/10000" => Governed<Hoist<f32, with::Exact, 10000>>,
    "hoist/f32/reduced/1000" => Governed<Hoist<f32, with::Reduced, 1000>>,
    "hoist/f32/reduced/4000" => Governed<Hoist<f32, with::Reduced, 4000>>,
    "hoist/f32/reduced/10000" => Governed<Hoist<f32, with::Reduced, 10000>>,
    "hoist/fixed/rigid/1000" => Governed<Hoist<Fixed, with::Rigid, 1000>>,
    "hoist/fixed/rigid/4000" => Governed<Hoist<Fixed, with::Rigid, 4000>>,
    "hoist/fixed/rigid/10000" => Governed<Hoist<Fixed, with::Rigid, 10000>>,
    "hoist/fixed/cut/1000" => Governed<Hoist<Fixed, with::Cut, 1000>>,
    "hoist/fixed/cut/4000" => Governed<Hoist<Fixed, with::Cut, 4000>>,
    "hoist/fixed/cut/10000" => Governed<Hoist<Fixed, with::Cut, 10000>>,
    "hoist/fixed/exact/1000" => Governed<Hoist<Fixed, with::Exact, 1000>>,
    "hoist/fixed/exact/4000" => Governed<Hoist<Fixed, with::Exact, 4000>>,
    "hoist/fixed/exact/10000" => Governed<Hoist<Fixed, with::Exact, 10000>>,
    "hoist/fixed/reduced/1000" => Governed<Hoist<Fixed, with::Reduced, 1000>>,
    "hoist/fixed/reduced/4000" => Governed<Hoist<Fixed, with::Reduced, 4000>>,
    "hoist/fixed/reduced/10000" => Governed<Hoist<Fixed, with::Reduced, 10000>>,
    "grinding-spindle/f32/two-mass/4000" => Balanced<GrindingSpindle<f32>>,
    "grinding-spindle/fixed/two-mass/4000" => Balanced<GrindingSpindle<Fixed>>,
}
