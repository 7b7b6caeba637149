//! The library for C: written as a crate, compiled, and handed over with its header.

use serde::Serialize;

use super::archive::DriveObject;
use super::build::build;
use super::core::{Arm, Core, Qemu};
use super::interface::{Fault, REFUSALS, Refusal, faults, version};
use crate::cli::Failure;
use crate::cli::project::{Project, fill};

/// Inputs of the templates. What the compiler decides is zero in those of the crate.
#[derive(Debug, Serialize)]
struct Values<'p> {
    #[serde(flatten)]
    project: &'p Project,
    interface: &'static str,
    of: &'static str,
    core: String,
    core_name: &'static str,
    flags: &'static str,
    header: String,
    refusals: [Refusal; 6],
    faults: Vec<Fault>,
    size: u32,
    align: u32,
    word: &'static str,
    torque_base: String,
    speed_base: String,
    version: &'static str,
    arm: Option<Arm>,
    qemu: Option<Qemu>,
}

/// Files for every core, by their templates; `NAME` in a path is the drive's.
const FILES: [(&str, &str); 8] = [
    ("NAME.h", "c/header.h"),
    ("NAME.hpp", "c/header.hpp"),
    ("NAME-config.cmake", "c/config.cmake"),
    ("NAME-config-version.cmake", "c/config-version.cmake"),
    ("NAME.mk", "c/make"),
    ("Makefile", "c/Makefile"),
    ("main.c", "c/main.c"),
    ("README.md", "c/README.md"),
];

/// Files for a core of Arm: QEMU, Zephyr, PlatformIO, Arduino, CMSIS-Pack.
const FOR_ARM: [(&str, &str); 8] = [
    ("qemu/startup.c", "c/qemu/startup.c"),
    ("qemu/memory.ld", "c/qemu/memory.ld"),
    ("zephyr/module.yml", "c/zephyr/module.yml"),
    ("zephyr/CMakeLists.txt", "c/zephyr/CMakeLists.txt"),
    ("zephyr/Kconfig", "c/zephyr/Kconfig"),
    ("library.json", "c/library.json"),
    ("library.properties", "c/library.properties"),
    ("driveline.NAME.pdsc", "c/pack.pdsc"),
];

/// The files of a library, by their paths, and the bytes of a drive's state.
#[derive(Debug)]
pub struct Library {
    /// The files.
    pub files: Vec<(String, Vec<u8>)>,
    /// Bytes of a drive's state.
    pub state: u32,
    /// Functions that the firmware's compiler brings.
    pub undefined: Vec<String>,
}

/// Compiles the drive of a machine, whose file has this text, for a core.
///
/// # Errors
/// The compiler's error, such as a speed loop that is not stable within its tolerances.
pub fn library(project: &Project, source: &str, core: Core) -> Result<Library, Failure> {
    let mut values = Values {
        project,
        interface: "c",
        of: "controller",
        core: core.key(),
        core_name: core.name(),
        flags: core.flags(),
        header: "0x0".into(),
        refusals: REFUSALS,
        faults: faults(),
        size: 0,
        align: 4,
        word: "uint32_t",
        torque_base: String::new(),
        speed_base: String::new(),
        version: env!("CARGO_PKG_VERSION"),
        arm: core.arm(),
        qemu: core.arm().map(|arm| arm.qemu),
    };
    // of all that the header and the library must agree on
    let texts = ["lib.rs", "machine.rs", "c/c.rs", "c/header.h"].map(|template| fill(template, &values));
    values.header = format!("0x{:08x}", version(&texts.each_ref().map(String::as_str)));
    let mut files: Vec<(String, Vec<u8>)> = [
        ("Cargo.toml", "c/Cargo.toml"),
        ("src/lib.rs", "lib.rs"),
        ("src/machine.rs", "machine.rs"),
        ("src/c.rs", "c/c.rs"),
    ]
    .map(|(path, template)| (format!("rust/{path}"), fill(template, &values).into_bytes()))
    .into();
    let archive = build(&files, core.target(), &format!("lib{}.a", project.krate), false)?;
    let object = DriveObject::find(&archive, &project.krate).map_err(Failure::failed)?;
    let reachable = format!("{}_panic_is_reachable", project.krate);
    if object.undefined.contains(&reachable) {
        return Err(Failure::failed("the drive of this machine could panic, and is not handed over: please report it"));
    }
    let [size, align, torque, speed] = object.layout;
    (values.size, values.align) = (size, align);
    values.word = if align == 8 { "uint64_t" } else { "uint32_t" };
    [values.torque_base, values.speed_base] = [torque, speed].map(|bits| format!("{:?}", f32::from_bits(bits)));
    let krate = &project.krate;
    let for_arm = values.arm.map_or(&[][..], |_| &FOR_ARM);
    files.extend(
        FILES
            .iter()
            .chain(for_arm)
            .map(|(path, template)| (path.replace("NAME", krate), fill(template, &values).into_bytes())),
    );
    files.push((format!("lib{krate}.a"), object.archive()));
    if let Some(arm) = values.arm {
        // Arduino looks for all of it in `src`
        files.push((format!("src/{}/lib{krate}.a", arm.folder), object.archive()));
        let header = |kind| (format!("src/{krate}.{kind}"), format!("#include \"../{krate}.{kind}\"\n").into_bytes());
        files.extend(["h", "hpp"].map(header));
    }
    files.push(("machine.toml".to_owned(), source.into()));
    Ok(Library { files, state: size, undefined: object.undefined })
}
