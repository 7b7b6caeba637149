//! Why no weights follow.

use driveline::balance::Refusal;

use crate::machine_file::Diagnostic;

/// Why no weights follow.
#[derive(Clone, Debug)]
pub enum Fault {
    /// What stands at a place of the file.
    Placed(Diagnostic),
    /// What was calculated.
    Refused(Refusal),
}

impl From<Refusal> for Fault {
    fn from(refusal: Refusal) -> Self {
        Fault::Refused(refusal)
    }
}
