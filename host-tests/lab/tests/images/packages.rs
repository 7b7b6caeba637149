//! The packages around an exported library, each built as its tool would: CMake and Make by themselves, Zephyr,
//! PlatformIO, Arduino and CMSIS-Pack by a stub of what the tool reads.

use std::fs;
use std::path::Path;
use std::process::Command;

use driveline_lab::check::skip;
use driveline_qemu::link::Emulator;

use super::export::ended_well;

const STUBS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/images");

/// Whether programs are there; else it is said which is not.
fn are_there(programs: &[&str]) -> bool {
    let lacks = programs.iter().find(|name| Command::new(name).arg("--version").output().is_err());
    lacks.inspect(|name| skip(format!("{name} is not on the path"))).is_none()
}

/// The word after a key at the beginning of a line.
#[track_caller]
fn value(text: &str, key: &str) -> String {
    let line = text.lines().find_map(|line| line.trim().strip_prefix(key));
    line.unwrap_or_else(|| panic!("no {key} in {text}")).trim().to_owned()
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Configures and builds the application of `packages/CMakeLists.txt`.
fn cmake(folder: &Path, module: &str, toolchain: &[String]) {
    let build = tempfile::tempdir().unwrap();
    let mut configure = Command::new("cmake");
    configure.arg(format!("-DDRIVE={}", folder.display())).arg(format!("-DMODULE={module}")).args(toolchain);
    ended_well(&configure.args(["-S", &format!("{STUBS}/packages"), "-B"]).arg(build.path()).output().unwrap());
    ended_well(&Command::new("cmake").arg("--build").arg(build.path()).output().unwrap());
}

/// `make run` ends with the exit code of the example, which is 0 where all estimates are right.
fn make_run(folder: &Path, emulator: Option<&Emulator>) {
    let mut make = Command::new("make");
    make.arg("-C").arg(folder).arg("run");
    if let Some(command) = emulator.map(Emulator::command) {
        make.arg(format!("QEMU={}", command.get_program().to_string_lossy()));
        // one that `setup` installed finds its libraries by these
        make.envs(command.get_envs().filter_map(|(name, value)| Some((name, value?))));
    }
    let ended = make.output().unwrap();
    ended_well(&ended);
    let said = String::from_utf8_lossy(&ended.stdout).into_owned();
    assert!(said.contains("faults: none"), "{said}");
}

/// The packages of a library for this computer, and the glue of the book.
pub fn build_on_the_host(folder: &Path) {
    if are_there(&["cmake"]) {
        cmake(folder, "", &[]);
    }
    make_run(folder, None);
    let book = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../doc/c.md")).unwrap();
    let fences: Vec<(&str, &str)> = book
        .split("```cpp,")
        .skip(1)
        .map(|rest| rest.split_once('\n').unwrap())
        .map(|(name, rest)| (name, rest.split("```").next().unwrap()))
        .collect();
    assert_eq!(fences.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["simplefoc", "moteus", "odrive"]);
    for (name, listing) in fences {
        let file = folder.join(format!("{name}.cpp"));
        fs::write(&file, listing).unwrap();
        let strict =
            ["-std=c++17", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I", &format!("{STUBS}/glue"), "-I"];
        ended_well(&Command::new("c++").args(strict).arg(folder).arg(&file).output().unwrap());
        let begun = listing.split_once("// in the loop").unwrap().1;
        let lines = begun.lines().filter(|line| line.starts_with("    ") && line.trim() != "}").count();
        assert_eq!(lines, 3, "{name}: three lines of glue");
    }
}

/// The packages of a library for a core of Arm.
pub fn build_for_arm(folder: &Path) {
    if !are_there(&["arm-none-eabi-gcc", "make"]) {
        return;
    }
    let has_cmake = are_there(&["cmake"]);
    let core = value(&text(folder, "hoist.mk"), "HOIST_CORE :=");
    match Emulator::find() {
        Some(emulator) => make_run(folder, Some(&emulator)),
        None => skip("QEMU for Arm is not there"),
    }
    let toolchain = [
        "-DCMAKE_SYSTEM_NAME=Generic".to_owned(),
        "-DCMAKE_C_COMPILER=arm-none-eabi-gcc".to_owned(),
        "-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY".to_owned(),
        format!("-DCMAKE_C_FLAGS={core} --specs=nosys.specs"),
    ];
    if has_cmake {
        cmake(folder, "", &toolchain);
    }

    // Zephyr: what `west` reads of a module, then its folder of CMake
    let module = text(folder, "zephyr/module.yml");
    let [name, at, kconfig] = ["name:", "cmake:", "kconfig:"].map(|key| value(&module, key));
    assert_eq!(name, "hoist");
    if has_cmake {
        cmake(folder, &at, &toolchain);
    }
    let kconfig = text(folder, &kconfig);
    assert!(kconfig.starts_with("config HOIST\n\tbool ") && kconfig.contains("\tdepends on CPU_CORTEX_M"), "{kconfig}");

    let place = tempfile::tempdir().unwrap();
    let program = place.path().join("program");
    let compile = |compiler: &str, source: &Path, flags: &[String]| {
        let mut command = Command::new(compiler);
        command.args(core.split(' ')).args(["-Os", "-Wall", "-Wextra", "-Werror", "--specs=nosys.specs"]);
        command.args(["-Wl,--gc-sections", "-Wl,--no-warnings"]).arg(source).args(flags).arg("-o").arg(&program);
        ended_well(&command.current_dir(folder).output().unwrap());
    };

    // PlatformIO runs a library's flags in its folder
    let manifest: serde_json::Value = serde_json::from_str(&text(folder, "library.json")).unwrap();
    let list = manifest["build"]["flags"].as_array().unwrap();
    let flags: Vec<String> = list.iter().map(|flag| flag.as_str().unwrap().to_owned()).collect();
    assert!(folder.join(manifest["headers"].as_str().unwrap()).is_file());
    compile("arm-none-eabi-gcc", &folder.join("main.c"), &flags);

    // Arduino: headers in `src`, the library in the folder of the core and of the FPU that the flags name
    let properties = text(folder, "library.properties");
    assert_eq!(value(&properties, "precompiled="), "full");
    let flag = |key: &str| core.split(' ').find_map(|flag| flag.strip_prefix(key)).map(str::to_owned);
    let fpu = flag("-mfpu=").map(|fpu| format!("/{fpu}-{}", flag("-mfloat-abi=").unwrap())).unwrap_or_default();
    let sketch = place.path().join("sketch.cpp");
    let includes = value(&properties, "includes=");
    let calls = "int main() { static hoist_drive drive; return (int)hoist_init(&drive, hoist_from_turns(0.5)); }";
    fs::write(&sketch, format!("#include <{includes}>\n{calls}\n")).unwrap();
    let libraries = format!("-Lsrc/{}{fpu}", flag("-mcpu=").unwrap());
    compile("arm-none-eabi-g++", &sketch, &["-Isrc".into(), libraries, value(&properties, "ldflags=")]);

    // CMSIS-Pack: the files of its component
    let description = text(folder, "driveline.hoist.pdsc");
    let document = roxmltree::Document::parse(&description).unwrap();
    let files: Vec<_> = document.descendants().filter(|node| node.has_tag_name("file")).collect();
    let of = |category: &str| {
        let file = files.iter().find(|file| file.attribute("category") == Some(category));
        file.and_then(|file| file.attribute("name")).unwrap_or_else(|| panic!("no {category} in {description}"))
    };
    assert!(files.iter().all(|file| folder.join(file.attribute("name").unwrap()).exists()), "{description}");
    let required = document.descendants().find(|node| node.has_tag_name("require")).unwrap();
    let cpu = required.attribute("Dcore").unwrap().to_lowercase();
    assert_eq!(Some(cpu.replace('+', "plus")), flag("-mcpu="));
    assert_eq!(required.attribute("Dfpu") == Some("NO_FPU"), fpu.is_empty());
    compile("arm-none-eabi-gcc", &folder.join("main.c"), &[format!("-I{}", of("include")), of("library").into()]);
}
