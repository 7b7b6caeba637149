//! A flexible rotor: shaft elements in a row, discs on their nodes, bearings under them.

use std::f64::consts::PI;

use nalgebra::RowDVector;

use super::beam::Section;
use super::bearing::Bearing;
use super::error::{RotorError, check, positive};
use super::material::Material;
use super::model::{Direction, Model};
use super::pencil::Strain;

/// A rigid disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia about the shaft (kg m2).
    pub polar: f64,
    /// Moment of inertia about a diameter (kg m2).
    pub diametral: f64,
}

impl Disc {
    /// A disc of outer diameter, bore and width (m).
    #[must_use]
    pub fn of(outer: f64, bore: f64, width: f64, material: Material) -> Self {
        let mass = material.density * PI / 4.0 * (outer.powi(2) - bore.powi(2)) * width;
        let squares = outer.powi(2) + bore.powi(2);
        Disc { mass, polar: mass * squares / 8.0, diametral: mass * (squares / 16.0 + width.powi(2) / 12.0) }
    }
}

/// A flexible rotor under construction. Node `k` stands before element `k`, the last node behind the last element.
#[derive(Clone, Debug, Default)]
pub struct FlexibleRotor {
    elements: Vec<Section>,
    discs: Vec<(usize, Disc)>,
    bearings: Vec<(usize, Bearing)>,
    stations: Vec<usize>,
    sensors: Vec<(usize, Direction)>,
}

/// Coordinates of a node.
const OF_NODE: usize = 4;

impl FlexibleRotor {
    /// A rotor without elements.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// A solid shaft of one diameter (m), its length (m) cut into equal elements.
    #[must_use]
    pub fn uniform(elements: usize, length: f64, diameter: f64, material: Material) -> Self {
        let section = Section { length: length / elements as f64, outer: diameter, bore: 0.0, material };
        FlexibleRotor { elements: vec![section; elements], ..Self::default() }
    }

    /// Adds an element at the far end.
    #[must_use]
    pub fn element(mut self, section: Section) -> Self {
        self.elements.push(section);
        self
    }

    /// Puts a disc on a node.
    #[must_use]
    pub fn disc(mut self, node: usize, disc: Disc) -> Self {
        self.discs.push((node, disc));
        self
    }

    /// Puts a bearing under a node.
    #[must_use]
    pub fn bearing(mut self, node: usize, bearing: Bearing) -> Self {
        self.bearings.push((node, bearing));
        self
    }

    /// Makes a node a station: unbalance acts there.
    #[must_use]
    pub fn station(mut self, node: usize) -> Self {
        self.stations.push(node);
        self
    }

    /// Watches a node.
    #[must_use]
    pub fn sensor(mut self, node: usize, direction: Direction) -> Self {
        self.sensors.push((node, direction));
        self
    }

    /// Places of the nodes along the shaft (m).
    #[must_use]
    pub fn places(&self) -> Vec<f64> {
        let ends = self.elements.iter().scan(0.0, |end, section| {
            *end += section.length;
            Some(*end)
        });
        std::iter::once(0.0).chain(ends).collect()
    }

    /// Centre of mass along the shaft (m), of elements and discs.
    #[must_use]
    pub fn centre(&self) -> f64 {
        let places = self.places();
        let elements = self.elements.iter().zip(&places).map(|(section, start)| {
            (section.material.density * section.area() * section.length, start + 0.5 * section.length)
        });
        // a node that is not there is refused by `build`
        let discs = self.discs.iter().filter_map(|(node, disc)| Some((disc.mass, *places.get(*node)?)));
        let (mass, moment) =
            elements.chain(discs).fold((0.0, 0.0), |(sum, moment), (mass, at)| (sum + mass, moment + mass * at));
        moment / mass
    }

    /// The equations.
    ///
    /// # Errors
    /// A number out of its range, a node that is not there, no element at all.
    pub fn build(&self) -> Result<Model, RotorError> {
        self.validate()?;
        let nodes = self.elements.len() + 1;
        let mut model = Model::empty(OF_NODE * nodes, 2 * OF_NODE - 1);
        for (index, section) in self.elements.iter().enumerate() {
            let beam = section.beam();
            for plane in 0..2 {
                let place = |k: usize| OF_NODE * (index + k / 2) + plane + 2 * (k % 2);
                for (stiffness, turns) in section.strains() {
                    let motion: Vec<(usize, f64)> = (0..4).map(|k| (place(k), turns[k])).collect();
                    model.strains.push(Strain { stiffness, force: motion.clone(), motion });
                }
                for i in 0..4 {
                    for j in 0..4 {
                        let at = (place(i), place(j));
                        model.stiffness[at] += beam.stiffness[(i, j)];
                        model.mass[at] += beam.mass[(i, j)];
                        // the other plane's coordinate of the same kind: `+y` acts on `x`, `-x` on `y`
                        let (other, sign) = if plane == 0 { (at.1 + 1, 1.0) } else { (at.1 - 1, -1.0) };
                        model.gyroscopic[(at.0, other)] += sign * beam.spin[(i, j)];
                    }
                }
            }
        }
        for (node, disc) in &self.discs {
            let first = OF_NODE * node;
            for plane in 0..2 {
                model.mass[(first + plane, first + plane)] += disc.mass;
                model.mass[(first + 2 + plane, first + 2 + plane)] += disc.diametral;
            }
            model.gyroscopic[(first + 2, first + 3)] += disc.polar;
            model.gyroscopic[(first + 3, first + 2)] -= disc.polar;
        }
        let deflections = |node: usize| {
            [0, 1].map(|plane| {
                let mut row = RowDVector::zeros(OF_NODE * nodes);
                row[OF_NODE * node + plane] = 1.0;
                row
            })
        };
        for (node, bearing) in &self.bearings {
            model.support(&deflections(*node), bearing);
        }
        model.stations = self.stations.iter().map(|&node| deflections(node)).collect();
        for &(node, direction) in &self.sensors {
            model.watch(&deflections(node), direction);
        }
        Ok(model)
    }

    fn validate(&self) -> Result<(), RotorError> {
        if self.elements.is_empty() {
            return Err(RotorError::Count { name: "elements", found: 0, expected: 1 });
        }
        for (index, section) in self.elements.iter().enumerate() {
            let place = || format!("element {index}");
            positive("length", place, section.length)?;
            positive("outer diameter", place, section.outer)?;
            let fits = (0.0..section.outer).contains(&section.bore);
            check("bore", place, section.bore, fits, "zero or above, and less than the outer diameter")?;
            let Material { density, young, poisson } = section.material;
            positive("density", place, density)?;
            positive("Young's modulus", place, young)?;
            check("Poisson's ratio", place, poisson, (0.0..=0.5).contains(&poisson), "0 to 0.5")?;
        }
        let last = self.elements.len();
        let at = |what: &str, index: usize, node: usize| {
            let place = format!("{what} {index}");
            if node <= last { Ok(()) } else { Err(RotorError::Node { place, node, last }) }
        };
        for (index, &(node, disc)) in self.discs.iter().enumerate() {
            at("disc", index, node)?;
            let place = || format!("disc {index}");
            positive("mass", place, disc.mass)?;
            positive("polar moment of inertia", place, disc.polar)?;
            positive("diametral moment of inertia", place, disc.diametral)?;
        }
        for (index, &(node, bearing)) in self.bearings.iter().enumerate() {
            at("bearing", index, node)?;
            validate_bearing(index, &bearing)?;
        }
        for (index, &node) in self.stations.iter().enumerate() {
            at("station", index, node)?;
        }
        for (index, &(node, _)) in self.sensors.iter().enumerate() {
            at("sensor", index, node)?;
        }
        Ok(())
    }
}

/// Refuses a bearing that pushes the shaft away or drives its whirl.
pub(super) fn validate_bearing(index: usize, bearing: &Bearing) -> Result<(), RotorError> {
    let place = || format!("bearing {index}");
    let not_negative = "a finite number, zero or above";
    for (row, other) in [(0, 1), (1, 0)] {
        let (k, c) = (bearing.stiffness[row][row], bearing.damping[row][row]);
        check("stiffness", place, k, k >= 0.0, not_negative)?;
        check("damping", place, c, c >= 0.0, not_negative)?;
        check("cross stiffness", place, bearing.stiffness[row][other], true, "a finite number")?;
        check("cross damping", place, bearing.damping[row][other], true, "a finite number")?;
    }
    Ok(())
}
