//! Symbols of an image.

/// A function or a variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Its name, mangled as in the file.
    pub name: String,
    /// Its address, without the bit that marks Thumb code.
    pub address: u64,
    /// Its bytes, a function's literal pool included.
    pub size: u64,
    /// Whether it is a function.
    pub is_function: bool,
}
