//! The page of an identification: measured and fitted response, and the figures.

use std::f64::consts::TAU;

use driveline_report::chart::{Curve, Lines};
use driveline_report::format::{percent, significant};
use driveline_report::{Figure, Key, Section, Sheet, fact};

use super::identify::Identified;
use super::text::table;

/// The page as HTML.
pub fn page(name: &str, identified: &Identified) -> String {
    let Identified { estimate, setting, lines } = identified;
    let places: Vec<f64> = lines.iter().map(|line| line.frequency / TAU).collect();
    let measured: Vec<f64> = lines.iter().map(|line| (line.motion / line.torque).norm()).collect();
    let respond = |frequency| estimate.model.response(frequency, setting.motion, setting.torque, setting.period);
    let fitted: Vec<f64> = lines.iter().map(|line| respond(line.frequency).norm()).collect();
    let turned = |complex: nalgebra::Complex<f64>| complex.arg().to_degrees();
    let phases = |of: &dyn Fn(&super::Line) -> f64| -> Vec<f64> { lines.iter().map(of).collect() };
    let draw = |across: &str, curves: [Vec<f64>; 2], logarithmic: bool| {
        let [measured, fitted] = curves;
        Lines {
            label: format!("{across} over frequency, measured and fitted"),
            along: "frequency, Hz".to_owned(),
            across: across.to_owned(),
            places: places.clone(),
            curves: vec![
                Curve { class: "truth".to_owned(), values: measured },
                Curve { class: "s0".to_owned(), values: fitted },
            ],
            logarithmic,
            ..Lines::default()
        }
        .draw()
    };
    let unit = match setting.motion {
        super::Motion::Acceleration => "acceleration per torque, rad/s² per N m",
        super::Motion::Angle if setting.torque == super::Torque::Sine => "angle per torque, rad per N m",
        _ => "speed per torque, rad/s per N m",
    };
    let amplitude = draw(unit, [measured, fitted], true);
    let phase = draw(
        "phase, degrees",
        [phases(&|line| turned(line.motion / line.torque)), phases(&|line| turned(respond(line.frequency)))],
        false,
    );
    Sheet {
        name: name.to_owned(),
        kicker: "Identification".to_owned(),
        summary: "Two masses with viscous friction, the likeliest behind the recording.".to_owned(),
        facts: vec![
            fact("lines of the spectrum", estimate.lines.to_string()),
            fact("torque left unexplained", percent(estimate.unexplained)),
            fact("condition of the information", significant(estimate.condition)),
        ],
        figures: vec![Figure::new(
            "Frequency response",
            "Line by line as measured, and of the fitted machine with its dead time.",
            vec![Key::curve("measured", "truth"), Key::curve("fitted", "s0")],
            vec![amplitude, phase],
        )],
        tables: vec![Section::new("Machine", "Figures with their standard deviations.", table(identified))],
    }
    .page()
}
