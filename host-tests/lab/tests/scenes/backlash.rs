//! The observer of backlash: its step against the full solver, its gains, a mill that bites, and what it refuses.

mod bites;
