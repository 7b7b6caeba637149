//! A torque on a coordinate, by its kind.

use std::f64::consts::TAU;

use driveline_solver::plant::LoadProgram;
use driveline_solver::plant::train::{Harmonic, Orders, Source, StrokeLoad, Waveform};

use super::reading::{Reading, harmonics};
use crate::machine_file::diagnostic::Diagnostic;
use crate::machine_file::quantity::Quantity;
use crate::machine_file::table::Table;

const KINDS: &str = "\"constant\", \"line\", \"parabola\", \"kloss\", \"shunt\", \"series\", \"combustion\", \
                     \"starting\", \"steps\", \"table\", \"triangle\", \"square\", \"sawtooth\", \"sawtooth up\", \
                     \"sawtooth down\", \"pulses\", \"rectified\", \"arc\", \"stroke\" or \"orders\"";

const ENGINES: &str = "\"spark\", \"indirect injection\" or \"direct injection\"";

impl Reading {
    pub(super) fn torque(&mut self, mut table: Table<'_>) -> Result<(usize, Source), Diagnostic> {
        let on = self.named(&mut table, "on")?;
        let kind = table.text("kind", KINDS)?;
        let any = |table: &mut Table<'_>, key| table.number(key, Quantity::ANY);
        let torque = match kind {
            "constant" => Source::Constant(any(&mut table, "torque")?),
            "line" => Source::Line { stall: any(&mut table, "stall")?, slope: any(&mut table, "slope")? },
            "parabola" => Source::Parabola(any(&mut table, "a")?, any(&mut table, "b")?, any(&mut table, "c")?),
            "kloss" => Source::Kloss {
                breakdown: any(&mut table, "breakdown")?,
                slip: table.number("slip", Quantity::RATIO)?,
                synchronous: table.number("synchronous", Quantity::SPEED)?,
            },
            "shunt" | "series" => {
                let voltage = any(&mut table, "voltage")?;
                let resistance = table.number("resistance", Quantity::RESISTANCE)?;
                let flux = table.number("flux", Quantity::FLUX)?;
                if kind == "series" {
                    let (pole, start) = (-resistance / flux, self.speeds.get(on).copied().unwrap_or(0.0));
                    if start <= pole {
                        return Err(table.wrong(
                            "on",
                            format!(
                                "a coordinate that starts above {pole} rad/s, -resistance/flux, where the current has \
                                 no bound; this one starts at {start} rad/s"
                            ),
                        ));
                    }
                    Source::Series { voltage, resistance, flux }
                } else {
                    Source::Line { stall: flux * voltage / resistance, slope: flux * flux / resistance }
                }
            }
            "combustion" => combustion(&mut table)?,
            "starting" => Source::Starting {
                torque: any(&mut table, "torque")?,
                time: table.number("time", Quantity::TIME)?,
                power: table.number("power", Quantity { least: 1.0, most: 2.0, whole: true, ..Quantity::RATIO })? as u8,
            },
            "steps" | "table" => {
                let rows = table.rows("points", 2, "rows of [time in s, torque], one after the other in time")?;
                let points: Vec<(f64, f64)> = rows.iter().map(|row| (row[0], row[1])).collect();
                if points.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
                    return Err(table.wrong("points", "times that come one after the other"));
                }
                Source::Program(if kind == "steps" { LoadProgram::steps(&points) } else { LoadProgram::table(&points) })
            }
            "triangle" | "square" | "sawtooth" | "sawtooth up" | "sawtooth down" | "pulses" | "rectified" => {
                let height = any(&mut table, "height")?;
                let period = table.number("period", Quantity::TIME)?;
                let terms = table.number("terms", Quantity::TERMS)? as usize;
                Source::Waveform(match kind {
                    "triangle" => Waveform::triangle(height, period, terms),
                    "square" => Waveform::square(height, period, terms),
                    "sawtooth" => Waveform::sawtooth(height, period, terms),
                    "pulses" => {
                        let width = table.number("width", Quantity::TIME)?;
                        if width >= period {
                            return Err(table.wrong("width", "less than the period"));
                        }
                        Waveform::pulses(height, width, period, terms)
                    }
                    "sawtooth up" => Waveform::sawtooth_up(height, period, terms),
                    "sawtooth down" => Waveform::sawtooth_down(height, period, terms),
                    _ => Waveform::rectified(height, period, terms),
                })
            }
            "arc" => {
                let torque = any(&mut table, "torque")?;
                let turns = table.number_or("turns", Quantity::TURNS, 1.0)? as u32;
                let turn = Quantity { most: TAU * f64::from(turns), ..Quantity::SIZE };
                let (from, to) = (table.number("from", turn)?, arc_end(&mut table, turn)?);
                if turns == 1 && to > from {
                    Source::Arc { torque, from, to }
                } else {
                    let constant = Harmonic { order: 0.0, cosine: torque, sine: 0.0 };
                    let to = if to > from { to } else { to + turn.most };
                    Source::Stroke { torque: Orders(vec![constant]), from, to, turns }
                }
            }
            "stroke" => {
                let force = any(&mut table, "force")?;
                let Some(way) = &self.ways[on] else {
                    return Err(table.wrong("on", "a coordinate with a `crank`, a `four_bar`, a `toggle` or a `cam`"));
                };
                let torque = way.slope().times(force);
                let mut acts = StrokeLoad { load: force, from: 0.0, to: TAU };
                let torque = if table.has("from") || table.has("to") {
                    let turn = Quantity { most: TAU, ..Quantity::SIZE };
                    let (from, to) = (table.number("from", turn)?, arc_end(&mut table, turn)?);
                    let to = if to > from { to } else { to + TAU };
                    (acts.from, acts.to) = (from, to);
                    Source::Stroke { torque, from, to, turns: 1 }
                } else {
                    Source::Orders(torque.0)
                };
                self.loads.push((on, acts));
                torque
            }
            "orders" => Source::Orders(harmonics(&mut table, "harmonics")?),
            _ => return Err(table.wrong("kind", KINDS)),
        };
        table.finish()?;
        Ok((on, torque))
    }
}

/// An engine at full load from idle to rated speed, and its governor from there to no load.
fn combustion(table: &mut Table<'_>) -> Result<Source, Diagnostic> {
    // Leiderman's polynomial with the coefficients of Jazar, Vehicle Dynamics, ch. 4
    let [a, b, c] = match table.text("combustion_type", ENGINES)? {
        "spark" => [1.0, 1.0, 1.0],
        "indirect injection" => [0.6, 1.4, 1.0],
        "direct injection" => [0.87, 1.13, 1.0],
        _ => return Err(table.wrong("combustion_type", ENGINES)),
    };
    let torque = table.number("rated_torque", Quantity::TORQUE)?;
    let rated = table.number("rated_speed", Quantity::SPEED)?;
    let idle = table.number("idle", Quantity::SPEED)?;
    if idle >= rated {
        return Err(table.wrong("idle", "a speed below `rated_speed`"));
    }
    let no_load = table.number("no_load", Quantity::SPEED)?;
    if no_load <= rated {
        return Err(table.wrong("no_load", "a speed above `rated_speed`"));
    }
    let full = [torque * a, torque * b / rated, -torque * c / (rated * rated)];
    let slope = torque / (no_load - rated);
    let governed = [slope * no_load, -slope, 0.0];
    Ok(Source::Pieces { ends: vec![idle, rated, no_load], torques: vec![full, governed] })
}

/// Where an arc ends, which is not where it begins; before it where it passes the angle zero.
fn arc_end(table: &mut Table<'_>, turn: Quantity) -> Result<f64, Diagnostic> {
    let (from, to) = (table.number("from", turn)?, table.number("to", turn)?);
    let differs = to != from && (to - from).abs() != turn.most;
    if differs { Ok(to) } else { Err(table.wrong("to", "another angle than `from`")) }
}
