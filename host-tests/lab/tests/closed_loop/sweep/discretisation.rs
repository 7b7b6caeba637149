//! Every case of `discretisation.json` through the coefficients that a tick loads, in every number. The
//! design's exponential meets the same file in the library's tests.

use driveline::design::Matrix;
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass as Machine};
use driveline::number::Fixed;
use driveline::observer::TwoMassObserver;
use driveline::settings::Bases;
use driveline_lab::sweep::{Step, open_loop};
use serde_json::Value;

fn cases() -> Vec<Value> {
    let path = format!("{}/../../tests/data/discretisation.json", env!("CARGO_MANIFEST_DIR"));
    let file: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    file["cases"].as_array().unwrap().clone()
}

fn number(case: &Value, key: &str) -> f64 {
    case[key].as_f64().unwrap()
}

fn machine(case: &Value) -> Machine {
    Machine::new(
        Inertia(number(case, "J_motor_kg_m2")),
        Inertia(number(case, "J_load_kg_m2")),
        Stiffness(number(case, "k_Nm_rad")),
        Damping(number(case, "d_Nms_rad")),
    )
}

fn matrix<const R: usize, const C: usize>(value: &Value) -> Matrix<R, C> {
    let mut out = Matrix::ZERO;
    for (row, values) in out.0.iter_mut().enumerate() {
        for (column, entry) in values.iter_mut().enumerate() {
            *entry = value[row][column].as_f64().unwrap();
        }
    }
    out
}

/// The pair of twist and slip in the file's matrix of motor speed, k twist and load speed: the file's motor speed and
/// load speed move in inverse proportion to their inertias.
fn pair_of(case: &Value) -> [[f64; 2]; 2] {
    let ad = matrix::<3, 3>(&case["elastic"]["Ad"]).0;
    let (jm, jl, k) = (number(case, "J_motor_kg_m2"), number(case, "J_load_kg_m2"), number(case, "k_Nm_rad"));
    let (motor, load) = (jl / (jm + jl), -jm / (jm + jl));
    // A slip of one about a mean of zero, and the slip and twist that come of it.
    let slip = ad.map(|row| row[0] * motor + row[2] * load);
    [[ad[1][1], slip[1] / k], [(ad[0][1] - ad[2][1]) * k, slip[0] - slip[2]]]
}

/// Worst difference of the pair in energy units, twist times omega against slip.
fn difference(stored: [[f64; 2]; 2], expected: [[f64; 2]; 2], omega: f64) -> f64 {
    let scale = [[1.0, omega], [1.0 / omega, 1.0]];
    let mut worst: f64 = 0.0;
    for row in 0..2 {
        for column in 0..2 {
            let one = f64::from(u8::from(row == column));
            let miss = one + stored[row][column] - expected[row][column];
            worst = worst.max((miss * scale[row][column]).abs());
        }
    }
    worst
}

/// Without friction the pair is closed, and what the tick loads is the file's matrix: `f64` to the file's 1e-14, `f32`
/// to its 1e-7, fixed point to two of its coefficients' units, 2^-30: the nearest is off by half of one, its neighbour
/// by one and a half.
#[test]
fn stored_coefficients_meet_the_file() {
    let mut met = 0;
    for case in cases().iter().filter(|case| number(case, "b_motor_Nms_rad") == 0.0) {
        let machine = machine(case);
        let (period, omega) = (number(case, "Ts_s"), machine.resonance());
        let design = open_loop(&machine, period);
        let bases = Bases::new(&machine, machine.stiffness * 0.01, omega * 0.01);
        let expected = pair_of(case);
        let double = <TwoMassObserver<f64> as Step<f64>>::config(&design, bases).unwrap();
        let single = <TwoMassObserver<f32> as Step<f32>>::config(&design, bases).unwrap();
        let fixed = <TwoMassObserver<Fixed> as Step<Fixed>>::config(&design, bases).unwrap();
        assert!(difference(<TwoMassObserver<f64> as Step<f64>>::increments(&double), expected, omega) < 1e-14);
        assert!(difference(<TwoMassObserver<f32> as Step<f32>>::increments(&single), expected, omega) < 1e-7);
        // Stored per unit of the twist's and the slip's base: back to SI.
        let [[n11, n12], [n21, n22]] = <TwoMassObserver<Fixed> as Step<Fixed>>::increments(&fixed);
        let ratio = bases.twist / bases.twist_rate;
        let stored = [[n11, n12 * ratio], [n21 / ratio, n22]];
        // A base of the slip that the damper cuts counts for more.
        let coarse = (omega * ratio).max(1.0 / (omega * ratio));
        assert!(difference(stored, expected, omega) < 2.0 * coarse / 1_073_741_824.0);
        met += 1;
    }
    assert_eq!(met, 2);
}
