//! Rotors that their firmware balances.

mod scenes;
