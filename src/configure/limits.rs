//! Plausibility limits of a sample, for a machine.

use super::{Configure, Machine};
use crate::drive::Limits;
use crate::number::Fixed;
use crate::settings::Bases;

macro_rules! limits {
    ($number:ident, $bases:expr) => {
        impl<M: Machine> Configure<M, $number> for Limits<$number> {
            type Config = Self;
            const CONFIG: Self = Limits::<$number>::new(&M::SCREENING, $bases);
        }
    };
}

limits!(f32, Bases::SI);
limits!(f64, Bases::SI);
limits!(Fixed, M::BASES);
