//! Faults of whole machines: what a supervised drive does, and what it says.

mod faults;
mod machines;
mod missed;
mod plant;
mod quiet;
mod replay;
mod run;
