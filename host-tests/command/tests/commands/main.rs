//! The subcommands as a user meets them, the files that they read and the pages that they write.

mod answers;
mod balance;
mod browser;
mod campaign;
mod cli;
mod cli_emit;
mod critical;
mod damper;
mod elements;
mod engine;
mod girder;
mod identify;
mod machine_file;
mod motor_wheel;
mod pages;
mod prime_movers;
#[path = "../references/mod.rs"]
mod references;
mod replay;
mod ring_down;
mod rotor;
#[path = "../../../report/tests/report/sample.rs"]
mod sample;
mod scope;
mod simulate;
#[path = "../../../report/tests/report/sound.rs"]
mod sound;
mod starting_time;
mod survey;
