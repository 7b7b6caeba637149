//! The composed governor: its design, its parts, its modes and trips; the generator sets that it governs.

mod attack;
mod barred;
mod design;
mod engine;
mod law;
mod modes;
mod page;
mod sets;
mod sharing;
mod switch;
mod watch;
