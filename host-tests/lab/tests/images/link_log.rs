//! What an image logs through `defmt` in QEMU, decoded on the host.

use std::fs::{self, File};
use std::process::Command;
use std::time::Duration;

use driveline_firmware::board::BOARDS;
use driveline_qemu::clone::workspace;
use driveline_qemu::image::{Program, build};
use driveline_qemu::link;

#[test]
fn logged_frames_are_decoded_with_the_image_itself() {
    let folder = tempfile::tempdir().unwrap();
    let frames = folder.path().join("frames");
    for &board in BOARDS {
        let image = build("hoist/f32/rigid/10000", board, Program::Log, |_| {}).unwrap();
        // ten thousand ticks take a fraction of a second
        fs::write(&frames, link::run(&image, Duration::from_secs(60)).unwrap().log).unwrap();
        let mut decoder = Command::new(env!("CARGO"));
        decoder.args(["run", "--quiet", "--package=driveline-defmt-log", "--"]).arg(&image.path);
        let decoder = decoder.current_dir(workspace().unwrap()).stdin(File::open(&frames).unwrap());
        let output = decoder.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let log = String::from_utf8(output.stdout).unwrap();
        assert_eq!(log.lines().next(), Some(format!("hoist/f32/rigid/10000 on {}", board.name).as_str()));
        assert_eq!(log.lines().last(), Some("10000 ticks"));
    }
}
