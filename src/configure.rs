//! Configuration: the constants of a drive's parts, derived from the machine.
//!
//! A [`Machine`] describes the machine, its motor, its encoder and its tick rate. [`Configure`] gives the constants of
//! a part for such a machine; it is implemented once per part and number, and for compositions of parts.
//! [`Drive::configure`] configures all parts of a drive. All of it is evaluated by the compiler: the firmware holds the
//! coefficients, and a machine that cannot be controlled is a compile error with its sentence.
//!
//! # Parts
//! | part | constants | needs |
//! |---|---|---|
//! | `TwoMassObserver`, `SemiImplicitObserver` | [`Machine::OBSERVER`] | |
//! | `RigidObserver` | [`Machine::RIGID_OBSERVER`], [`Machine::LOAD_SHARE`] | |
//! | `BacklashObserver` | [`Machine::BACKLASH_OBSERVER`] | a gap in the chain |
//! | `MechanismObserver`, `ToolObserver` | [`HasMechanism::MECHANISM_OBSERVER`] | [`HasMechanism`] |
//! | `MechanismFeedForward` | none | [`HasMechanism`] |
//! | `GearedObserver` | those of its observer, [`Machine::GEAR`] | |
//! | `LoadGearObserver` | those of its observer, [`Machine::LOAD_GEAR`] | |
//! | `EccentricityObserver` | those of its observer | |
//! | `SpeedLoop` | [`Machine::SPEED_LOOP`], [`Machine::RAMP`], torque limit, those of its filters | |
//! | `SetpointLag` | none | |
//! | `DampingLag` | [`Machine::SPEED_LOOP`] | a design with a lag of the damping |
//! | `SpeedLag` | [`Machine::SPEED_LOOP`] | a design with a lag of the speed |
//! | `SpeedGovernor` | [`Machine::GAINS`], [`Machine::RAMP`], those of its parts | |
//! | `SymmetricLimit`, `TorqueRange` | torque limit, [`Machine::LEAST_TORQUE`] | |
//! | `Curve` | [`HasTorqueCurve::CURVE`], [`Machine::LEAST_TORQUE`] | [`HasTorqueCurve`] |
//! | `Slew` | [`HasSlew::SLEW`], those of its limit | [`HasSlew`] |
//! | `BacklashTakeUp` | [`Machine::TAKE_UP`], those of its limit | |
//! | `InputShaper` | [`Machine::SHAPER`], [`Machine::RAMP`], those of its governor | |
//! | `Supervised` | [`Machine::SUPERVISION`], those of its governor | |
//! | `Droop` | [`Machine::DROOP`] | |
//! | `Barred` | [`HasBarredSpeeds::BARRED`] | [`HasBarredSpeeds`] |
//! | `FeedForward`, `AccelerationFeedback` | [`Machine::GAINS`] | [`GainSource::Governor`] |
//! | `ActiveDamping` | [`Machine::SPEED_LOOP`] | |
//! | `Sequencer` | [`Machine::SEQUENCER`] | |
//! | `Actuated` | [`HasActuator::LAGS`], [`HasActuator::MONITOR`], [`HasActuator::TORQUE_DELAY`] | [`HasActuator`] |
//! | `LoadSharing` | [`HasLoadSharing::SHARING`] | [`HasLoadSharing`] |
//! | `MovingAverage`, `CycleAverage` | none | |
//! | `Extremes`, `Waveform`, `Interleaved`, `CycleMean` | [`Machine::CYCLE`], [`Machine::CYCLES`] | |
//! | `GearMesh` | [`HasGearMesh::MESH`], [`HasGearMesh::TEETH`] | [`HasGearMesh`] |
//! | `Rainflow` | [`HasLife::CLASSED_TORQUE`] | [`HasLife`] |
//! | `Phasors` | [`HasVibration::PHASORS`] | [`HasVibration`] |
//!
//! A part of one's own implements [`Configure`] for itself and any machine; a part of the library that a machine uses
//! with constants of its own is a newtype.
//!
//! # The speed loop that is refused
//! A drive whose speed loop has less than 6 dB or 30 degrees with its observer in it, or is unstable within the
//! machine's tolerances, is a compile error. It names the margin or the tolerance, and the remedy. To overrule it,
//! name [`Machine::ROBUSTNESS`] or [`Machine::TOLERANCE`]:
//!
//! ```
//! # use driveline::prelude::*;
//! # use driveline::design::{Spread, Tolerance};
//! # struct Lift;
//! # impl Machine for Lift {
//! #     const CHAIN: Chain = Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.35));
//! #     const RATING: Rating = Rating { torque: Torque(200.0), speed: Speed(150.0), torque_limit: Torque(300.0) };
//! #     const ENCODER: Encoder = Encoder::lines(2048);
//! #     const RATE_HZ: u32 = 1_000;
//!     // an empty hook to an overload, on rope of 5 to 30 m where the chain has 12 m
//!     const TOLERANCE: Tolerance = Tolerance {
//!         load_inertia: Spread::between(0.05, 1.1),
//!         stiffness: Spread::between(0.4, 2.4),
//!         // the rope's damping was measured
//!         damping: Spread::between(0.5, 2.0),
//!         ..Tolerance::USUAL
//!     };
//! # }
//! # static CONFIG: ConfigOf<Drive<f32, TwoMassObserver, SpeedLoop>> =
//! #     Drive::<f32, TwoMassObserver, SpeedLoop>::configure::<Lift>();
//! ```
//!
//! The gains of a speed loop are tested with the observer in the loop: linear, with the gap closed, a crank with its
//! mean inertia. Margins hold with the losses of the gears in `CHAIN` too, whichever way power flows, and with the
//! friction that a `GearedObserver` deducts. The gains of [`GainSource::Governor`] are tested by their frequency
//! response, with the actuator, the compensation and the average of the speed. A droop, which takes from the integral
//! alone, is left out: it raises the margins. Of 500 random loops with these margins none had less with a droop, and
//! none was unstable within the usual tolerances, by the eigenvalues of a model of its own. Wider tolerances are not
//! tested for such a governor. A part of one's own that acts on the loop names [`Configure::LOOP`].
//!
//! # One file for several drives
//! A machine that is driven in several ways is one type with a parameter, or several types that share constants:
//!
//! ```
//! # use driveline::prelude::*;
//! /// The hoist at a tick rate: `Hoist<1_000>` and `Hoist<10_000>` are two machines.
//! struct Hoist<const RATE_HZ: u32>;
//! impl<const RATE_HZ: u32> Machine for Hoist<RATE_HZ> {
//!     const CHAIN: Chain = Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.35));
//!     const RATING: Rating = Rating { torque: Torque(200.0), speed: Speed(150.0), torque_limit: Torque(300.0) };
//!     const ENCODER: Encoder = Encoder::lines(2048);
//!     const RATE_HZ: u32 = RATE_HZ;
//! }
//! /// Anything that has a machine and a drive gets its constants without a macro.
//! trait Scene {
//!     type Machine: Machine;
//!     type Drive: driveline::drive::Composition;
//!     const CONFIG: ConfigOf<Self::Drive>;
//! }
//! struct Scene1k;
//! impl Scene for Scene1k {
//!     type Machine = Hoist<1_000>;
//!     type Drive = Drive<Fixed, TwoMassObserver, SpeedLoop>;
//!     const CONFIG: ConfigOf<Self::Drive> = Self::Drive::configure::<Self::Machine>();
//! }
//! assert_eq!(Scene1k::CONFIG.limits.max_coast, 17);
//! ```
//!
//! Generic code asks for `D: Composition + Configure<M, D::Number, Config = ConfigOf<D>>` and takes `D::CONFIG`.

mod bases;
mod family;
mod fluctuation;
mod gain_source;
mod governor;
mod life;
mod limits;
mod loop_part;
mod machine;
mod observer;
mod refusal;
mod schedule_test;
mod units;
mod vibration;

pub use family::{Family, HasLoadAndRope, ScheduleOf, Scheduled};
pub use fluctuation::HasGearMesh;
pub use gain_source::GainSource;
pub use governor::{HasActuator, HasBarredSpeeds, HasLoadSharing, HasSlew, HasTorqueCurve};
pub use life::HasLife;
pub use loop_part::LoopPart;
pub use machine::{Machine, Rating};
pub use observer::HasMechanism;
pub use refusal::{Needs, Refusal};
pub(crate) use refusal::{constants, stop_refused};
pub use schedule_test::test_schedule;
pub use units::Units;
pub use vibration::{HasVibration, VibrationNumber};

use crate::balancing::Balancer;
use crate::drive::{Config, ConfigOf, Drive, Limits};
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::{Number, Part};
use crate::observer::Observer;

/// The constants of a part in the number `N`, for the machine `M`.
///
/// ```
#[doc = include_str!("roll.txt")]
/// use driveline::configure::Configure;
/// use driveline::governor::{SymmetricLimit, SymmetricLimitConfig};
/// // the same part of the same machine in two numbers
/// const SINGLE: SymmetricLimitConfig<f32> = <SymmetricLimit as Configure<Roll, f32>>::CONFIG;
/// const FIXED: SymmetricLimitConfig<Fixed> = <SymmetricLimit as Configure<Roll, Fixed>>::CONFIG;
/// assert_eq!(SINGLE.torque, 550.0);
/// assert!((FIXED.torque.to_f64() * Roll::BASES.torque - 550.0).abs() < 1e-4);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no constants for the machine `{M}` in `{N}`",
    note = "what has no sensible default is a trait of its own: see the table of parts in `driveline::configure`"
)]
pub trait Configure<M: Machine, N: Number> {
    /// The part's constants.
    type Config;
    /// The constants.
    const CONFIG: Self::Config;
    /// This part in the speed loop, for the test of the loop's stability.
    const LOOP: LoopPart = LoopPart::NONE;
    /// What this part needs of the machine.
    const NEEDS: Needs = Needs::NONE;
    /// Why the machine is refused, as a drive finds it.
    const REFUSED: Option<Refusal> = None;
}

/// Nothing: a part that is left out.
impl<M: Machine, N: Number> Configure<M, N> for () {
    type Config = ();
    const CONFIG: () = ();
}

impl<M: Machine, N: Number, A: Configure<M, N>, B: Configure<M, N>> Configure<M, N> for (A, B) {
    type Config = (A::Config, B::Config);
    const CONFIG: Self::Config = (A::CONFIG, B::CONFIG);
    const LOOP: LoopPart = A::LOOP.and(&B::LOOP);
}

impl<M, N, A, B, C> Configure<M, N> for (A, B, C)
where
    M: Machine,
    N: Number,
    A: Configure<M, N>,
    B: Configure<M, N>,
    C: Configure<M, N>,
{
    type Config = (A::Config, B::Config, C::Config);
    const CONFIG: Self::Config = (A::CONFIG, B::CONFIG, C::CONFIG);
    const LOOP: LoopPart = A::LOOP.and(&B::LOOP).and(&C::LOOP);
}

impl<M, N, O, G, F, B> Configure<M, N> for Drive<N, O, G, F, B>
where
    M: Machine,
    N: Number,
    Limits<N>: Configure<M, N, Config = Limits<N>>,
    O: Part<N, State: Observer<N, Config = <O as Configure<M, N>>::Config>> + Configure<M, N>,
    G: Part<N, State: Governor<N, Config = <G as Configure<M, N>>::Config>> + Configure<M, N>,
    F: Part<N, State: Fluctuation<N, Config = <F as Configure<M, N>>::Config>> + Configure<M, N>,
    B: Part<N, State: Balancer<N, Config = <B as Configure<M, N>>::Config>> + Configure<M, N>,
{
    type Config = ConfigOf<Self>;
    const CONFIG: Self::Config = {
        if let Some(refusal) = &Self::REFUSED {
            refusal.stop()
        }
        Config {
            limits: <Limits<N> as Configure<M, N>>::CONFIG,
            observer: O::CONFIG,
            fluctuation: F::CONFIG,
            governor: G::CONFIG,
            balancer: B::CONFIG,
        }
    };
    const REFUSED: Option<Refusal> = match refusal::of_machine::<M>(&O::NEEDS, &F::NEEDS) {
        None => loop_part::refused::<M, N, O, G>(),
        refused => refused,
    };
}

impl<N, O, G, F, B> Drive<N, O, G, F, B>
where
    N: Number,
    O: Part<N, State: Observer<N>>,
    G: Part<N, State: Governor<N>>,
    F: Part<N, State: Fluctuation<N>>,
    B: Part<N, State: Balancer<N>>,
{
    /// The constants of this drive for the machine `M`.
    ///
    /// In a `static` or a constant the compiler evaluates them, and a machine that cannot be controlled stops it with a
    /// sentence.
    pub const fn configure<M: Machine>() -> ConfigOf<Self>
    where
        Self: Configure<M, N, Config = ConfigOf<Self>>,
    {
        refusal::stop_refused::<Self, M, N>();
        refusal::constants::<Self, M, N>()
    }
}
