//! The torsion-lateral gear pair between a motor and a load: two wheels, helical or spur, that turn, move and tilt on
//! their shafts and bearings. Derived; fourteen coordinates as [`SpurPair`](super::SpurPair) has, but others: the
//! turning of the motor, the six motions of each wheel, and the turning of the load.
//!
//! Axes of each wheel: `x` along the line of centres from pinion to wheel, `y` across it in
//! the sense of the pinion's drive at the pitch point, `z` along the shaft. Each wheel turns positively in its
//! driving sense.
//!
//! | coordinate | of the motor | of the pinion | of the wheel | of the load |
//! |---|---|---|---|---|
//! | turning | 0 | 6 | 12 | 13 |
//! | x, y, z | | 1, 2, 3 | 7, 8, 9 | |
//! | tilt about x, about y | | 4, 5 | 10, 11 | |
//!
//! The mesh is one link along the normal of the teeth: with `alpha` the transverse pressure angle and `beta_b` the
//! base helix angle its elongation is `cos(beta_b) (r_b1 phi_1 - r_b2 phi_2 + cos(alpha) (y_1 - y_2) + sin(alpha)
//! (x_1 - x_2)) + sin(beta_b) (z_1 - z_2 + r_1 psi_y1 + r_2 psi_y2)`.

use super::{Coordinate, Link, Source, Train, Variation};

/// One wheel on its shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearBody {
    /// kg.
    pub mass: f64,
    /// About its axis, kg m2.
    pub inertia: f64,
    /// About a diameter, kg m2.
    pub tilt_inertia: f64,
    /// m.
    pub base_radius: f64,
    /// m.
    pub pitch_radius: f64,
    /// Of shaft and bearings to the ground: along x, y, z in N/m, about x and y in N m/rad.
    pub stiffness: [f64; 5],
    /// As the stiffness, N s/m and N m s/rad.
    pub damping: [f64; 5],
}

/// The pair with what it stands between.
#[derive(Debug, Clone, PartialEq)]
pub struct GearPair {
    /// Inertia of the motor, kg m2.
    pub motor: f64,
    /// Stiffness, N m/rad, and damping, N m s/rad, of the shaft from the motor to the pinion.
    pub input: (f64, f64),
    /// The driving wheel.
    pub pinion: GearBody,
    /// The driven wheel.
    pub wheel: GearBody,
    /// Stiffness, N m/rad, and damping, N m s/rad, of the shaft from the wheel to the load.
    pub output: (f64, f64),
    /// Inertia of the load, kg m2.
    pub load: f64,
    /// Transverse pressure angle, rad.
    pub pressure_angle: f64,
    /// Helix angle on the base cylinder, rad; zero of a spur pair.
    pub base_helix: f64,
    /// Mean stiffness of the mesh, N/m.
    pub mesh_stiffness: f64,
    /// Damping of the mesh, N s/m.
    pub mesh_damping: f64,
    /// How the mesh stiffness goes with time; constant if none.
    pub variation: Option<Variation>,
    /// Backlash along the line of action, m; zero for the linear form.
    pub gap: f64,
    /// Torque of the motor, N m. The load brakes with it in the ratio of the base radii.
    pub torque: f64,
}

impl GearPair {
    pub const COORDINATES: usize = 14;
    /// Link of the shaft from the motor.
    pub const INPUT: usize = 0;
    /// Link of the mesh.
    pub const MESH: usize = 1;
    /// Link of the shaft to the load.
    pub const OUTPUT: usize = 2;
    /// First of five supports of the pinion: x, y, z, tilt about x, tilt about y. Those of the wheel follow.
    pub const SUPPORTS: usize = 3;

    /// The pair as a train.
    #[must_use]
    pub fn train(&self) -> Train {
        let mut train = Train::new().coordinate(Coordinate::new(self.motor).source(Source::Constant(self.torque)));
        for body in [&self.pinion, &self.wheel] {
            for _ in 0..3 {
                train = train.coordinate(Coordinate::new(body.mass));
            }
            for _ in 0..2 {
                train = train.coordinate(Coordinate::new(body.tilt_inertia));
            }
            train = train.coordinate(Coordinate::new(body.inertia));
        }
        let brake = -self.torque * self.wheel.base_radius / self.pinion.base_radius;
        train = train.coordinate(Coordinate::new(self.load).source(Source::Constant(brake)));
        train = train.link(Link::shaft(0, 6, self.input.0).damping(self.input.1));
        let mut mesh = Link::new(&self.normal(), self.mesh_stiffness).damping(self.mesh_damping).gap(self.gap);
        if let Some(variation) = &self.variation {
            mesh = mesh.varying(variation.clone());
        }
        train = train.link(mesh);
        train = train.link(Link::shaft(12, 13, self.output.0).damping(self.output.1));
        for (first, body) in [(1, &self.pinion), (7, &self.wheel)] {
            for (i, (&stiffness, &damping)) in body.stiffness.iter().zip(&body.damping).enumerate() {
                train = train.link(Link::ground(first + i, stiffness).damping(damping));
            }
        }
        train
    }

    /// Elongation of the mesh per coordinate; coordinates without a share are left out.
    #[must_use]
    pub fn normal(&self) -> Vec<(usize, f64)> {
        let (sine, cosine) = self.pressure_angle.sin_cos();
        let (axial, across) = self.base_helix.sin_cos();
        let all = [
            (6, across * self.pinion.base_radius),
            (12, -across * self.wheel.base_radius),
            (1, across * sine),
            (7, -across * sine),
            (2, across * cosine),
            (8, -across * cosine),
            (3, axial),
            (9, -axial),
            (5, axial * self.pinion.pitch_radius),
            (11, axial * self.wheel.pitch_radius),
        ];
        all.into_iter().filter(|term| term.1 != 0.0).collect()
    }
}
