//! The subcommands as a user meets them, the files that they read and the pages that they write.

mod answers;
mod balance;
mod bench;
mod cli_emit;
mod composed;
mod critical;
mod damper;
mod elements;
mod engine;
mod girder;
mod identify;
mod installed;
mod locks;
mod loop_measured;
mod machine_file;
mod motor_wheel;
mod prime_movers;
#[path = "../../../../tests/library/references.rs"]
mod references;
mod replay;
mod rotor;
mod simulate;
mod starting_time;
mod starts;
mod tune;
