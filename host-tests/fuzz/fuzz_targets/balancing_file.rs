#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| driveline_fuzz::balancing_file(bytes));
