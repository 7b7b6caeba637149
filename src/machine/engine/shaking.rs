//! Free forces and moments of the reciprocating masses, order by order.

use super::Cylinder;
use crate::machine::CrankSlider;
use crate::math::{hypot, sin_cos};

/// A free force or moment of one order as two vectors, in units of one cylinder's force of that order.
///
/// In the plane across the crankshaft, x along the direction of bank 0, it is `forward exp(i n phi) + backward
/// exp(-i n phi)`: an ellipse. A mass opposite to the forward part and rotating with it at `n` times the speed balances
/// that part; the backward part needs a shaft that turns against the crank [derived; heading: Pfützner 1980 ch. 2].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Shaking {
    /// Part that rotates with the crank, x and y.
    pub forward: [f64; 2],
    /// Part that rotates against the crank, x and y.
    pub backward: [f64; 2],
}

impl Shaking {
    /// Largest value over a turn: half of the ellipse's long axis.
    #[must_use]
    pub const fn largest(&self) -> f64 {
        hypot(self.forward[0], self.forward[1]) + hypot(self.backward[0], self.backward[1])
    }

    /// Smallest size over a turn: half of the ellipse's short axis.
    #[must_use]
    pub const fn smallest(&self) -> f64 {
        (hypot(self.forward[0], self.forward[1]) - hypot(self.backward[0], self.backward[1])).abs()
    }

    /// The first order with a counterweight opposite to every throw, of `share` times the reciprocating mass of each of
    /// its cylinders at the crank's radius. A share of 1/2 removes the forward part.
    #[must_use]
    pub const fn counterweighted(self, share: f64) -> Self {
        self.with_balance_shafts(2.0 * share, 0.0)
    }

    /// Adds shafts at `n` times the speed that balance a share of the forward part and one of the backward part.
    #[must_use]
    pub const fn with_balance_shafts(self, forward: f64, backward: f64) -> Self {
        let (f, b) = (1.0 - forward, 1.0 - backward);
        Self {
            forward: [f * self.forward[0], f * self.forward[1]],
            backward: [b * self.backward[0], b * self.backward[1]],
        }
    }

    /// Unbalances of the two shafts that balance it whole at `order` times the speed, as x and y with the crank at
    /// zero: of the one that turns with the crank, and of the one that turns against it. kg m of a force; kg m2 of a
    /// moment, each unbalance times its place along the shaft. `crank` is that of one cylinder.
    ///
    /// The part of the size f in units of the order's force F, whose shafts turn `order` times as fast, has
    /// `f F/(order omega)^2`: `f m r` of the first order. Derived. `None` for orders that the crank's
    /// [`force_orders`](CrankSlider::force_orders) do not resolve, 0 and above 16.
    #[must_use]
    pub const fn balance_shafts(&self, crank: &CrankSlider, order: u32) -> Option<[[f64; 2]; 2]> {
        if order == 0 || order as usize >= ORDERS {
            return None;
        }
        let opposite = -crank.force_orders::<ORDERS>(1.0)[order as usize] / (order as f64 * order as f64);
        let [f, b] = [self.forward, self.backward];
        Some([[opposite * f[0], opposite * f[1]], [opposite * b[0], opposite * b[1]]])
    }
}

/// Orders that balance shafts are made for, 0 among them.
const ORDERS: usize = 17;

/// Free force of an order in units of one cylinder's, see
/// [`force_orders`](crate::machine::CrankSlider::force_orders): `m r omega^2` of the first.
///
/// Rotating masses at the throws, one for each cylinder, give twice the forward part of the first order, in units of
/// their own `m r omega^2`.
#[must_use]
pub const fn free_forces(cylinders: &[Cylinder], order: u32) -> Shaking {
    sum(cylinders, order, None)
}

/// Free moment of an order about a place on the crankshaft (m), in metres times the unit of [`free_forces`]. Its x
/// and y are those of the forces that make it.
#[must_use]
pub const fn free_moments(cylinders: &[Cylinder], order: u32, about: f64) -> Shaking {
    sum(cylinders, order, Some(about))
}

const fn sum(cylinders: &[Cylinder], order: u32, about: Option<f64>) -> Shaking {
    let n = order as f64;
    let (mut forward, mut backward) = ([0.0; 2], [0.0; 2]);
    each!(j, 0..cylinders.len(), {
        let Cylinder { throw, bank, position, .. } = cylinders[j];
        let half = match about {
            Some(about) => 0.5 * (position - about),
            None => 0.5,
        };
        // cos(n phi_j) along the bank: half of it rotates each way
        let (sine, cosine) = sin_cos(bank + n * (throw - bank));
        forward = [forward[0] + half * cosine, forward[1] + half * sine];
        let (sine, cosine) = sin_cos(bank - n * (throw - bank));
        backward = [backward[0] + half * cosine, backward[1] + half * sine];
    });
    Shaking { forward, backward }
}
