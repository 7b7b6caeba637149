//! What the report says in words and single figures.

use driveline::machine::{Chain, Match};
use driveline_firmware::scenes::hoist;

use super::closed_loop::Trace;
use super::figures::{deviations, peaks};
use super::scenario::Machine;
use crate::report::{Fact, Variant};

/// What was run.
pub const SUMMARY: &str = "A 12 t crane hoist, observed and governed from the motor's angle and torque alone: the firmware \
    of every variant runs in QEMU, tick by tick against a full solver of the whole machine.";

/// The machine and its reduction.
pub fn of_hoist(machine: &Machine) -> Vec<Fact> {
    let (two, cut) = (hoist::REDUCED, hoist::CUT);
    let modal = Chain::reduce(&hoist::CHAIN, Match::ModalTruncation);
    let hertz = |rate: f64| rate / core::f64::consts::TAU;
    let design = hoist::observer(&two, 10_000);
    let reduction = |name: &str, two: &driveline::machine::TwoMass| {
        fact(
            name,
            format!(
                "{:.4} and {:.4} kg m², {:.1} N m/rad; error at most {:.1} % of the motor's first jump in speed",
                two.motor_inertia,
                two.load_inertia,
                two.stiffness,
                100.0 * two.error.worst
            ),
        )
    };
    let sd = design.standard_deviation;
    vec![
        fact(
            "antiresonance, resonance",
            format!("{:.2} Hz, {:.2} Hz", hertz(two.antiresonance()), hertz(two.resonance())),
        ),
        reduction("reduced by resonance and antiresonance", &two),
        reduction("reduced by modal truncation", &modal),
        reduction("textbook cut at the rope", &cut),
        fact(
            "mode left out",
            format!(
                "{:.1} Hz, with {:.0} % of the rigid motion's share at the motor",
                hertz(two.error.next_mode),
                100.0 * two.error.next_share
            ),
        ),
        fact(
            "error of the semi-implicit step at 10 kHz",
            format!(
                "{:.2} % over a period of the resonance; the design takes it below 1 %",
                100.0 * design.semi_implicit.fidelity.error_bound
            ),
        ),
        fact(
            "predicted standard deviations",
            format!(
                "shaft torque {:.2} N m, load speed {:.2} rad/s, load torque {:.1} N m",
                sd.shaft_torque, sd.load_speed, sd.load_torque
            ),
        ),
        fact("torque noise", format!("{:.1} N m rms in every tick, white", machine.torque_noise)),
        fact("encoder", "2048 lines, 8192 counts a turn".into()),
    ]
}

/// The run that is not counted, with its figure.
pub fn of_sudden(machine: &Machine, variant: &Variant, traces: &[Trace]) -> Vec<Fact> {
    let outside = traces.iter().zip(&machine.scenarios).filter(|(_, scenario)| !scenario.counted);
    outside
        .map(|(trace, scenario)| {
            let [torque, _, load] = peaks(std::iter::once(trace));
            let [torque, speed, _] = deviations(std::iter::once(trace), [torque, machine.rated_speed, load]);
            fact(
                &format!("{} (not counted), {}", scenario.name, variant.label()),
                format!(
                    "shaft torque {:.2} % rms of peak, load speed {:.2} % rms and {:.1} % at most of rated",
                    100.0 * torque.rms,
                    100.0 * speed.rms,
                    100.0 * speed.max
                ),
            )
        })
        .collect()
}

/// What is measured and what is not.
pub fn notes(quick: bool) -> Vec<String> {
    let mut notes: Vec<String> = [
        "Measured in QEMU 7.2 or later: instructions, to the instruction; stack, by painting it; bits, against the host. No real board has run this.",
        "Cycles are an estimate: instructions times the mean of the cores' manuals over the tick's instruction mix, without wait states.",
        "Flash and RAM are those of the image with the drive less those of the image without one.",
        "Errors are estimate less truth over the counted runs: of the peak for torques, of rated speed for speeds. The shaft torque is the rope's pull at the motor, \
         behind the gear's loss.",
        "Every run of the solver was integrated again by another integrator (DOP853) and with tenfold tighter events, and agreed within 1e-8.",
        "The textbook cut, the modal truncation and the match of resonance and antiresonance estimate this hoist alike within the noise: its motor shaft is stiff and its rope soft. \
         Machines with shafts of like stiffness differ; `cargo driveline modes` says by how much.",
    ]
    .map(String::from)
    .into();
    if quick {
        notes
            .insert(0, "A quick run: two seconds of the first situation, not proven. Not for figures to quote.".into());
    }
    notes
}

fn fact(name: &str, value: String) -> Fact {
    Fact { name: name.into(), value }
}
