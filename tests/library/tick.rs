//! The tick of the hoist's drives: bad samples, garbage, angles that wrap, momentum, the speed loop, fine encoders, and
//! the same bits however the constants were made.

mod angle;
mod constants;
mod faults;
mod fixed;
mod garbage;
mod momentum;
mod refused;
mod rig;
mod speed_loop;
mod spinning;
