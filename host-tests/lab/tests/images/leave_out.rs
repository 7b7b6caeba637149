//! A part that is left out of a drive contributes no byte.
//!
//! Every part is inlined into the tick: no symbol names it, whether it is there or not. So its absence has to show in
//! bytes: its state and its table of constants are gone to the byte, and the tick is shorter by its law.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use driveline_firmware::board::Facts;
use driveline_qemu::image::{Contents, Program, board, build};

const CORES: [(&str, &str); 2] = [("f32", "m4f"), ("fixed", "m3")];

/// An image's contents; each is built once for all tests.
fn read(number: &str, parts: &str, board: Facts) -> Contents {
    static BUILT: Mutex<BTreeMap<String, Contents>> = Mutex::new(BTreeMap::new());
    let variant = format!("composition/{number}/{parts}/10000");
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    let contents = built.entry(variant.clone()).or_insert_with(|| {
        let image = build(&variant, board, Program::ControlLoop, |_| {}).unwrap();
        Contents::read(&image.path).unwrap()
    });
    contents.clone()
}

#[test]
fn a_governor_that_is_left_out_is_not_there() {
    for (number, core) in CORES {
        for observer in ["rigid", "semi-implicit", "two-mass", "two-mass-geared"] {
            let board = board(core).unwrap();
            let without = read(number, &format!("{observer}-observer"), board);
            let with = read(number, &format!("{observer}-governed"), board);
            let what = format!("{observer} on {core}: {:?} and {:?}", without.sizes, with.sizes);
            // Its state: integral, setpoint and reference, four bytes each.
            assert_eq!(with.sizes.ram() - without.sizes.ram(), 12, "{what}");
            // Its table: three coefficients and two limits, four bytes each, in a section that is aligned to eight at
            // most.
            let table = with.sizes.constants - without.sizes.constants;
            assert!((20..=20 + 8).contains(&table), "{what}");
            // Its law: some forty instructions of two to four bytes, at least one for each of its ten operations.
            assert!(with.tick_code >= without.tick_code + 2 * 10, "{what}");
            assert!(with.sizes.text >= without.sizes.text + 2 * 10, "{what}");
        }
    }
}

#[test]
fn a_measurement_of_the_fluctuation_that_is_left_out_is_not_there() {
    for (number, core) in CORES {
        let board = board(core).unwrap();
        let without = read(number, "two-mass-observer", board);
        // Extremes: peaks of four words, two of each speed with its last value, and four for each of two finished
        // cycles; five ends of four words; ten for where it stands: 18 + 32 + 20 + 10 words. Waveform: 64 bins, each
        // three words and a sum of torques, in fixed point of two words; five ends of four words, ten for where it
        // stands.
        let bin = if number == "f32" { 16 } else { 20 };
        for (part, state) in [("extremes", 80 * 4), ("waveform", 64 * bin + 30 * 4)] {
            let with = read(number, &format!("two-mass-{part}"), board);
            let what = format!("{part} on {core}: {:?} and {:?}", without.sizes, with.sizes);
            // Both are inlined whole into the tick: what they bring is seen by its size.
            // What is aligned to eight bytes may leave four.
            assert!((state..=state + 4).contains(&(with.sizes.ram() - without.sizes.ram())), "{what}");
            assert!(with.tick_code > without.tick_code && with.sizes.constants > without.sizes.constants, "{what}");
        }
    }
}

#[test]
fn a_gear_that_is_left_out_is_not_there() {
    for (number, core) in CORES {
        let board = board(core).unwrap();
        let (without, with) =
            (read(number, "two-mass-observer", board), read(number, "two-mass-geared-observer", board));
        let what = format!("{core}: {:?} and {:?}", without.sizes, with.sizes);
        // No state; friction, firmness and play in the table, and a longer name.
        assert_eq!(with.sizes.ram(), without.sizes.ram(), "{what}");
        assert!((8..=12 + 8).contains(&(with.sizes.constants - without.sizes.constants)), "{what}");
        assert!(with.tick_code > without.tick_code, "{what}");
    }
}

#[test]
fn an_observer_brings_nothing_of_another() {
    for (number, core) in CORES {
        let board = board(core).unwrap();
        let contents =
            ["rigid-observer", "semi-implicit-observer", "two-mass-observer"].map(|parts| read(number, parts, board));
        // Fewer states, fewer constants, less code: in this order, each by what its file counts.
        let code = contents.each_ref().map(|contents| contents.tick_code);
        assert!(code[0] < code[1] && code[1] < code[2], "{core}: {code:?}");
        let sizes = contents.map(|contents| contents.sizes);
        assert!(sizes[0].flash() < sizes[1].flash() && sizes[1].flash() < sizes[2].flash(), "{core}: {sizes:?}");
        // Rigid: speed, load torque, accelerating torque, residual, angle; the others have one more.
        assert_eq!(sizes[1].ram() - sizes[0].ram(), 4, "{core}: {sizes:?}");
        assert_eq!(sizes[2].ram(), sizes[1].ram(), "{core}: {sizes:?}");
    }
}
