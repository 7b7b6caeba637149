//! The observer of backlash: its step against the full solver, the gap's two sides, random reversals, and what it
//! refuses.

mod paths;
mod reversals;
mod scenes;
mod sides;
