//! `cargo driveline design`: observer and governor of a machine.

#[cfg(not(target_family = "wasm"))]
mod command;
mod crossings;
#[cfg(not(target_family = "wasm"))]
mod drawn;
mod linear;
mod page;
pub mod rates;
mod responses;

#[cfg(not(target_family = "wasm"))]
pub use command::Design;
use std::f64::consts::TAU;

use self::page::page;
use self::responses::{Detail, Responses};
use super::controller::{Causes, LeastMargins, Margins, Predicted, SpeedLoop};
use super::emit::tolerance;
use super::{Plan, rust};
use crate::machine_file::MachineFile;
use crate::machine_file::class::Class;
use crate::machine_file::designs::{Designs, Widest};
use driveline::design::{Actuator, Spread, Tolerance};
use driveline_report::Table;
use driveline_report::format::{counted, percent, rate, significant};

/// The design with the arrays of its loop.
#[derive(serde::Serialize)]
struct Whole<'p> {
    #[serde(flatten)]
    plan: &'p Plan,
    /// `null` where the machine has no shaft.
    responses: Option<Responses>,
    /// How wide the speed loop may be; `null` where it lacks margins as it is.
    widest: Option<Widest>,
    /// Rates and observers side by side, where they are asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    rates: Option<Vec<rates::Choice>>,
}

/// The design as a page in a browser has it.
#[derive(Debug)]
pub struct Answered {
    /// What `--json` prints, where that is asked for: it takes longer than the page.
    pub json: Option<String>,
    /// What `--html` writes.
    pub page: String,
    /// The constants of a loop that is stable.
    pub rust: Option<String>,
}

impl Answered {
    /// Of a machine; `quick` with fewer points drawn.
    ///
    /// # Errors
    /// The library's sentence for a machine that cannot be observed or governed.
    pub fn of(machine: &MachineFile, with_json: bool, quick: bool) -> Result<Self, String> {
        let plan = Plan::with_dampers(machine)?;
        let responses = responses(machine, if quick { Detail::QUICK } else { Detail::FULL })?;
        let page = page(&plan, responses.as_ref());
        let is_stable = plan.speed_loop.as_ref().is_none_or(|governor| governor.no_margins.is_none());
        let rust = is_stable.then(|| emitted(machine, &plan)).transpose()?;
        let whole = |responses| Whole { plan: &plan, responses, widest: widest(machine, &plan), rates: None };
        let json = with_json.then(|| serde_json::to_string(&whole(responses))).transpose();
        Ok(Self { json: json.map_err(|error| error.to_string())?, page, rust })
    }
}

/// The responses of the loop; none where the machine has no shaft.
fn responses(machine: &MachineFile, detail: Detail) -> Result<Option<Responses>, String> {
    let damped = machine.with_dampers()?;
    let of = |two| Responses::of(&damped, &Designs::of(&damped, &two)?, detail);
    damped.two_masses().map(of).transpose().map_err(|error| error.to_string())
}

/// How wide the speed loop of a plan may be.
fn widest(machine: &MachineFile, plan: &Plan) -> Option<Widest> {
    let damped = machine.with_dampers().ok()?;
    damped.widest(&damped.two_masses()?, plan.speed_loop.as_ref()?.observer == "rigid")
}

/// The constants, and which parts of the design are none of them.
fn emitted(machine: &MachineFile, plan: &Plan) -> Result<String, String> {
    let rigid = plan.predicted.as_ref().is_some_and(|predicted| predicted.observer == "rigid");
    let left_out = [
        rigid.then_some("the selected observer, of one mass"),
        (machine.actuator() != Actuator::DIRECT).then_some("the actuator"),
        (!tolerance(machine).is_empty()).then_some("the tolerances"),
    ];
    let left_out: Vec<&str> = left_out.into_iter().flatten().collect();
    let note = match left_out.as_slice() {
        [] => String::new(),
        parts => {
            format!("\n// Not among these: {}; `cargo driveline new` writes a project with them.\n", parts.join(", "))
        }
    };
    let lack = plan.speed_loop.as_ref().and_then(|governor| governor.not_robust.as_ref());
    let warning = lack.map_or_else(String::new, |why| format!("\n// The speed loop lacks margins: {why}.\n"));
    rust(machine).map(|text| text + &note + &warning)
}

/// The design in words and tables.
fn text(machine: &MachineFile, plan: &Plan) -> String {
    let mut text = format!("{}: {} observer at {}\n\n", plan.name, plan.observer, rate(plan.rate_hz));
    let mut facts = Table::new(["machine at the motor", "value", "unit"]);
    let mut fact =
        |name: &str, value: f64, unit: &str| facts.row([name.to_owned(), significant(value), unit.to_owned()]);
    let sides: &[&str] =
        if plan.inertias.len() == 1 { &["inertia"] } else { &["motor-side inertia", "load-side inertia"] };
    for (name, inertia) in sides.iter().zip(&plan.inertias) {
        fact(name, *inertia, "kg m²");
    }
    if let Some(shaft) = &plan.shaft {
        fact("stiffness", shaft.stiffness, "N m/rad");
        fact("damping", shaft.damping, "N m s/rad");
        fact("backlash", shaft.gap, "rad");
        fact("resonance", shaft.resonance / TAU, "Hz");
        fact("antiresonance", shaft.antiresonance / TAU, "Hz");
        fact("reduction error at worst", shaft.reduction_error * 100.0, "% of a jump of the motor's speed");
    }
    fact("weight", machine.gravity_torque(), "N m");
    text.push_str(&format!("{facts}\n"));
    if let Some(dampers) = &plan.dampers {
        text.push_str(&format!("{dampers}\n\n"));
    }
    for warning in &plan.warnings {
        text.push_str(&format!("warning: {warning}\n\n"));
    }
    if let Some(shaft) = &plan.shaft {
        let bound = match shaft.semi_implicit_error {
            Some(error) => format!("off by {} over a period of the resonance", percent(error)),
            None => "unstable".to_owned(),
        };
        let limit = percent(shaft.semi_implicit_threshold);
        let it = if shaft.step == "exact" { "the semi-implicit one" } else { "it" };
        text.push_str(&format!("step: {}, because {it} is {bound} (taken up to {limit})\n\n", shaft.step));
    }
    if let Some(need) = &plan.need {
        let missed = |[torque, speed]: [f64; 2]| {
            format!("{} of the largest torque and {} of the largest speed", percent(torque), percent(speed))
        };
        text.push_str(&format!("errors by the load cycle alone: without the shaft {}", missed(need.without_shaft)));
        if need.without_gap != [0.0; 2] {
            text.push_str(&format!(", without the gap {}", missed(need.without_gap)));
        }
        text.push_str(&format!(" (rms; 1 % and 0.15 % are allowed): {} would do\n\n", words(need.observer)));
    }
    let mut states = Table::new(["state", "unit", "gain per rad of innovation", "predicted standard deviation"]);
    for state in &plan.states {
        states.row([
            state.name.to_owned(),
            state.unit.to_owned(),
            significant(state.gain),
            significant(state.standard_deviation),
        ]);
    }
    if let Some(shaft) = &plan.shaft {
        states.row([
            "shaft torque".to_owned(),
            "N m".to_owned(),
            String::new(),
            significant(shaft.torque_standard_deviation),
        ]);
    }
    text.push_str(&format!("{states}\n"));
    let poles: Vec<String> = plan
        .poles
        .iter()
        .map(|pole| match pole.im {
            0.0 => format!("{:.4}", pole.re),
            im => format!("{:.4}{im:+.4}j", pole.re),
        })
        .collect();
    text.push_str(&format!("poles: {} (largest size {:.6})\n", poles.join(", "), plan.spectral_radius));
    if let Some(governor) = &plan.speed_loop {
        text.push_str(&format!(
            "\nspeed loop with the observer of {}: proportional {} N m s/rad, integral {} N m/rad, \
             damping {} N m s/rad; {} Hz wide{}\n{}{}",
            if governor.observer == "rigid" { "one mass" } else { "two masses" },
            significant(governor.proportional),
            significant(governor.integral),
            significant(governor.damping),
            significant(governor.bandwidth / TAU),
            wide(machine, plan),
            governor.margins.as_ref().map_or_else(|| none("margins", governor.no_margins.as_ref()), margins)
                + &with_losses(governor),
            within_tolerances(machine, governor),
        ));
    }
    if let Some(predicted) = &plan.predicted {
        text.push_str(&over_tolerances(machine, predicted));
    }
    text.trim_end().to_owned()
}

/// The width of the loop in the industry's unit, and what limits it.
fn wide(machine: &MachineFile, plan: &Plan) -> String {
    widest(machine, plan).map_or_else(String::new, |Widest { share, cause }| {
        let beyond = cause.map_or_else(String::new, |cause| format!("; beyond, {cause}"));
        format!(", {} of the antiresonance, may be {share:.2} of it{beyond}", significant(machine.bandwidth))
    })
}

/// The errors that are predicted over the tolerances, and the observer that is selected by them.
fn over_tolerances(machine: &MachineFile, predicted: &Predicted) -> String {
    let mut table = Table::new(["errors over tolerances, rms", "statics", "encoder", "noise", "swing", "total"]);
    let quantities = ["shaft torque, of rated", "load speed, of the largest", "load torque, of rated"];
    for (name, causes) in [("two masses", &predicted.two_masses), ("one mass", &predicted.one_mass)] {
        for (k, quantity) in quantities.into_iter().enumerate() {
            let Causes { statics, encoder, noise, swing, total } = causes;
            let parts = [statics, encoder, noise, swing, total].map(|part| percent(part[k]));
            table.row([format!("{name}: {quantity}")].into_iter().chain(parts));
        }
    }
    let class = Class::ALL.into_iter().find(|(_, class)| *class == machine.class).map_or("general", |(name, _)| name);
    let simpler = if predicted.is_simpler { ": one mass is as good over the tolerances" } else { "" };
    let remark = predicted.remark.as_ref().map_or_else(String::new, |remark| format!("; {remark}"));
    let sound =
        if predicted.observer == "rigid" && predicted.lack.is_none() { "; its loop has the margins" } else { "" };
    let lack = predicted.lack.as_ref().map_or_else(String::new, |lack| format!("warning: {lack}\n"));
    format!(
        "\n{table}selected observer, over the tolerances of class {class}: {}{simpler}{sound}{remark}\n{lack}",
        words(predicted.observer)
    )
}

/// An observer in words.
fn words(observer: &str) -> &'static str {
    match observer {
        "rigid" => "one mass",
        "semi-implicit" => "two masses by the semi-implicit step",
        "exact" => "two masses by the exact step",
        _ => "two masses with the gap",
    }
}

/// "None", with the reason.
fn none(which: &str, why: Option<&String>) -> String {
    format!("{which}: none: {}\n", why.map_or("", |why| why))
}

/// The least margins within the tolerances, and a warning where the library would refuse the loop.
fn within_tolerances(machine: &MachineFile, speed_loop: &SpeedLoop) -> String {
    let Tolerance { motor_inertia, load_inertia, stiffness, torque, late, lag, .. } = machine.tolerance();
    let range = |spread: Spread| format!("{} to {}", significant(spread.min), significant(spread.max));
    let control =
        if lag > 0.0 { format!(", current control of {} Hz", significant(1.0 / (TAU * lag))) } else { String::new() };
    let masses = if machine.dampers.is_empty() { "" } else { " of the two masses, without rings," };
    let within = format!(
        "margins{masses} within tolerances (motor side {}, load side {}, stiffness {}, torque {}, {} late{control})",
        range(motor_inertia),
        range(load_inertia),
        range(stiffness),
        range(torque),
        counted(late.into(), "tick"),
    );
    let refused = speed_loop.not_robust.as_ref().map_or_else(String::new, |why| format!("warning: {why}\n"));
    match &speed_loop.least_margins {
        None if speed_loop.margins.is_none() => String::new(),
        None => none(&within, speed_loop.not_robust.as_ref()),
        Some(least) => format!("{within}: {}\n{refused}", each(least)),
    }
}

/// Each margin; gains as factors and in dB.
fn each(margins: &LeastMargins) -> String {
    let gain = |factor: f64| {
        if factor > 0.0 {
            format!("{} ({:.1} dB)", significant(factor), 20.0 * factor.log10())
        } else {
            "any".to_owned()
        }
    };
    let any = |text: Option<String>| text.unwrap_or_else(|| "any".to_owned());
    format!(
        "gain up {}, gain down {}, phase {}, delay {}, distance from -1 {}",
        any(margins.gain_up.map(gain)),
        gain(margins.gain_down),
        any(margins.phase.map(|phase| format!("{:.0}°", phase.to_degrees()))),
        any(margins.delay.map(|delay| format!("{} ms", significant(1e3 * delay)))),
        significant(margins.modulus),
    )
}

/// The margins with the losses of the gears, in a line for each way that power flows.
fn with_losses(speed_loop: &SpeedLoop) -> String {
    let ways = [("motor", &speed_loop.margins_motor_driving), ("load", &speed_loop.margins_load_driving)];
    let line = |(way, found): (&str, &Option<LeastMargins>)| {
        found
            .as_ref()
            .map(|found| format!("margins with the losses of the gears, the {way} driving: {}\n", each(found)))
    };
    ways.into_iter().filter_map(line).collect()
}

/// The margins in two lines.
fn margins(margins: &Margins) -> String {
    let range = |[down, up]: [Option<f64>; 2]| match (down, up) {
        (None, None) => "any".to_owned(),
        (Some(down), None) => format!("{} times and more", significant(down)),
        (None, Some(up)) => format!("up to {} times", significant(up)),
        (Some(down), Some(up)) => format!("{} to {} times", significant(down), significant(up)),
    };
    format!(
        "margins: {}\ntolerates, one at a time: motor inertia {}, load inertia {}, stiffness {}\n",
        each(&margins.least),
        range(margins.motor_inertia),
        range(margins.load_inertia),
        range(margins.stiffness),
    )
}
