//! A recording of any bytes is read or refused.
#![no_main]

use std::cell::OnceCell;
use std::fs;

use cargo_driveline::recording::{Asked, read_recording};
use tempfile::TempPath;

thread_local! {
    static FILE: OnceCell<TempPath> = const { OnceCell::new() };
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    FILE.with(|file| {
        let path = file.get_or_init(|| tempfile::NamedTempFile::new().expect("a temporary file").into_temp_path());
        fs::write(path, bytes).expect("a temporary file");
        for (rate, uneven) in [(None, false), (Some(1e3), false), (None, true)] {
            let (torque_constant, counts) = (Some(1.0), Some(4096.0));
            let asked = Asked { rate, torque_constant, counts, columns: vec![], window: [None; 2], uneven };
            let _ = read_recording(path, &asked);
        }
    });
});
