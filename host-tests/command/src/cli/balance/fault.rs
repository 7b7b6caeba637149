//! Why no weights follow.

use driveline::balancing::Error;

use crate::machine_file::Diagnostic;

/// Why no weights follow.
#[derive(Clone, Debug)]
pub enum Fault {
    /// An entry of the file.
    Placed(Diagnostic),
    /// A calculation.
    Refused(Error),
}

impl From<Error> for Fault {
    fn from(refusal: Error) -> Self {
        Fault::Refused(refusal)
    }
}
