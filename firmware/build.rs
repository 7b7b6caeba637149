//! Selects the board of an image for the compiler, and its memory layout for the linker.
//!
//! `DRIVELINE_BOARD`: a name from `src/board.rs`; where it is not set, the board that goes with the compiler's target.
//! `DRIVELINE_VARIANT` is read by the binaries alone (`selected!`).

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The board that feature `nucleo-g474re` is for.
const NUCLEO: &str = "nucleo-g474re";

fn main() {
    let nucleo = env::var_os("CARGO_FEATURE_NUCLEO_G474RE").is_some();
    let target = env::var("TARGET").expect("cargo sets TARGET for build scripts");
    let default = if nucleo { NUCLEO } else { default_board(&target) };
    let board = env::var("DRIVELINE_BOARD").unwrap_or_else(|_| default.into());
    println!("cargo::rerun-if-env-changed=DRIVELINE_BOARD");
    println!("cargo::rustc-check-cfg=cfg(driveline_board, values(any()))");
    println!("cargo::rustc-cfg=driveline_board={board:?}");

    if target.starts_with("riscv") {
        let map = boards().join("virt.x");
        println!("cargo::rerun-if-changed={}", map.display());
        println!("cargo::rustc-link-arg-bins=-T{}", map.display());
    }
    if target.starts_with("thumb") {
        memory_map(&board);
        if env::var_os("CARGO_FEATURE_DEFMT").is_some() {
            println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
        }
    }
}

/// The board that QEMU offers for a target: a core with an FPU, or one without.
fn default_board(target: &str) -> &'static str {
    match target {
        _ if target.starts_with("riscv") => "virt",
        _ if target.ends_with("eabihf") => "mps2-an386",
        _ => "mps2-an385",
    }
}

/// Puts the board's memory map where the linker finds it as `board.x`, which `memory.x` includes.
fn memory_map(board: &str) {
    let boards = boards();
    let own = boards.join(format!("{}.x", board.replace('-', "_")));
    let map = if own.exists() { own } else { boards.join("mps2.x") };
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    copy(&map, &out.join("board.x"));
    // the repository's, which its README names
    let memory = boards.join("../../../memory.x");
    copy(&memory, &out.join("memory.x"));
    println!("cargo::rerun-if-changed={}", map.display());
    println!("cargo::rerun-if-changed={}", memory.display());
    println!("cargo::rustc-link-search={}", out.display());
}

/// The folder of the boards.
fn boards() -> PathBuf {
    PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR")).join("src/board")
}

fn copy(from: &Path, to: &Path) {
    if let Err(error) = fs::copy(from, to) {
        panic!("the memory map {} could not be copied to {}: {error}", from.display(), to.display());
    }
}
