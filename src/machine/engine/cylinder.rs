//! Where the cylinders stand and when they fire.

use core::f64::consts::TAU;

use crate::machine::{Error, Length};
use crate::math::{hypot, sin_cos};

/// Crank angles that are nearer to each other than this are the same (rad): far above their rounding, far below the
/// distance of two throws.
const SAME: f64 = 1e-6;

/// The working cycle of an engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum WorkingCycle {
    /// One turn; orders 1, 2, 3 ... \[derived\].
    TwoStroke,
    /// Two turns; orders 1/2, 1, 3/2 ... \[derived\].
    FourStroke,
}

impl WorkingCycle {
    /// Crank angle of a cycle (rad).
    #[must_use]
    pub const fn angle(self) -> f64 {
        match self {
            Self::TwoStroke => TAU,
            Self::FourStroke => 2.0 * TAU,
        }
    }

    /// Lowest order, of which all others are multiples.
    #[must_use]
    pub const fn lowest_order(self) -> f64 {
        TAU / self.angle()
    }
}

/// A cylinder of an engine.
///
/// A cylinder's crank angle from its top dead centre is `phi_j = phi + throw_j - bank_j`. Everything is a phasor sum
/// over these angles: free forces and moments over the mass force of each cylinder, the excitation of a mode over its
/// torque [derived; heading: Pfützner 1980 ch. 2].
///
/// | term | meaning | unit |
/// |---|---|---|
/// | throw | angle of a crank on the crankshaft, in the sense of rotation | rad |
/// | bank | direction of a cylinder's axis about the crankshaft, in the same sense | rad |
/// | order | multiple of the crankshaft's speed: 1/2, 1, 3/2 ... of a four-stroke engine | 1 |
/// | forward, backward | parts of a force that rotate with the crank and against it, at `order` times its speed | |
/// | phasor sum | sum of the mode shape at the throws, each at its firing angle times the order | |
///
/// ```
/// use core::f64::consts::PI;
/// use driveline::machine::{Cylinder, Length, free_forces, phasor_sum};
///
/// const FOUR: [Cylinder; 4] = Cylinder::fired(Cylinder::in_line([0.0, PI, PI, 0.0], Length(0.1)), [1, 3, 4, 2]);
/// // no first order, four times that of one cylinder of the second
/// assert!(free_forces(&FOUR, 1).largest() < 1e-15);
/// assert!((free_forces(&FOUR, 2).largest() - 4.0).abs() < 1e-15);
/// // the rigid crankshaft feels the second order of all four, and nothing of the first
/// assert!((phasor_sum(&FOUR, &[1.0; 4], 2.0) - 4.0).abs() < 1e-14);
/// assert!(phasor_sum(&FOUR, &[1.0; 4], 1.0) < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Cylinder {
    /// Angle of its throw on the crankshaft (rad), in the sense of rotation.
    pub throw: f64,
    /// Direction of its axis about the crankshaft (rad), in the sense of rotation.
    pub bank: f64,
    /// Place along the crankshaft (m).
    pub position: f64,
    /// Angle of the crankshaft at which it fires (rad), a top dead centre.
    pub firing: f64,
}

impl Cylinder {
    /// A cylinder that fires at its first top dead centre, as every one of a two-stroke engine.
    #[must_use]
    pub const fn new(throw: f64, bank: f64, position: Length) -> Self {
        Self { throw, bank, position: position.0, firing: within_a_turn(bank - throw) }
    }

    /// Cylinders in line, `pitch` apart, by their throws (rad).
    #[must_use]
    pub const fn in_line<const N: usize>(throws: [f64; N], pitch: Length) -> [Self; N] {
        let mut all = [Self::new(0.0, 0.0, Length(0.0)); N];
        each!(j, 0..N, {
            all[j] = Self::new(throws[j], 0.0, Length(pitch.0 * j as f64));
        });
        all
    }

    /// The cylinders of a four-stroke engine with their firing angles, by the firing order, cylinders counted from 1.
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence of [`Error::FiringOrder`].
    #[must_use]
    pub const fn fired<const N: usize>(mut cylinders: [Self; N], order: [usize; N]) -> [Self; N] {
        match Self::try_fire(&mut cylinders, &order) {
            Ok(()) => cylinders,
            Err(error) => error.stop(),
        }
    }

    /// Sets the firing angles of a four-stroke engine: each cylinder fires at its first top dead centre after the one
    /// before it in the order. The first named begins, at its first one; what is left of two turns follows the last.
    ///
    /// An order that begins elsewhere in the same sequence can be another engine. Two cylinders on one pin, 45 degrees
    /// apart, fire at 0 and 45 degrees as `[1, 2]`, at 45 and 360 as `[2, 1]`.
    ///
    /// # Errors
    /// [`Error::FiringOrder`] where the order does not name every cylinder once, counted from 1, or does not fit into
    /// two turns.
    pub const fn try_fire(cylinders: &mut [Self], order: &[usize]) -> Result<(), Error> {
        if order.len() != cylinders.len() {
            return Err(Error::FiringOrder);
        }
        let (mut j, mut begin, mut last) = (0, 0.0, 0.0);
        while j < order.len() {
            each!(before, 0..j, {
                if order[before] == order[j] {
                    return Err(Error::FiringOrder);
                }
            });
            if order[j] == 0 || order[j] > cylinders.len() {
                return Err(Error::FiringOrder);
            }
            let cylinder = &mut cylinders[order[j] - 1];
            let dead_centre = within_a_turn(cylinder.bank - cylinder.throw);
            if j == 0 {
                begin = dead_centre;
                last = dead_centre;
            } else {
                let step = within_a_turn(dead_centre - last);
                last += if step < SAME { step + TAU } else { step };
            }
            if !(last - begin < WorkingCycle::FourStroke.angle() - SAME) {
                return Err(Error::FiringOrder);
            }
            cylinder.firing = last;
            j += 1;
        }
        Ok(())
    }
}

/// Phasor sum of an order over a mode's `shape` at each cylinder's throw: `|sum psi_j exp(-i nu alpha_j)|` with the
/// firing angles alpha \[derived; excitation by orders: Pfützner 1980 (1.2a) to (1.2c)\].
///
/// Torque of the order times this sum is the mode's excitation. Cylinders beyond the shape's length do not count.
#[must_use]
pub const fn phasor_sum(cylinders: &[Cylinder], shape: &[f64], order: f64) -> f64 {
    let (mut re, mut im, mut j) = (0.0, 0.0, 0);
    while j < cylinders.len() && j < shape.len() {
        let (sine, cosine) = sin_cos(order * cylinders[j].firing);
        re += shape[j] * cosine;
        im -= shape[j] * sine;
        j += 1;
    }
    hypot(re, im)
}

/// The same angle from zero to a turn.
const fn within_a_turn(angle: f64) -> f64 {
    let rest = angle % TAU;
    if rest < -SAME {
        rest + TAU
    } else if rest > 0.0 {
        rest
    } else {
        0.0
    }
}
