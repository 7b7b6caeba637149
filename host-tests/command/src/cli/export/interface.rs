//! The C interface in tables: its refusals, the faults, and the version of its header.

use driveline::fault::Faults;
use serde::Serialize;

/// A refused call.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Refusal {
    /// The end of its macro's name.
    upper: &'static str,
    /// As `fault_text` writes it.
    text: &'static str,
    /// The comment above the macro.
    meaning: &'static str,
}

/// The refusals, from number 1 on.
pub const REFUSALS: [Refusal; 6] = [
    Refusal { upper: "NOT_INITIALISED", text: "not initialised", meaning: "The drive was not initialised." },
    Refusal { upper: "SIZE", text: "wrong size of the state", meaning: "The state has another size in the library." },
    Refusal { upper: "HEADER", text: "header of another version", meaning: "The header is not the library's." },
    Refusal { upper: "NOT_YET", text: "not complete yet", meaning: "No reading is complete yet." },
    Refusal {
        upper: "UNSOUND",
        text: "reading unsound",
        meaning: "The reading is complete and cannot be used: speed or vibration were unsteady, or a sample was lost.",
    },
    Refusal { upper: "CHANNEL", text: "no such channel", meaning: "There is no such channel." },
];

/// A fault of a tick.
#[derive(Clone, Debug, Serialize)]
pub struct Fault {
    upper: String,
    bit: u32,
}

/// The faults of the library, by their bits.
pub fn faults() -> Vec<Fault> {
    let fault = |(fault, name): (Faults, &str)| Fault {
        upper: name.replace(' ', "_").to_ascii_uppercase(),
        bit: fault.bits().trailing_zeros(),
    };
    let mut faults: Vec<Fault> = Faults::NAMES.map(fault).into();
    faults.sort_by_key(|fault| fault.bit);
    faults
}

/// A version from the texts that make an interface: FNV-1a, 32 bit.
pub fn version(texts: &[&str]) -> u32 {
    let step = |hash: u32, byte: u8| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    texts.iter().flat_map(|text| text.bytes()).fold(0x811c_9dc5, step)
}
