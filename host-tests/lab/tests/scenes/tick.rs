//! The tick of the hoist's drives: bad samples, garbage, angles that wrap, momentum, the speed loop, fine encoders, and
//! the same bits however the constants were made.

mod fine_encoders;
mod missed;
