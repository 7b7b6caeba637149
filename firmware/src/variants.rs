//! The variants that can be flashed.
//!
//! One line a variant: its name (the scene's [`Scene::NAME`](crate::scene::Scene::NAME): scene, number, observer,
//! ticks a second) and its type. `DRIVELINE_VARIANT` chooses the line when a binary is built:
//! [`selected!`](crate::selected!) gives the binary that type as `Selected`.

use driveline::fluctuation::{Extremes, Waveform};
use driveline::governor::SpeedLoop;
use driveline::number::Fixed;
use driveline::observer::{GearedObserver, RigidObserver, SemiImplicitObserver, TwoMassObserver};

use crate::scene::assembled::Assembled;
use crate::scene::balanced::Balanced;
use crate::scene::governed::Governed;
use crate::scene::on_axis::OnAxis;
use crate::scene::table::variants;
use crate::scenes::balanced_fan::BalancedFan;
use crate::scenes::blooming_mill::{self, BloomingMill};
use crate::scenes::commission::Commission;
use crate::scenes::composition::{ByHand, Composed, Of};
use crate::scenes::converter::{self, Converter};
use crate::scenes::crane_travel::CraneTravel;
use crate::scenes::empty::Empty;
use crate::scenes::fan::Fan;
use crate::scenes::flexible::Flexible;
use crate::scenes::gear_drive::GearDrive;
use crate::scenes::generator::{self, Generator};
use crate::scenes::grinding_spindle::GrindingSpindle;
use crate::scenes::hoist::{Hoist, with};
use crate::scenes::planetary_drive::PlanetaryDrive;
use crate::scenes::punch_press::{self, PunchPress};
use crate::scenes::skip_winch::{self, SkipWinch};
use crate::scenes::spindle::Spindle;
use crate::scenes::strip_mill::StripMill;
use crate::scenes::test_rig::TestRig;
use crate::scenes::vibrating_screen::{self, VibratingScreen};

variants! {
    "empty/f32/none/10000" => Empty,
    "composition/f32/rigid-observer/10000" => Composed<Of<f32, RigidObserver<f32>, ()>>,
    "composition/f32/rigid-governed/10000" => Composed<Of<f32, RigidObserver<f32>, SpeedLoop<f32>>>,
    "composition/f32/semi-implicit-observer/10000" => Composed<Of<f32, SemiImplicitObserver<f32>, ()>>,
    "composition/f32/semi-implicit-governed/10000" => Composed<Of<f32, SemiImplicitObserver<f32>, SpeedLoop<f32>>>,
    "composition/f32/two-mass-observer/10000" => Composed<Of<f32, TwoMassObserver<f32>, ()>>,
    "composition/f32/two-mass-governed/10000" => Composed<Of<f32, TwoMassObserver<f32>, SpeedLoop<f32>>>,
    "composition/f32/two-mass-geared-observer/10000" => Composed<Of<f32, GearedObserver<TwoMassObserver<f32>>, ()>>,
    "composition/f32/two-mass-geared-governed/10000" => Composed<Of<f32, GearedObserver<TwoMassObserver<f32>>, SpeedLoop<f32>>>,
    "composition/f32/two-mass-extremes/10000" => Composed<Of<f32, TwoMassObserver<f32>, (), Extremes<f32>>>,
    "composition/f32/two-mass-waveform/10000" => Composed<Of<f32, TwoMassObserver<f32>, (), Waveform<f32, 64>>>,
    "composition/f32/two-mass-by-hand/10000" => ByHand<f32, TwoMassObserver<f32>>,
    "composition/fixed/rigid-observer/10000" => Composed<Of<Fixed, RigidObserver<Fixed>, ()>>,
    "composition/fixed/rigid-governed/10000" => Composed<Of<Fixed, RigidObserver<Fixed>, SpeedLoop<Fixed>>>,
    "composition/fixed/semi-implicit-observer/10000" => Composed<Of<Fixed, SemiImplicitObserver<Fixed>, ()>>,
    "composition/fixed/semi-implicit-governed/10000" => Composed<Of<Fixed, SemiImplicitObserver<Fixed>, SpeedLoop<Fixed>>>,
    "composition/fixed/two-mass-observer/10000" => Composed<Of<Fixed, TwoMassObserver<Fixed>, ()>>,
    "composition/fixed/two-mass-governed/10000" => Composed<Of<Fixed, TwoMassObserver<Fixed>, SpeedLoop<Fixed>>>,
    "composition/fixed/two-mass-geared-observer/10000" => Composed<Of<Fixed, GearedObserver<TwoMassObserver<Fixed>>, ()>>,
    "composition/fixed/two-mass-geared-governed/10000" => Composed<Of<Fixed, GearedObserver<TwoMassObserver<Fixed>>, SpeedLoop<Fixed>>>,
    "composition/fixed/two-mass-extremes/10000" => Composed<Of<Fixed, TwoMassObserver<Fixed>, (), Extremes<Fixed>>>,
    "composition/fixed/two-mass-waveform/10000" => Composed<Of<Fixed, TwoMassObserver<Fixed>, (), Waveform<Fixed, 64>>>,
    "composition/fixed/two-mass-by-hand/10000" => ByHand<Fixed, TwoMassObserver<Fixed>>,
    "generator/f32/diesel/2400" => Generator<generator::Of<f32, generator::with::Diesel>>,
    "generator/f32/turbine/2400" => Generator<generator::Of<f32, generator::with::Turbine>>,
    "generator/fixed/diesel/2400" => Generator<generator::Of<Fixed, generator::with::Diesel>>,
    "generator/fixed/turbine/2400" => Generator<generator::Of<Fixed, generator::with::Turbine>>,
    "balanced-fan/f32/two-mass/4000" => Balanced<BalancedFan<f32>>,
    "balanced-fan/fixed/two-mass/4000" => Balanced<BalancedFan<Fixed>>,
    "flexible/f32/two-mass/4000" => Balanced<Flexible<f32>>,
    "flexible/fixed/two-mass/4000" => Balanced<Flexible<Fixed>>,
    "commission/f32/two-mass/10000" => Commission,
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
    "blooming-mill/f32/backlash/10000" => Governed<BloomingMill<f32, blooming_mill::with::Backlash, 10000>>,
    "blooming-mill/f32/exact/10000" => Governed<BloomingMill<f32, blooming_mill::with::Exact, 10000>>,
    "blooming-mill/fixed/backlash/10000" => Governed<BloomingMill<Fixed, blooming_mill::with::Backlash, 10000>>,
    "blooming-mill/fixed/exact/10000" => Governed<BloomingMill<Fixed, blooming_mill::with::Exact, 10000>>,
    "blooming-mill/f32/slack/10000" => Assembled<BloomingMill<f32, blooming_mill::with::Slack, 10000>>,
    "blooming-mill/fixed/slack/10000" => Assembled<BloomingMill<Fixed, blooming_mill::with::Slack, 10000>>,
    "converter/f32/plain/10000" => Assembled<Converter<f32, converter::with::Plain>>,
    "converter/f32/slack/10000" => Assembled<Converter<f32, converter::with::Slack>>,
    "converter/fixed/plain/10000" => Assembled<Converter<Fixed, converter::with::Plain>>,
    "converter/fixed/slack/10000" => Assembled<Converter<Fixed, converter::with::Slack>>,
    "fan/f32/rigid/1000" => Governed<Fan<f32, RigidObserver<f32>>>,
    "fan/fixed/rigid/1000" => Governed<Fan<Fixed, RigidObserver<Fixed>>>,
    "spindle/f32/rigid/10000" => Governed<Spindle<f32, RigidObserver<f32>>>,
    "spindle/f32/exact/10000" => Governed<Spindle<f32, TwoMassObserver<f32>>>,
    "spindle/fixed/rigid/10000" => Governed<Spindle<Fixed, RigidObserver<Fixed>>>,
    "spindle/fixed/exact/10000" => Governed<Spindle<Fixed, TwoMassObserver<Fixed>>>,
    "strip-mill/f32/rigid/10000" => Governed<StripMill<f32, RigidObserver<f32>>>,
    "strip-mill/f32/semi-implicit/10000" => Governed<StripMill<f32, SemiImplicitObserver<f32>>>,
    "strip-mill/fixed/rigid/10000" => Governed<StripMill<Fixed, RigidObserver<Fixed>>>,
    "strip-mill/fixed/semi-implicit/10000" => Governed<StripMill<Fixed, SemiImplicitObserver<Fixed>>>,
    "planetary/f32/rigid/4000" => Governed<PlanetaryDrive<f32, GearedObserver<RigidObserver<f32>>>>,
    "planetary/f32/exact/4000" => Governed<PlanetaryDrive<f32, GearedObserver<TwoMassObserver<f32>>>>,
    "planetary/fixed/rigid/4000" => Governed<PlanetaryDrive<Fixed, GearedObserver<RigidObserver<Fixed>>>>,
    "planetary/fixed/exact/4000" => Governed<PlanetaryDrive<Fixed, GearedObserver<TwoMassObserver<Fixed>>>>,
    "crane-travel/f32/rigid/1000" => Governed<CraneTravel<f32, RigidObserver<f32>>>,
    "crane-travel/f32/semi-implicit/1000" => Governed<CraneTravel<f32, SemiImplicitObserver<f32>>>,
    "crane-travel/fixed/rigid/1000" => Governed<CraneTravel<Fixed, RigidObserver<Fixed>>>,
    "crane-travel/fixed/semi-implicit/1000" => Governed<CraneTravel<Fixed, SemiImplicitObserver<Fixed>>>,
    "skip-winch/f32/rigid/2000" => Governed<SkipWinch<f32, GearedObserver<RigidObserver<f32>>>>,
    "skip-winch/f32/semi-implicit/2000" => Governed<SkipWinch<f32, GearedObserver<SemiImplicitObserver<f32>>>>,
    "skip-winch/fixed/rigid/2000" => Governed<SkipWinch<Fixed, GearedObserver<RigidObserver<Fixed>>>>,
    "skip-winch/fixed/semi-implicit/2000" => Governed<SkipWinch<Fixed, GearedObserver<SemiImplicitObserver<Fixed>>>>,
    "gear-drive/f32/exact/4000" => Governed<GearDrive<f32, TwoMassObserver<f32>>>,
    "gear-drive/fixed/exact/4000" => Governed<GearDrive<Fixed, TwoMassObserver<Fixed>>>,
    "vibrating-screen/f32/exact/4000" => Assembled<VibratingScreen<f32, vibrating_screen::with::Quick>>,
    "vibrating-screen/fixed/exact/4000" => Assembled<VibratingScreen<Fixed, vibrating_screen::with::Quick>>,
    "punch-press/f32/plain/10000" => PunchPress<punch_press::Of<f32, punch_press::with::Plain>>,
    "punch-press/fixed/plain/10000" => PunchPress<punch_press::Of<Fixed, punch_press::with::Plain>>,
    "punch-press/f32/mean/10000" => PunchPress<punch_press::Of<f32, punch_press::with::Mean>>,
    "punch-press/fixed/mean/10000" => PunchPress<punch_press::Of<Fixed, punch_press::with::Mean>>,
    "skip-winch/f32/plain/2000" => Assembled<SkipWinch<f32, skip_winch::with::Plain>>,
    "skip-winch/f32/slack/2000" => Assembled<SkipWinch<f32, skip_winch::with::Slack>>,
    "skip-winch/fixed/plain/2000" => Assembled<SkipWinch<Fixed, skip_winch::with::Plain>>,
    "skip-winch/fixed/slack/2000" => Assembled<SkipWinch<Fixed, skip_winch::with::Slack>>,
    "grinding-spindle/f32/two-mass/4000" => Balanced<GrindingSpindle<f32>>,
    "grinding-spindle/fixed/two-mass/4000" => Balanced<GrindingSpindle<Fixed>>,
    "test-rig/f32/two-mass/10000" => OnAxis<TestRig>,
}
