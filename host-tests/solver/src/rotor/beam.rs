//! A shaft element of uniform round section by Timoshenko's theory, in one plane.
//!
//! Coordinates: deflection and slope at the near end, then at the far end. Both planes have the same matrices, for
//! slopes and not turning vectors are the coordinates [Nelson 1980].

use std::f64::consts::PI;

use nalgebra::Matrix4;

use super::material::Material;

/// A round section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Length of the element (m).
    pub length: f64,
    /// Outer diameter (m).
    pub outer: f64,
    /// Bore (m), 0 where it is solid.
    pub bore: f64,
    pub material: Material,
}

/// The matrices of an element.
pub(super) struct Beam {
    pub stiffness: Matrix4<f64>,
    /// Mass: that of its deflection and that of the turning of its sections.
    pub mass: Matrix4<f64>,
    /// Gyroscopic coupling of the slopes' rates of both planes, per rad/s.
    pub spin: Matrix4<f64>,
}

impl Section {
    /// Area (m2).
    pub(super) fn area(&self) -> f64 {
        PI / 4.0 * (self.outer.powi(2) - self.bore.powi(2))
    }

    /// Second moment of area about a diameter (m4).
    pub(super) fn second_moment(&self) -> f64 {
        PI / 64.0 * (self.outer.powi(4) - self.bore.powi(4))
    }

    /// Share of the area that carries shear [Cowper 1966]: of a hollow circle.
    pub(super) fn shear_coefficient(&self) -> f64 {
        let nu = self.material.poisson;
        let square = (1.0 + (self.bore / self.outer).powi(2)).powi(2);
        let ratio = (self.bore / self.outer).powi(2);
        6.0 * (1.0 + nu) * square / ((7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * ratio)
    }

    /// `12 E I/(kappa G A l^2)`: how much more the element gives by shear than by bending.
    pub(super) fn shear(&self) -> f64 {
        let Material { young, .. } = self.material;
        let shear_stiffness = self.shear_coefficient() * self.material.shear_modulus() * self.area();
        12.0 * young * self.second_moment() / (shear_stiffness * self.length.powi(2))
    }

    /// The strain energy as `1/2 k e^2`: of the bending that both ends share, `e = s2 - s1`, and of what shears the
    /// element, `e = (s1 + s2)/2 - (w2 - w1)/l`. Stiffness, and `e` by the coordinates.
    pub(super) fn strains(&self) -> [(f64, [f64; 4]); 2] {
        let bending = self.material.young * self.second_moment() / self.length;
        let per_length = self.length.recip();
        [(bending, [0.0, -1.0, 0.0, 1.0]), (12.0 * bending / (1.0 + self.shear()), [per_length, 0.5, -per_length, 0.5])]
    }

    /// The matrices.
    pub(super) fn beam(&self) -> Beam {
        let (l, p) = (self.length, self.shear());
        let Material { density, young, .. } = self.material;
        let moment = self.second_moment();
        let k = young * moment / (l.powi(3) * (1.0 + p));
        let stiffness = k * pattern(12.0, 6.0 * l, (4.0 + p) * l * l, -12.0, 6.0 * l, (2.0 - p) * l * l);
        let m = density * self.area() * l / (1.0 + p).powi(2);
        let moving = m * pattern(
            13.0 / 35.0 + 7.0 / 10.0 * p + p * p / 3.0,
            (11.0 / 210.0 + 11.0 / 120.0 * p + p * p / 24.0) * l,
            (1.0 / 105.0 + p / 60.0 + p * p / 120.0) * l * l,
            9.0 / 70.0 + 3.0 / 10.0 * p + p * p / 6.0,
            -(13.0 / 420.0 + 3.0 / 40.0 * p + p * p / 24.0) * l,
            -(1.0 / 140.0 + p / 60.0 + p * p / 120.0) * l * l,
        );
        let r = density * moment / (l * (1.0 + p).powi(2));
        let turning = r * pattern(
            6.0 / 5.0,
            (1.0 / 10.0 - p / 2.0) * l,
            (2.0 / 15.0 + p / 6.0 + p * p / 3.0) * l * l,
            -6.0 / 5.0,
            (1.0 / 10.0 - p / 2.0) * l,
            (-1.0 / 30.0 - p / 6.0 + p * p / 6.0) * l * l,
        );
        // A round section has twice the moment about its axis that it has about a diameter.
        Beam { stiffness, mass: moving + turning, spin: 2.0 * turning }
    }
}

/// A symmetric matrix of an element that looks alike from both ends: deflection and slope at the near end (`dd`, `ds`,
/// `ss`), near against far deflection (`df`), near deflection against far slope (`dt`), slope against slope (`st`).
fn pattern(dd: f64, ds: f64, ss: f64, df: f64, dt: f64, st: f64) -> Matrix4<f64> {
    #[rustfmt::skip]
    let rows = [
        dd,  ds,  df,  dt,
        ds,  ss, -dt,  st,
        df, -dt,  dd, -ds,
        dt,  st, -ds,  ss,
    ];
    Matrix4::from_row_slice(&rows)
}

#[cfg(test)]
mod tests {
    use crate::rotor::beam::*;

    /// Gauss's rule of five points on 0..1: exact to degree nine, and the integrands have six.
    const GAUSS: [(f64, f64); 5] = [
        (0.046_910_077_030_668, 0.118_463_442_528_095),
        (0.230_765_344_947_158_5, 0.239_314_335_249_683),
        (0.5, 0.284_444_444_444_444_4),
        (0.769_234_655_052_841_5, 0.239_314_335_249_683),
        (0.953_089_922_969_332, 0.118_463_442_528_095),
    ];

    /// Deflection, turn of the section and its rate along the element, for each coordinate at one: the exact static
    /// deflection of a shear-flexible beam, by hand from `E I w'''' = 0` with `turn = w' + p l^2/12 w'''`.
    fn shapes(l: f64, p: f64, s: f64) -> [[f64; 3]; 4] {
        let cubic = |c: [f64; 4]| {
            let [a, b, d, e] = c;
            let (z, gain) = (s * l, p * l * l / 12.0);
            let w = a + b * z + d * z * z + e * z * z * z;
            let turn = b + 2.0 * d * z + 3.0 * e * z * z + gain * 6.0 * e;
            [w, turn, 2.0 * d + 6.0 * e * z]
        };
        // From the four end conditions, each coordinate in turn.
        let system = nalgebra::Matrix4::from_fn(|row, column| {
            let mut c = [0.0; 4];
            c[column] = 1.0;
            let [a, b, d, e] = c;
            let (z, gain) = (if row < 2 { 0.0 } else { l }, p * l * l / 12.0);
            if row % 2 == 0 {
                a + b * z + d * z * z + e * z * z * z
            } else {
                b + 2.0 * d * z + 3.0 * e * z * z + gain * 6.0 * e
            }
        });
        let inverse = system.try_inverse().unwrap();
        [0, 1, 2, 3].map(|k| cubic([0, 1, 2, 3].map(|row| inverse[(row, k)])))
    }

    #[test]
    fn the_matrices_are_the_energies_of_the_static_deflection() {
        for (length, bore) in [(0.1, 0.0), (0.02, 0.01), (1.0, 0.03)] {
            let section = Section { length, outer: 0.05, bore, material: Material::STEEL };
            let Material { density, young, .. } = section.material;
            let (beam, p) = (section.beam(), section.shear());
            let (bending, area) = (young * section.second_moment(), section.area());
            let sheared = section.shear_coefficient() * section.material.shear_modulus() * area;
            for i in 0..4 {
                for j in 0..4 {
                    let (mut stiffness, mut mass) = (0.0, 0.0);
                    for (s, weight) in GAUSS {
                        let shape = shapes(length, p, s);
                        // the shear angle is w' - turn = -p l^2/12 w''', and w''' = rate's slope
                        let angle = |k: usize| {
                            let (a, b) = (shapes(length, p, 0.0)[k][2], shapes(length, p, 1.0)[k][2]);
                            -p * length * length / 12.0 * (b - a) / length
                        };
                        stiffness +=
                            weight * length * (bending * shape[i][2] * shape[j][2] + sheared * angle(i) * angle(j));
                        mass += weight
                            * length
                            * density
                            * (area * shape[i][0] * shape[j][0] + section.second_moment() * shape[i][1] * shape[j][1]);
                    }
                    // the largest entry of a row of the same kind sets the scale; Gauss's numbers have 15 digits
                    let near =
                        |a: f64, b: f64, of: &Matrix4<f64>| (a - b).abs() <= 1e-11 * (of[(i, i)] * of[(j, j)]).sqrt();
                    assert!(near(beam.stiffness[(i, j)], stiffness, &beam.stiffness), "stiffness {i} {j}");
                    assert!(near(beam.mass[(i, j)], mass, &beam.mass), "mass {i} {j}");
                }
            }
        }
    }
}
