//! Equivalent quantities on another shaft of a gear train [Huang 1987 ch. 1, Wang 1989 §1-3].
//!
//! The driving side supplies the loss: with the motor driving, what lies behind the gear weighs `1/efficiency` as much at the motor;
//! with the load driving, `efficiency` as much. Referring from the motor's side to the load's is the inverse.

/// Which way the power flows through a lossy gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Flow {
    /// No loss: energy is kept.
    Lossless,
    /// The motor drives the load.
    Motoring,
    /// The load drives the motor.
    Overhauling,
}

/// On which side of the gear the quantity is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Side {
    /// Given on the load's (slow) side, wanted on the motor's.
    Load,
    /// Given on the motor's (fast) side, wanted on the load's.
    Motor,
}

const fn with_loss(value: f64, efficiency: f64, side: Side, flow: Flow) -> f64 {
    match (side, flow) {
        (_, Flow::Lossless) => value,
        (Side::Load, Flow::Motoring) | (Side::Motor, Flow::Overhauling) => value / efficiency,
        (Side::Load, Flow::Overhauling) | (Side::Motor, Flow::Motoring) => value * efficiency,
    }
}

/// A torque \[N m\] on the other side of a gear of `ratio` (motor speed over load speed).
#[must_use]
pub const fn refer_torque(torque: f64, ratio: f64, efficiency: f64, side: Side, flow: Flow) -> f64 {
    let kept = match side {
        Side::Load => torque / ratio,
        Side::Motor => torque * ratio,
    };
    with_loss(kept, efficiency, side, flow)
}

/// An inertia \[kg m2\] on the other side of a gear of `ratio`.
#[must_use]
pub const fn refer_inertia(inertia: f64, ratio: f64, efficiency: f64, side: Side, flow: Flow) -> f64 {
    let kept = match side {
        Side::Load => inertia / (ratio * ratio),
        Side::Motor => inertia * (ratio * ratio),
    };
    with_loss(kept, efficiency, side, flow)
}

/// A stiffness \[N m/rad\] or a damping \[N m s/rad\] on the other side of a gear of `ratio`.
#[must_use]
pub const fn refer_stiffness(stiffness: f64, ratio: f64, efficiency: f64, side: Side, flow: Flow) -> f64 {
    refer_inertia(stiffness, ratio, efficiency, side, flow)
}

/// A backlash \[rad\] on the other side of a gear of `ratio`.
#[must_use]
pub const fn refer_gap(gap: f64, ratio: f64, side: Side) -> f64 {
    match side {
        Side::Load => gap * ratio,
        Side::Motor => gap / ratio,
    }
}

/// Stiffness of two springs in series \[N m/rad\]: `1/k = 1/k1 + 1/k2`.
#[must_use]
pub const fn series(k1: f64, k2: f64) -> f64 {
    let (soft, stiff) = if k1 < k2 { (k1, k2) } else { (k2, k1) };
    soft / (1.0 + soft / stiff)
}
