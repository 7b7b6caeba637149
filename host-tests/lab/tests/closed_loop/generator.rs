//! Generator sets: their engines, their governors under attack.

mod attack;
mod engine;
mod sets;
