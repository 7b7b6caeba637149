//! Error of a constant.

/// A constant that a number type cannot hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// A coefficient outside the range of fixed point.
    Coefficient(&'static str),
    /// A value out of the range of its base.
    Value(&'static str),
}

impl Error {
    /// The sentence that names the constant.
    pub const fn message(self) -> &'static str {
        match self {
            Error::Coefficient(sentence) | Error::Value(sentence) => sentence,
        }
    }

    /// Stops with the sentence: a compile error in a constant.
    pub(crate) const fn stop(self) -> ! {
        panic!("{}", self.message())
    }
}

messages!(Error);
