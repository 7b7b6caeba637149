//! Identification of a machine from a recording of its torque and motion, or from a table of its frequency response.
//!
//! The machine is two masses on a shaft with viscous friction on both. A recording is taken to its spectrum: of each
//! part of it the lines that carry the torque. [`driveline::commissioning::fit`] gives a first guess, and
//! [`estimate`] the likeliest machine with its deviations; whatever a record cannot determine is refused.

mod cause;
mod contact;
mod estimate;
mod identify;
mod model;
mod page;
mod refusal;
mod spectrum;
mod text;

pub use cause::Rigid;
pub use estimate::{Estimate, Figures, Setting, estimate};
pub use identify::{Identified, NotIdentified, identify, identify_response};
pub use model::{Model, Motion, Third, Torque};
pub use page::page;
pub use refusal::Refusal;
pub use spectrum::{Line, carriers, guess, lines, smoothed, tabulated};
pub use text::{Drive, machine_file, table};
