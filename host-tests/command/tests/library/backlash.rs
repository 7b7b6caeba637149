//! The observer of backlash: its step against the full solver, and what it refuses.

mod sentences;
mod step;
