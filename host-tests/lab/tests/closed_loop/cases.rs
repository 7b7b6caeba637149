//! Published and made-up cases that are stiff or extreme.

mod machine_modes;
mod mesh;
