//! Cost of a call, measured by the image itself: instructions ([`count`]) and stack ([`stack`]).

pub mod count;
pub mod stack;
