//! The full solver beyond chains: branches, loops, meshes, cranks, friction, absorbers, each held to a closed form or
//! a case.

mod absorber;
mod contact;
mod crank;
mod linear;
mod linkage;
mod losses;
mod modes;
mod mover;
mod pins;
mod proof;
mod rigid_gear;
mod spur_pair;
mod start;
mod unbalance;
