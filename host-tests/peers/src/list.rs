//! All observers by their names.

use driveline::design::{Rate, StepChoice};
use driveline::governor::SpeedLoopConfig;
use driveline::number::Fixed;
use driveline::observer::{
    BacklashConfig, BacklashObserver, MechanismConfig, MechanismObserver, GearedConfig, GearedObserver, RigidConfig,
    RigidObserver, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver,
};
use driveline::settings::Bases;

use crate::constant_gain::{ByHand, ByNalgebra};
use crate::governors::{ByIdsp, ByPid, ByPidCtrl, LibraryLoop, Observed, OnLowPass, settings};
use crate::kalman::{Adskalman, Idsp, Kfilter, Minikalman};
use crate::least_squares::{self, EachTick, Factorisation, Solver};
use crate::library::Driveline;
use crate::luenberger;
use crate::model::{Behind, Model, Replayed};
use crate::scene::Scene;
use crate::simple::{DifferenceLowPass, DisturbanceObserver, Nothing};

/// The observers. Those that begin with `driveline` are the library's, in `f32` and in fixed point.
pub const PEERS: &[&str] = &[
    "nothing",
    "driveline rigid, f32",
    "driveline semi-implicit, f32",
    "driveline exact, f32",
    "driveline backlash, f32",
    "driveline crank, f32",
    "driveline rigid, fixed",
    "driveline semi-implicit, fixed",
    "driveline exact, fixed",
    "driveline backlash, fixed",
    "driveline crank, fixed",
    "constant gain by hand",
    "constant gain, nalgebra",
    "Luenberger",
    "disturbance observer",
    "difference and low-pass",
    "Kalman, idsp",
    "Kalman, adskalman",
    "Kalman, minikalman",
    "Kalman, kfilter",
    "driveline semi-implicit tuned, f32",
    "driveline exact tuned, f32",
    "driveline semi-implicit tuned, fixed",
    "driveline exact tuned, fixed",
];

/// The numbers of those that have a corner or a radius to tune.
pub const TUNED: [usize; 7] = [13, 14, 15, 20, 21, 22, 23];

/// Number of the first of [`GOVERNORS`].
pub const FIRST_GOVERNOR: usize = 100;

/// Speed loops.
pub const GOVERNORS: &[&str] = &[
    "driveline loop, f32",
    "pid",
    "pid-ctrl",
    "idsp",
    "driveline rigid observer and loop, f32",
    "driveline rigid observer and loop, fixed",
];

/// Number of the first of [`SOLVERS`].
pub const FIRST_SOLVER: usize = 200;

/// Least squares of balancing.
pub const SOLVERS: &[&str] = &[
    "driveline, f32",
    "nalgebra QR, f32",
    "nalgebra SVD, f32",
    "nalgebra normal equations, f32",
    "driveline, f64",
    "nalgebra QR, f64",
    "nalgebra SVD, f64",
    "nalgebra normal equations, f64",
];

/// Something to be done with an observer, whatever its type.
pub trait Visitor {
    /// What comes of it.
    type Output;
    /// Does it.
    fn visit<R: Replayed>(self, observer: R) -> Self::Output;
}

/// Hands the observer of that number to a visitor; none where the scene's machine has no such observer. `value` is the
/// corner or radius (rad/s) of what is tuned by one.
pub fn with<V: Visitor>(scene: &Scene, peer: usize, value: f32, visitor: V) -> Option<V::Output> {
    macro_rules! library {
        ($number:ty, $bases:expr, $which:expr) => {{
            let bases = $bases;
            let period = scene.period();
            macro_rules! behind {
                ($observer:ty, $config:expr) => {
                    match scene.gear {
                        None => Some(visitor.visit(Driveline::<$number, $observer>::new($config))),
                        Some(gear) => {
                            let config = GearedConfig::<$number, _>::try_new($config, &gear, period, bases).ok()?;
                            Some(visitor.visit(Driveline::<$number, GearedObserver<$observer>>::new(config)))
                        }
                    }
                };
            }
            match $which {
                0 => behind!(
                    RigidObserver<$number>,
                    RigidConfig::<$number>::try_new(&scene.rigid, scene.load_share, bases).ok()?
                ),
                1 | 2 | 5 | 6 => {
                    let (_, design) = Model::of(scene)?;
                    let placed = || design.machine.try_observer_of_bandwidth(Rate::every(period), f64::from(value));
                    match $which {
                        1 => behind!(
                            SemiImplicitObserver<$number>,
                            SemiImplicitConfig::<$number>::try_new(&design, bases).ok()?
                        ),
                        2 => behind!(TwoMassObserver<$number>, TwoMassConfig::<$number>::try_new(&design, bases).ok()?),
                        5 if design.chosen != StepChoice::Exact => behind!(
                            SemiImplicitObserver<$number>,
                            SemiImplicitConfig::<$number>::try_of_placed(&placed().ok()?, bases).ok()?
                        ),
                        5 => None,
                        _ => behind!(
                            TwoMassObserver<$number>,
                            TwoMassConfig::<$number>::try_of_placed(&placed().ok()?, bases).ok()?
                        ),
                    }
                }
                3 => behind!(
                    BacklashObserver<$number>,
                    BacklashConfig::<$number>::try_new(&scene.backlash?, bases).ok()?
                ),
                _ => behind!(MechanismObserver<$number>, MechanismConfig::<$number>::try_new(&scene.crank?, bases).ok()?),
            }
        }};
    }
    macro_rules! of_five_states {
        ($make:expr) => {{
            let (model, design) = Model::of(scene)?;
            #[allow(clippy::redundant_closure_call)]
            let peer = ($make)(&model, &design)?;
            Some(visitor.visit(Behind::new(scene, peer)))
        }};
    }
    match peer {
        0 => Some(visitor.visit(Nothing)),
        1..=5 => library!(f32, Bases::SI, peer - 1),
        6..=10 => library!(Fixed, scene.bases, peer - 6),
        11 => of_five_states!(|model: &Model, _| Some(ByHand::new(model, model.gains))),
        12 => of_five_states!(|model: &Model, _| Some(ByNalgebra::new(model))),
        13 => of_five_states!(|model: &Model, design| {
            luenberger::gains(design, f64::from(value)).map(|gains| ByHand::new(model, gains))
        }),
        14 => Some(visitor.visit(Behind::new(scene, DisturbanceObserver::new(scene, value)))),
        15 => Some(visitor.visit(Behind::new(scene, DifferenceLowPass::new(scene, value)))),
        16 => of_five_states!(|model: &Model, _| Some(Idsp::new(model))),
        17 => of_five_states!(|model: &Model, _| Some(Adskalman::new(model))),
        18 => of_five_states!(|model: &Model, _| Some(Minikalman::new(model))),
        20 | 21 => library!(f32, Bases::SI, peer - 15),
        22 | 23 => library!(Fixed, scene.bases, peer - 17),
        19 => of_five_states!(|model: &Model, _| Some(Kfilter::new(model))),
        FIRST_GOVERNOR.. => match peer.checked_sub(FIRST_SOLVER) {
            None => governor(scene, peer - FIRST_GOVERNOR, visitor),
            Some(solver) => with_solver(solver, Ticking(visitor)),
        },
        _ => None,
    }
}

/// Hands a speed loop to a visitor, those with an observer for a machine whose gear has no losses.
fn governor<V: Visitor>(scene: &Scene, governor: usize, visitor: V) -> Option<V::Output> {
    macro_rules! rigid {
        ($number:ty, $bases:expr) => {{
            let config = RigidConfig::<$number>::try_new(&scene.rigid, scene.load_share, $bases).ok()?;
            let governor = SpeedLoopConfig::<$number>::try_new(&scene.speed_loop, settings(scene), $bases).ok()?;
            Some(visitor.visit(Observed::<$number, RigidObserver<$number>>::new(config, governor)))
        }};
    }
    if scene.gear.is_some() {
        return None;
    }
    match governor {
        0 => Some(visitor.visit(OnLowPass::new(scene, LibraryLoop::new(scene)?))),
        1 => Some(visitor.visit(OnLowPass::new(scene, ByPid::new(scene)))),
        2 => Some(visitor.visit(OnLowPass::new(scene, ByPidCtrl::new(scene)))),
        3 => Some(visitor.visit(OnLowPass::new(scene, ByIdsp::new(scene)))),
        4 => rigid!(f32, Bases::SI),
        5 => rigid!(Fixed, scene.bases),
        _ => None,
    }
}

/// Something to be done with a solver of least squares, whatever its type.
pub trait SolverVisitor {
    /// What comes of it.
    type Output;
    /// Does it.
    fn visit<S: Solver>(self, solver: S) -> Self::Output;
}

/// A visitor of what ticks, for solvers.
struct Ticking<V>(V);

impl<V: Visitor> SolverVisitor for Ticking<V> {
    type Output = V::Output;

    fn visit<S: Solver>(self, solver: S) -> V::Output {
        self.0.visit(EachTick(solver))
    }
}

/// Hands a solver of [`SOLVERS`] to a visitor.
pub fn with_solver<V: SolverVisitor>(solver: usize, visitor: V) -> Option<V::Output> {
    const QR: usize = Factorisation::Qr as usize;
    const SVD: usize = Factorisation::Svd as usize;
    const NORMAL: usize = Factorisation::Normal as usize;
    match solver {
        0 => Some(visitor.visit(least_squares::ByLibrary::<f32>::new()?)),
        1 => Some(visitor.visit(least_squares::ByNalgebra::<f32, QR>::new())),
        2 => Some(visitor.visit(least_squares::ByNalgebra::<f32, SVD>::new())),
        3 => Some(visitor.visit(least_squares::ByNalgebra::<f32, NORMAL>::new())),
        4 => Some(visitor.visit(least_squares::ByLibrary::<f64>::new()?)),
        5 => Some(visitor.visit(least_squares::ByNalgebra::<f64, QR>::new())),
        6 => Some(visitor.visit(least_squares::ByNalgebra::<f64, SVD>::new())),
        7 => Some(visitor.visit(least_squares::ByNalgebra::<f64, NORMAL>::new())),
        _ => None,
    }
}
