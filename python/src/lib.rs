//! The native part of the Python package `driveline`: commands of `cargo driveline`, and drives with the firmware's
//! bits, over bytes.

use std::ffi::OsString;
use std::path::PathBuf;

use cargo_driveline::campaign::file_drive::{self, start};
use cargo_driveline::cli::answer;
use cargo_driveline::machine_file::designs::{Designs, NO_SHAFT};
use cargo_driveline::machine_file::read;
use driveline_closed_loop::units::Units;
use driveline_firmware::scene::{Input, Output, Scene};
use driveline_firmware::{Words, scenes};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

fn refused(sentence: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(sentence.to_string())
}

/// Runs a command: what it writes to standard output, and why it failed, if it did.
#[pyfunction]
fn command(py: Python<'_>, arguments: Vec<OsString>) -> (String, Option<String>) {
    let (text, ended) = py.detach(|| answer(&arguments));
    (text, ended.err().map(|failure| failure.to_string()))
}

/// A drive at rest.
#[pyclass(unsendable)]
struct Drive {
    scene: Box<dyn Scene>,
    units: Units,
    #[pyo3(get)]
    rate_hz: u32,
    /// Observer of a machine file's drive, or name of a variant.
    #[pyo3(get)]
    name: String,
    /// Bases of torque (N m) and speed (rad/s) of its words.
    #[pyo3(get)]
    bases: (f64, f64),
}

#[pymethods]
impl Drive {
    /// Of a machine file, in `f32` or `fixed`; without an observer the selected one.
    #[staticmethod]
    fn of_file(file: PathBuf, number: &str, observer: Option<&str>) -> PyResult<Self> {
        let words = match number {
            "f32" => Words::Single,
            "fixed" => Words::Fixed,
            _ => return Err(refused(format!("there is no number `{number}`; there are f32, fixed"))),
        };
        let machine = read(&file).map(|machine| machine.with_dampers()).map_err(refused)?.map_err(refused)?;
        let two = machine.two_masses().ok_or_else(|| refused(format!("no drive can be made: {NO_SHAFT}")))?;
        let designs = Designs::of(&machine, &two).map_err(refused)?;
        let chosen = match observer {
            None => designs.selected.chosen,
            Some(name) => file_drive::observer(name)
                .map_err(|names| refused(format!("there is no observer `{name}`; there are {names}")))?,
        };
        let (scene, bases) = start(&machine, &designs, chosen, words).map_err(refused)?;
        let (rate_hz, name) = (machine.control.rate_hz, file_drive::name(chosen).to_owned());
        Ok(Self { scene, units: Units::new(words, bases), rate_hz, name, bases: (bases.torque, bases.speed) })
    }

    /// A variant of the firmware; its fixed point per unit of bases.
    #[staticmethod]
    fn variant(name: &str) -> PyResult<Self> {
        let row = scenes::find(name).ok_or_else(|| refused(format!("there is no variant `{name}`; see variants()")))?;
        let units = Units::new(row.words(), driveline::settings::Bases::SI);
        Ok(Self { scene: row.start(), units, rate_hz: row.rate_hz, name: name.to_owned(), bases: (1.0, 1.0) })
    }

    /// Ticks, one for each eight words, as on the link of the firmware.
    fn exchange<'py>(&mut self, py: Python<'py>, input: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let (rows, []) = input.as_chunks::<32>() else {
            return Err(refused("expected rows of eight words of 32 bits"));
        };
        let word = |row: &[u8; 32], at: usize| u32::from_ne_bytes(std::array::from_fn(|byte| row[4 * at + byte]));
        PyBytes::new_with(py, input.len(), |output| {
            for (row, output) in rows.iter().zip(output.as_chunks_mut::<32>().0) {
                let [angle, torque, setpoint, flags, v, w, key, value] = std::array::from_fn(|at| word(row, at));
                let input = Input { angle, torque, setpoint, flags, vibration: [v, w], asked: [key, value] };
                let Output { torque, motor_speed, shaft_torque, load_speed, load_torque, faults, instructions, answer } =
                    self.scene.exchange(&input);
                let words = [torque, motor_speed, shaft_torque, load_speed, load_torque, faults, instructions, answer];
                output.as_chunks_mut::<4>().0.iter_mut().zip(words).for_each(|(at, word)| *at = word.to_ne_bytes());
            }
            Ok(())
        })
    }

    /// Words of numbers (`f64`) over a base.
    fn to_words<'py>(&self, py: Python<'py>, values: &[u8], base: f64) -> PyResult<Bound<'py, PyBytes>> {
        let values = values.as_chunks::<8>().0;
        PyBytes::new_with(py, 4 * values.len(), |words| {
            let word = |value: &[u8; 8]| self.units.word(f64::from_ne_bytes(*value), base).to_ne_bytes();
            words.as_chunks_mut::<4>().0.iter_mut().zip(values).for_each(|(at, value)| *at = word(value));
            Ok(())
        })
    }

    /// Numbers (`f64`) of words over a base.
    fn of_words<'py>(&self, py: Python<'py>, words: &[u8], base: f64) -> PyResult<Bound<'py, PyBytes>> {
        let words = words.as_chunks::<4>().0;
        PyBytes::new_with(py, 8 * words.len(), |values| {
            let value = |word: &[u8; 4]| self.units.value(u32::from_ne_bytes(*word), base).to_ne_bytes();
            values.as_chunks_mut::<8>().0.iter_mut().zip(words).for_each(|(at, word)| *at = value(word));
            Ok(())
        })
    }
}

/// Names of the firmware's variants.
#[pyfunction]
fn variants() -> Vec<&'static str> {
    scenes::VARIANTS.to_vec()
}

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::{Drive, command, variants};
}
