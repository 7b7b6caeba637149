//! Images: what is read from them, and that the board counts instructions exactly.

use std::process::Command;
use std::time::Duration;

use driveline_firmware::board::BOARDS;
use driveline_firmware::board::nucleo_g474re::FACTS as NUCLEO;
use driveline_qemu::image::{Contents, ON_NUCLEO, Program, board, build, tick_code};
use driveline_qemu::link;
use driveline_qemu::measure::{Cost, Loops, MachineCode, self_test};
use object::{Object, ObjectSection, ObjectSymbol};

/// A bench takes well under a second of QEMU.
const LIMIT: Duration = Duration::from_secs(60);

/// Words of a governed rigid drive: speed, load torque, accelerating torque, residual and angle of the observer;
/// setpoint, ramp and integral of the governor; the last command, the count of missed angles, and the pointer to the
/// constants.
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
            // and no other path than the straight one is in the machine code
            let code = MachineCode::read(&image.path, Loops::default()).unwrap();
            let bound = code.bound(line["function"].as_u64().unwrap() as u32).unwrap();
            assert_eq!(bound.instructions, expected, "longest path of {name} on {}", board.name);
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
    assert!(error.contains("DRIVELINE_VARIANT is `hoist`; firmware/src/scenes.rs has `hoist/"), "{error}");
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
    // what the scene adds to the image is its tick and its start, constants, and little else; alignment makes up the
    // rest
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
    let bound = cost.bound.unwrap();
    assert!(u64::from(spread.max) <= bound.instructions && cost.stack <= bound.stack, "{spread:?}, {bound:?}");
    // the code is straight but for bad samples: the bound is no multiple of what is counted
    assert!(bound.instructions < u64::from(spread.max) * 5 / 4, "{spread:?}, {bound:?}");
}

#[test]
fn the_longest_path_is_listed_and_adds_up_to_the_bound() {
    let image = build("hoist/fixed/rigid/10000", BOARDS[0], Program::ControlLoop, |_| {}).unwrap();
    let run = |arguments: &[&str]| {
        let program = env!("CARGO_BIN_EXE_lab");
        Command::new(program).arg("longest-path").arg(&image.path).args(arguments).output().unwrap()
    };
    let output = run(&["--json"]);
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let pieces = found["path"].as_array().unwrap();
    let figure = |piece: &serde_json::Value, key: &str| piece[key].as_u64().unwrap();
    let sum: u64 = pieces.iter().map(|piece| figure(piece, "instructions") * figure(piece, "times")).sum();
    // the empty function of the counter: its frame, the frame's pointer and the return
    assert_eq!(sum - figure(&found, "instructions"), 3);
    assert!(pieces.iter().any(|piece| piece["function"] == "driveline_tick"), "{found}");
    // `main` waits for inputs without end, and calls the tick through a pointer
    let refused = run(&["--function", "main"]);
    assert_eq!(refused.status.code(), Some(1), "{refused:?}");
    let missing = run(&["--function", "no_such_function"]);
    let message = String::from_utf8_lossy(&missing.stderr).into_owned();
    assert_eq!(missing.status.code(), Some(2), "{message}");
    assert!(message.contains("has no function `no_such_function`"), "{message}");
}

/// The kernels have one path each: in QEMU their counts are its length, and no other function exceeds its bound. The
/// same image for the board with a motor links, and its lines are told from another image's.
#[test]
fn the_benchs_counts_are_laid_beside_the_bounds_of_its_image() {
    let variant = "hoist/f32/reduced/10000";
    let image = build(variant, board("m4f").unwrap(), Program::Bench, |_| {}).unwrap();
    let lines = link::run(&image, LIMIT).unwrap().lines;
    let folder = tempfile::tempdir().unwrap();
    let log = folder.path().join("bench.log");
    let compare = |image: &std::path::Path, text: &str| {
        std::fs::write(&log, text).unwrap();
        let program = env!("CARGO_BIN_EXE_lab");
        Command::new(program).arg("longest-path").arg(image).arg("--counted").arg(&log).arg("--json").output().unwrap()
    };
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    let output = compare(&image.path, &format!("a terminal's own line\n{text}"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Vec<serde_json::Value> = serde_json::from_slice(&output.stdout).unwrap();
    let kernels: Vec<_> = found.iter().filter(|one| one["bench"].as_str().unwrap().starts_with("kernel/")).collect();
    // 19 for every core, 12 for the floating-point unit
    assert_eq!(kernels.len(), 31);
    assert!(kernels.iter().all(|one| one["counted"] == one["bounds"]), "{kernels:?}");
    let data = kernels.iter().find(|one| one["bench"] == "kernel/data").unwrap();
    assert_eq!(data["counted"], serde_json::json!([64, 64]));

    // as if in cycles: what no core can do is found, in both directions
    let cycles = |count: u64| {
        let mut line = lines.iter().find(|line| line["bench"] == "kernel/data").unwrap().clone();
        line["unit"] = "cycles".into();
        (line["min"], line["max"]) = (count.into(), count.into());
        compare(&image.path, &line.to_string())
    };
    for (count, fits) in [(63, false), (64, true), (65, false)] {
        assert_eq!(cycles(count).status.success(), fits, "{count}");
    }
    let on_board = build(variant, NUCLEO, Program::Bench, |_| {}).unwrap();
    let other = compare(&on_board.path, &text);
    let message = String::from_utf8_lossy(&other.stderr).into_owned();
    assert_eq!(other.status.code(), Some(2), "{message}");
    assert!(message.contains("the image has no function at"), "{message}");
    let cut = compare(&image.path, &text[..text.len() - 2]);
    assert_eq!(cut.status.code(), Some(2), "{}", String::from_utf8_lossy(&cut.stderr));
}

/// What a linker may decide is where a function and a table lie; the tick's code is else the same, halfword for
/// halfword, on the board with a motor and in QEMU on the same core, and so are the tables that it reads and the
/// drive's constants.
#[test]
fn the_tick_on_the_board_with_a_motor_is_the_tick_in_qemu() {
    let in_qemu = build(ON_NUCLEO, board("m4f").unwrap(), Program::ControlLoop, |_| {}).unwrap();
    let on_board = build(ON_NUCLEO, NUCLEO, Program::Nucleo, |_| {}).unwrap();
    let [qemu, nucleo] = [&in_qemu, &on_board].map(|image| tick_code(&image.path).unwrap());
    assert_eq!(qemu[0].name, "driveline_tick");
    for (here, there) in qemu.iter().zip(&nucleo) {
        let bytes: usize = here.referents.iter().map(|referent| referent.bytes.len()).sum();
        println!(
            "{}: {} bytes, {} addresses, {bytes} bytes of tables",
            here.name,
            2 * here.code.len(),
            here.referents.len()
        );
        assert_eq!(here, there);
    }
    assert_eq!(qemu.len(), nucleo.len());
    // what the comparison can see: another variant's tick is another
    let other = build("hoist/f32/rigid/10000", board("m4f").unwrap(), Program::ControlLoop, |_| {}).unwrap();
    assert_ne!(tick_code(&other.path).unwrap()[0].code, qemu[0].code);
}

/// The stack of the board with a motor lies below its variables, at the bottom of the memory: it cannot grow into one.
#[test]
fn the_stack_of_the_board_with_a_motor_ends_where_the_memory_ends() {
    let image = build(ON_NUCLEO, NUCLEO, Program::Nucleo, |_| {}).unwrap();
    let bytes = std::fs::read(&image.path).unwrap();
    let file = object::File::parse(&*bytes).unwrap();
    let address = |name: &str| file.symbols().find(|symbol| symbol.name() == Ok(name)).unwrap().address();
    // RM0440, 2.2.2: SRAM1 begins here, and below it there is nothing that can be written
    assert_eq!(address("_stack_end"), 0x2000_0000);
    assert_eq!(address("_stack_start"), address("_stack_end") + 24 * 1024);
    for variables in ["__sdata", "__sbss"] {
        assert!(address(variables) >= address("_stack_start"), "{variables}");
    }
    // the handler of faults pushes nothing: the addresses of TIM1_BDTR and of TAMP_BKP0R, the mark that the next start
    // reads there; then MOE is cleared and the mark written for ever (Arm DDI 0403E, A7.7)
    let text = file.section_by_name(".text").unwrap();
    let handler = text.data_range(address("HardFault") & !1, 36).unwrap().unwrap();
    let code: Vec<u16> = handler.chunks_exact(2).map(|two| u16::from_le_bytes([two[0], two[1]])).collect();
    let registers = [0xf642, 0x4044, 0xf2c4, 0x0001, 0xf242, 0x5200, 0xf2c4, 0x0200, 0xf240, 0x0301, 0xf6c1, 0x531e];
    let cleared = [0x6801, 0xf421, 0x4100, 0x6001, 0x6013, 0xe7f9];
    assert_eq!(code, [&registers[..], &cleared[..]].concat());
    // and the core starts there: the first word of the vectors
    let vectors = file.section_by_name(".vector_table").unwrap();
    let first = vectors.data_range(vectors.address(), 4).unwrap().unwrap();
    assert_eq!(u64::from(u32::from_le_bytes(first.try_into().unwrap())), address("_stack_start"));
}

/// The book has the bounds of the whole interrupt of that board, as its command prints them.
#[test]
fn the_interrupt_of_the_board_with_a_motor_is_as_long_as_the_book_says() {
    let image = build(ON_NUCLEO, NUCLEO, Program::Nucleo, |_| {}).unwrap();
    let page = include_str!("../../../../doc/makers/boards.md");
    let line = page.lines().find(|line| line.starts_with("cargo lab longest-path") && line.contains("TIM6_DAC"));
    let arguments = line.unwrap().split_whitespace().skip(4);
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    let output = command.args(["longest-path", "--json"]).arg(&image.path).args(arguments).output().unwrap();
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let (cycles, bound) = (&found["cycles"], [&found["instructions"], &found["stack"]]);
    let [instructions, stack] = bound;
    let (least, most) = (&cycles["least"], &cycles["most"]);
    let sentence = format!("{instructions} instructions, {stack} bytes of stack, and {least} to {most} cycles");
    assert!(page.split_whitespace().collect::<Vec<_>>().join(" ").contains(&sentence), "{sentence}");
}
