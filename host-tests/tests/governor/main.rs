//! The composed governor: its design, its parts, its modes and trips.

mod barred;
mod design;
mod law;
mod modes;
mod sharing;
mod switch;
