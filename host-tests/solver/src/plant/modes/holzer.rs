//! Holzer's residual torque of a free chain: a check that needs no matrix
//! `[derived; headings: Pfützner 1980 ch. 1, Wang 1989 ch. 3]`.

/// Torque, N m, that must act on the last disc for the chain to swing at `omega` (rad/s) with one radian at the first
/// disc: zero at a natural frequency. Inertias in kg m2, `stiffness` (N m/rad) one shorter; surplus numbers are left
/// out.
#[must_use]
pub fn residual_torque(inertia: &[f64], stiffness: &[f64], omega: f64) -> f64 {
    let (mut angle, mut torque) = (1.0, 0.0);
    let square = omega * omega;
    for (j, inertia) in inertia.iter().enumerate() {
        torque += square * inertia * angle;
        if let Some(k) = stiffness.get(j) {
            angle -= torque / k;
        }
    }
    torque
}

/// The natural frequency between two (rad/s) at which the residual torque has opposite signs, by halving to the last
/// digit; none if the signs agree.
#[must_use]
pub fn frequency_between(inertia: &[f64], stiffness: &[f64], low: f64, high: f64) -> Option<f64> {
    let residual = |omega| residual_torque(inertia, stiffness, omega);
    let (mut a, mut b) = (low, high);
    let sign = residual(a).signum();
    if sign == residual(b).signum() {
        return None;
    }
    loop {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            return Some(middle);
        }
        if residual(middle).signum() == sign { a = middle } else { b = middle }
    }
}
