//! The speed's fluctuation: cycles, waveforms and orders against motions in closed form, through the real drive.

mod breakage;
mod cycle_mean;
mod cylinders;
mod deviation;
mod extremes;
mod flywheel;
mod gear_mesh;
mod motion;
mod numerics;
mod rig;
mod toothed_wheel;
mod waveform;
