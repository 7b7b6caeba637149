//! Fatigue: rainflow counting on the tick against the standard's rule, damage against Miner's sum, the life
//! on a scene's panel.

mod life;
