//! A rotor that a user wrote: shaft, discs, bearings, unbalance and sensors, read with every fault placed.

use std::ops::Range;
use std::path::Path;

use nalgebra::Complex;

use super::balance::PLANES;
use super::diagnostic::Diagnostic;
use super::quantity::Quantity;
use super::read::{document, load, named, section};
use super::source::Source;
use super::table::Table;
use driveline_solver::rotor::{Bearing, Direction, Disc, FlexibleRotor, Material, Model, Polar, Section};

/// Most elements of a shaft: 1,604 coordinates.
const MOST: usize = 400;

/// A rotor as its file describes it.
///
/// ```toml
/// name = "two discs"
///
/// [material]                 # steel where it is left out
/// density = 7850.0           # kg/m3
/// young = 2.1e11             # Pa
/// poisson = 0.3
///
/// [[element]]                # pieces of shaft, from one end to the other
/// length = 0.6               # m
/// diameter = 0.05            # m
/// bore = 0.0                 # m, 0 where it is left out
/// pieces = 6                 # equal elements, 1 where it is left out
///
/// [[disc]]                   # by size, or by `mass`, `polar` and `diametral` [kg, kg m2]
/// node = 2                   # from 0, one more than elements
/// diameter = 0.28            # m
/// bore = 0.05                # m, 0 where it is left out
/// width = 0.05               # m
///
/// [[bearing]]
/// node = 0
/// stiffness_x = 4.0e6        # N/m
/// stiffness_y = 3.0e6        # N/m, as along x where it is left out
/// damping_x = 2.5e3          # N s/m, 0 where it is left out
/// damping_y = 2.0e3          # N s/m, as along x where it is left out
/// cross_xy = 0.0             # N/m, force along x by y, 0 where it is left out; cross_yx too
///
/// [[bearing]]
/// node = 6
/// stiffness_x = 4.0e6
///
/// [[unbalance]]              # may be left out
/// node = 2
/// amount = 2.0e-4            # kg m
/// angle = 35.0               # degrees, 0 where it is left out
///
/// [[sensor]]                 # may be left out
/// node = 1
/// angle = 0.0                # degrees from x towards y, 0 where it is left out
///
/// [balancing]                # may be left out, as may the unbalance; bearings alike in all directions
/// planes = [1, 3, 5]         # nodes
/// modes = 1                  # as many as planes, or two fewer
///
/// [speeds]
/// highest = 600.0            # rad/s
/// ```
#[derive(Clone, Debug)]
pub struct RotorFile {
    /// Name: letters, digits, `-`, `_` and spaces, at most 40.
    pub name: String,
    /// Places of the nodes along the shaft (m).
    pub places: Vec<f64>,
    /// The equations; its stations are all nodes.
    pub model: Model,
    /// Node, unbalance (kg m).
    pub unbalance: Vec<(usize, Complex<f64>)>,
    /// Node and angle (degrees) of each sensor.
    pub sensors: Vec<(usize, f64)>,
    /// Discs: node and mass (kg).
    pub discs: Vec<(usize, f64)>,
    /// Nodes of the bearings.
    pub bearings: Vec<usize>,
    /// Whether no bearing takes or gives energy: no damping, and no circulatory stiffness.
    pub conservative: bool,
    /// Centre of mass along the shaft (m).
    pub centre: f64,
    /// How the unbalance is to be balanced.
    pub balancing: Option<Balancing>,
    /// Highest speed of interest (rad/s).
    pub highest: f64,
}

/// Modal balancing of a rotor.
#[derive(Clone, Debug)]
pub struct Balancing {
    /// Nodes of the correction planes.
    pub planes: Vec<usize>,
    /// Deflection of every node in the forward whirl at each critical speed that is to be balanced (rad/s).
    pub modes: Vec<(f64, Vec<f64>)>,
}

impl RotorFile {
    /// The unbalance at every node (kg m).
    #[must_use]
    pub fn unbalances(&self) -> Vec<Complex<f64>> {
        let mut all = vec![Complex::new(0.0, 0.0); self.places.len()];
        for &(node, unbalance) in &self.unbalance {
            // every node was checked when the file was read
            if let Some(sum) = all.get_mut(node) {
                *sum += unbalance;
            }
        }
        all
    }
}

/// Reads a rotor from a file.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn read_rotor(path: &Path) -> Result<RotorFile, Diagnostic> {
    load(path, "a rotor file", parse_rotor)
}

/// Reads a rotor from a text; `name` is what messages call it.
///
/// # Errors
/// A [`Diagnostic`] with the place, the key, what was found and what was expected.
pub fn parse_rotor(name: &str, text: &str) -> Result<RotorFile, Diagnostic> {
    let source = Source { name, text };
    let document = document(source, "a rotor: `name`, [[element]], [[bearing]] and [speeds]")?;
    let mut root = Table::root(source, document.get_ref());
    let rotor_name = named(source, &mut root)?;
    let material = material(&mut root)?;
    let mut rotor = shaft(source, &mut root, material)?;
    let last = rotor.places().len() - 1;
    let mut discs = Vec::new();
    for mut table in root.optional_tables("disc")? {
        let node = node(&mut table, last)?;
        let disc = disc(&mut table, material)?;
        table.finish()?;
        discs.push((node, disc.mass));
        rotor = rotor.disc(node, disc);
    }
    let (mut bearings, mut alike, mut conservative) = (Vec::new(), true, true);
    let mut span: Range<usize> = 0..0;
    for (at, mut table) in root.tables_of("bearing", "bearing")? {
        let node = node(&mut table, last)?;
        let bearing = bearing(&mut table)?;
        alike &= bearing.stiffness == [[bearing.stiffness[0][0], 0.0], [0.0, bearing.stiffness[0][0]]];
        conservative &= bearing.damping == [[0.0; 2]; 2] && bearing.stiffness[0][1] == bearing.stiffness[1][0];
        rotor = rotor.bearing(node, bearing);
        table.finish()?;
        bearings.push(node);
        span = at;
    }
    let mut unbalance = Vec::new();
    for mut table in root.optional_tables("unbalance")? {
        let node = node(&mut table, last)?;
        let amount = table.number("amount", Quantity::UNBALANCE)?;
        let angle = table.number_or("angle", Quantity::DEGREES, 0.0)?;
        table.finish()?;
        unbalance.push((node, Polar::degrees(amount, angle)));
    }
    let mut sensors = Vec::new();
    for mut table in root.optional_tables("sensor")? {
        let node = node(&mut table, last)?;
        let angle = table.number_or("angle", Quantity::DEGREES, 0.0)?;
        table.finish()?;
        rotor = rotor.sensor(node, Direction::At(angle.to_radians()));
        sensors.push((node, angle));
    }
    let planes = balancing(&mut root, last)?;
    let highest = section(&mut root, "speeds", |table| table.number("highest", Quantity::SPEED))?;
    for node in 0..=last {
        rotor = rotor.station(node);
    }
    // Each table was checked; the whole must still have stiffness against every motion.
    let whole = |error: driveline_solver::rotor::RotorError| {
        Diagnostic::at(
            source,
            span.clone(),
            "bearing",
            error.to_string(),
            "bearings that hold the rotor in all directions",
        )
    };
    let model = rotor.build().map_err(whole)?;
    model.held().map_err(whole)?;
    let balancing = match planes {
        Some((planes, count)) => {
            if unbalance.is_empty() {
                return Err(root.wrong("balancing", "an [[unbalance]] to be balanced"));
            }
            if !alike {
                let expected = "bearings with one stiffness in all directions, or balancing by influence coefficients";
                return Err(root.wrong("balancing", expected));
            }
            let modes = model.forward_shapes(count);
            if modes.len() < count {
                return Err(root.wrong("balancing", format!("`modes` up to {}, all that the rotor has", modes.len())));
            }
            Some(Balancing { planes, modes })
        }
        None => None,
    };
    root.finish()?;
    let (places, centre) = (rotor.places(), rotor.centre());
    let name = rotor_name;
    Ok(RotorFile { name, places, model, unbalance, sensors, discs, bearings, conservative, centre, balancing, highest })
}

/// Nodes of the planes, and how many modes they are to balance.
fn balancing(root: &mut Table<'_>, last: usize) -> Result<Option<(Vec<usize>, usize)>, Diagnostic> {
    let Some(mut table) = root.table_if("balancing")? else { return Ok(None) };
    // `NODE` allows whole numbers up to 400 only.
    let planes: Vec<usize> = table.numbers("planes", Quantity::NODE)?.into_iter().map(|node| node as usize).collect();
    let own = |(index, node): (usize, &usize)| *node <= last && !planes[..index].contains(node);
    if planes.len() > PLANES || !planes.iter().enumerate().all(own) {
        return Err(table.wrong("planes", format!("up to {PLANES} different nodes of the shaft, 0 to {last}")));
    }
    let modes = table.number("modes", Quantity::MODES)? as usize;
    if planes.len() != modes && planes.len() != modes + 2 {
        let refusal = driveline::balancing::Error::ModalPlanes { modes, planes: planes.len() };
        return Err(table.wrong("modes", format!("a number that goes with the planes: {refusal}")));
    }
    table.finish()?;
    Ok(Some((planes, modes)))
}

fn material(root: &mut Table<'_>) -> Result<Material, Diagnostic> {
    let Some(mut table) = root.table_if("material")? else { return Ok(Material::STEEL) };
    let material = Material {
        density: table.number("density", Quantity::DENSITY)?,
        young: table.number("young", Quantity::YOUNG)?,
        poisson: table.number("poisson", Quantity::POISSON)?,
    };
    table.finish()?;
    Ok(material)
}

fn shaft(source: Source<'_>, root: &mut Table<'_>, material: Material) -> Result<FlexibleRotor, Diagnostic> {
    let mut rotor = FlexibleRotor::new();
    let mut count = 0;
    for (index, (span, mut table)) in root.tables_of("element", "piece of the shaft")?.into_iter().enumerate() {
        let length = table.number("length", Quantity::LENGTH)?;
        let outer = table.number("diameter", Quantity::DIAMETER)?;
        let bore = table.number_or("bore", Quantity::BORE, 0.0)?;
        if bore >= outer {
            return Err(table.wrong("bore", "a bore smaller than the `diameter`"));
        }
        // `PIECES` allows whole numbers up to 400 only.
        let pieces = table.number_or("pieces", Quantity::PIECES, 1.0)? as usize;
        table.finish()?;
        count += pieces;
        if count > MOST {
            let found = format!("{count} elements in all up to here");
            return Err(Diagnostic::at(source, span, format!("element[{index}]"), found, format!("at most {MOST}")));
        }
        let section = Section { length: length / pieces as f64, outer, bore, material };
        rotor = (0..pieces).fold(rotor, |rotor, _| rotor.element(section));
    }
    Ok(rotor)
}

fn node(table: &mut Table<'_>, last: usize) -> Result<usize, Diagnostic> {
    // `NODE` allows whole numbers up to 400 only.
    let node = table.number("node", Quantity::NODE)? as usize;
    if node <= last { Ok(node) } else { Err(table.wrong("node", format!("a node of the shaft, 0 to {last}"))) }
}

fn disc(table: &mut Table<'_>, material: Material) -> Result<Disc, Diagnostic> {
    if let Some(mass) = table.number_if("mass", Quantity::MASS)? {
        let polar = table.number("polar", Quantity::INERTIA)?;
        return Ok(Disc { mass, polar, diametral: table.number("diametral", Quantity::INERTIA)? });
    }
    let outer = table.number("diameter", Quantity::DIAMETER)?;
    let bore = table.number_or("bore", Quantity::BORE, 0.0)?;
    if bore >= outer {
        return Err(table.wrong("bore", "a bore smaller than the `diameter`"));
    }
    Ok(Disc::of(outer, bore, table.number("width", Quantity::LENGTH)?, material))
}

fn bearing(table: &mut Table<'_>) -> Result<Bearing, Diagnostic> {
    let x = table.number("stiffness_x", Quantity::BEARING)?;
    let y = table.number_or("stiffness_y", Quantity::BEARING, x)?;
    let damping_x = table.number_or("damping_x", Quantity::BEARING_DAMPING, 0.0)?;
    let damping_y = table.number_or("damping_y", Quantity::BEARING_DAMPING, damping_x)?;
    let xy = table.number_or("cross_xy", Quantity::CROSS, 0.0)?;
    let yx = table.number_or("cross_yx", Quantity::CROSS, 0.0)?;
    Ok(Bearing { stiffness: [[x, xy], [yx, y]], damping: [[damping_x, 0.0], [0.0, damping_y]] })
}
