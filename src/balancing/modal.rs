//! Modal balancing: influence coefficients of the planes on modal unbalances. Derived.
//!
//! A rotor is bent near the critical speed of mode n by its modal unbalance `V_n = sum u_i phi_n(z_i)`, phi_n the shape
//! of the whirl at that speed. N planes take N modal unbalances away: `sum w_j phi_n(z_j) = -V_n`. They leave others,
//! and with them forces at all speeds. Two more planes take those of the rigid rotor away as well: its static and its
//! couple unbalance ([`super::RigidUnbalance`]).

use super::error::Error;
use super::influence::Influence;
use super::matrix::pick;
use super::scalar::{Complex, Scalar, zero};

impl<T: Scalar, const ROWS: usize, const PLANES: usize> Influence<T, ROWS, PLANES> {
    /// Coefficients of planes at `places` (m from the centre of mass) on modal unbalances: `shapes` has the deflection
    /// of each mode at each plane, in any scale.
    ///
    /// Planes are as many as modes, or two more. The rows are the modes; with two more planes then the static (kg m)
    /// and the couple unbalance (kg m2) of the rigid rotor, which a weighting of the couple by one over the largest
    /// distance makes comparable. [`Influence::correct`] has the weights for these unbalances. For minus one in the row
    /// of a mode and zeros in the others it has the set of weights that bends that mode alone: a trial weight for
    /// vibration that is measured near its critical speed.
    ///
    /// # Errors
    /// [`Error::ModalPlanes`], [`Error::Size`], [`Error::Setting`] with the plane whose place is not a number,
    /// [`Error::ReadingMissing`] with the mode whose shape has fewer deflections than planes, [`Error::Reading`] with
    /// the mode whose deflection is not a number.
    pub fn modal(shapes: &[&[T]], places: &[T]) -> Result<Self, Error> {
        let (modes, planes) = (shapes.len(), places.len());
        if planes != modes && planes != modes.saturating_add(2) {
            return Err(Error::ModalPlanes { modes, planes });
        }
        let mut influence = Influence::new(planes, planes)?;
        if let Some(index) = places.iter().position(|place| !place.is_finite()) {
            return Err(Error::Setting { index });
        }
        if let Some(row) = shapes.iter().position(|shape| shape.len() < planes) {
            return Err(Error::ReadingMissing { row });
        }
        let real = |re: T| Complex { re, im: T::zero() };
        for (plane, place) in places.iter().enumerate() {
            let mut column = [zero(); ROWS];
            let conditions = shapes.iter().map(|shape| pick(shape, plane, T::zero())).chain([T::one(), *place]);
            for (value, condition) in column.iter_mut().zip(conditions).take(planes) {
                *value = real(condition);
            }
            influence.set(plane, &column)?;
        }
        Ok(influence)
    }
}
