//! Generator sets: their engines, the sets by their standards, what disturbs them.

mod cylinders;
mod disturbed;
mod engine;
mod sets;
