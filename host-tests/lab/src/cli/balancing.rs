//! `cargo lab run balanced-fan`, `surface-grinder`: a rotor balanced by its firmware in QEMU.

use serde_json::json;

use crate::balancing::{Ran, Scene, tables};
use crate::candidates::Candidate;
use crate::drivetrains::Variants;
use cargo_driveline::cli::setup::ready;
use cargo_driveline::cli::{Failure, Progress, say, say_json};
use driveline_qemu::setup::Need;

/// The seed is the same in every run.
const SEED: u64 = 1;

/// How a scene is run.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// Which variants.
    pub variants: Variants<'a>,
    /// JSON instead of tables.
    pub json: bool,
}

/// Balances a scene in some of its variants, prints tables or JSON.
///
/// # Errors
/// No such variant; what kept one from being balanced; a claim that was missed, a word that differs from the host's.
pub fn run(scene: &Scene, wanted: Wanted<'_>) -> Result<(), Failure> {
    let filter = if let Variants::Containing(filter) = wanted.variants { Some(filter) } else { None };
    let mut variants = scene.variants(filter);
    if matches!(wanted.variants, Variants::Chosen) {
        variants.retain(|&(variant, board)| Candidate { variant, board }.is_native());
    }
    if let (true, Some(filter)) = (variants.is_empty(), filter) {
        let there: Vec<_> =
            scene.variants(None).into_iter().map(|(variant, board)| Candidate { variant, board }.key()).collect();
        let sentence = format!("no variant of `{}` contains `{filter}`; there are {}", scene.name, there.join(", "));
        return Err(Failure::usage(sentence));
    }
    ready(&Need::to_run(variants.iter().map(|(_, board)| board)))?;
    let progress = Progress::of(variants.len() as u64);
    let mut all: Vec<Ran> = Vec::new();
    for (variant, board) in variants {
        let ran = scene.in_qemu(variant, board, SEED, &|text| progress.says(text));
        all.push(ran.map_err(|error| Failure::failed(error.to_string()))?);
        progress.step();
    }
    drop(progress);
    if wanted.json {
        say_json(&json!({ "scene": scene.name, "variants": all }))?;
    } else {
        for section in tables(&all) {
            say(section);
        }
    }
    verdict(&all)
}

/// Whether every variant kept what it had to show, with the same words as on the host.
fn verdict(all: &[Ran]) -> Result<(), Failure> {
    for ran in all {
        if let Some(claim) = ran.outcome.claims.iter().find(|claim| !claim.holds()) {
            let sentence = format!("{}: {} is {}, at most {}", ran.variant, claim.name, claim.measured, claim.limit);
            return Err(Failure::failed(sentence));
        }
        if !ran.same_on_host {
            return Err(Failure::failed(format!("{}: other words in QEMU than on the host", ran.variant)));
        }
    }
    Ok(())
}
