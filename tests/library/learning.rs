//! Learners: what they find, and that nonsense changes nothing.

mod eccentricity;
mod gear_loss;
mod run_up;
mod stored;
mod torque_constant;
