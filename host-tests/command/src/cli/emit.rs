//! A machine as Rust constants to paste into a firmware, in the library's own words.

use std::collections::BTreeSet;
use std::fmt::Write;

use driveline::design::{SpeedLoopTuning, Spread, Tolerance};
use driveline::machine::Damper;

use crate::machine_file::{Branch, DamperKind, DamperRing, Element, MachineFile, Part};

/// The constants: the chain, its reduction, the observer's design and, for two masses, the speed loop's.
pub fn rust(machine: &MachineFile) -> Result<String, String> {
    let name = machine.constant();
    let rings = machine.rings();
    let is_train = !machine.branches.is_empty() || !rings.is_empty();
    let two = machine.with_dampers()?.two_masses().is_some();
    let designs = if two {
        "Disturbance, Encoder, Rate, SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign"
    } else {
        "Disturbance, Encoder, Rate, RigidDesign"
    };
    let mut chain = written(&machine.elements, "    ");
    if is_train {
        chain = format!("Train::of(\n    {}\n)", written(&machine.elements, "        "));
    }
    for Branch { node, ratio, elements, .. } in &machine.branches {
        let branch = written(elements, "        ");
        chain.push_str(&format!("\n.branch(\n    {node},\n    Ratio({ratio:?}),\n    {branch},\n)"));
    }
    chain.push_str(&dampers(&rings));
    let mut words = words(&chain);
    words.extend(if two { ["Match", "TwoMass"].as_slice() } else { ["Rigid"].as_slice() });
    let kind = if is_train { "Train" } else { "Chain" };
    let (torque, step, within) =
        (machine.disturbance.torque_accuracy, machine.disturbance.load_torque_step, machine.disturbance.within);
    let encoder = encoder(machine);
    let (model, make, observer) = if two {
        ("TwoMass", format!("{name}.reduce(Match::ResonanceAntiresonance)"), "TwoMassDesign")
    } else {
        ("Rigid", format!("{name}.rigid()"), "RigidDesign")
    };
    let mut text = format!(
        "//! {title}: the machine and its controller, designed by the compiler.

use driveline::design::{{{designs}}};
use driveline::machine::{{{words}}};

/// The machine, from the motor to the load.
pub const {name}: {kind} = {chain};

/// The observer's model.
pub const {name}_MODEL: {model} = {make};

/// Ticks a second.
pub const {name}_RATE: Rate = Rate::hz({rate});

/// The observer.
pub const {name}_OBSERVER: {observer} = {name}_MODEL.observer(
    {name}_RATE,
    {encoder},
    Disturbance {{ torque_accuracy: {torque:?}, load_torque_step: {step:?}, within: {within:?} }},
);
",
        title = machine.name,
        words = words.into_iter().collect::<Vec<_>>().join(", "),
        rate = machine.control.rate_hz,
    );
    if two {
        let tuning = tuning(machine, &format!("&{name}_MODEL"));
        // Writing to a `String` cannot fail.
        let _ = write!(
            text,
            "
/// The speed loop.
pub const {name}_SPEED_LOOP: SpeedLoopDesign = {name}_MODEL.speed_loop({name}_RATE, {tuning});
"
        );
    }
    let _ = write!(
        text,
        "
/// Largest motor torque (N m).
pub const {name}_TORQUE: f64 = {:?};

/// Largest motor speed (rad/s).
pub const {name}_SPEED: f64 = {:?};
",
        machine.limits.torque, machine.limits.speed
    );
    Ok(text)
}

/// The calls that put rings on a train, each on a line of its own.
pub(super) fn dampers(rings: &[(&DamperRing, Damper)]) -> String {
    let call = |(ring, Damper { inertia, stiffness, damping }): &(&DamperRing, Damper)| match ring.kind {
        // it sticks to its mass while the vibration is small
        DamperKind::Friction { .. } => {
            format!("\n.branch({}, Ratio(1.0), Chain::motor(Inertia({inertia:?})))", ring.mass)
        }
        _ => {
            let sizes = format!("inertia: {inertia:?}, stiffness: {stiffness:?}, damping: {damping:?}");
            format!("\n.damper({}, Ratio(1.0), Damper {{ {sizes} }})", ring.mass)
        }
    };
    rings.iter().map(call).collect()
}

/// The library's words that a chain is written with: those with a capital, and of `Member::Sun` the first.
pub(super) fn words(chain: &str) -> BTreeSet<&str> {
    let paths = chain.split(|c: char| !(c.is_alphanumeric() || "_:".contains(c)));
    paths.filter_map(|path| path.split(':').next()).filter(|word| word.starts_with(char::is_uppercase)).collect()
}

/// Whether the file names another bandwidth than the usual one.
pub(super) fn has_tuning(machine: &MachineFile) -> bool {
    machine.bandwidth != SpeedLoopTuning::USUAL.bandwidth
}

/// The speed loop's tuning for two masses.
pub(super) fn tuning(machine: &MachineFile, two: &str) -> String {
    if has_tuning(machine) {
        format!("SpeedLoopTuning::with_bandwidth({two}, {:?})", machine.bandwidth)
    } else {
        format!("SpeedLoopTuning::of({two})")
    }
}

/// The encoder with its accuracy.
pub(super) fn encoder(machine: &MachineFile) -> String {
    let accuracy = &machine.encoder.accuracy;
    // the library takes so few lines for bits
    let mut encoder = match machine.encoder.lines {
        lines @ 0..32 => format!("Encoder::counts({})", 4 * lines),
        lines => format!("Encoder::lines({lines})"),
    };
    if !accuracy.is_none() {
        encoder += &format!(
            ".interpolation({}, {:?}).eccentricity({:?}).jitter({:?}, {:?})",
            accuracy.signal_periods,
            accuracy.interpolation,
            accuracy.eccentricity,
            accuracy.jitter,
            machine.limits.speed,
        );
    }
    encoder
}

/// The elements of a chain or a branch in the library's words, a line for each.
pub(super) fn written(elements: &[Part], indent: &str) -> String {
    let mut text = String::new();
    for (index, part) in elements.iter().enumerate() {
        match part.element {
            // a branch begins as a chain does
            Element::Rotor { inertia, viscous } if index == 0 => {
                text.push_str(&Element::Motor { inertia, viscous }.rust());
            }
            element if index == 0 && !matches!(element, Element::Motor { .. }) => {
                text.push_str(&format!("Chain::motor(Inertia(f64::MIN_POSITIVE))\n{indent}{}", element.rust()));
            }
            element if index == 0 => text.push_str(&element.rust()),
            element => text.push_str(&format!("\n{indent}{}", element.rust())),
        }
    }
    text
}

/// The tolerances that the speed loop is tested with, where they are not the usual ones.
pub fn tolerance(machine: &MachineFile) -> Vec<String> {
    let (own, usual) = (machine.tolerance(), Tolerance::USUAL);
    let spreads = [
        ("motor_inertia", own.motor_inertia, usual.motor_inertia),
        ("load_inertia", own.load_inertia, usual.load_inertia),
        ("stiffness", own.stiffness, usual.stiffness),
        ("torque", own.torque, usual.torque),
        ("damping", own.damping, usual.damping),
    ];
    let spread = |(name, own, usual): (&str, Spread, Spread)| {
        (own != usual).then(|| format!("{name}: Spread::between({:?}, {:?})", own.min, own.max))
    };
    let late = (own.late != usual.late).then(|| format!("late: {}", own.late));
    let lag = (own.lag != usual.lag).then(|| format!("lag: {:?}", own.lag));
    spreads.into_iter().filter_map(spread).chain(late).chain(lag).collect()
}
