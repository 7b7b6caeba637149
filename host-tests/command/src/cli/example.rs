//! `cargo driveline example`: files to begin with, which the program carries.

use clap::Args;

use super::{Failure, say, say_json};

/// Print a file to begin with: a machine, a train with its run, a rotor, readings for balancing, a recording.
///
/// Without a name, prints what there is.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo driveline example
  cargo driveline example hoist > hoist.toml
  cargo driveline modes hoist.toml")]
pub struct Example {
    /// Its name
    name: Option<String>,
    /// Print [{name, commands, about}], with a name {name, commands, about, text}
    #[arg(long)]
    pub json: bool,
}

/// An example as `--json` prints it.
#[derive(serde::Serialize)]
struct Entry {
    name: &'static str,
    commands: &'static str,
    about: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    text: Option<&'static str>,
}

/// What reads a machine with the settings of a drive, and a train with a run.
const DRIVE: &str = "modes, design";
const TRAIN: &str = "simulate, modes";

/// Name, commands that read it, what it is, and text of each.
const EXAMPLES: [(&str, &str, &str, &str); 27] = [
    ("hoist", DRIVE, "a crane's hoist of 12 t", include_str!("../../machines/hoist.toml")),
    ("roll", DRIVE, "a motor, a coupling and a roll", include_str!("../../machines/roll.toml")),
    ("axis", DRIVE, "a machine tool's feed axis", include_str!("../../machines/axis.toml")),
    ("mill", DRIVE, "the main drive of a rolling mill", include_str!("../../machines/mill.toml")),
    ("conveyor", DRIVE, "a conveyor behind a planetary set", include_str!("../../machines/conveyor.toml")),
    ("table", DRIVE, "a table moved by a worm and a screw", include_str!("../../machines/table.toml")),
    ("crane", DRIVE, "a crane travels with a swinging load", include_str!("../../machines/crane.toml")),
    ("press", DRIVE, "a crank press with belt and pump", include_str!("../../machines/press.toml")),
    ("four-bar", DRIVE, "a press with a four-bar", include_str!("../../machines/four-bar.toml")),
    (
        "generating-set",
        DRIVE,
        "a diesel set with every kind of damper",
        include_str!("../../machines/generating-set.toml"),
    ),
    ("ship", "modes", "a twin-screw ship with branches", include_str!("../../machines/ship.toml")),
    ("gear-pair", TRAIN, "a spur pair at its resonance", include_str!("../../trains/gear-pair.toml")),
    ("spur-pair", TRAIN, "a spur pair on shafts and bearings", include_str!("../../trains/spur-pair.toml")),
    ("two-stage", TRAIN, "two gear stages in line", include_str!("../../trains/two-stage.toml")),
    ("gear-branch", TRAIN, "a wheel that drives two machines", include_str!("../../trains/gear-branch.toml")),
    ("hoist-start", TRAIN, "the hoist lifts its load from the ground", include_str!("../../trains/hoist-start.toml")),
    ("girder", TRAIN, "the same on an elastic girder", include_str!("../../trains/girder.toml")),
    ("travel", TRAIN, "a crane's travelling drive reverses", include_str!("../../trains/travel.toml")),
    ("tilting", TRAIN, "two motors on one ring gear", include_str!("../../trains/tilting.toml")),
    ("crank-press", TRAIN, "a press with friction in its pins", include_str!("../../trains/crank-press.toml")),
    ("four-bar-press", TRAIN, "a four-bar press in its steady cycle", include_str!("../../trains/four-bar-press.toml")),
    ("toggle-press", TRAIN, "a toggle press and a cam on one shaft", include_str!("../../trains/toggle-press.toml")),
    ("prime-movers", TRAIN, "an engine, a tram, a winch", include_str!("../../trains/prime-movers.toml")),
    ("torques", TRAIN, "every other torque and mesh", include_str!("../../trains/torques.toml")),
    ("three-discs", "rotor", "three discs on a flexible shaft", include_str!("../../rotors/three_discs.toml")),
    ("fan-balance", "balancing", "readings of a fan in two planes", include_str!("../../rotors/fan-balance.toml")),
    (
        "bench-log",
        "identify, replay",
        "a recording of two motors and a coupling",
        include_str!("../../recordings/two-mass-bench.csv"),
    ),
];

impl Example {
    /// Prints the file, or the names.
    pub fn execute(&self) -> Result<(), Failure> {
        let Some(name) = &self.name else {
            if self.json {
                return say_json(&EXAMPLES.map(|(name, commands, about, _)| Entry {
                    name,
                    commands,
                    about,
                    text: None,
                }));
            }
            for (name, commands, about, _) in EXAMPLES {
                say(format_args!("{name:<15} {commands:<17} {about}"));
            }
            return Ok(());
        };
        let Some(&(name, commands, about, text)) = EXAMPLES.iter().find(|(known, ..)| known == name) else {
            let names = EXAMPLES.map(|(name, ..)| format!("`{name}`")).join(", ");
            return Err(Failure::usage(format!("there is no example `{name}`; there are {names}")));
        };
        if self.json {
            return say_json(&Entry { name, commands, about, text: Some(text) });
        }
        say(text.trim_end());
        Ok(())
    }
}
