//! The composed governor: its design, its parts, its modes and trips; the generator sets that it governs.

mod barred;
mod design;
mod law;
mod modes;
mod natural_damping;
mod sharing;
mod switch;
mod torque_curve;
mod watch;
