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
    /// Print [{name, commands}], with a name {name, commands, text}
    #[arg(long)]
    pub json: bool,
}

/// An example as `--json` prints it.
#[derive(serde::Serialize)]
struct Entry {
    name: &'static str,
    commands: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    text: Option<&'static str>,
}

/// Name, for which commands, and text of each.
const EXAMPLES: [(&str, &str, &str); 16] = [
    ("hoist", "modes, design", include_str!("../../machines/hoist.toml")),
    ("roll", "modes, design", include_str!("../../machines/roll.toml")),
    ("axis", "modes, design", include_str!("../../machines/axis.toml")),
    ("mill", "modes, design", include_str!("../../machines/mill.toml")),
    ("ship", "modes", include_str!("../../machines/ship.toml")),
    ("gear-pair", "simulate, modes", include_str!("../../trains/gear-pair.toml")),
    ("spur-pair", "simulate, modes", include_str!("../../trains/spur-pair.toml")),
    ("two-stage", "simulate, modes", include_str!("../../trains/two-stage.toml")),
    ("gear-branch", "simulate, modes", include_str!("../../trains/gear-branch.toml")),
    ("hoist-start", "simulate, modes", include_str!("../../trains/hoist-start.toml")),
    ("girder", "simulate, modes", include_str!("../../trains/girder.toml")),
    ("travel", "simulate, modes", include_str!("../../trains/travel.toml")),
    ("tilting", "simulate, modes", include_str!("../../trains/tilting.toml")),
    ("three-discs", "rotor", include_str!("../../rotors/three_discs.toml")),
    ("fan-balance", "balancing", include_str!("../../rotors/fan-balance.toml")),
    ("bench-log", "identify, replay", include_str!("../../recordings/two-mass-bench.csv")),
];

impl Example {
    /// Prints the file, or the names.
    pub fn execute(&self) -> Result<(), Failure> {
        let Some(name) = &self.name else {
            if self.json {
                return say_json(&EXAMPLES.map(|(name, commands, _)| Entry { name, commands, text: None }));
            }
            EXAMPLES.iter().for_each(|(name, commands, _)| say(format_args!("{name:<12} {commands}")));
            return Ok(());
        };
        let Some(&(name, commands, text)) = EXAMPLES.iter().find(|(known, ..)| known == name) else {
            let names = EXAMPLES.map(|(name, ..)| format!("`{name}`")).join(", ");
            return Err(Failure::usage(format!("there is no example `{name}`; there are {names}")));
        };
        if self.json {
            return say_json(&Entry { name, commands, text: Some(text) });
        }
        say(text.trim_end());
        Ok(())
    }
}
