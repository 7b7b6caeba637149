//! Inputs and outputs as they travel: eight little-endian words.

use driveline_firmware::scene::{Input, Output};

/// Bytes of an input, and of an output.
pub const LENGTH: usize = 32;

/// The bytes of an input.
pub fn of_input(input: &Input) -> [u8; LENGTH] {
    let Input { angle, torque, setpoint, flags, vibration: [v0, v1], asked: [key, value] } = *input;
    let mut bytes = [0; LENGTH];
    for (place, word) in bytes.chunks_exact_mut(4).zip([angle, torque, setpoint, flags, v0, v1, key, value]) {
        place.copy_from_slice(&word.to_le_bytes());
    }
    bytes
}

pub fn to_output(bytes: &[u8; LENGTH]) -> Output {
    let mut words = bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    let mut next = || words.next().unwrap_or(0);
    Output {
        torque: next(),
        motor_speed: next(),
        shaft_torque: next(),
        load_speed: next(),
        load_torque: next(),
        faults: next(),
        instructions: next(),
        answer: next(),
    }
}
