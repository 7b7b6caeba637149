//! A coordinate: its inertia, and the crank, four-bar, toggle or cam that it turns.

use std::f64::consts::{PI, TAU};

use driveline_solver::plant::train::{Coordinate, Crank, FourBarPins, Orders, Pins, StrokeLoad, rubbing};

use super::mechanism::{self, even, four_bar, inertia, toggle};
use super::reading::{Joints, Reading, fresh};
use crate::machine_file::diagnostic::Diagnostic;
use crate::machine_file::quantity::Quantity;
use crate::machine_file::table::Table;

/// Of a rod that is hardly longer than its crank.
const LONGER: &str = "more than the crank's radius by a thousandth of it: the slider's way has no series otherwise";

impl Reading {
    pub(super) fn coordinate(&mut self, mut table: Table<'_>) -> Result<Coordinate, Diagnostic> {
        let name = fresh(&mut table, &self.names)?;
        let speed = table.number_or("speed", Quantity::ANY, 0.0)?;
        self.speeds.push(speed);
        let mut coordinate = Coordinate::new(table.number("inertia", Quantity::INERTIA_OR_MASS)?)
            .speed(speed)
            .angle(table.number_or("angle", Quantity::ANY, 0.0)?)
            .viscous(table.number_or("viscous", Quantity::DAMPER, 0.0)?);
        let (mut way, mut friction) = (None::<Orders>, 0.0);
        let mut law = Vec::new();
        let mechanisms = ["crank", "four_bar", "toggle", "cam"].into_iter().filter(|key| table.has(key));
        if let Some(second) = mechanisms.collect::<Vec<_>>().get(1) {
            return Err(table.wrong(second, "one of `crank`, `four_bar`, `toggle` and `cam`"));
        }
        if let Some(mut crank) = table.table_if("crank")? {
            let radius = crank.number("radius", Quantity::DIAMETER)?;
            let rod = crank.number("rod", Quantity::DIAMETER)?;
            if rod <= radius {
                return Err(crank.wrong("rod", "more than the crank's radius"));
            }
            let one = Quantity { most: 1.0, ..Quantity::SIZE };
            let drive = Crank {
                rod_mass: crank.number_or("rod_mass", Quantity::SIZE, 0.0)?,
                rod_inertia: crank.number_or("rod_inertia", Quantity::SIZE, 0.0)?,
                rod_centre: crank.number_or("rod_centre", one, 0.3)?,
                ..Crank::new(radius, rod, crank.number("slider_mass", Quantity::SIZE)?)
            };
            coordinate = coordinate.crank(drive);
            if let Some(mut pins) = crank.table_if("pins")? {
                let found = Pins {
                    coefficient: pins.number("coefficient", Quantity::FRICTION)?,
                    main: pins.number_or("main", Quantity::PIN, 0.0)?,
                    crank: pins.number_or("crank", Quantity::PIN, 0.0)?,
                    wrist: pins.number_or("wrist", Quantity::PIN, 0.0)?,
                };
                let place = pins.place();
                pins.finish()?;
                self.pins.push((self.names.len(), Joints::Crank(found), place));
            }
            let turn = Quantity { most: TAU, ..Quantity::SIZE };
            if let Some(angle) = crank.number_if("pins_at", turn)? {
                self.pins_at.push((self.names.len(), drive, angle));
            }
            friction = crank.number_or("friction", Quantity::SIZE, 0.0)?;
            if friction > 0.0 {
                // against the slider, which goes inwards first
                let on = |load, from, to| (self.names.len(), StrokeLoad { load, from, to });
                self.loads.extend([on(friction, 0.0, PI), on(-friction, PI, TAU)]);
            }
            let reach = move |angle: f64| (rod * rod - (radius * angle.sin()).powi(2)).sqrt();
            let slider = Orders::sampled(|angle| radius * angle.cos() + reach(angle));
            if slider.at(0.0).is_nan() {
                return Err(crank.wrong("rod", LONGER));
            }
            way = Some(slider);
            crank.finish()?;
        } else if let Some(mut four) = table.table_if("four_bar")? {
            let (bars, parts) = four_bar(&mut four)?;
            let rocker = Orders::sampled(|angle| bars.angles(angle)[1]);
            law = inertia(&four, "crank", &parts, &rocker)?;
            (way, friction) = (Some(rocker), four.number_or("friction", Quantity::SIZE, 0.0)?);
            if let Some(mut pins) = four.table_if("pins")? {
                let found = FourBarPins {
                    coefficient: pins.number("coefficient", Quantity::FRICTION)?,
                    main: pins.number_or("main", Quantity::PIN, 0.0)?,
                    crank: pins.number_or("crank", Quantity::PIN, 0.0)?,
                    rocker: pins.number_or("rocker", Quantity::PIN, 0.0)?,
                    pivot: pins.number_or("pivot", Quantity::PIN, 0.0)?,
                };
                let place = pins.place();
                pins.finish()?;
                let [.., (inertia, _)] = parts;
                self.pins.push((self.names.len(), Joints::FourBar(bars, inertia, found), place));
            }
            if friction > 0.0 {
                // against the rocker, which reverses at its dead centres
                let [stretched, folded] = bars.dead_centres();
                let against = -friction * bars.rates(0.5 * (stretched + folded))[1].signum();
                let on = |load, from, to| (self.names.len(), StrokeLoad { load, from, to });
                self.loads.extend([on(against, stretched, folded), on(-against, folded, stretched + TAU)]);
            }
            four.finish()?;
        } else if let Some(mut knee) = table.table_if("toggle")? {
            let (slider, parts) = toggle(&mut knee)?;
            law = inertia(&knee, "crank", &parts, &slider)?;
            (way, friction) = (Some(slider), knee.number_or("friction", Quantity::SIZE, 0.0)?);
            knee.finish()?;
        } else if let Some(mut cam) = table.table_if("cam")? {
            let (follower, parts) = mechanism::cam(&mut cam)?;
            law = inertia(&cam, "lift", &parts, &follower)?;
            (way, friction) = (Some(follower), cam.number_or("friction", Quantity::SIZE, 0.0)?);
            cam.finish()?;
        }
        if let Some(way) = way.as_ref().filter(|_| friction > 0.0) {
            coordinate = rubbing(way, friction).into_iter().fold(coordinate, Coordinate::source);
            self.forwards.push(self.names.len());
        }
        if table.has("inertia_table") {
            law.extend(Orders::of(&even(&mut table, "inertia_table", Quantity::SIZE)?).0);
        }
        if !law.is_empty() {
            coordinate = coordinate.inertia_law(Orders(law));
        }
        table.finish()?;
        self.names.push(name);
        self.ways.push(way);
        Ok(coordinate)
    }
}
