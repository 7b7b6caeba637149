//! A piston engine on masses of the machine.

use driveline::machine::{CrankSlider, Cylinder, Diameter, Harmonic, Indicator, Inertia, Length, Mass, WorkingCycle};

use driveline_solver::plant::train;

use super::diagnostic::Diagnostic;
pub use super::excitation::ENGINE as NAME;
use super::excitation::Excitation;
use super::quantity::Quantity;
use super::table::Table;

/// Highest index of an order that a torque is resolved to: the order 24 with four strokes, 48 with two.
const ORDERS: usize = 49;

/// Angles of a cycle that the typical indicator diagram is taken at.
const ANGLES: usize = 1440;

/// A mass that turns: its label, its index, and the motor's speed over its own.
pub(super) type Turning = (String, usize, f64);

/// A piston engine, all cylinders alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Engine {
    pub cylinders: Vec<Cylinder>,
    /// Whether the file has their places along the crankshaft.
    pub placed: bool,
    /// Index of the mass that each works on.
    pub at: Vec<usize>,
    /// The motor's speed over the crankshaft's.
    pub ratio: f64,
    /// Two or four strokes.
    pub cycle: WorkingCycle,
    /// A cylinder's crank, connecting rod and reciprocating mass.
    pub crank: CrankSlider,
    /// Gas torque of a cylinder: index k is k times the lowest order.
    gas: Vec<Harmonic>,
    /// Orders of the excitation.
    orders: Vec<f64>,
}

impl Engine {
    /// Reads `[engine]`; `masses` are those that a cylinder can work on.
    pub(super) fn read(mut table: Table<'_>, masses: &[Turning]) -> Result<Self, Diagnostic> {
        const STROKES: &str = "2 or 4";
        let cycle = match table.number("strokes", Quantity { least: 2.0, most: 4.0, ..Quantity::COUNT })? {
            2.0 => WorkingCycle::TwoStroke,
            4.0 => WorkingCycle::FourStroke,
            _ => return Err(table.wrong("strokes", STROKES)),
        };
        let cranks = table.numbers("cranks", Quantity::DEGREES)?;
        let count = cranks.len();
        let banks = list(&mut table, "banks", Quantity::DEGREES, count)?;
        let positions = list(&mut table, "positions", Quantity::PLACE, count)?;
        let degrees = |values: &[f64], j: usize| values.get(j).copied().unwrap_or(0.0).to_radians();
        let mut cylinders: Vec<Cylinder> = (0..count)
            .map(|j| {
                let place = positions.as_ref().map_or(0.0, |positions| positions[j]);
                Cylinder::new(degrees(&cranks, j), degrees(banks.as_deref().unwrap_or(&[]), j), Length(place))
            })
            .collect();
        if cycle == WorkingCycle::FourStroke {
            // `COUNT` allows whole numbers up to 360 only
            let order = table.numbers("firing_order", Quantity::COUNT)?;
            let order: Vec<usize> = order.into_iter().map(|number| number as usize).collect();
            Cylinder::try_fire(&mut cylinders, &order).map_err(|error| {
                table
                    .wrong("firing_order", format!("every cylinder from 1 to {count} in the order they fire ({error})"))
            })?;
        }
        let (at, ratio) = places(&mut table, count, masses)?;
        let [radius, rod] = [table.number("radius", Quantity::LENGTH)?, table.number("rod", Quantity::LENGTH)?];
        let reciprocating = Mass(table.number("reciprocating", Quantity::MASS)?);
        let crank = CrankSlider::massless_rod(Length(radius), Length(rod), Inertia(0.0), reciprocating);
        crank.check().map_err(|_| table.wrong("radius", format!("a radius below the rod's {rod} m")))?;
        let bore = Diameter(table.number("bore", Quantity::DIAMETER)?);
        let pressure = pressure(&mut table, &crank, cycle)?;
        let lowest = cycle.lowest_order();
        let most = lowest * (ORDERS - 1) as f64;
        let orders = table.numbers("orders", Quantity { least: lowest, most, ..Quantity::ORDER })?;
        let highest = lowest * (ORDERS.min(pressure.len() / 2) - 1) as f64;
        if orders.iter().any(|order| (order / lowest).fract() != 0.0 || *order > highest) {
            return Err(table.wrong("orders", format!("multiples of {lowest} up to {highest}")));
        }
        table.finish()?;
        let gas = crank.gas_torque::<ORDERS>(bore, &pressure, cycle).to_vec();
        Ok(Self { cylinders, placed: positions.is_some(), at, ratio, cycle, crank, gas, orders })
    }

    /// Its orders, for the diagram of critical speeds.
    pub fn excitation(&self) -> Excitation {
        Excitation { name: NAME.to_owned(), ratio: self.ratio, orders: self.orders.clone() }
    }

    /// Torque of one cylinder (N m), gas and masses, of an order at a speed of the crankshaft (rad/s); the angle
    /// counts from its firing.
    pub fn torque(&self, order: f64, speed: f64) -> Harmonic {
        let at = |order: f64| order.round() as usize;
        let mut torque = self.gas[at(order / self.cycle.lowest_order())];
        if order.fract() == 0.0 {
            torque.sine += self.crank.mass_torque::<ORDERS>(speed)[at(order)];
        }
        torque
    }

    /// The gas torque of the cylinders for a run: the mean and the orders that count, each on its mass, at the motor.
    /// All crank angles count from the masses' start.
    pub(super) fn sources(&self) -> impl Iterator<Item = (usize, train::Source)> {
        let lowest = self.cycle.lowest_order();
        self.cylinders.iter().zip(&self.at).map(move |(cylinder, &mass)| {
            let harmonic = |order: f64| {
                let Harmonic { cosine, sine } = self.gas[(order / lowest).round() as usize];
                let (turned, upright) = f64::sin_cos(order * cylinder.firing);
                train::Harmonic {
                    order: order / self.ratio,
                    cosine: (cosine * upright - sine * turned) / self.ratio,
                    sine: (cosine * turned + sine * upright) / self.ratio,
                }
            };
            let orders = [0.0].iter().chain(&self.orders);
            (mass, train::Source::Orders(orders.map(|&order| harmonic(order)).collect()))
        })
    }
}

impl Engine {
    /// The inertia of the reciprocating masses about its mean, by the angle of each mass at the motor (kg m2). The mean
    /// stands in the elements.
    pub(super) fn laws(&self) -> Vec<(usize, train::Orders)> {
        let (radius, rod) = (self.crank.radius.0, self.crank.rod.0);
        let way = |angle: f64| radius * angle.cos() + (rod * rod - (radius * angle.sin()).powi(2)).sqrt();
        let one = train::Orders::inertia(&[(self.crank.slider.0, &train::Orders::sampled(way))]);
        let square = self.ratio * self.ratio;
        let mut laws: Vec<(usize, train::Orders)> = Vec::new();
        for (cylinder, &mass) in self.cylinders.iter().zip(&self.at) {
            let turned = one.0.iter().filter(|h| h.order > 0.0).map(|h| {
                let (sine, cosine) = f64::sin_cos(h.order * cylinder.firing);
                train::Harmonic {
                    order: h.order / self.ratio,
                    cosine: (h.cosine * cosine - h.sine * sine) / square,
                    sine: (h.cosine * sine + h.sine * cosine) / square,
                }
            });
            match laws.iter_mut().find(|(at, _)| *at == mass) {
                Some((_, law)) => law.0.iter_mut().zip(turned).for_each(|(sum, h)| {
                    (sum.cosine, sum.sine) = (sum.cosine + h.cosine, sum.sine + h.sine);
                }),
                None => laws.push((mass, train::Orders(turned.collect()))),
            }
        }
        laws
    }
}

/// A list of `count` numbers that may be left out.
fn list(
    table: &mut Table<'_>,
    key: &'static str,
    quantity: Quantity,
    count: usize,
) -> Result<Option<Vec<f64>>, Diagnostic> {
    if !table.has(key) {
        return Ok(None);
    }
    let numbers = table.numbers(key, quantity)?;
    if numbers.len() == count {
        Ok(Some(numbers))
    } else {
        Err(table.wrong(key, format!("as many numbers as `cranks`, {count}")))
    }
}

/// The masses that the cylinders work on, and the motor's speed over theirs.
fn places(table: &mut Table<'_>, count: usize, masses: &[Turning]) -> Result<(Vec<usize>, f64), Diagnostic> {
    let known = masses.iter().map(|(label, ..)| format!("\"{label}\"")).collect::<Vec<_>>().join(", ");
    let expected = format!("as many labels as `cranks`, {count}, of masses that turn at one speed: {known}");
    let labels = table.texts("at", count, &expected)?;
    let found: Option<Vec<&Turning>> = labels
        .iter()
        .map(|label| {
            let mut labelled = masses.iter().filter(|(name, ..)| name == label);
            labelled.next().filter(|_| labelled.next().is_none())
        })
        .collect();
    match found {
        Some(found) if found.iter().all(|(.., ratio)| *ratio == found[0].2) => {
            Ok((found.iter().map(|(_, mass, _)| *mass).collect(), found[0].2))
        }
        _ => Err(table.wrong("at", expected)),
    }
}

/// The indicator diagram over a cycle (Pa): the file's, or the typical one of its compression and peak pressure.
fn pressure(table: &mut Table<'_>, crank: &CrankSlider, cycle: WorkingCycle) -> Result<Vec<f64>, Diagnostic> {
    if table.has("pressure") {
        table.instead_of("pressure", &["compression", "exponent", "charge_pressure", "peak_pressure"])?;
        let pressure = table.numbers("pressure", Quantity { unit: "Pa", ..Quantity::ANY })?;
        return if pressure.len() >= 8 { Ok(pressure) } else { Err(table.wrong("pressure", "8 numbers or more")) };
    }
    let pascal = Quantity { unit: "Pa", ..Quantity::TORQUE };
    let above_one = |most: f64| Quantity { least: 1.001, most, ..Quantity::RATIO };
    let indicator = Indicator {
        compression: table.number("compression", above_one(100.0))?,
        exponent: table.number_or("exponent", above_one(2.0), 1.3)?,
        charge: table.number_or("charge_pressure", pascal, 101_325.0)?,
        peak: table.number("peak_pressure", pascal)?,
    };
    indicator.check().map_err(|error| table.wrong("peak_pressure", error.message()))?;
    Ok(indicator.sample::<ANGLES>(crank, cycle).to_vec())
}
