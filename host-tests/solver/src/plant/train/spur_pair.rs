//! A spur pair on two shafts with four bearings that have masses of their own: fourteen coordinates `[Tang 1994
//! (1.6)]`.
//!
//! `Y` lies along the line of action, `X` across it. Each shaft bends between its bearings under its wheel. Its
//! elongation is the way of the wheel less that of the line through both bearings there, shared by the levers.
//!
//! | coordinate | pinion | its bearings | wheel | its bearings |
//! |---|---|---|---|---|
//! | Y | 0 | 3, 5 | 7 | 10, 12 |
//! | X | 1 | 4, 6 | 8 | 11, 13 |
//! | turning | 2 | | 9 | |
//!
//! The mesh is stretched by `r_b1 phi_1 - r_b2 phi_2 + Y_1 - Y_2 - e`, and damped by the rate of that `[Tang 1994
//! (1.5)]`.

use super::{Coordinate, Link, Source, Train, Variation};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpurBearing {
    /// kg.
    pub mass: f64,
    /// From the wheel along the shaft, m.
    pub lever: f64,
    /// Along Y and X, N/m.
    pub stiffness: [f64; 2],
    /// Along Y and X, N s/m.
    pub damping: [f64; 2],
}

/// A wheel on its shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpurWheel {
    /// kg.
    pub mass: f64,
    /// About its axis, kg m2.
    pub inertia: f64,
    /// m.
    pub base_radius: f64,
    /// Bending stiffness of the shaft at the wheel on rigid bearings, N/m: `3 E I (a + b)/(a b)^2` of an even shaft.
    pub shaft_stiffness: f64,
    /// N s/m.
    pub shaft_damping: f64,
    /// One on either side.
    pub bearings: [SpurBearing; 2],
}

#[derive(Debug, Clone, PartialEq)]
pub struct SpurPair {
    /// The driving wheel.
    pub pinion: SpurWheel,
    /// The driven wheel.
    pub wheel: SpurWheel,
    /// Mean stiffness of the mesh, N/m.
    pub mesh_stiffness: f64,
    /// Damping of the mesh, N s/m.
    pub mesh_damping: f64,
    /// Course of the mesh stiffness, and the error; constant and none if left out.
    pub variation: Option<Variation>,
    /// Backlash along the line of action, m.
    pub gap: f64,
    /// Torque on the pinion, N m. The wheel is braked with it in the ratio of the base radii.
    pub torque: f64,
}

impl SpurPair {
    pub const COORDINATES: usize = 14;
    /// Link of the mesh. Of each wheel follow the shaft along Y, along X, and the bearings, each along Y and X.
    pub const MESH: usize = 0;

    /// The pair as a train.
    #[must_use]
    pub fn train(&self) -> Train {
        let (coordinates, links) = self.parts(0);
        let train = coordinates.into_iter().fold(Train::new(), Train::coordinate);
        links.into_iter().fold(train, Train::link)
    }

    /// Its coordinates and links as parts of a train in which `first` coordinates are before them.
    #[must_use]
    pub fn parts(&self, first: usize) -> (Vec<Coordinate>, Vec<Link>) {
        let (one, two) = (self.pinion.base_radius, self.wheel.base_radius);
        let terms = [(0, 1.0), (2, one), (7, -1.0), (9, -two)].map(|(at, share)| (first + at, share));
        let mut mesh = Link::new(&terms, self.mesh_stiffness).damping(self.mesh_damping).gap(self.gap);
        if let Some(variation) = &self.variation {
            mesh = mesh.varying(variation.clone());
        }
        let (mut coordinates, mut links) = (Vec::new(), vec![mesh]);
        for (first, body, torque) in
            [(first, &self.pinion, self.torque), (first + 7, &self.wheel, -self.torque * two / one)]
        {
            coordinates.extend([Coordinate::new(body.mass), Coordinate::new(body.mass)]);
            let turning = Coordinate::new(body.inertia);
            coordinates.push(if torque == 0.0 { turning } else { turning.source(Source::Constant(torque)) });
            let [near, far] = body.bearings.map(|bearing| bearing.lever);
            for direction in 0..2 {
                // the line through both bearings: the nearer one counts more
                let terms = [
                    (first + direction, 1.0),
                    (first + 3 + direction, -far / (near + far)),
                    (first + 5 + direction, -near / (near + far)),
                ];
                links.push(Link::new(&terms, body.shaft_stiffness).damping(body.shaft_damping));
            }
            for (at, bearing) in [first + 3, first + 5].into_iter().zip(&body.bearings) {
                for direction in 0..2 {
                    coordinates.push(Coordinate::new(bearing.mass));
                    let (k, d) = (bearing.stiffness[direction], bearing.damping[direction]);
                    links.push(Link::ground(at + direction, k).damping(d));
                }
            }
        }
        (coordinates, links)
    }
}
