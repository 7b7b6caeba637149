//! The report's facts and single figures.

use driveline::configure;

use driveline_closed_loop::figures::{deviations, peaks};
use driveline_closed_loop::lockstep::Trace;
use driveline_closed_loop::scenario::Machine;
use driveline_closed_loop::sensors::Encoder;
use driveline_report::{Fact, Variant};

/// Noise of the reported torque in every scene, of rated torque.
const NOISE: f64 = 0.01;

/// What follows from a scene's constants. Its runs, nodes and torques are put in; nothing is told of friction.
pub fn scene<M: configure::Machine>(name: &'static str, counts: u32) -> Machine {
    Machine {
        name,
        summary: "",
        facts: Vec::new(),
        notes: Vec::new(),
        chosen: ("", M::RATE_HZ),
        scenarios: Vec::new(),
        encoder: Encoder::new(counts),
        torque_noise: NOISE * M::RATING.torque.0,
        load: 0,
        shaft_torque: |_| 0.0,
        load_torque: |_| 0.0,
        told_friction: 0.0,
        rated_speed: M::RATING.speed.0,
        bases: M::BASES,
    }
}

/// A machine as its observer has it, and what the design says of it.
pub fn of_design<M: configure::Machine>(counts: u32) -> Vec<Fact> {
    let (design, torque_noise) = (M::OBSERVER, NOISE * M::RATING.torque.0);
    let two = &design.machine;
    let hertz = |rate: f64| rate / core::f64::consts::TAU;
    let left_out = if two.error.next_mode.is_finite() {
        format!(
            "{:.1} Hz, with {:.2} % of the rigid motion's share at the motor",
            hertz(two.error.next_mode),
            100.0 * two.error.next_share
        )
    } else {
        "none".to_owned()
    };
    let sd = design.standard_deviation;
    vec![
        fact(
            "two masses",
            format!(
                "{:.4} and {:.4} kg m², {:.4e} N m/rad, at the motor",
                two.motor_inertia, two.load_inertia, two.stiffness
            ),
        ),
        fact(
            "antiresonance, resonance",
            format!("{:.2} Hz, {:.2} Hz", hertz(two.antiresonance()), hertz(two.resonance())),
        ),
        fact("mode left out", left_out),
        fact(
            "error of the semi-implicit step",
            format!(
                "{:.2} % over a period of the resonance; the design takes it below 1 %",
                100.0 * design.semi_implicit.fidelity.error_bound
            ),
        ),
        fact(
            "predicted standard deviations",
            format!(
                "shaft torque {:.3} N m, load speed {:.4} rad/s, load torque {:.2} N m",
                sd.shaft_torque, sd.load_speed, sd.load_torque
            ),
        ),
        fact("torque noise", format!("{torque_noise:.2} N m rms in every tick, white")),
        fact("encoder", format!("{counts} counts a turn")),
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

/// Measured and unmeasured costs.
pub fn notes(machine: &Machine, quick: bool) -> Vec<String> {
    let general = [
        "Measured in QEMU 7.2 or later: instructions, to the instruction; stack, by painting it; bits, against the \
            host. No real board has run this.",
        "Cycles are those of the path that has the most, by the rules of the cores' manuals without wait states: the \
            upper end is a bound.",
        "Flash and RAM are those of the image with the drive less those of the image without one.",
        "Errors are estimate less truth over the counted runs: of the peak for torques, of rated speed for speeds.",
    ];
    let proven = "Every run of the solver was integrated again by another integrator (DOP853) and with tenfold tighter \
        events, and agreed within 1e-8.";
    let brief = "A quick run: two seconds of the first situation, not proven. Not for figures to quote.";
    let (first, last) = if quick { (Some(&brief), None) } else { (None, Some(&proven)) };
    let notes = first.into_iter().chain(&general).chain(last).chain(&machine.notes);
    notes.map(|note| (*note).to_owned()).collect()
}

pub fn fact(name: &str, value: String) -> Fact {
    Fact { name: name.into(), value }
}
