//! The elements of machines against textbooks, published machines and closed forms.

mod crank;
mod damper;
mod dynamic_factor;
mod engine;
mod main_mode;
mod need;
mod prime_mover;
mod section;
mod starting_time;
mod train;
mod train_damper;
mod travel;
