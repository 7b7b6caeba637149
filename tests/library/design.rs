//! Designs against closed forms and high-precision arithmetic.

mod approximate;
mod matrix;
mod nodes;
mod observer;
mod predicted;
mod speed_loop;
mod step;
mod undescribed;

use driveline::design::Matrix;
use serde_json::Value;

/// A number of a reference file, as such or in decimals.
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
}

fn matrix<const R: usize, const C: usize>(value: &Value) -> Matrix<R, C> {
    Matrix(core::array::from_fn(|i| core::array::from_fn(|j| number(&value[i][j]))))
}
