//! Machine models: a chain of elements from the motor to the load, described once as a constant.
//!
//! ```
//! use driveline::machine::{Chain, Damping, Diameter, Efficiency, Falls, Inertia, Mass, Match, Ratio};
//! use driveline::machine::{Stiffness, TwoMass};
//!
//! const HOIST: Chain = Chain::motor(Inertia(0.62))
//!     .shaft(Stiffness(5.0e4), Damping(2.0))
//!     .rotor(Inertia(0.08))
//!     .gear(Ratio(31.5), Efficiency(0.94))
//!     .drum(Diameter(0.8))
//!     .rope(Falls(2), Stiffness(9.0e5))
//!     .lifted(Mass(12_000.0));
//! const TWO: TwoMass = HOIST.reduce(Match::ResonanceAntiresonance);
//! assert!(TWO.resonance() > TWO.antiresonance());
//! ```
//!
//! Everything is referred to the motor's shaft, keeping the power, the kinetic energy and the strain energy
//! [Wang 1989 §1-3, Huang 1987 ch. 1, Pfützner 1980 §1.2]. Every function is a `const fn` in `f64`: evaluated by the
//! compiler or at run time it gives the same bits. A chain carries its first [`Error`]: a constant that is made of a
//! wrong chain is a compile error with its sentence, which the `try_` form of the same method returns.
//!
//! | term | meaning | unit |
//! |---|---|---|
//! | inertia | moment of inertia, referred to the motor | kg m2 |
//! | stiffness, damping | of a shaft, referred to the motor | N m/rad, N m s/rad |
//! | gap | whole free travel of a backlash, at the motor | rad |
//! | ratio | motor-side speed over load-side speed of a gear | 1 |
//! | resonance | natural frequency of the free chain | rad/s |
//! | antiresonance | natural frequency of the chain with the motor locked | rad/s |
//! | residue | square of a mass-normalised mode shape at the motor | 1/(kg m2) |

mod belt;
mod chain;
mod crank;
mod damper;
mod driven_mechanism;
mod engine;
mod error;
mod linear;
mod linkage;
mod main_mode;
mod mechanism;
mod modes;
mod planetary;
mod prime_mover;
mod quantity;
mod reduce;
mod reduction_error;
mod refer;
mod rigid;
mod section;
mod sensitivity;
mod train;
mod train_damper;
mod train_reduce;
mod two_mass;

pub use belt::Belt;
pub use chain::{CAPACITY, Chain, Losses, Shaft};
pub use crank::{CrankSlider, Travel};
pub use damper::{CentrifugalPendulum, Damper, FrictionDamper, Resonance};
pub use driven_mechanism::DrivenMechanism;
pub use engine::{Cylinder, Harmonic, Indicator, Shaking, WorkingCycle, free_forces, free_moments, phasor_sum};
pub use error::Error;
pub use linear::STANDARD_GRAVITY;
pub use linkage::{FourBar, Toggle};
pub use mechanism::{MECHANISM_POINTS, Mechanism, MechanismPoint};
pub use modes::{Mode, Modes};
pub use planetary::{Member, Planetary, PlanetaryGear};
pub use prime_mover::{Characteristic, Induction, Line, Parabola, Series, StartingLaw};
pub use quantity::{
    Damping, Density, Diameter, Efficiency, Falls, Gap, Inertia, Length, LinearDamping, Mass, Ratio, ShearModulus,
    Speed, Stiffness, Torque,
};
pub use reduce::Match;
pub use reduction_error::ReductionError;
pub use refer::{Flow, Side, refer_gap, refer_inertia, refer_stiffness, series};
pub use rigid::Rigid;
pub use section::{Section, stepped, try_stepped};
pub use sensitivity::{Element, Part, Sensitivity};
pub use train::{Joint, TRAIN_SHAFTS, Train};
pub use two_mass::TwoMass;
