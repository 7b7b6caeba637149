//! The figures of natural vibrations.

use driveline_report::chart::{Station, mode_shape};
use driveline_report::format::significant;
use driveline_report::{Arrangement, Figure};

/// Most shapes that are drawn.
const DRAWN: usize = 24;

/// The shapes of the lowest modes, each as its frequency (Hz) and the amplitudes of the stations in any scale, with the
/// stations that each link joins; none where nothing vibrates.
pub fn shapes<'m>(
    stations: &[Station],
    links: &[[usize; 2]],
    modes: impl Iterator<Item = (f64, &'m [f64])>,
) -> Option<Figure> {
    let drawn = |(index, (hz, shape)): (usize, (f64, &[f64]))| {
        mode_shape(stations, links, shape, &format!("{}. {} Hz", index + 1, significant(hz)))
    };
    let plots: Vec<String> = modes.take(DRAWN).enumerate().map(drawn).collect();
    let text = "How far each mass turns, referred to the motor and scaled to one; a line is a shaft or a mesh. The \
        area of a disc is the mass's share of the inertia.";
    let beside = |figure| Figure { arrangement: Arrangement::Beside, ..figure };
    (!plots.is_empty()).then(|| beside(Figure::new("Natural vibrations", text, Vec::new(), plots)))
}

/// The Campbell diagram.
pub fn campbell(diagram: String) -> Figure {
    let text = "Natural frequencies (level), and excitation orders (rising) over the motor's speed. The band is the \
        running range; a crossing in it or within 10 % of it is marked in red.";
    Figure::new("Campbell diagram", text, Vec::new(), vec![diagram])
}
