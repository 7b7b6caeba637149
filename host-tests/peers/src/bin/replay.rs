//! Runs an observer over a recording: `replay SCENE PEER VALUE`, numbers of the scene, the observer and its corner, as
//! `replay list` has them in turn.
//!
//! Standard input has a tick in twelve bytes: angle, torque as a word of the observer's number, and flags; a tick that
//! is not released starts the observer. Standard output has shaft torque and load speed of each in eight.

use std::io::{self, Read, Write};
use std::process::ExitCode;

use driveline_firmware::scene::{Input, Output};
use driveline_peers::{PEERS, Replayed, SCENES, TUNED, Visitor, with};

/// Ticks through a recording.
struct Through<'r>(&'r [u8]);

impl Visitor for Through<'_> {
    type Output = Vec<u8>;

    fn visit<R: Replayed>(self, mut observer: R) -> Vec<u8> {
        let word = |bytes: &[u8]| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
        let mut estimates = Vec::with_capacity(self.0.len() / 3 * 2);
        let mut output = Output::default();
        for tick in self.0.chunks_exact(12) {
            let [angle, torque, flags] = [0, 4, 8].map(|at| word(&tick[at..]));
            let input = Input { angle, torque, flags, ..Input::default() };
            if flags & Input::RELEASED == 0 {
                observer.start(&input);
            } else {
                observer.tick(&input, &mut output);
            }
            estimates.extend(output.shaft_torque.to_le_bytes());
            estimates.extend(output.load_speed.to_le_bytes());
        }
        estimates
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments == ["list"] {
        SCENES.iter().for_each(|scene| println!("scene {}", scene.name));
        PEERS.iter().for_each(|peer| println!("peer {peer}"));
        TUNED.iter().for_each(|peer| println!("tuned {}", PEERS[*peer]));
        return ExitCode::SUCCESS;
    }
    let [scene, peer, value] = arguments.as_slice() else {
        eprintln!("expected the numbers of a scene and an observer, and a corner in rad/s");
        return ExitCode::from(2);
    };
    let (Ok(scene), Ok(peer), Ok(value)) = (scene.parse::<usize>(), peer.parse(), value.parse()) else {
        eprintln!("not numbers: {arguments:?}");
        return ExitCode::from(2);
    };
    let Some(scene) = SCENES.get(scene) else {
        eprintln!("there are {} scenes", SCENES.len());
        return ExitCode::from(2);
    };
    let mut recording = Vec::new();
    if let Err(error) = io::stdin().read_to_end(&mut recording) {
        eprintln!("standard input: {error}");
        return ExitCode::FAILURE;
    }
    // Nothing out: the machine has no such observer.
    let estimates = with(scene, peer, value, Through(&recording)).unwrap_or_default();
    match io::stdout().write_all(&estimates) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}
