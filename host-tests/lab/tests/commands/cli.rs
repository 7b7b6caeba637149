//! The command line as a user meets it: results, faults, exit codes, JSON.

use std::process::{Command, Output, Stdio};

fn driveline(arguments: &[&str]) -> Output {
    let folder = env!("CARGO_TARGET_TMPDIR");
    Command::new(env!("CARGO_BIN_EXE_lab")).args(arguments).current_dir(folder).output().unwrap()
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn json(text: &str) -> serde_json::Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

const HOIST: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../command/machines/hoist.toml");

/// What the constants leave out of a file is said beneath them.
#[test]
fn constants_without_tolerances_and_actuator_say_so() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("own.toml");
    let hoist = std::fs::read_to_string(HOIST).unwrap();
    assert!(!hoist.contains("[tolerance]") && !hoist.contains("[actuator]"));
    std::fs::write(&file, format!("{hoist}\n[tolerance]\nstiffness = 0.1\n[actuator]\ndelay = 1e-4\n")).unwrap();
    let rust = out(&driveline(&["design", file.to_str().unwrap(), "--emit", "rust"]));
    assert!(rust.contains("\n// Not among these: the actuator, the tolerances; `cargo driveline new`"), "{rust}");
}

/// Viscous damping stands in the table of the parts where there is some; what it keeps from vibrating is said.
#[test]
fn viscous_damping_is_shown() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("viscous.toml");
    let hoist = std::fs::read_to_string(HOIST).unwrap();
    let shown = |viscous: &str| {
        std::fs::write(&file, hoist.replace("inertia = 0.62", &format!("inertia = 0.62{viscous}"))).unwrap();
        let page = folder.path().join("page.html");
        let tables = out(&driveline(&["modes", file.to_str().unwrap(), "--html", page.to_str().unwrap()]));
        tables + &std::fs::read_to_string(page).unwrap()
    };
    let (without, some, much) = (shown(""), shown("\nviscous = 0.375"), shown("\nviscous = 1e5"));
    assert!(!without.contains("viscous") && !without.contains("decay without vibration"), "{without}");
    assert!(some.contains("viscous N m s/rad") && some.contains("0.375"), "{some}");
    // what coasts against the ground does not swing
    assert!(some.contains("decay without vibration") && much.contains("decay without vibration"), "{much}");
}

/// Nothing damps the ship's upper vibration, which the two masses leave out: no margins, a reason, and no constants.
#[test]
fn an_unstable_loop_is_said_and_not_emitted() {
    let ship = concat!(env!("CARGO_MANIFEST_DIR"), "/../command/machines/ship.toml");
    let designed = driveline(&["design", ship, "--json"]);
    assert_eq!(designed.status.code(), Some(1), "{}", err(&designed));
    let plan = json(&out(&designed));
    assert!(plan["speed_loop"]["margins"].is_null());
    assert!(plan["speed_loop"]["no_margins"].as_str().unwrap().contains("damping"), "{plan}");
    assert!(plan["predicted"]["lack"].as_str().unwrap().contains("damping"), "{plan}");
    // margins of the two masses would say that the loop is sound
    assert!(plan["speed_loop"]["least_margins"].is_null() && plan["speed_loop"]["not_robust"].is_string(), "{plan}");
    let designed = driveline(&["design", ship]);
    assert!(designed.status.code() == Some(1) && err(&designed).contains("no margins"), "{}", err(&designed));
    let shown = out(&designed);
    assert!(shown.contains("margins: none: the speed loop") && !shown.contains("within tolerances"), "{shown}");
    let emitted = driveline(&["design", ship, "--emit", "rust"]);
    assert_eq!((emitted.status.code(), out(&emitted).as_str()), (Some(1), ""));
    assert!(err(&emitted).contains("no constants are printed"), "{}", err(&emitted));
    let hoist = out(&driveline(&["design", HOIST]));
    assert!(hoist.contains("margins within tolerances") && !hoist.contains("none"), "{hoist}");
}

#[test]
fn a_fault_in_a_file_ends_with_2_and_shows_the_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bad.toml");
    std::fs::write(&file, std::fs::read_to_string(HOIST).unwrap().replace("ratio = 31.5", "ratio = 0.0")).unwrap();
    for command in ["modes", "design"] {
        let output = driveline(&[command, file.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2));
        assert!(out(&output).is_empty());
        let shown = err(&output);
        assert!(shown.starts_with("error: ") && shown.contains("`element[3].ratio`: found 0.0, expected"), "{shown}");
        assert!(shown.contains("^^^"), "{shown}");
    }
    let output = driveline(&["modes", file.to_str().unwrap(), "--json"]);
    assert_eq!(output.status.code(), Some(2));
    let fault = json(&err(&output));
    assert!(fault["error"].as_str().unwrap().contains("element[3].ratio"));
    assert_eq!(fault["at"]["key"], "element[3].ratio");
}

#[test]
fn wrong_arguments_end_with_2() {
    for arguments in [&["nothing"][..], &["modes"], &["modes", HOIST, "--loud"], &["design", HOIST, "--emit", "c"]] {
        let output = driveline(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!err(&output).is_empty() && out(&output).is_empty());
    }
    let output = driveline(&["modes", "--json", "--loud"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(json(&err(&output))["error"].as_str().unwrap().contains("--loud"));
    // what the parser lists below its first line
    let output = driveline(&["export", "c", "--json"]);
    let error = json(&err(&output))["error"].as_str().unwrap().to_owned();
    assert_eq!(error, "the following required arguments were not provided: --out <PATH>, --core <CORE>, <FILE>");
}

/// Who names a variant or a source that is not there is shown what there is, in the words that the option takes.
#[test]
fn a_wrong_name_is_answered_with_the_right_ones() {
    for (arguments, there) in [
        (&["run", "--variants", "nothing"][..], "fixed/m3/reduced/10000"),
        (&["watch", "--qemu", "nothing"], "hoist/f32/reduced/10000"),
        (&["watch", "--qemu", "hoist/f32/reduced/10000", "--core", "m7"], "m4f"),
        (&["watch"], "--qemu VARIANT"),
    ] {
        let output = driveline(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(err(&output).contains(there), "{arguments:?}: {}", err(&output));
    }
}

#[test]
fn a_page_that_cannot_be_written_is_found_before_anything_runs() {
    // A file stands where the folder should be.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    std::fs::write(&file, "kept").unwrap();
    let page = file.join("page.html");
    let output = driveline(&["run", "--html", page.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("file is not a folder") && !err(&output).contains("building"));
    assert_eq!(std::fs::read_to_string(file).unwrap(), "kept");
    // A folder in which nobody can make a file.
    if cfg!(target_os = "linux") {
        let output = driveline(&["run", "--html", "/proc/page.html"]);
        assert_eq!(output.status.code(), Some(1));
        assert!(err(&output).contains("page.html cannot be written") && !err(&output).contains("building"));
    }
}

/// Where nothing can be written, not even by root, the figures are printed all the same, and the failure is said.
#[test]
#[cfg(target_os = "linux")]
fn figures_are_printed_where_no_page_can_be_written() {
    for (arguments, folder) in
        [(vec!["modes", HOIST], "/proc"), (vec!["modes", HOIST, "--html", "/proc/page.html"], ".")]
    {
        let program = env!("CARGO_BIN_EXE_lab");
        let output = Command::new(program).args(&arguments).current_dir(folder).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        assert!(err(&output).contains("cannot be written"), "{}", err(&output));
        let there = driveline(&["modes", HOIST, "--json"]);
        assert!(out(&output).lines().count() > 10 && there.status.success(), "{}", out(&output));
    }
}

#[test]
fn design_warns_of_a_machine_that_two_masses_do_not_stand_for() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("three.toml");
    let text = std::fs::read_to_string(HOIST).unwrap();
    let settings = &text[text.find("[encoder]").unwrap()..];
    // A light motor before two heavy masses: ten elevenths of a blow to it go into the second mode.
    let mass = |kind: &str, inertia: f64| format!("[[element]]\nkind = \"{kind}\"\ninertia = {inertia:?}\n");
    let shaft = |stiffness: f64| format!("[[element]]\nkind = \"shaft\"\nstiffness = {stiffness:?}\n");
    let (motor, first, second) = (mass("motor", 0.1), mass("rotor", 1.0), mass("rotor", 1.0));
    let (stiff, soft) = (shaft(1e5), shaft(10.0));
    std::fs::write(&file, format!("name = \"three\"\n{motor}{stiff}{first}{soft}{second}{settings}")).unwrap();
    assert!(out(&driveline(&["design", file.to_str().unwrap()])).contains("warning: two masses are a poor model"));
    assert!(!out(&driveline(&["design", HOIST])).contains("warning"));
}

#[test]
fn design_warns_of_a_weight_that_the_motor_does_not_hold() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("weak.toml");
    // the weight is 747 N m
    let text = std::fs::read_to_string(HOIST).unwrap().replace("torque = 1350.0 ", "torque = 700.0 ");
    std::fs::write(&file, text).unwrap();
    let design = out(&driveline(&["design", file.to_str().unwrap()]));
    assert!(design.contains("warning: the weight of 747 N m at the motor is not held by `limits.torque`, 700 N m"));
}

#[test]
fn a_word_of_c_is_no_name_of_a_drive_in_c() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("drive");
    let command = ["export", "c", HOIST, "--core", "host", "--out", out.to_str().unwrap(), "--name", "int"];
    let output = driveline(&command);
    assert_eq!(output.status.code(), Some(2), "{}", err(&output));
    assert!(err(&output).contains("`int` is a word of C or C++"), "{}", err(&output));
    assert!(!out.exists());
}

#[test]
fn an_image_that_is_no_elf_is_refused_before_qemu_starts() {
    let output = driveline(&["qemu", "mps2-an386", HOIST]);
    assert_eq!(output.status.code(), Some(2), "{}", err(&output));
    assert!(err(&output).contains("hoist.toml is no ELF file"), "{}", err(&output));
}

/// What builds firmware of the repository says that it needs a clone.
#[test]
fn outside_a_clone_the_firmware_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for command in [&["run"][..], &["report"], &["check"]] {
        let mut lab = Command::new(env!("CARGO_BIN_EXE_lab"));
        let output = lab.args(command).current_dir(folder.path()).env_remove("CARGO_TARGET_DIR").output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{command:?}");
        assert!(err(&output).contains("needs a clone of driveline's repository"), "{command:?}: {}", err(&output));
    }
}

#[test]
fn a_result_and_standard_output_do_not_share_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("both");
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    let to_file = std::fs::File::create(&file).unwrap();
    let output = command.args(["modes", HOIST, "--html"]).arg(&file).stdout(to_file).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("is where standard output goes"), "{}", err(&output));
}

#[test]
fn a_folder_is_not_made_for_a_typo() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("reprot/page.html");
    let output = driveline(&["modes", HOIST, "--html", page.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("reprot; make it, or name another"), "{}", err(&output));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_number_below_zero_is_a_wrong_value_and_no_unknown_option() {
    let output = driveline(&["campaign", "spindle", "--draws", "-1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("invalid value '-1' for '--draws <DRAWS>'"), "{}", err(&output));
}

#[test]
fn what_cannot_be_printed_is_shown_by_a_mark() {
    let page = "--html=/no\u{1b}[2J/page";
    for arguments in [&["modes", "no\u{1b}[2J.toml"][..], &["no\u{7}", "x"], &["modes", HOIST, page]] {
        let output = driveline(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let said = err(&output);
        // of a word that it does not know the parser prints what can be printed
        assert!(said.contains('\u{fffd}') || arguments[0] != "modes", "{said:?}");
        assert!(!said.contains(|c: char| c.is_control() && c != '\n'), "{said:?}");
    }
}

/// A pipe gives its text once: nothing is read twice.
#[test]
fn a_machine_comes_through_a_pipe() {
    const TILTING: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../command/trains/tilting.toml");
    for (command, file) in [("modes", HOIST), ("modes", TILTING), ("design", HOIST), ("simulate", TILTING)] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_lab"))
            .args([command, "/dev/stdin", "--json"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), &std::fs::read(file).unwrap()).unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{command} {file}: {}", err(&output));
        assert!(json(&out(&output)).is_object(), "{command} {file}");
    }
}
