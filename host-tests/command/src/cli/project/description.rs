//! A machine and its drive as the templates need them.

use std::f64::consts::TAU;

use clap::ValueEnum;
use driveline::configure::Rating;
use driveline::design::Actuator;
use driveline::machine::{Damper, Losses};
use serde::Serialize;

use super::{Part, PartOptions, Source};
use crate::cli::Failure;
use crate::cli::controller::Plan;
use crate::cli::emit::{dampers, encoder, has_tuning, tolerance, tuning, words, written};
use crate::machine_file::designs::{BRANCHES, Designs, NO_SHAFT};
use crate::machine_file::{DamperRing, MachineFile};

/// The number of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Number {
    /// Single precision, in SI units
    #[value(name = "f32")]
    Single,
    /// Fixed point, per unit of the machine's bases
    Fixed,
}

impl Number {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Number::Single => "f32",
            Number::Fixed => "fixed",
        }
    }
}

/// A machine and its drive, in the words of Rust.
#[derive(Debug, Serialize)]
pub struct Project {
    /// The package: `feed-axis`.
    pub name: String,
    /// The crate, and the prefix of C: `feed_axis`.
    #[serde(rename = "crate")]
    pub krate: String,
    /// `FEED_AXIS`.
    pub upper: String,
    /// `FeedAxis`.
    #[serde(rename = "type")]
    pub type_name: String,
    /// The machine's name in its file.
    pub title: String,
    words: String,
    chain: String,
    encoder: String,
    /// Largest torque of the motor (N m).
    torque: String,
    /// Its rated torque (N m).
    rated_torque: String,
    speed: String,
    /// Whether the motor is faster than most.
    fast: bool,
    /// Whether its run-up and the twist of a shaft pass the plausible ones.
    heavy: bool,
    soft: bool,
    /// Ticks a second.
    pub rate_hz: u32,
    torque_accuracy: String,
    load_torque_step: String,
    within: String,
    /// Where the file names a bandwidth.
    ramp: Option<String>,
    tuning: Option<String>,
    /// Delay and lag (s), where the file has some.
    actuator: Option<[String; 2]>,
    /// Fields of the tolerance that are not the usual ones, in the words of Rust.
    tolerance: Vec<String>,
    designs: String,
    /// Whether its observer has one mass.
    rigid: bool,
    /// Calls that put the dampers on a train; empty where there are none.
    dampers: String,
    number: &'static str,
    observer: String,
    observers: String,
    fluctuation: bool,
    phasors: bool,
    vibration_limit: String,
    vibration_base: String,
    counts: u32,
    weight: String,
    /// The masses of the chain, then the rings of dampers.
    nodes: Vec<Node>,
    /// Index of the chain's last mass.
    load: usize,
    /// Index of the softest shaft, whose torque the drive estimates.
    softest: usize,
    /// Viscous damping before and behind it (N m s/rad).
    friction: [String; 2],
    /// Load torque that a run adds at rated speed (N m).
    load_step: String,
    plant: TwoMasses,
    dependency_note: &'static str,
    driveline: String,
    solver: String,
    firmware: String,
    hal: String,
    /// Why there is no drive.
    #[serde(skip)]
    no_drive: Option<Failure>,
    /// What the design warns of.
    #[serde(skip)]
    warnings: Vec<String>,
}

/// A mass of the machine, and the shaft before it, at the motor.
#[derive(Clone, Debug, Default, Serialize)]
struct Node {
    /// Index of the mass before it.
    from: usize,
    inertia: String,
    /// Viscous damping against the ground; empty for none.
    viscous: String,
    /// Of the gear between it and the next shaft, or in it; empty for 1.
    efficiency: String,
    /// With the load driving, where it differs.
    back_efficiency: String,
    /// Its inertia in front of a gear with no shaft behind (kg m2); empty where there is none.
    front: String,
    kind: &'static str,
    stiffness: String,
    damping: String,
    /// Empty for none.
    gap: String,
    twist: String,
    /// Of a ring that dry friction holds instead of a shaft (N m); empty for a shaft.
    friction: String,
}

/// The two masses that an example simulates, and its steps.
#[derive(Clone, Debug, Serialize)]
struct TwoMasses {
    motor_inertia: String,
    load_inertia: String,
    stiffness: String,
    damping: String,
    /// Losses of the gears before the shaft, in shaft torques: the motor driving, the load driving.
    before: [String; 2],
    /// The same behind the shaft.
    behind: [String; 2],
    steps: u32,
    /// When its load comes on (s).
    seconds: u32,
    /// When it ends (s).
    end: u32,
}

/// Torque that a gear behind the shaft holds where it locks itself, in shaft torques: as good as any.
const LOCKED: f64 = 1e6;

impl Project {
    /// A drive of the machine in a file, under a name.
    ///
    /// # Errors
    /// A name that is no crate's, a machine with branches or without a shaft, options that contradict each other.
    pub fn of(machine: &MachineFile, name: &str, number: Number, options: &PartOptions) -> Result<Self, Failure> {
        let krate = crate_name(name)?;
        let limit = options.vibration_limit()?;
        let refused = |why: &str| Failure::usage(format!("`{}`: no drive can be made: {why}", machine.name));
        if !machine.branches.is_empty() {
            return Err(refused(BRANCHES));
        }
        let damped = machine.with_dampers().map_err(|error| refused(&error))?;
        let Some(two) = damped.two_masses() else {
            return Err(refused(NO_SHAFT));
        };
        let gears = damped.drive_gears(&two, matches!(number, Number::Fixed)).map(|_| ());
        let plan = Plan::of(&damped);
        let observers = plan.as_ref().map_or_else(|_| Vec::new(), |plan| observers(machine, plan));
        let rigid = observers.last() == Some(&"RigidObserver");
        let chain = written(&machine.elements, "        ");
        let dampers = dampers(&machine.rings()).replace('\n', "\n    ");
        let written = format!("{chain}{dampers}");
        let mut words = words(&written);
        words.extend(["Speed", "Torque"]);
        if !dampers.is_empty() {
            words.extend(["Match", "Train", "TwoMass"]);
        }
        let float = |value: f64| format!("{value:?}");
        let weight = machine.chain.gravity_torque();
        let shafts = machine.chain.shafts();
        let least = |a: usize, b: usize| if shafts[b].stiffness < shafts[a].stiffness { b } else { a };
        let softest = (1..shafts.len()).fold(0, least);
        let viscous = &machine.viscous()[..machine.chain.masses().len()];
        let Losses { before, behind } = machine.chain.losses();
        // a tenth of the largest torque remains for the speed loop
        let left = 0.9 * machine.limits.torque - viscous.iter().sum::<f64>() * machine.limits.speed;
        let load_step = (left * before[0] * behind[0] - weight).min(0.5 * machine.limits.rated_torque);
        let bandwidth =
            plan.as_ref().ok().and_then(|plan| plan.speed_loop.as_ref()).map(|speed_loop| speed_loop.bandwidth);
        // ten time constants of the speed loop
        let settling = (10.0 / bandwidth.unwrap_or(10.0)).max(1.0);
        let seconds = machine.limits.speed / machine.ramp(machine.chain.total_inertia());
        let loaded = 2 + (seconds + settling) as u32;
        let (actuator, tolerance) = (machine.actuator(), tolerance(machine));
        let period = 1.0 / f64::from(machine.control.rate_hz);
        Ok(Project {
            warnings: plan.as_ref().map_or_else(|_| Vec::new(), |plan| plan.warnings.clone()),
            name: name.to_owned(),
            upper: krate.to_ascii_uppercase(),
            type_name: type_name(&krate, &words.iter().copied().collect::<Vec<_>>()),
            krate,
            title: machine.name.clone(),
            words: words.into_iter().collect::<Vec<_>>().join(", "),
            chain,
            encoder: encoder(machine),
            torque: float(machine.limits.torque),
            rated_torque: float(machine.limits.rated_torque),
            speed: float(machine.limits.speed),
            heavy: machine.rating().run_up(machine.chain.total_inertia()) > Rating::RUN_UP,
            soft: machine.chain.largest_twist(machine.limits.rated_torque) > Rating::SHAFT_TWIST,
            fast: !machine.rating().is_within(machine.chain.masses()[0], Rating::PERIPHERAL_SPEED),
            rate_hz: machine.control.rate_hz,
            torque_accuracy: float(machine.disturbance.torque_accuracy),
            load_torque_step: float(machine.disturbance.load_torque_step),
            within: float(machine.disturbance.within),
            ramp: machine.ramp.map(float),
            tuning: has_tuning(machine).then(|| tuning(machine, "&Self::TWO_MASS")),
            actuator: (actuator != Actuator::DIRECT).then(|| [actuator.delay, actuator.lag].map(float)),
            designs: designs(machine, &tolerance, rigid).join(", "),
            rigid,
            dampers,
            tolerance,
            number: match number {
                Number::Single => "f32",
                Number::Fixed => "driveline::number::Fixed",
            },
            observer: observers.iter().rev().fold(String::new(), |inner, &outer| match inner.as_str() {
                "" => outer.to_owned(),
                inner => format!("{outer}<{inner}>"),
            }),
            observers: match observers.as_slice() {
                [one] => (*one).to_owned(),
                several => format!("{{{}}}", several.join(", ")),
            },
            fluctuation: options.has(Part::Fluctuation),
            phasors: limit.is_some(),
            vibration_limit: float(limit.unwrap_or_default()),
            // as `HasVibration::VIBRATION_BASE` follows from the limit
            vibration_base: float(2.0 * limit.unwrap_or_default()),
            counts: 4 * machine.encoder.lines,
            weight: float(weight),
            nodes: nodes(machine, weight),
            load: machine.chain.masses().len() - 1,
            softest,
            friction: [&viscous[..=softest], &viscous[softest + 1..]].map(|part| float(part.iter().sum())),
            load_step: float(load_step.max(0.0)),
            plant: TwoMasses {
                motor_inertia: float(two.motor_inertia),
                load_inertia: float(two.load_inertia),
                stiffness: float(two.stiffness),
                damping: float(two.damping),
                before: [1.0 / before[0] - 1.0, 1.0 - before[1]].map(float),
                behind: [1.0 - behind[0], if behind[1] > 0.0 { 1.0 / behind[1] - 1.0 } else { LOCKED }].map(float),
                steps: 1 + (40.0 / TAU * period * two.resonance()) as u32,
                seconds: loaded,
                end: loaded + 2 + (2.0 * settling).ceil() as u32,
            },
            dependency_note: Source::find().note(),
            driveline: Source::find().dependency(""),
            solver: Source::find().dependency("host-tests/solver"),
            firmware: Source::find().dependency("firmware"),
            hal: Source::find().dependency("hal"),
            no_drive: match (gears, &plan) {
                (Err(why), _) => Some(why),
                (_, Err(error)) => Some(Designs::refusal(&damped, *error)),
                (_, Ok(plan)) => plan.predicted.as_ref().and_then(|predicted| predicted.lack.clone()),
            }
            .map(|why| refused(&why)),
        })
    }

    /// Itself, if its drive is robust; the machine alone needs none. What the design warns of goes to the standard
    /// error output.
    ///
    /// # Errors
    /// A drive that cannot be designed, or a speed loop without the margins that it must have.
    pub fn robust(mut self) -> Result<Self, Failure> {
        if let Some(failure) = self.no_drive.take() {
            return Err(failure);
        }
        self.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
        Ok(self)
    }

    /// The observer as a type.
    pub fn observer(&self) -> &str {
        &self.observer
    }
}

/// What the machine's file takes from `driveline::design`.
fn designs(machine: &MachineFile, tolerance: &[String], rigid: bool) -> Vec<&'static str> {
    let has = |word: &'static str, is: bool| is.then_some(word);
    [
        has("Actuator", machine.actuator() != Actuator::DIRECT),
        Some("Disturbance"),
        Some("Encoder"),
        has("RigidDesign", !machine.dampers.is_empty()),
        has("SpeedLoopTuning", has_tuning(machine)),
        has("Spread", tolerance.iter().any(|field| field.contains("Spread"))),
        has("Supervision", rigid),
        has("Tolerance", !tolerance.is_empty()),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The observer that is selected over the tolerances, from the outside in: behind the gear's losses, where it has some.
fn observers(machine: &MachineFile, plan: &Plan) -> Vec<&'static str> {
    let selected = match plan.predicted.as_ref().map(|predicted| predicted.observer) {
        Some("rigid") => "RigidObserver",
        Some("backlash") => "BacklashObserver",
        Some("semi-implicit") => "SemiImplicitObserver",
        _ => "TwoMassObserver",
    };
    let Losses { before, behind } = machine.chain.losses();
    let gear = |name, losses| (losses != [1.0; 2]).then_some(name);
    let gears = [gear("LoadGearObserver", behind), gear("GearedObserver", before)];
    gears.into_iter().flatten().chain([selected]).collect()
}

/// The masses for the full solver.
fn nodes(machine: &MachineFile, weight: f64) -> Vec<Node> {
    let (ropes, losses) = machine.ropes_and_efficiencies();
    let rigid = machine.rigid_gears();
    let (masses, shafts) = (machine.chain.masses(), machine.chain.shafts());
    let viscous = machine.viscous();
    let unless = |neutral: f64, value: f64| if value == neutral { String::new() } else { format!("{value:?}") };
    let node = |(at, inertia): (usize, &f64)| {
        let before = at.checked_sub(1);
        let shaft = before.and_then(|before| shafts.get(before));
        let [stiffness, damping, gap] =
            shaft.map_or([1.0, 0.0, 0.0], |shaft| [shaft.stiffness, shaft.damping, shaft.gap]);
        // the weight keeps a gap on its flank
        let flank = if weight > 0.0 { 0.5 * gap } else { 0.0 };
        let gear = rigid.iter().find(|(mass, _)| *mass == at).map(|(_, gear)| gear);
        let before_shaft = losses.get(at).filter(|_| at < shafts.len()).copied().unwrap_or([1.0; 2]);
        let [ahead, back] = gear.map_or(before_shaft, |gear| [gear.efficiency, gear.back_efficiency]);
        let is_rope = before.and_then(|before| ropes.get(before)).is_some_and(|&rope| rope);
        Node {
            from: before.unwrap_or(0),
            inertia: format!("{inertia:?}"),
            viscous: unless(0.0, viscous[at]),
            efficiency: unless(1.0, ahead),
            back_efficiency: unless(ahead, back),
            front: gear.map_or_else(String::new, |gear| format!("{:?}", gear.front)),
            kind: if is_rope { "rope" } else { "elastic" },
            stiffness: format!("{stiffness:?}"),
            damping: format!("{damping:?}"),
            gap: unless(0.0, gap),
            twist: format!("{:?}", flank + weight / stiffness),
            friction: String::new(),
        }
    };
    let ring = |(ring, sized, friction): (&DamperRing, Damper, Option<f64>)| Node {
        from: ring.mass,
        inertia: format!("{:?}", sized.inertia),
        kind: "elastic",
        stiffness: format!("{:?}", sized.stiffness),
        damping: format!("{:?}", sized.damping),
        twist: "0.0".to_owned(),
        friction: friction.map_or_else(String::new, |torque| format!("{torque:?}")),
        ..Node::default()
    };
    masses.iter().enumerate().map(node).chain(machine.sized_dampers().into_iter().map(ring)).collect()
}

/// The crate of a package's name, as cargo has it.
fn crate_name(name: &str) -> Result<String, Failure> {
    let krate = name.replace('-', "_").to_ascii_lowercase();
    let letters = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_');
    let taken = ["driveline", "core", "std", "alloc", "test", "build", "deps", "examples", "proc_macro"];
    let reserved = [
        "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate", "do", "dyn",
        "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro",
        "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return", "self", "static", "struct", "super",
        "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
    ];
    if !letters || !name.starts_with(|c: char| c.is_ascii_alphabetic()) || name.len() > 40 {
        return Err(Failure::usage(format!(
            "`{name}` is no name of a project: expected a letter, then letters, digits, `-` or `_`, at most 40 in all"
        )));
    }
    if taken.contains(&krate.as_str()) || reserved.contains(&krate.as_str()) {
        return Err(Failure::usage(format!(
            "`{name}` is a reserved word of Rust or cargo; name the project otherwise"
        )));
    }
    Ok(krate)
}

/// Keywords of C and C++, and the program itself.
const WORDS_OF_C: &str = "
    alignas alignof and and_eq asm atomic_cancel atomic_commit atomic_noexcept auto bitand bitor bool break
    case catch char char16_t char32_t char8_t class co_await co_return co_yield compl concept const
    const_cast consteval constexpr constinit continue contract_assert decltype default delete do double
    dynamic_cast else enum explicit export extern false float for friend goto if inline int long mutable
    namespace new noexcept not not_eq nullptr operator or or_eq private protected public reflexpr register
    reinterpret_cast requires restrict return short signed sizeof static static_assert static_cast struct
    switch synchronized template this thread_local throw true try typedef typeid typename typeof
    typeof_unqual union unsigned using virtual void volatile wchar_t while xor xor_eq main
";

/// The name of a crate as a prefix in C and a namespace in C++, of which it must be no word.
pub fn name_of_c(krate: &str) -> Result<(), Failure> {
    if WORDS_OF_C.split_whitespace().any(|word| word == krate) {
        return Err(Failure::usage(format!(
            "`{krate}` is a word of C or C++, and no prefix of its names; give another with --name"
        )));
    }
    Ok(())
}

/// A type for the machine that is none of the words it is described with.
fn type_name(krate: &str, words: &[&str]) -> String {
    let part = |part: &str| part[..1].to_ascii_uppercase() + &part[1..];
    let name: String = krate.split('_').filter(|name| !name.is_empty()).map(part).collect();
    let imported = ["Machine", "Rating", "Disturbance", "Encoder", "HasVibration", "Self", "TheMachine"];
    if words.contains(&name.as_str()) || imported.contains(&name.as_str()) { name + "Drive" } else { name }
}

#[cfg(test)]
mod tests {
    use super::{crate_name, name_of_c, type_name};

    #[test]
    fn a_name_is_that_of_a_crate_and_of_a_type() {
        assert_eq!(crate_name("feed-axis").unwrap(), "feed_axis");
        assert_eq!(type_name("feed_axis_2", &[]), "FeedAxis2");
        // an import of the machine's file is not defined twice
        assert_eq!(type_name("chain", &["Chain"]), "ChainDrive");
        for wrong in ["", "2fast", "a b", "../x", "match", "core", "driveline", "größe"] {
            assert!(crate_name(wrong).is_err(), "{wrong}");
        }
        // `namespace int` is no C++, `int_state_t` is
        assert!(name_of_c("int").is_err() && name_of_c("int_drive").is_ok());
    }
}
