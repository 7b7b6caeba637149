//! What is written for a user outside the repository: a firmware crate ([`new`](super::new)), a library for C
//! ([`export`](super::export)). Both hold a machine as a constant and its drive, as [`Project`] describes them.

mod description;
mod folder;
mod part;
mod source;
mod template;

pub use description::{Number, Project, name_of_c};
pub use folder::{is_free, write};
pub use part::{Part, PartOptions};
pub use source::Source;
pub use template::fill;
