//! A family of machines: one drive whose load and shaft change, and its gain schedule.

use super::{Configure, Machine};
use crate::balancing::Balancer;
use crate::design::{Disturbance, PlacedObserver, SpeedLoopDesign, SpeedLoopTuning};
use crate::drive::{Composition, Drive};
use crate::fluctuation::Fluctuation;
use crate::governor::{DampingLag, Governor, LagConfig, LoopFilter, SetpointLag, SpeedLag, SpeedLoop, SpeedLoopConfig};
use crate::learning::{EccentricityNumber, EccentricityObserver};
use crate::machine::{Length, Mass, Match, TwoMass};
use crate::math::{exp, ln};
use crate::number::{Fixed, Interpolate, Number, Part, StateOf};
use crate::observer::{
    GearedConfig, GearedObserver, Observer, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver,
};
use crate::scheduling::{Breakpoints, Schedule};
use crate::settings::{Bases, SpeedLoopSettings};

/// A machine with two parameters that change while it runs, such as the load's mass and the rope's length.
///
/// The constants of a drive are designed at the points of a grid and interpolated between them. A model's coefficients
/// are nearly linear in the stiffness and in the inverse of the load: these make good parameters.
///
/// [`Machine::TWO_MASS`] is one member. It scales the disturbance and sets the speed loop's bandwidth. Margins and
/// tolerances of the loops at the points are tested by [`test_schedule`], which belongs into a test of the firmware: it
/// would cost the compiler many times a drive. [`Machine::BASES`] must hold for all members: with the exact step a
/// stiffness may change fourfold in fixed point.
///
/// [`test_schedule`]: crate::configure::test_schedule
///
/// ```
/// use driveline::configure::{Family, Machine, Rating};
/// use driveline::machine::{Match, TwoMass};
/// use driveline::prelude::*;
/// use driveline::scheduling::Schedule;
///
/// /// By the load in tonnes, and the stiffness of the rope over that of the longest one.
/// const fn member(load: f64, rope: f64) -> Chain {
///     Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0 * rope), Damping(0.5)).rotor(Inertia(0.17 * load))
/// }
/// struct Hoist;
/// impl Machine for Hoist {
///     const CHAIN: Chain = member(2.0, 1.0);
///     const RATING: Rating = Rating { torque: Torque(200.0), speed: Speed(150.0), torque_limit: Torque(300.0) };
///     const ENCODER: Encoder = Encoder::lines(2048);
///     const RATE_HZ: u32 = 10_000;
/// }
/// impl Family<2, 2> for Hoist {
///     /// Inverse of the load (1/t).
///     const FIRST: [f64; 2] = [0.5, 1.0];
///     const SECOND: [f64; 2] = [1.0, 3.0];
///     const MEMBERS: [[TwoMass; 2]; 2] = {
///         const TWO_MASS: Match = Match::ResonanceAntiresonance;
///         [
///             [member(2.0, 1.0).reduce(TWO_MASS), member(2.0, 3.0).reduce(TWO_MASS)],
///             [member(1.0, 1.0).reduce(TWO_MASS), member(1.0, 3.0).reduce(TWO_MASS)],
///         ]
///     };
/// }
/// type HoistDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
/// static SCHEDULE: driveline::configure::ScheduleOf<HoistDrive, 2, 2> = HoistDrive::schedule::<Hoist, 2, 2>();
/// let mut config = HoistDrive::configure::<Hoist>();
/// let mut drive = HoistDrive::new(&config, 0);
/// // between two ticks: a load of 1.5 t on a rope of half the longest
/// drive.follow(&mut config, &SCHEDULE, 1.0 / 1.5, 2.0);
/// assert!(config.governor.proportional < HoistDrive::configure::<Hoist>().governor.proportional);
/// ```
pub trait Family<const A: usize, const B: usize>: Machine {
    /// Points of the first parameter, rising.
    const FIRST: [f64; A];
    /// Points of the second parameter, rising.
    const SECOND: [f64; B];
    /// The two masses at the points.
    const MEMBERS: [[TwoMass; B]; A];
    /// The disturbance that the observers at the points are designed for, with the load of [`Machine::TWO_MASS`]. The
    /// schedule follows the load: the rest wanders less than under one set of gains for all loads.
    const SCHEDULED_DISTURBANCE: Disturbance = Self::DISTURBANCE;
    /// The observers' gains at the points.
    ///
    /// They are those of [`SCHEDULED_DISTURBANCE`](Self::SCHEDULED_DISTURBANCE) with the step of the load torque in
    /// proportion to the load's inertia: a light load cannot change by more than itself. Without this a schedule is
    /// worse than fixed gains at a light load.
    const OBSERVERS: [[PlacedObserver; B]; A] = {
        let mut observers = [[observer::<Self>(&Self::MEMBERS[0][0], &Self::SCHEDULED_DISTURBANCE); B]; A];
        each!(i, 0..A, {
            each!(j, 0..B, {
                if i + j > 0 {
                    observers[i][j] = observer::<Self>(&Self::MEMBERS[i][j], &Self::SCHEDULED_DISTURBANCE);
                }
            });
        });
        observers
    };
    /// Active damping at the points: the gain on the twist rate over the proportional one. A swing decays the faster
    /// the larger it is; the observer's lag leaves the less margin, mostly where the resonance is low. 0.1 as in
    /// [`SpeedLoopTuning::of`].
    const DAMPING: [[f64; B]; A] = [[SpeedLoopTuning::TWIST_GAIN; B]; A];
    /// The speed loops at the points: [`TwoMass::try_limited_speed_loop`] with the bandwidth of
    /// [`Machine::SPEED_LOOP`] and the [`DAMPING`](Self::DAMPING). A lag of its damping is in proportion to the period
    /// of the member's resonance, one of its speed to the reciprocal of the member's bandwidth.
    const SPEED_LOOPS: [[SpeedLoopDesign; B]; A] = {
        let mut loops = [[Self::SPEED_LOOP; B]; A];
        let bandwidth = Self::SPEED_LOOP.bandwidth;
        each!(i, 0..A, {
            each!(j, 0..B, {
                match Self::MEMBERS[i][j].try_limited_speed_loop(Self::RATE, bandwidth, Self::DAMPING[i][j]) {
                    Ok(design) => {
                        let period = Self::TWO_MASS.resonance() / Self::MEMBERS[i][j].resonance();
                        let slower = bandwidth / design.bandwidth;
                        loops[i][j] = design
                            .with_damping_lag(Self::SPEED_LOOP.damping_lag * period)
                            .with_speed_lag(Self::SPEED_LOOP.speed_lag * slower);
                    }
                    Err(error) => error.stop(),
                }
            });
        });
        loops
    };
}

/// A hoist: a machine whose load and rope change. It is a [`Family`] by the inverse of both.
///
/// [`Machine::CHAIN`] ends in a rope and a lifted mass, and gives the range of both by
/// [`Chain::lengths`](crate::machine::Chain::lengths) and [`Chain::loads`](crate::machine::Chain::loads); the other
/// members are [`Chain::hoisting`](crate::machine::Chain::hoisting).
///
/// ```
/// use driveline::configure::HasLoadAndRope;
/// use driveline::prelude::*;
/// struct Crane;
/// impl Machine for Crane {
///     const CHAIN: Chain = Chain::motor(Inertia(0.35)).gear(Ratio(20.0), Efficiency(0.95)).drum(Diameter(0.5))
///         .rope(Falls(2), Stiffness(1.2e6)).lengths(Length(4.0), Length(10.0), Length(16.0))
///         .lifted(Mass(5e3)).loads(Mass(500.0), Mass(8_000.0));
///     const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed::rpm(1480.0), torque_limit: Torque(600.0) };
///     const ENCODER: Encoder = Encoder::lines(1024);
///     const RATE_HZ: u32 = 10_000;
/// }
/// impl HasLoadAndRope<3, 2> for Crane {}
/// assert!((Crane::LOADS[1] - 2_000.0).abs() < 1e-9); // in equal ratios: sqrt(500 * 8000)
/// ```
#[doc(alias("crane", "hoist", "gain scheduling"))]
pub trait HasLoadAndRope<const A: usize, const B: usize>: Machine {
    /// Loads at the points (kg), falling: in equal ratios.
    const LOADS: [f64; A] = falling(Self::CHAIN.least_and_largest_load());
    /// Lengths at the points (m), falling: in equal ratios.
    const ROPES: [f64; B] = {
        let [shortest, _, longest] = Self::CHAIN.lengths_of_rope();
        falling([shortest, longest])
    };
    /// As [`Family::SCHEDULED_DISTURBANCE`]: [`Rating::hoisting_on_schedule`](super::Rating::hoisting_on_schedule).
    const HOISTING_DISTURBANCE: Disturbance = Self::RATING.hoisting_on_schedule(Self::RATE);
    /// As [`Family::DAMPING`]: a quarter. Three hoists of 5 to 12 t have their margins up to 0.29 to 0.98.
    const SWING_DAMPING: [[f64; B]; A] = [[0.25; B]; A];
}

impl<M: HasLoadAndRope<A, B>, const A: usize, const B: usize> Family<A, B> for M {
    const FIRST: [f64; A] = inverse(Self::LOADS, 1e3);
    const SECOND: [f64; B] = inverse(Self::ROPES, 1.0);
    const SCHEDULED_DISTURBANCE: Disturbance = Self::HOISTING_DISTURBANCE;
    const DAMPING: [[f64; B]; A] = Self::SWING_DAMPING;
    const MEMBERS: [[TwoMass; B]; A] = {
        let mut members = [[Self::TWO_MASS; B]; A];
        each!(i, 0..A, {
            each!(j, 0..B, {
                let (load, rope) = (Mass(Self::LOADS[i]), Length(Self::ROPES[j]));
                let chain = Self::CHAIN.hoisting(load, rope);
                members[i][j] = chain.reduce(Match::ResonanceAntiresonance);
            });
        });
        members
    };
}

/// A number over each value.
const fn inverse<const K: usize>(values: [f64; K], over: f64) -> [f64; K] {
    let mut inverse = [0.0; K];
    each!(k, 0..K, {
        inverse[k] = over / values[k];
    });
    inverse
}

/// Values in equal ratios from the largest to the least.
const fn falling<const K: usize>([least, most]: [f64; 2]) -> [f64; K] {
    assert!(
        K >= 2 && least > 0.0 && most > least && most.is_finite(),
        "CHAIN: a gain schedule over load and rope has two points or more of each between two values that rise: give \
            `.lengths(Length(5.0), Length(12.0), Length(30.0))` behind the rope and `.loads(Mass(500.0), Mass(13e3))` \
            behind the load"
    );
    let ratio = exp(ln(least / most) / (K - 1) as f64);
    let mut values = [most; K];
    each!(k, 1..K, {
        values[k] = if k == K - 1 { least } else { values[k - 1] * ratio };
    });
    values
}

/// The gains for a member.
const fn observer<M: Machine + ?Sized>(member: &TwoMass, disturbance: &Disturbance) -> PlacedObserver {
    let scale = member.load_inertia / M::TWO_MASS.load_inertia;
    let disturbance = Disturbance { load_torque_step: scale * disturbance.load_torque_step, ..*disturbance };
    or_stop!(member.try_placed_observer(M::RATE, M::ENCODER, disturbance))
}

/// A part whose constants follow two parameters of the machine.
pub trait Scheduled<M: Family<A, B>, N: Number, const A: usize, const B: usize>: Configure<M, N> {
    /// The part's constants at the points.
    const CELLS: [[Self::Config; B]; A];
}

macro_rules! cells {
    ($first:expr, |$i:ident, $j:ident| $cell:expr) => {{
        let mut cells = [[$first; B]; A];
        let mut $i = 0;
        while $i < A {
            let mut $j = 0;
            while $j < B {
                cells[$i][$j] = $cell;
                $j += 1;
            }
            $i += 1;
        }
        cells
    }};
}

impl<M, N, O, const A: usize, const B: usize> Scheduled<M, N, A, B> for EccentricityObserver<O>
where
    M: Family<A, B>,
    N: EccentricityNumber,
    O: Scheduled<M, N, A, B>,
{
    const CELLS: [[Self::Config; B]; A] = O::CELLS;
}

/// No filter.
impl<M: Family<A, B>, N: Number, const A: usize, const B: usize> Scheduled<M, N, A, B> for () {
    const CELLS: [[(); B]; A] = [[(); B]; A];
}

impl<M: Family<A, B>, N: Number, const A: usize, const B: usize> Scheduled<M, N, A, B> for SetpointLag {
    const CELLS: [[(); B]; A] = [[(); B]; A];
}

impl<M, N, F, G, const A: usize, const B: usize> Scheduled<M, N, A, B> for (F, G)
where
    M: Family<A, B>,
    N: Number,
    F: Scheduled<M, N, A, B, Config: Copy>,
    G: Scheduled<M, N, A, B, Config: Copy>,
{
    const CELLS: [[Self::Config; B]; A] = cells!((F::CONFIG, G::CONFIG), |i, j| (F::CELLS[i][j], G::CELLS[i][j]));
}

macro_rules! scheduled {
    ($number:ident, $bases:expr) => {
        impl<M: Family<A, B>, const A: usize, const B: usize> Scheduled<M, $number, A, B> for TwoMassObserver {
            const CELLS: [[Self::Config; B]; A] = cells!(<Self as Configure<M, $number>>::CONFIG, |i, j| {
                TwoMassConfig::<$number>::of_placed(&M::OBSERVERS[i][j], $bases)
            });
        }

        impl<M: Family<A, B>, const A: usize, const B: usize> Scheduled<M, $number, A, B> for SemiImplicitObserver {
            const CELLS: [[Self::Config; B]; A] = cells!(<Self as Configure<M, $number>>::CONFIG, |i, j| {
                SemiImplicitConfig::<$number>::of_placed(&M::OBSERVERS[i][j], $bases)
            });
        }

        impl<M: Family<A, B>, F, const A: usize, const B: usize> Scheduled<M, $number, A, B> for SpeedLoop<F>
        where
            F: Part<$number, State: LoopFilter<$number>> + Scheduled<M, $number, A, B, Config: Copy>,
        {
            const CELLS: [[Self::Config; B]; A] = cells!(<Self as Configure<M, $number>>::CONFIG, |i, j| {
                SpeedLoopConfig::<$number>::new(
                    &M::SPEED_LOOPS[i][j],
                    SpeedLoopSettings { torque_limit: M::RATING.torque_limit.0, ramp: M::RAMP },
                    $bases,
                )
                .with_filter(F::CELLS[i][j])
            });
        }

        impl<M: Family<A, B>, const A: usize, const B: usize> Scheduled<M, $number, A, B> for DampingLag {
            const CELLS: [[Self::Config; B]; A] = cells!(<Self as Configure<M, $number>>::CONFIG, |i, j| {
                LagConfig::<$number>::new(M::SPEED_LOOPS[i][j].damping_lag, M::PERIOD, $bases)
            });
        }

        impl<M: Family<A, B>, const A: usize, const B: usize> Scheduled<M, $number, A, B> for SpeedLag {
            const CELLS: [[Self::Config; B]; A] = cells!(<Self as Configure<M, $number>>::CONFIG, |i, j| {
                LagConfig::<$number>::new(M::SPEED_LOOPS[i][j].speed_lag, M::PERIOD, $bases)
            });
        }

        impl<M: Family<A, B>, O, const A: usize, const B: usize> Scheduled<M, $number, A, B> for GearedObserver<O>
        where
            O: Scheduled<M, $number, A, B, Config: Copy>,
        {
            const CELLS: [[Self::Config; B]; A] = cells!(<Self as Configure<M, $number>>::CONFIG, |i, j| {
                GearedConfig::<$number, _>::new(O::CELLS[i][j], &M::GEAR, M::PERIOD, $bases)
            });
        }
    };
}

scheduled!(f32, Bases::SI);
scheduled!(f64, Bases::SI);
scheduled!(Fixed, M::BASES);

/// The gain schedule of a drive's observer and governor.
pub type ScheduleOf<D, const A: usize, const B: usize> = Schedule<
    (
        <<D as Composition>::Observer as Observer<<D as Composition>::Number>>::Config,
        <<D as Composition>::Governor as Governor<<D as Composition>::Number>>::Config,
    ),
    A,
    B,
>;

impl<N, O, G, F, B> Drive<N, O, G, F, B>
where
    N: Number,
    O: Part<N, State: Observer<N, Config: Interpolate>>,
    G: Part<N, State: Governor<N, Config: Interpolate>>,
    F: Part<N, State: Fluctuation<N>>,
    B: Part<N, State: Balancer<N>>,
{
    /// The gain schedule of this drive for a family of machines, to be kept in a `static`.
    pub const fn schedule<M, const I: usize, const K: usize>() -> ScheduleOf<Self, I, K>
    where
        M: Family<I, K>,
        O: Scheduled<M, N, I, K, Config = <StateOf<O, N> as Observer<N>>::Config>,
        G: Scheduled<M, N, I, K, Config = <StateOf<G, N> as Governor<N>>::Config>,
    {
        let (observers, governors) = (O::CELLS, G::CELLS);
        let mut cells = [[(O::CONFIG, G::CONFIG); K]; I];
        each!(i, 0..I, {
            each!(k, 0..K, {
                cells[i][k] = (observers[i][k], governors[i][k]);
            });
        });
        Schedule::new(Breakpoints::new(M::FIRST), Breakpoints::new(M::SECOND), cells)
    }
}
