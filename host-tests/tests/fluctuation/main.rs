//! The speed's fluctuation: cycles, waveforms and orders against motions in closed form, through the real drive.

mod extremes;
mod motion;
mod rig;
mod waveform;
