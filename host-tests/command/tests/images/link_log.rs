//! What an image logs through `defmt` in QEMU, decoded on the host.

use std::fs;
use std::time::Duration;

use defmt_decoder::Table;
use driveline_firmware::board::BOARDS;
use driveline_qemu::image::{Program, build};
use driveline_qemu::link;

#[test]
fn logged_frames_are_decoded_with_the_image_itself() {
    for &board in BOARDS {
        let image = build("hoist/f32/rigid/10000", board, Program::Log, |_| {}).unwrap();
        // ten thousand ticks take a fraction of a second
        let log = link::run(&image, Duration::from_secs(60)).unwrap().log;
        let table = Table::parse(&fs::read(&image.path).unwrap()).unwrap().unwrap();
        let mut decoder = table.new_stream_decoder();
        decoder.received(&log);
        let mut messages = Vec::new();
        while let Ok(frame) = decoder.decode() {
            messages.push(frame.display_message().to_string());
        }
        assert_eq!(messages.first(), Some(&format!("hoist/f32/rigid/10000 on {}", board.name)));
        assert_eq!(messages.last().map(String::as_str), Some("10000 ticks"));
    }
}
