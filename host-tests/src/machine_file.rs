//! Machines that a user wrote: a TOML file of ordered elements, read with every fault placed.
//!
//! ```toml
//! name = "hoist"
//!
//! [[element]]              # from the motor to the load
//! kind = "motor"
//! inertia = 0.62           # kg m2
//!
//! [[element]]
//! kind = "shaft"
//! stiffness = 5.0e4        # N m/rad
//! damping = 2.0            # N m s/rad, 0 where it is left out
//!
//! [[element]]
//! kind = "rotor"
//! inertia = 0.08           # kg m2
//!
//! [encoder]
//! lines = 2048             # on a turn; four counts a line
//!
//! [control]
//! rate_hz = 10000          # ticks a second
//!
//! [disturbance]
//! torque_accuracy = 4.0    # N m, rms error of the motor torque in a tick
//! load_torque_step = 150.0 # N m at the motor: the change of load torque that ...
//! within = 0.2             # s ... may come about in this time
//!
//! [limits]
//! torque = 400.0           # N m, largest motor torque
//! speed = 160.0            # rad/s, largest motor speed
//! ```
//!
//! | kind | keys (those in brackets may be left out) |
//! |---|---|
//! | `motor`, `rotor` | `inertia` \[kg m2\] |
//! | `shaft` | `stiffness` \[N m/rad\], (`damping` \[N m s/rad\]) |
//! | `gear` | `ratio` motor speed over load speed, (`efficiency`) |
//! | `drum` | `diameter` \[m\] |
//! | `rope` | `falls`, `stiffness` \[N/m\] at the load, (`damping` \[N s/m\]) |
//! | `lifted`, `driven` | `mass` \[kg\]; a lifted one has weight |
//! | `backlash` | `gap` \[rad\], the whole free angle |
//!
//! A rotor that is to be balanced has a file of its own kind: see [`RotorFile`].
//!
//! Every element may have a `label`, which tables and plots then use. Quantities stand on their own shaft, as a data sheet gives them; the library refers them to the motor.

mod diagnostic;
mod element;
mod quantity;
mod read;
mod rotor;
mod source;
mod table;

pub use diagnostic::{Diagnostic, Fault};
pub use element::Element;
pub use quantity::Quantity;
pub use read::{LARGEST, not_toml, parse, read, text};
pub use rotor::{RotorFile, parse_rotor, read_rotor};
pub use source::Source;
pub use table::{Item, Table};

use driveline::machine::Chain;
use serde::Serialize;

/// A machine as its file describes it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MachineFile {
    /// Name: letters, digits, `-`, `_` and spaces, at most 40.
    pub name: String,
    /// The elements from the motor to the load.
    pub elements: Vec<Part>,
    /// The motor's encoder.
    pub encoder: Encoder,
    /// The controller.
    pub control: Control,
    /// What the observer has to reckon with.
    pub disturbance: Disturbance,
    /// What the machine can do at most.
    pub limits: Limits,
    /// The elements as the library's chain, referred to the motor.
    #[serde(skip)]
    pub chain: Chain,
}

/// An element with the name that tables and plots give it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Its label, or its kind, numbered from the second of a kind on.
    pub label: String,
    /// The element.
    #[serde(flatten)]
    pub element: Element,
}

/// The encoder on the motor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Encoder {
    /// Lines on a turn; quadrature gives four counts a line.
    pub lines: u32,
}

/// The controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Control {
    /// Ticks a second.
    pub rate_hz: u32,
}

/// What the observer has to reckon with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Disturbance {
    /// Root mean square of the error of the motor's torque in one tick \[N m\].
    pub torque_accuracy: f64,
    /// A change of load torque at the motor \[N m\] ...
    pub load_torque_step: f64,
    /// ... that may come about within this time \[s\].
    pub within: f64,
}

/// What the machine can do at most, at the motor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limits {
    /// Torque \[N m\].
    pub torque: f64,
    /// Speed \[rad/s\].
    pub speed: f64,
}

impl MachineFile {
    /// The name as part of a file name: lower case, `-` for everything but letters and digits.
    pub fn slug(&self) -> String {
        let letter = |c: char| {
            if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' }
        };
        self.name.chars().map(letter).collect()
    }

    /// The name as a Rust constant: upper case, `_` for everything but letters and digits.
    pub fn constant(&self) -> String {
        let name = self.slug().replace('-', "_").to_ascii_uppercase();
        if name.starts_with(|c: char| c.is_ascii_digit()) { format!("MACHINE_{name}") } else { name }
    }
}
