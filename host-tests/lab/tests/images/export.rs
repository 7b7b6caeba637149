//! The library for C against the drive in Rust, over a run of the hoist: on the host under sanitizers, in QEMU with its
//! instructions.
//!
//! `export/hoist.rs` is the machine that `export` writes for `machines/hoist.toml`. After a change of what is written,
//! `DRIVELINE_EMIT=1 cargo test -p cargo-driveline --test images export` writes it anew.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output as Ended};

use driveline::configure::{Configure, Machine};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::number::Fixed;
use driveline::observer::{GearedObserver, SemiImplicitObserver, Stiction};
use driveline_closed_loop::lockstep;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_firmware::scene::composed::OverWords;
use driveline_firmware::scene::{Input, Output};
use driveline_lab::check::skip;
use driveline_lab::drivetrains::hoist as scene;
use driveline_qemu::link::Emulator;
use driveline_qemu::setup::cargo;
use object::read::archive::ArchiveFile;
use object::{Object, ObjectSymbol};
use tempfile::TempDir;

use super::packages;

#[rustfmt::skip]
#[path = "export/hoist.rs"]
pub mod hoist;

type HoistDrive<N> = Drive<N, GearedObserver<SemiImplicitObserver>, SpeedLoop>;

/// The drive in Rust.
struct InRust<D: OverWords>(D, ConfigOf<D>);

impl<D: OverWords> Ticks for InRust<D> {
    fn tick(&mut self, input: &Input) -> std::io::Result<Output> {
        Ok(self.0.advance(&self.1, input))
    }
}

/// Inputs and outputs of the drive in Rust, in closed loop with the full solver of the hoist: a start with the load
/// hanging, half a load more, lowering.
pub fn run<N: Stiction>(words: Words) -> Vec<(Input, Output)>
where
    HoistDrive<N>: Configure<hoist::Hoist, N, Config = ConfigOf<HoistDrive<N>>>,
{
    let machine = scene::machine().unwrap();
    let units = Units::new(words, hoist::Hoist::BASES);
    let config = <HoistDrive<N> as Configure<hoist::Hoist, N>>::CONFIG;
    let mut drive = InRust(HoistDrive::<N>::new(&config, 0), config);
    let trace = lockstep::run(&machine, &machine.scenarios[0], &units, hoist::Hoist::RATE_HZ, &mut drive, |_| ());
    let words = trace.unwrap().words;
    assert!(words.len() > 100_000, "{} ticks", words.len());
    words
}

/// The file that the machine in Rust is written from.
pub const MACHINE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../command/machines/hoist.toml");
const TESTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/images/export");

/// The library as `export` writes it, in a folder of its own.
struct Exported {
    folder: TempDir,
    target: Option<&'static str>,
}

impl Exported {
    fn new(core: &str, number: &str, target: Option<&'static str>) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("hoist");
        let ended = Command::new(env!("CARGO_BIN_EXE_lab"))
            .args(["export", "c", MACHINE, "--core", core, "--number", number, "--out"])
            .arg(&out)
            .output()
            .unwrap();
        ended_well(&ended);
        Exported { folder, target }
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join("hoist").join(name)
    }

    /// Runs the inputs through a program that reads `input` and writes `output` in a folder.
    fn run(&self, command: &mut Command, run: &[(Input, Output)]) -> Vec<[u32; 8]> {
        fs::write(self.folder.path().join("input"), words(run)).unwrap();
        ended_well(&command.current_dir(self.folder.path()).output().unwrap());
        rows(&fs::read(self.folder.path().join("output")).unwrap())
    }

    /// The drive in Rust as a static library, compiled of the same machine.
    fn beside(&self) -> PathBuf {
        fs::copy(format!("{TESTS}/beside.rs"), self.file("rust/src/c.rs")).unwrap();
        let mut command = Command::new(cargo());
        command
            .args(["build", "--release", "--quiet"])
            .args(self.target.iter().flat_map(|target| ["--target", target]));
        // of the folder that the crate lies in, whatever the caller of the tests has chosen for them
        command.env_remove("CARGO_TARGET_DIR");
        ended_well(&command.current_dir(self.file("rust")).output().unwrap());
        self.file("rust/target").join(self.target.unwrap_or("")).join("release/libhoist.a")
    }
}

/// The inputs as a file.
pub fn words(run: &[(Input, Output)]) -> Vec<u8> {
    let words = |input: &Input| {
        let Input { angle, torque, setpoint, flags, vibration, asked } = *input;
        [angle, torque, setpoint, flags, vibration[0], vibration[1], asked[0], asked[1]].map(u32::to_le_bytes)
    };
    run.iter().flat_map(|(input, _)| words(input)).flatten().collect()
}

/// Rows of eight words of a file.
pub fn rows(bytes: &[u8]) -> Vec<[u32; 8]> {
    let word = |bytes: &[u8]| u32::from_le_bytes(bytes.try_into().unwrap());
    bytes.chunks_exact(32).map(|row| std::array::from_fn(|at| word(&row[4 * at..4 * at + 4]))).collect()
}

#[track_caller]
pub fn ended_well(ended: &Ended) {
    let said = [&ended.stdout, &ended.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert!(ended.status.success(), "{}\n{}", ended.status, said.join("\n"));
}

/// The outputs in C, without their instructions, are those in Rust.
#[track_caller]
pub fn same_bits(rows: &[[u32; 8]], run: &[(Input, Output)]) {
    assert_eq!(rows.len(), run.len());
    for (tick, (row, (_, o))) in rows.iter().zip(run).enumerate() {
        let expected = [o.torque, o.motor_speed, o.shaft_torque, o.load_speed, o.load_torque, o.faults];
        assert_eq!(row[..6], expected, "tick {tick}");
    }
}

#[test]
fn the_machine_that_is_written_is_the_one_that_is_compared() {
    let exported = Exported::new("host", "f32", None);
    let written = fs::read_to_string(exported.file("rust/src/machine.rs")).unwrap();
    if std::env::var_os("DRIVELINE_EMIT").is_some() {
        fs::write(format!("{TESTS}/hoist.rs"), &written).unwrap();
    }
    assert_eq!(written, fs::read_to_string(format!("{TESTS}/hoist.rs")).unwrap());
}

/// Whether a compiler is there and links a program with these flags; else it is said.
fn links(compiler: &str, flags: &[&str]) -> bool {
    let folder = tempfile::tempdir().unwrap();
    let (source, program) = (folder.path().join("empty.c"), folder.path().join("empty"));
    fs::write(&source, "int main(void) { return 0; }\n").unwrap();
    let ended = Command::new(compiler).args(flags).arg(source).arg("-o").arg(program).output();
    let linked = ended.is_ok_and(|ended| ended.status.success());
    if !linked {
        skip(format!("{compiler} with {} is not there", flags.join(" ")));
    }
    linked
}

/// Every warning an error, and under sanitizers; `host.c` makes every wrong call first. Clang's of addresses needs
/// another package; that of undefined behaviour ends the program by itself.
#[test]
fn the_library_on_the_host_gives_the_bits_of_rust() {
    let compilers: [(&str, &[&str]); 2] = [
        ("cc", &["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]),
        ("clang", &["-fsanitize=undefined", "-fsanitize-trap=all"]),
    ];
    let compilers = compilers.map(|(compiler, flags)| links(compiler, flags).then_some((compiler, flags)));
    for (number, words) in [("f32", Words::Single), ("fixed", Words::Fixed)] {
        let run = if number == "f32" { run::<f32>(words) } else { run::<Fixed>(words) };
        let exported = Exported::new("host", number, None);
        packages::build_on_the_host(&exported.file(""));
        for (name, sanitized) in compilers.into_iter().flatten() {
            let strict = ["-Wall", "-Wextra", "-Werror", "-O1", "-g"];
            let program = exported.folder.path().join("run");
            let mut compiler = Command::new(name);
            compiler.args(strict).args(sanitized).args(["-std=c11", "-I", TESTS, "-I"]).arg(exported.file(""));
            compiler.args(["run.c", "host.c"].map(|file| Path::new(TESTS).join(file)));
            compiler.arg(exported.file("libhoist.a")).arg("-o").arg(&program);
            ended_well(&compiler.output().unwrap());
            same_bits(&exported.run(&mut Command::new(&program), &run), &run);

            // the example: as C99 without extensions, and its run without a fault
            let example = exported.folder.path().join("example");
            let mut compiler = Command::new(name);
            compiler.args(strict).args(sanitized).args(["-std=c99", "-pedantic"]).arg(exported.file("main.c"));
            compiler.arg(exported.file("libhoist.a")).arg("-o").arg(&example);
            ended_well(&compiler.output().unwrap());
            let ended = Command::new(&example).output().unwrap();
            ended_well(&ended);
            let printed = String::from_utf8(ended.stdout).unwrap();
            // whole numbers, cut off: the largest speed is 155 rad/s
            let fast = printed.contains("motor 154 rad/s") || printed.contains("motor 155 rad/s");
            // and, by its exit code, four estimates within 1 % of rated
            assert!(fast && printed.contains("faults: none\n"), "{name}: {printed}");
        }
    }
}

/// The library has one object, which needs nothing of Rust and has none of the parts that were not asked for. Every
/// package around it builds.
#[test]
fn the_library_holds_the_drive_alone() {
    for core in ["m0plus", "m3", "m4f", "m7", "m33"] {
        let number = if matches!(core, "m0plus" | "m3") { "fixed" } else { "f32" };
        let exported = Exported::new(core, number, None);
        packages::build_for_arm(&exported.file(""));
        let bytes = fs::read(exported.file("libhoist.a")).unwrap();
        let members: Vec<_> = ArchiveFile::parse(&*bytes).unwrap().members().map(Result::unwrap).collect();
        assert_eq!(members.len(), 1, "{core}");
        let file = object::File::parse(members[0].data(&*bytes).unwrap()).unwrap();
        let symbols: Vec<_> =
            file.symbols().filter_map(|symbol| Some((symbol.name().ok()?, symbol.is_undefined()))).collect();
        for (name, is_undefined) in symbols.iter().filter(|(name, _)| !name.is_empty()) {
            for part in ["panic", "core3fmt", "fluctuation", "Extremes", "Phasors", "telemetry"] {
                assert!(!name.contains(part), "{core}: {name}");
            }
            // the run-time ABI of Arm, which every C compiler for it brings
            assert!(!is_undefined || name.starts_with("__aeabi_"), "{core}: {name}");
            // a tick copies nothing: on the cores with all instructions it calls no helper at all
            assert!(!is_undefined || core == "m0plus", "{core}: {name}");
        }
        assert!(symbols.iter().any(|(name, _)| *name == "hoist_tick"), "{core}");
    }
}

/// The linker of the Rust toolchain, under the name by which clang takes it for one of ELF.
fn linker() -> PathBuf {
    let sysroot = Command::new("rustc").args(["--print", "sysroot"]).output().unwrap();
    let libraries = Path::new(String::from_utf8(sysroot.stdout).unwrap().trim()).join("lib/rustlib");
    libraries.join(format!("{}-unknown-linux-gnu/bin/gcc-ld/ld.lld", std::env::consts::ARCH))
}

/// In QEMU, compiled by GCC and by clang for Arm: the same bits, and the instructions of the interface beside those of
/// the drive called from Rust in the same image.
#[test]
fn the_library_in_qemu_gives_the_bits_of_rust_and_takes_few_instructions_more() {
    let Some(emulator) = Emulator::find() else {
        skip("QEMU for Arm is not there");
        return;
    };
    let there = |name: &&str| {
        let is_there = Command::new(name).arg("--version").output().is_ok();
        if !is_there {
            skip(format!("{name} is not on the path"));
        }
        is_there
    };
    let compilers: Vec<&str> = ["arm-none-eabi-gcc", "clang"].into_iter().filter(there).collect();
    if compilers.is_empty() {
        return;
    }
    let m4f = ["-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"];
    for (core, number, target, machine, flags) in [
        ("m4f", "f32", "thumbv7em-none-eabihf", "mps2-an386", &m4f[..]),
        ("m3", "fixed", "thumbv7m-none-eabi", "mps2-an385", &["-mcpu=cortex-m3"][..]),
    ] {
        let run = if number == "f32" { run::<f32>(Words::Single) } else { run::<Fixed>(Words::Fixed) };
        let exported = Exported::new(core, number, Some(target));
        let beside = exported.beside();
        for name in &compilers {
            let image = exported.folder.path().join("run.elf");
            let mut compiler = Command::new(name);
            if *name == "clang" {
                // its names for an ABI; what GCC's library has is in the Rust drive's
                let abi = if core == "m4f" { "eabihf" } else { "eabi" };
                compiler.arg(format!("--target=arm-none-{abi}")).arg(format!("--ld-path={}", linker().display()));
            }
            compiler.args(flags).args([
                "-mthumb",
                "-O2",
                "-std=gnu11",
                "-Wall",
                "-Wextra",
                "-Werror",
                "-ffreestanding",
            ]);
            compiler.args(["-nostdlib", "-Wl,--gc-sections", "-DBESIDE", "-I", TESTS, "-I"]);
            compiler.arg(exported.file("")).arg("-T").arg(format!("{TESTS}/qemu.ld"));
            compiler.args(["run.c", "qemu.c"].map(|file| Path::new(TESTS).join(file)));
            compiler.arg(exported.file("libhoist.a")).arg(&beside).arg("-o").arg(&image);
            ended_well(&compiler.output().unwrap());
            let mut qemu = emulator.command();
            qemu.args(["-machine", machine, "-display", "none", "-monitor", "none", "-serial", "none"]);
            // as firmware/src/board/cmsdk_timer.rs counts: an instruction is 2^10 ns
            qemu.args(["-icount", "shift=10,align=off,sleep=off", "-semihosting-config", "enable=on,target=native"]);
            let rows = exported.run(qemu.arg("-kernel").arg(&image), &run);
            same_bits(&rows, &run);
            let ticks = || rows.iter().zip(&run).filter(|(_, (input, _))| input.flags & Input::RELEASED != 0);
            let largest = |at: usize| ticks().map(|(row, _)| row[at] as i32).max().unwrap();
            println!("{name}, {core}: at most {} instructions a tick, {} more than in Rust", largest(6), largest(7));
            assert!(largest(7) <= 10, "{name}, {core}: {} instructions more", largest(7));
        }
    }
}
