//! A machine file of any bytes is designed, a train's or a rotor's is read, or each is refused.
#![no_main]

use cargo_driveline::cli::Plan;
use cargo_driveline::machine_file::{is_train, parse, parse_rotor, parse_train, parse_train_for_modes};

libfuzzer_sys::fuzz_target!(|text: &str| {
    if is_train(text) {
        let _ = parse_train("fuzz.toml", text);
        let _ = parse_train_for_modes("fuzz.toml", text);
    } else if text.contains("[[station]]") || text.contains("[[disc]]") {
        let _ = parse_rotor("fuzz.toml", text);
    } else if let Ok(machine) = parse("fuzz.toml", text) {
        let _ = Plan::of(&machine);
    }
});
