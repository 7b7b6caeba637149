//! Generator sets: their engines, the sets by their standards, what disturbs them.

mod disturbed;
mod engine;
mod sets;
