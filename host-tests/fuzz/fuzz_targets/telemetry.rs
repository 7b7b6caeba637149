//! Telemetry of any bytes, in any pieces.
#![no_main]

use cargo_driveline::telemetry::Decoder;

libfuzzer_sys::fuzz_target!(|pieces: Vec<Vec<u8>>| {
    let mut decoder = Decoder::default();
    for piece in &pieces {
        decoder.take(piece, |decoder, told| {
            for (index, word) in told.words.iter().enumerate() {
                let _ = decoder.channel(index).value(*word);
            }
        });
    }
});
