//! All observers by their names.

use driveline::design::{Rate, StepChoice};
use driveline::number::Fixed;
use driveline::observer::{
    BacklashConfig, BacklashObserver, GearedConfig, GearedObserver, MechanismConfig, MechanismObserver, RigidConfig,
    RigidObserver, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver,
};
use driveline::settings::Bases;

use crate::constant_gain::{ByHand, ByNalgebra};
use crate::kalman::Idsp;
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
    "driveline semi-implicit tuned, f32",
    "driveline exact tuned, f32",
    "driveline semi-implicit tuned, fixed",
    "driveline exact tuned, fixed",
];

/// The numbers of those that have a corner or a radius to tune.
pub const TUNED: [usize; 7] = [13, 14, 15, 17, 18, 19, 20];

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
        17 | 18 => library!(f32, Bases::SI, peer - 12),
        19 | 20 => library!(Fixed, scene.bases, peer - 14),
        _ => None,
    }
}
