//! A file of balancing of any bytes is read or refused.
#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    let _ = cargo_driveline::machine_file::balance::parse("fuzz.toml", text);
});
