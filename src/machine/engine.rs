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

mod cylinder;
mod indicator;
mod shaking;
mod torque;

pub use cylinder::{Cylinder, WorkingCycle, phasor_sum};
pub use indicator::Indicator;
pub use shaking::{Shaking, free_forces, free_moments};
pub use torque::Harmonic;
