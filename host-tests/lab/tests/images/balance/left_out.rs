//! A drive without balancing has none of its symbols.

use driveline_qemu::image::{Contents, Program, board, build};

const PARTS: [&str; 11] = [
    "9balancing",
    "phasor",
    "Phasor",
    "sincos",
    "rotor_angle",
    "influence",
    "Influence",
    "min_max",
    "procedure",
    "nalgebra",
    "in_run",
];

fn symbols(number: &str, core: &str, program: Program) -> Vec<String> {
    let image = build(&format!("hoist/{number}/reduced/10000"), board(core).unwrap(), program, |_| {}).unwrap();
    Contents::read(&image.path).unwrap().symbols.into_iter().map(|symbol| symbol.name).collect()
}

#[test]
fn a_drive_without_balancing_has_nothing_of_it() {
    for (number, core) in [("f32", "m4f"), ("fixed", "m3")] {
        let names = symbols(number, core, Program::ControlLoop);
        for part in PARTS {
            let found: Vec<_> = names.iter().filter(|name| name.contains(part)).collect();
            assert!(found.is_empty(), "{core}: {found:?}");
        }
        // the bench measures it, so that these names are what it would be seen by
        let names = symbols(number, core, Program::Bench);
        for part in ["phasor", "sincos"] {
            assert!(names.iter().any(|name| name.contains(part)), "{part} on {core}");
        }
    }
}
