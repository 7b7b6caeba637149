//! Runs an observer over a recording: `replay SCENE PEER VALUE`, numbers of the scene, the observer and its corner, as
//! `replay list` has them in turn.
//!
//! Standard input has a tick in twelve bytes: angle, torque as a word of the observer's number, and flags; a tick that
//! is not released starts the observer. Standard output has shaft torque and load speed of each in eight.
//!
//! `replay govern SCENE GOVERNOR` is in lock-step: angle, torque, setpoint and flags of a tick in sixteen bytes, its
//! torque in four. `replay solvers` has a line for each solver of least squares: error of the weights, residual, name.

use std::io::{self, Read, Write};
use std::process::ExitCode;

use driveline_firmware::scene::{Input, Output};
use driveline_peers::least_squares::{Solver, judged};
use driveline_peers::{
    FIRST_GOVERNOR, GOVERNORS, PEERS, Replayed, SCENES, SOLVERS, SolverVisitor, TUNED, Visitor, with, with_solver,
};

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

/// In lock-step to the end of standard input.
struct LockStep;

impl Visitor for LockStep {
    type Output = io::Result<()>;

    fn visit<R: Replayed>(self, mut governor: R) -> io::Result<()> {
        let (mut from, mut to) = (io::stdin().lock(), io::stdout().lock());
        let (mut bytes, mut output) = ([0; 16], Output::default());
        while from.read_exact(&mut bytes).is_ok() {
            let [angle, torque, setpoint, flags] =
                [0, 4, 8, 12].map(|at| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]));
            let input = Input { angle, torque, setpoint, flags, ..Input::default() };
            if flags & Input::RELEASED == 0 {
                governor.start(&input);
                output.torque = setpoint;
            } else {
                governor.tick(&input, &mut output);
            }
            to.write_all(&output.torque.to_le_bytes())?;
            to.flush()?;
        }
        Ok(())
    }
}

/// Error of the weights and residual.
struct Judged;

impl SolverVisitor for Judged {
    type Output = [f64; 2];

    fn visit<S: Solver>(self, solver: S) -> [f64; 2] {
        judged(&solver)
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments == ["solvers"] {
        for (solver, name) in SOLVERS.iter().enumerate() {
            let [error, residual] = with_solver(solver, Judged).unwrap_or([f64::NAN; 2]);
            println!("{error:e} {residual} {name}");
        }
        return ExitCode::SUCCESS;
    }
    if let [first, scene, governor] = arguments.as_slice()
        && first == "govern"
    {
        let scene = scene.parse().ok().and_then(|scene: usize| SCENES.get(scene));
        let governed = scene
            .zip(governor.parse::<usize>().ok())
            .and_then(|(scene, governor)| with(scene, FIRST_GOVERNOR + governor, 0.0, LockStep));
        return if let Some(Ok(())) = governed { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    if arguments == ["list"] {
        SCENES.iter().for_each(|scene| println!("scene {}", scene.name));
        PEERS.iter().for_each(|peer| println!("peer {peer}"));
        TUNED.iter().for_each(|peer| println!("tuned {}", PEERS[*peer]));
        GOVERNORS.iter().for_each(|governor| println!("governor {governor}"));
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
