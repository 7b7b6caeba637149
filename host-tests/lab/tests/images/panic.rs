//! No image with a reachable panic links.

use driveline_firmware::board::BOARDS;
use driveline_qemu::image::{BuildError, Program, build, links};

const VARIANT: &str = "empty/f32/none/10000";

#[test]
fn the_linker_refuses_a_reachable_panic_by_name() {
    for &board in BOARDS {
        let Err(BuildError::Cargo { command, output }) = build(VARIANT, board, Program::Panics, |_| {}) else {
            panic!("an image with a reachable panic was linked for {}", board.name);
        };
        assert!(output.contains("undefined symbol: panic_is_reachable"), "{command}: {output}");
        assert!(!links(VARIANT, board, Program::Panics).unwrap());
    }
}

#[test]
fn the_linker_accepts_an_image_without_one() {
    for &board in BOARDS {
        assert!(links(VARIANT, board, Program::ControlLoop).unwrap());
    }
}
