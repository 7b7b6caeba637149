//! Blocks made by hand, with mean, variance and drift in closed form.

use super::*;
use crate::settings::PhasorSettings;

/// Blocks of one turn of ten ticks, with these growths of sine and cosine, in units of pi.
fn blocks<const EDGES: usize>(growths: [[f32; 2]; EDGES]) -> ([Edge<f32, 1>; EDGES], PhasorsConfig<f32, 1>) {
    let mut config = PhasorsConfig::<f32, 1>::new(&PhasorSettings::DIRECT, [1.0]);
    config.block = 1;
    let (mut sums, mut ticks) = ([0.0; 2], 0);
    let edges = growths.map(|[sine, cosine]| {
        sums = [sums[0] + cosine * core::f32::consts::PI, sums[1] + sine * core::f32::consts::PI];
        ticks += 10;
        Edge { sums: [sums], ticks, past: 0 }
    });
    (edges, config)
}

/// A tick of a tenth of a turn holds a sample for 36 degrees: e^{-ix} x/sin x, with x of 18.
#[test]
fn a_block_is_its_phasor() {
    let (edges, config) = blocks([[0.0; 2], [3.0, 4.0]]);
    let reading = Reading::between(&edges, 0, &config).unwrap();
    let x = 0.1 * core::f32::consts::PI;
    let expected = Phasor { re: 3.0, im: 4.0 }.times(Phasor { re: x / x.tan(), im: -x });
    // rounding of single precision
    assert!(reading.phasor.less(expected).amplitude() < 1e-5, "{reading:?} {expected:?}");
    assert_eq!((reading.variance, reading.drift, reading.scatter), (0.0, 0.0, 0.0));
    // two blocks are a line, and nothing is beside it
    let (edges, config) = blocks([[0.0; 2], [3.0, 4.0], [3.5, 4.0]]);
    let reading = Reading::between(&edges, 0, &config).unwrap();
    assert_eq!((reading.variance, reading.scatter), (0.0, 0.0));
}

/// The first zero lies half a tick before the end of its tick, the second at the end: ten and a half.
#[test]
fn a_turn_begins_where_the_zero_lies() {
    let (mut edges, config) = blocks([[0.0; 2], [1.0, 0.0]]);
    edges[0].past = config.turning.turn / 20;
    // a unit of 2^26 on a turn
    assert!((Reading::between(&edges, 0, &config).unwrap().ticks - 10.5).abs() < 1e-5);
}

/// An amplitude of a quarter of the floor counts a quarter of its scatter and drift of a fifth; zero has none.
#[test]
fn the_floor_is_an_amplitude() {
    let reading = |amplitude: f32, drift: f32| Reading {
        phasor: Phasor { re: amplitude, im: 0.0 },
        variance: 0.01,
        turns: 1,
        ticks: 10.0,
        speed_spread: 0.0,
        drift,
        scatter: 0.0,
    };
    let limits = |scatter: f32, drift: f32| Steadiness { speed: 0.01, drift, scatter, floor: 2.0 };
    assert!(reading(0.5, 0.2).accept(false, &limits(0.051, 0.051)).is_ok());
    let refused = reading(0.5, 0.2).accept(false, &limits(0.049, 0.051));
    assert!(matches!(refused, Err(ReadingFault::Scattered { .. })), "{refused:?}");
    let refused = reading(0.5, 0.2).accept(false, &limits(0.051, 0.049));
    assert_eq!(refused, Err(ReadingFault::Drifting { drift: 0.2 }));
    let none = Steadiness { floor: 0.0, ..limits(0.05, 0.05) };
    assert!(reading(0.0, f32::INFINITY).accept(false, &none).is_ok());
}
