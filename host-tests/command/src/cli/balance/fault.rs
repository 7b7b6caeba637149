//! Why no weights follow.

use driveline::balancing::Error;

use crate::machine_file::Diagnostic;

/// Why no weights follow.
#[derive(Clone, Debug)]
pub enum Fault {
    /// What stands at a place of the file.
    Placed(Diagnostic),
    /// What was calculated.
    Refused(Error),
}

impl From<Error> for Fault {
    fn from(refusal: Error) -> Self {
        Fault::Refused(refusal)
    }
}
