//! The composed governor: its design, its parts, its modes and trips; the generator sets that it governs.

mod dynamic_part;
mod generator_sets;
mod sway;
