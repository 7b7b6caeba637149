//! Images: what is read from them, and that the board counts instructions exactly.

use std::time::Duration;

use driveline_firmware::board::BOARDS;
use host_tests::image::{Contents, Cost, Program, build, self_test};
use host_tests::link;

/// A bench takes well under a second of QEMU.
const LIMIT: Duration = Duration::from_secs(60);

/// Words of a governed rigid drive: speed, load torque, accelerating torque, residual and angle of the observer; set point,
/// ramp and integral of the governor; the last command, the count of missed angles, and the pointer to the constants.
const RIGID_STATE: u64 = 4 * (5 + 3 + 3);

#[test]
fn ten_and_a_thousand_nops_count_as_ten_and_a_thousand() {
    for &board in BOARDS {
        let image = build("hoist/fixed/rigid/10000", board, Program::Bench, |_| {}).unwrap();
        let lines = link::run(&image, LIMIT).unwrap().lines;
        for (name, expected) in [("nops/10", 10), ("nops/1000", 1000)] {
            let line = lines.iter().find(|line| line["bench"] == name).unwrap();
            for figure in ["min", "median", "max"] {
                assert_eq!(line[figure], expected, "{figure} of {name} on {}", board.name);
            }
        }
    }
}

#[test]
fn the_self_test_gives_the_hosts_fingerprint() {
    for variant in ["hoist/f32/rigid/10000", "hoist/fixed/rigid/10000"] {
        for &board in BOARDS {
            self_test(variant, board).unwrap();
        }
    }
}

#[test]
fn a_self_test_of_no_variant_is_an_error_that_names_it() {
    let error = self_test("hoist", BOARDS[0]).unwrap_err().to_string();
    assert_eq!(error, "no variant is called `hoist`");
    // and the firmware's own build says which there are
    let error = build("hoist", BOARDS[0], Program::SelfTest, |_| {}).unwrap_err().to_string();
    assert!(error.contains("DRIVELINE_VARIANT is `hoist`; firmware/src/selected.rs has `empty/"), "{error}");
}

#[test]
fn each_variant_keeps_an_image_of_its_own() {
    let read = |variant| {
        let image = build(variant, BOARDS[1], Program::ControlLoop, |_| {}).unwrap();
        (image.path.clone(), Contents::read(&image.path).unwrap())
    };
    let (empty_path, empty) = read("empty/f32/none/10000");
    let (single_path, single) = read("hoist/f32/rigid/10000");
    assert_ne!(empty_path, single_path);
    assert_eq!(Contents::read(&empty_path).unwrap().sizes, empty.sizes);
    // on a core without an FPU the tick calls software floating point: its code is more than its own function
    let own = single.symbol("driveline_tick").unwrap().size;
    assert!(single.tick_code > own + 500, "{} bytes in all, {own} its own", single.tick_code);
    assert_eq!(empty.tick_code, empty.symbol("driveline_tick").unwrap().size);
    // what the scene adds to the image is its tick and its start, constants, and little else; alignment makes up the rest
    let added = single.sizes.flash() - empty.sizes.flash();
    assert!(added >= single.tick_code - empty.tick_code, "{added} bytes more in the image");
    assert_eq!(single.sizes.ram() - empty.sizes.ram(), RIGID_STATE);
}

#[test]
fn a_cost_is_the_images_and_the_runs() {
    let cost = Cost::measure("hoist/fixed/rigid/10000", BOARDS[0], |_| {}).unwrap();
    let spread = cost.instructions;
    assert!(0 < spread.min && spread.min <= spread.median && spread.median <= spread.max, "{spread:?}");
    assert_eq!(u64::from(cost.state), RIGID_STATE);
    assert!(cost.stack >= 8 && cost.sizes.ram() >= RIGID_STATE && cost.tick_code > 0, "{cost:?}");
}
