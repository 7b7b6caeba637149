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
//!
//! [duty]                   # may be left out: which observer the machine needs
//! change = 150.0           # N m at the motor: the largest change of torque ...
//! rise = 0.1               # s ... comes about in this time
//! every = 2.0              # s from one to the next
//!
//! [actuator]               # may be left out: the torque acts within the tick
//! delay = 1e-4             # s from the command to the current's setpoint
//! bandwidth = 500.0        # Hz, of the current control
//!
//! [tolerance]              # may be left out: those of the class `general`
//! class = "crane"          # general, crane, mill or machine-tool: what is not stated below
//! stiffness = 0.2          # 20 % either way
//! load = [0.05, 1.1]       # from and to, of nominal
//! ```
//!
//! A tolerance is a number or a range. A number is a ratio's deviation either way, a difference either way, or the
//! largest amplitude: see [`factor`] for the keys and their units.
//!
//! The kinds of element and their keys; those in brackets may be left out:
//!
//! - **`motor`, `rotor`**: `inertia` (kg m2)
//! - **`shaft`**: `stiffness` (N m/rad), (`damping` (N m s/rad))
//! - **`section`**: `length` (m), `diameter` (m), (`end` diameter (m)), (`bore` (m)), (`modulus` (Pa), steel's),
//!   (`damping` (N m s/rad)); pieces in a row are a stepped shaft
//! - **`crank`**: `inertia`, `radius` (m), `rod` (m), `slider` (kg), (`rod_mass`, `rod_centre` (m) from the pin,
//!   `rod_inertia`); the mean over a turn
//! - **`worm`**: `ratio`, `efficiency`, `back_efficiency` with the load driving
//! - **`planetary`**: `sun_teeth`, `ring_teeth`, `module` (m), `planets`, `sun`, `planet`, `carrier` (kg m2),
//!   `planet_mass` (kg), (`efficiency`, `input` the member on the motor's side, `held`: `sun`, `ring` or `carrier`;
//!   the sun and the ring where they are left out; `ring` (kg m2); `back_efficiency`)
//! - **`belt`**: `driving`, `driven` (m), `stiffness` (N/m) of a strand, (`damping` (N s/m)), (`efficiency`)
//! - **`screw`**: `lead` (m) a turn
//! - **`swinging`**: `mass` (kg), `length` (m) of the pendulum
//! - **`slack`**: `travel` (m) along the load's path
//! - **`gear`**: `ratio` motor speed over load speed, (`efficiency`, `back_efficiency`)
//! - **`drum`**: `diameter` (m)
//! - **`rope`**: `falls`, `stiffness` (N/m) at the load, (`damping` (N s/m))
//! - **`lifted`, `driven`**: `mass` (kg); a lifted one has weight
//! - **`backlash`**: `gap` (rad), the whole free angle
//!
//! A machine with branches has, beside its chain of elements, a `[[branch]]` for each: `at`, the label of the element
//! whose mass it stands on (a motor, rotor, crank or planetary set of the chain or of a branch before it), and
//! `[[branch.element]]` tables away from there. A branch that turns at another speed begins with a gear.
//!
//! ```toml
//! [[branch]]
//! at = "pinion"            # an element's label
//!
//! [[branch.element]]
//! kind = "gear"
//! ratio = 1.6
//!
//! [[branch.element]]
//! kind = "rotor"
//! label = "gear wheel"
//! inertia = 800.0          # kg m2
//! ```
//!
//! A rotor that is to be balanced has a file of its own kind: see [`RotorFile`].
//!
//! For a diagram of critical speeds, `[running]` gives the speeds `least` and `greatest` of the motor (rad/s), and each
//! `[[excitation]]` its `name`, its `orders`, and the `ratio` of the motor's speed over that of the shaft that excites
//! (1 where it is left out). `[engine]` describes a piston engine on masses of the machine, `[[damper]]` a damper that
//! `modes` sizes. For `simulate` see [`train`].
//!
//! Every element may have a `label`, which tables and plots then use. Quantities stand on their own shaft, as a data
//! sheet gives them; the library refers them to the motor.

pub mod balance;
pub mod class;
mod damper;
pub mod designs;
mod diagnostic;
mod element;
pub(crate) mod engine;
mod excitation;
pub mod factor;
mod quantity;
mod read;
mod referred;
mod rotor;
mod source;
pub(crate) mod station;
mod table;
pub mod train;

pub use damper::{DamperKind, DamperRing};
pub use diagnostic::{Diagnostic, Fault};
pub use element::Element;
pub use engine::Engine;
pub use excitation::{Excitation, Running};
pub use quantity::Quantity;
pub use read::{LARGEST, not_toml, parse, parse_for_modes, read, text};
pub use rotor::{Balancing, RotorFile, parse_rotor, read_rotor};
pub use source::{Source, printable, slug};
pub use table::{Item, Table};
pub use train::{PinForces, TrainFile, is_train, parse_train, parse_train_for_modes, read_train};

use class::Class;
use driveline::machine::{Chain, Train};
use factor::Tolerance;
use station::Long;

/// A machine as its file describes it.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFile {
    /// Name: letters, digits, `-`, `_` and spaces, at most 40.
    pub name: String,
    /// The elements from the motor to the load.
    pub elements: Vec<Part>,
    /// The motor's encoder.
    pub encoder: Encoder,
    pub control: Control,
    /// Disturbances for the observer.
    pub disturbance: Disturbance,
    /// Limits of the machine.
    pub limits: Limits,
    /// Delay and bandwidth of the torque.
    pub actuator: Actuator,
    /// Natural frequency of the speed loop over the antiresonance.
    pub bandwidth: f64,
    /// Acceleration of the speed's setpoint (rad/s2); `None` for that of the rating.
    pub ramp: Option<f64>,
    /// Its class, which tolerances that the file does not state come from.
    pub class: Class,
    pub tolerances: Vec<Tolerance>,
    /// The speeds it runs at, where the file says so.
    pub running: Option<Running>,
    pub excitations: Vec<Excitation>,
    /// Its piston engine, whose excitation is the last of them.
    pub engine: Option<Engine>,
    pub dampers: Vec<DamperRing>,
    /// How the machine is shaken, if the file says.
    pub duty: Option<Duty>,
    /// The elements as the library's chain, referred to the motor.
    pub chain: Chain,
    /// Branches on masses of the chain, or of branches before.
    pub branches: Vec<Branch>,
    /// Chain and branches as the library's train; none where there is no branch.
    pub train: Option<Train>,
    /// Chain and branches of a machine that the library's chain and train do not hold, which then carry that error.
    pub(crate) long: Option<Long>,
}

/// A chain of elements that stands on a mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Label of the element whose mass it stands on.
    pub at: String,
    /// The elements, away from that mass.
    pub elements: Vec<Part>,
    /// The elements as the library's chain, referred to that mass.
    pub chain: Chain,
    /// Index of that mass.
    pub node: usize,
    /// The motor's speed over that of the mass.
    pub ratio: f64,
    /// Index of the first mass that the branch adds to the machine.
    pub first: usize,
    /// Number of its masses, with the one it stands on.
    pub(crate) count: usize,
}

/// An element with the name that tables and plots give it.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its label, or its kind, numbered from the second of a kind on.
    pub label: String,
    pub element: Element,
}

/// The encoder on the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// Lines on a turn; quadrature gives four counts a line.
    pub lines: u32,
    /// Its accuracy, where the file states one.
    pub accuracy: Accuracy,
}

/// The accuracy of an encoder, as a data sheet states it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Signal periods on a turn: the lines of its scale.
    pub signal_periods: u32,
    /// Amplitude of the interpolation error, as a fraction of a signal period.
    pub interpolation: f64,
    /// Amplitude of the angle's error once a turn (rad).
    pub eccentricity: f64,
    /// Rms deviation of the time at which it is read (s).
    pub jitter: f64,
}

impl Accuracy {
    /// None stated.
    pub const NONE: Self = Self { signal_periods: 1, interpolation: 0.0, eccentricity: 0.0, jitter: 0.0 };

    /// Whether none is stated: the encoder is accurate to its counts.
    pub fn is_none(&self) -> bool {
        self.interpolation == 0.0 && self.eccentricity == 0.0 && self.jitter == 0.0
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Ticks a second.
    pub rate_hz: u32,
}

/// Disturbances for the observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance {
    /// Root mean square of the error of the motor's torque in one tick (N m).
    pub torque_accuracy: f64,
    /// Noise of the reported torque in one tick (N m, rms), which campaigns and predictions have; `torque_accuracy`
    /// where the file has none.
    pub torque_noise: Option<f64>,
    /// A change of load torque at the motor (N m) ...
    pub load_torque_step: f64,
    /// ... that may come about within this time (s).
    pub within: f64,
}

impl Disturbance {
    /// The noise of the reported torque in one tick (N m, rms).
    pub fn noise(&self) -> f64 {
        self.torque_noise.unwrap_or(self.torque_accuracy)
    }
}

/// Limits of the machine, at the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Torque (N m).
    pub torque: f64,
    /// Speed (rad/s).
    pub speed: f64,
    /// Rated torque (N m); half of the largest where the file states none.
    pub rated_torque: f64,
}

/// The motor's torque after its command.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Actuator {
    /// Dead time (s).
    pub delay: f64,
    /// Bandwidth of the current control (Hz), where it is not within the tick.
    pub bandwidth: Option<f64>,
}

/// How the machine is shaken: what decides which observer it needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Duty {
    /// Largest change of torque that comes about at once, at the motor (N m).
    pub change: f64,
    /// How long it takes (s).
    pub rise: f64,
    /// Time between two of them (s).
    pub every: f64,
}

impl MachineFile {
    /// The name as a Rust constant: upper case, `_` for everything but letters and digits.
    pub fn constant(&self) -> String {
        let name = slug(&self.name).replace('-', "_").to_ascii_uppercase();
        if name.starts_with(|c: char| c.is_ascii_digit()) { format!("MACHINE_{name}") } else { name }
    }
}
