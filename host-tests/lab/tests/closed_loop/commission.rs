//! Commissioning: what the test finds on full plants beside what is true, and what it refuses.

mod attacked;
mod found;
mod refused;
