//! Generator sets: their engines, their governors under attack, their page.

mod attack;
mod engine;
mod page;
mod sets;
