//! The full solver beyond chains: branches, loops, meshes, cranks, friction, absorbers, each held to a closed form or
//! a case.

mod against_chain;
mod crank;
mod mesh;
mod proof;
mod transfer;
