//! A published case solved on the controllers themselves.

use std::time::Duration;

use driveline_qemu::image::{Program, board, build};

/// 1e-5 in single precision, with the controller's own square roots, sines and cosines.
#[test]
fn least_squares_in_single_precision_on_the_cores() {
    for (number, core) in [("f32", "m4f"), ("fixed", "m3")] {
        let image =
            build(&format!("hoist/{number}/reduced/10000"), board(core).unwrap(), Program::Bench, |_| {}).unwrap();
        let lines = driveline_qemu::link::run(&image, Duration::from_secs(60)).unwrap().lines;
        let line = lines.iter().find(|line| line["accuracy"] == "balance/darlow").unwrap();
        let off = line["billionths"].as_u64().unwrap();
        println!("{core}: {off} billionths");
        assert!(off < 10_000, "{off} billionths on {core}");
    }
}
