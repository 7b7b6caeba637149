//! Error of a constant.

/// A constant that a number type cannot hold.
///
/// ```
/// use driveline::governor::SymmetricLimitConfig;
/// use driveline::{number::Fixed, settings::{Bases, Error}};
/// // a torque limit beyond the base of the torque
/// let bases = Bases { torque: 500.0, ..Bases::SI };
/// let refused = SymmetricLimitConfig::<Fixed>::try_new(550.0, bases);
/// assert!(matches!(refused, Err(Error::Value(sentence)) if sentence.contains("within the base of the torque")));
/// ```
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
