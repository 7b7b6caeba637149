//! The gain schedule of a hoist, over its load and its rope.

use super::STEPS;
use crate::balancing::Balancer;
use crate::configure::{Family as _, HasLoadAndRope, Machine, ScheduleOf, Scheduled};
use crate::design::PlacedObserver;
use crate::drive::{Composition, ConfigOf, Drive, GovernorConfigOf, ObserverConfigOf};
use crate::fluctuation::Fluctuation;
use crate::governor::Governor;
use crate::number::{Interpolate, Number, Part};
use crate::observer::Observer;
use crate::scheduling::{LoadMass, LoadMassConfig, RopeLength};

/// The gains follow load and rope, over `A` loads and `B` lengths of rope of a machine that
/// [`HasLoadAndRope`]: the schedule's slot of an [`Adaptive`](super::Adaptive) drive.
///
/// The load is weighed by the load torque, unless it is [`Known`](super::Known). The rope is counted by the motor's
/// turns, from the length of [`Machine::CHAIN`] on, until a [`Known`](super::Known) length comes.
///
/// ```
#[doc = include_str!("crane.txt")]
/// type CraneDrive = Adaptive<Crane, Inner, LoadAndRope<3, 2>>;
/// static CONFIG: ConfigOf<CraneDrive> = CraneDrive::configure();
/// let mut drive = CraneDrive::new(&CONFIG, 0);
/// // it begins with load and rope of the chain
/// assert!((drive.load() - 5_000.0).abs() < 1.0 && (drive.rope() - 10.0).abs() < 1e-3);
/// // with less load the same bandwidth takes less gain: after a second with the empty hook
/// let heavy = drive.constants().governor.proportional;
/// for _ in 0..50 {
///     (0..200).for_each(|_| { drive.hold(&CONFIG, 0, 0.0); });
///     drive.background(&CONFIG, &Known { rope: None, load: Some(500.0) });
/// }
/// assert!((drive.load() - 500.0).abs() < 1.0 && drive.constants().governor.proportional < heavy);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadAndRope<const A: usize, const B: usize>;

/// State of [`LoadAndRope`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoadAndRopeState<const A: usize, const B: usize> {
    mass: LoadMass,
    rope: RopeLength,
    /// Ticks since the rope was counted.
    ticks: u32,
}

/// A schedule of a drive `D` of the machine `M`: the state of the third slot of an [`Adaptive`](super::Adaptive) drive.
/// Without one, `()`, the gains are those of the machine.
pub trait Scheduling<M: Machine, D: Composition>: Sized {
    /// Its constants.
    type Config: Copy;
    /// Its constants for the machine.
    const CONFIG: Self::Config;
    /// The observer that the eccentricity is learnt behind.
    const OBSERVER: PlacedObserver;
    /// Load and rope of [`Machine::CHAIN`], the motor at rest at `angle` (2^-32 turn).
    fn start(angle: u32) -> Self;
    /// Counts the ticks that have passed.
    fn pass(&mut self, _ticks: u32) {}
    /// Counts the rope at the motor's angle (2^-32 turn) and speed (rad/s); where it is known, that is its length (m).
    fn wind(&mut self, _known: Option<f32>, _angle: u32, _speed: f32) {}
    /// Weighs the load by the load torque (N m), `seconds` after the last time, or takes the known one (kg).
    fn weigh(&mut self, _seconds: f32, _known: Option<f32>, _load_torque: f32) {}
    /// Gives the constants of observer and governor at load and rope.
    fn constants(&self, _config: &Self::Config, _next: &mut ConfigOf<D>) {}
    /// Length of the rope (m).
    fn rope(&self) -> f32 {
        0.0
    }
    /// Mass of the load (kg).
    fn load(&self) -> f32 {
        0.0
    }
}

impl<M: Machine, D: Composition> Scheduling<M, D> for () {
    type Config = ();
    const CONFIG: () = ();
    const OBSERVER: PlacedObserver = PlacedObserver::of(&M::OBSERVER);
    fn start(_: u32) -> Self {}
}

/// Time constant of the weighing (s).
const WEIGHING: f64 = 0.2;

/// Constants of a machine's schedule.
struct Constants<M, const A: usize, const B: usize>(M);

impl<M: HasLoadAndRope<A, B>, const A: usize, const B: usize> Constants<M, A, B> {
    const TRAVEL: f64 = M::CHAIN.travel_per_angle();
    const MASS: LoadMassConfig = LoadMassConfig::new(
        Self::TRAVEL,
        WEIGHING,
        super::TRANSFER as f64 / STEPS as f64,
        [M::LOADS[A - 1], M::LOADS[0]],
    );
    const LEAST_ROPE: f32 = M::ROPES[B - 1] as f32;
}

impl<M, N, O, G, F, B, const I: usize, const K: usize> Scheduling<M, Drive<N, O, G, F, B>> for LoadAndRopeState<I, K>
where
    M: HasLoadAndRope<I, K>,
    N: Number,
    O: Part<N, State: Observer<N, Config: Interpolate>>
        + Scheduled<M, N, I, K, Config = ObserverConfigOf<Drive<N, O, G, F, B>>>,
    G: Part<N, State: Governor<N, Config: Interpolate>>
        + Scheduled<M, N, I, K, Config = GovernorConfigOf<Drive<N, O, G, F, B>>>,
    F: Part<N, State: Fluctuation<N>>,
    B: Part<N, State: Balancer<N>>,
{
    type Config = ScheduleOf<Drive<N, O, G, F, B>, I, K>;
    const CONFIG: Self::Config = Drive::<N, O, G, F, B>::schedule::<M, I, K>();
    /// In the middle of the schedule, where the heavy half of the loads begins.
    const OBSERVER: PlacedObserver = M::OBSERVERS[I / 4][K / 2];

    fn start(angle: u32) -> Self {
        let (travel, load) = const { (Constants::<M, I, K>::TRAVEL, M::CHAIN.lifted_mass()) };
        let rope = const { M::CHAIN.lengths_of_rope()[1] };
        LoadAndRopeState {
            mass: LoadMass::new(const { &Constants::<M, I, K>::MASS }, load as f32),
            rope: RopeLength::new(travel as f32, rope as f32, angle),
            ticks: 0,
        }
    }

    fn pass(&mut self, ticks: u32) {
        self.ticks = self.ticks.saturating_add(ticks);
    }

    fn wind(&mut self, known: Option<f32>, angle: u32, speed: f32) {
        let elapsed = core::mem::take(&mut self.ticks) as f32 * const { M::PERIOD as f32 };
        self.rope.update(angle, speed, elapsed);
        if let Some(length) = known {
            self.rope.resync(length);
        }
    }

    fn weigh(&mut self, seconds: f32, known: Option<f32>, load_torque: f32) {
        let config = const { &Constants::<M, I, K>::MASS };
        match known {
            Some(load) => self.mass = LoadMass::new(config, load),
            None => {
                let elapsed = seconds * const { STEPS as f32 / super::TRANSFER as f32 };
                self.mass.update_after(config, elapsed, load_torque);
            }
        }
    }

    fn constants(&self, config: &Self::Config, next: &mut ConfigOf<Drive<N, O, G, F, B>>) {
        let length = self.rope.length().max(const { Constants::<M, I, K>::LEAST_ROPE });
        (next.observer, next.governor) = config.at(1e3 / self.mass.mass(), 1.0 / length);
    }

    fn rope(&self) -> f32 {
        self.rope.length()
    }

    fn load(&self) -> f32 {
        self.mass.mass()
    }
}
