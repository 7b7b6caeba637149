//! The speed fluctuation in closed loop.

mod stroke;
