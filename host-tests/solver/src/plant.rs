//! The full solver: a drive train of `n` inertias on `n - 1` shafts, solved as exactly as `f64` allows.
//!
//! Everything is referred to the motor shaft. Node 0 is the motor, node `n - 1` the far end; shaft `s` joins nodes
//! `s` and `s + 1`. Terms and units:
//!
//! | term | meaning | unit |
//! |---|---|---|
//! | inertia | `J_j` of a node | kg m2 |
//! | twist | angle of node `s` less that of node `s + 1`, the strain of shaft `s` | rad |
//! | stiffness, damping | `k`, `d` of a shaft: torque per twist and per twist rate | N m/rad, N m s/rad |
//! | backlash | total free play of a shaft, both flanks together | rad |
//! | slack | how far a rope must be wound before it pulls | rad |
//! | Coulomb torque | friction that holds a node at rest up to this torque | N m |
//! | load torque | torque against positive speed, whatever the speed (gravity) | N m |
//! | efficiency | of a gear at a node, towards the shaft behind it; the driving side pays, the shaft at its own | 1 |
//!
//! Equations: `J_j w_j' = T_(j-1) - m_j T_j - c_j w_j - friction_j - load_j` `[Pfützner 1980 (1.6)]`, with the shaft
//! torque `T_s = k (theta - G/2) + d dw` for `theta > G/2`, `k (theta + G/2) + d dw` for `theta < -G/2` and zero in
//! the gap `[derived; headings: Huang 1987 ch. 3 to 7]`, and `m` the loss of the gear, `1/eta` driving and `eta` driven
//! `[Huang 1987 tables 1-2 to 1-4]`.
//!
//! Between events (a flank met or left, a stop, a slip, a reversal of the flow of power, a corner of an excitation)
//! the equations are linear with constant coefficients and are propagated by their exponential; events are isolated
//! by bounds on the second derivative, so that a grazing contact is found whatever the length of the tick.
//!
//! The module shares no code with the library that it judges.
//!
//! ```
//! use driveline_solver::plant::{Chain, EventKind, Shaft, Start};
//! // a slack rope is wound up by the motor, comes taut and lifts 60 N m
//! let mut hoist = Chain::motor(0.62)
//!     .shaft(Shaft::elastic(5.0e4).damping(2.0), 0.08).efficiency(0.94)
//!     .shaft(Shaft::rope(900.0).damping(0.5).gap(0.5), 0.35).coulomb(60.0)
//!     .start(Start::Slack)
//!     .build()?;
//! for _ in 0..5000 {
//!     // in lock-step: angle and speed out, torque in, held for a tick of 100 us
//!     let torque = (20.0 - hoist.motor_speed()) * 40.0;
//!     hoist.advance(torque.clamp(-150.0, 150.0), 1e-4);
//! }
//! assert!(hoist.events().iter().any(|event| event.kind == EventKind::Contact && event.new == 1));
//! assert!(hoist.shaft_torque(1) > 0.0 && hoist.speed(2) > 0.0);
//! # Ok::<(), driveline_solver::plant::PlantError>(())
//! ```
//!
//! - [`Chain`] describes, [`Plant`] runs it as the [`train`] that it is, [`train::Source`] and [`LoadProgram`] drive it,
//!   [`Event`] reports;
//! - [`converge`] proves a run with another integrator.

mod chain;
pub mod converge;
mod error;
mod event;
mod excitation;
mod extremes;
mod propagator;
mod root;
mod shaft;
pub mod train;
pub mod vibration;

pub use chain::{Chain, Start};
pub use error::PlantError;
pub use event::{Event, EventKind, Place};
pub use excitation::LoadProgram;
pub use extremes::Extremes;
pub use shaft::Shaft;
pub use train::plant::Plant;
