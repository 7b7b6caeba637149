//! Piston engines: cylinders about a crankshaft, their free forces and moments, and their torque by orders.
//!
//! A cylinder's crank angle from its top dead centre is `phi_j = phi + throw_j - bank_j`. Everything is a phasor sum
//! over these angles: free forces and moments over the mass force of each cylinder, the excitation of a mode over its
//! torque [derived; heading: Pfützner 1980 ch. 2].
//!
//! | term | meaning | unit |
//! |---|---|---|
//! | throw | angle of a crank on the crankshaft, in the sense of rotation | rad |
//! | bank | direction of a cylinder's axis about the crankshaft, in the same sense | rad |
//! | order | multiple of the crankshaft's speed: 1/2, 1, 3/2 ... of a four-stroke engine | 1 |
//! | forward, backward | parts of a force that rotate with the crank and against it, at `order` times its speed | |
//! | phasor sum | sum of the mode shape at the throws, each at its firing angle times the order | |
//!
//! ```
//! use core::f64::consts::PI;
//! use driveline::machine::{Cylinder, Length, free_forces, phasor_sum};
//!
//! const FOUR: [Cylinder; 4] = Cylinder::fired(Cylinder::in_line([0.0, PI, PI, 0.0], Length(0.1)), [1, 3, 4, 2]);
//! // no first order, four times that of one cylinder of the second
//! assert!(free_forces(&FOUR, 1).largest() < 1e-15);
//! assert!((free_forces(&FOUR, 2).largest() - 4.0).abs() < 1e-15);
//! // the rigid crankshaft feels the second order of all four, and nothing of the first
//! assert!((phasor_sum(&FOUR, &[1.0; 4], 2.0) - 4.0).abs() < 1e-14);
//! assert!(phasor_sum(&FOUR, &[1.0; 4], 1.0) < 1e-14);
//! ```

mod cylinder;
mod indicator;
mod shaking;
mod torque;

pub use cylinder::{Cylinder, WorkingCycle, phasor_sum};
pub use indicator::Indicator;
pub use shaking::{Shaking, free_forces, free_moments};
pub use torque::Harmonic;
