//! Equivalent quantities on another shaft of a gear train [Huang 1987 ch. 1, tables 1-2 to 1-4, Wang 1989 §1-3].
//!
//! The driving side supplies the loss: motoring, elements behind the gear count `1/efficiency` times at the motor;
//! overhauling, `efficiency` times. Referring from the motor's side to the load's is the inverse.

/// Direction of power through a gear with losses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Flow {
    /// No loss: energy is kept.
    Lossless,
    /// Motoring: the motor drives the load.
    Motoring,
    /// Overhauling: the load drives the motor.
    Overhauling,
}

/// Side of the gear on which the quantity is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Side {
    /// From the load's (slow) side to the motor's.
    Load,
    /// From the motor's (fast) side to the load's.
    Motor,
}

const fn with_loss(value: f64, efficiency: f64, side: Side, flow: Flow) -> f64 {
    match (side, flow) {
        (_, Flow::Lossless) => value,
        (Side::Load, Flow::Motoring) | (Side::Motor, Flow::Overhauling) => value / efficiency,
        (Side::Load, Flow::Overhauling) | (Side::Motor, Flow::Motoring) => value * efficiency,
    }
}

/// An inertia (kg m2) on the other side of a gear of `ratio`.
#[must_use]
pub const fn refer_inertia(inertia: f64, ratio: f64, efficiency: f64, side: Side, flow: Flow) -> f64 {
    let kept = match side {
        Side::Load => inertia / (ratio * ratio),
        Side::Motor => inertia * (ratio * ratio),
    };
    with_loss(kept, efficiency, side, flow)
}

/// A stiffness (N m/rad) or a damping (N m s/rad) on the other side of a gear of `ratio`.
#[must_use]
pub const fn refer_stiffness(stiffness: f64, ratio: f64, efficiency: f64, side: Side, flow: Flow) -> f64 {
    refer_inertia(stiffness, ratio, efficiency, side, flow)
}

/// A backlash (rad) on the other side of a gear of `ratio`.
#[must_use]
pub const fn refer_gap(gap: f64, ratio: f64, side: Side) -> f64 {
    match side {
        Side::Load => gap * ratio,
        Side::Motor => gap / ratio,
    }
}

/// Stiffness of two springs in series (N m/rad): `1/k = 1/k1 + 1/k2`.
#[must_use]
pub const fn series(k1: f64, k2: f64) -> f64 {
    let (soft, stiff) = if k1 < k2 { (k1, k2) } else { (k2, k1) };
    soft / (1.0 + soft / stiff)
}
