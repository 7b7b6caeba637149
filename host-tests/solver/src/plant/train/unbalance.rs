//! An unbalanced mass on a turning coordinate whose bearing moves along a way: the exciter of a vibrating machine.
//!
//! With the turning coordinate at `phi`, the mass stands at `x + r cos phi` along the way. Its own mass belongs to the
//! way's and `m r^2` to the inertia of what turns, so that the moment `S = m r` alone couples them. By Lagrange's
//! equations, gravity `g` pulling against the way:
//!
//! `M x'' - S (phi'' sin phi + phi'^2 cos phi) = forces`, `J phi'' - S sin phi (x'' + g) = torques`
//!
//! Two equal masses that turn against each other, as those of a linear exciter do, are one with the sum of their
//! moments; what they do across the way cancels. The solver integrates the momenta `M x' - S phi' sin phi` and
//! `J phi' - S x' sin phi`, whose rates hold no acceleration.

/// The coupling of a turning coordinate with a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unbalance {
    /// The coordinate that turns.
    pub turning: usize,
    /// The coordinate that its bearing moves along.
    pub way: usize,
    /// `S`, mass times radius, kg m.
    pub moment: f64,
    /// Gravity against the way, m/s2.
    pub gravity: f64,
}

impl Unbalance {
    /// Torque of gravity on what turns, at its angle, N m.
    pub(super) fn weight(&self, angle: f64) -> f64 {
        self.moment * self.gravity * angle.sin()
    }
}
