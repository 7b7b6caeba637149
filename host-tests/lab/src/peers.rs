//! Other observers on the scenes' own runs: errors, cost, and the front of error against cost of each scene.
//!
//! The observers are those of the crate `host-tests/peers`, which the library and its tests do not depend on. All get
//! the same signals: angle and torque that the scene's drive had in closed loop, from the release on. Errors are
//! computed on the host, instructions, stack and code in QEMU over a stretch of the same run.
//!
//! | term | meaning |
//! |---|---|
//! | tuned | a corner or a radius of poles is swept over a run; the best for the shaft torque is kept |
//! | drawn | on machines drawn from within the tolerances, others than those that the corner was swept on |
//! | wins | has an error that is smaller by 1 % than that of every observer of the library at no more instructions |

mod comparison;
mod count;
mod drawn;
mod markdown;
mod recording;
mod replay;

pub use comparison::{Accuracy, Comparison, Observer, SceneComparison, scenes};
pub use count::{Cost, Images};
pub use markdown::peers_markdown;
pub use recording::Recording;
pub use replay::Replay;
