//! Built-in inputs, and the fingerprint of a run over them, for comparing bits and counting instructions.

pub mod backlash_inputs;
pub mod fingerprint;
pub mod inputs;
