//! The page of `design`: the loop, what is in it, its steps, its margins.

use driveline_report::chart::{Band, Curve as Drawing, Lines, Locus, nyquist};
use driveline_report::format::{rate, significant};
use driveline_report::{Figure, Key, Section, Sheet, Table, fact};

use super::responses::{Curve, One, Range, Responses, Step, Steps};
use crate::cli::Plan;
use crate::cli::controller::LeastMargins;

/// What the loop leaves out.
const LINEAR: &str = "It is linear: gaps are closed, gears as drawn have no losses, and no limit acts.";

/// The page as HTML; without a speed loop, tables alone.
pub fn page(plan: &Plan, responses: Option<&Responses>) -> String {
    let mut facts = vec![fact("observer", plan.observer.to_owned()), fact("rate", rate(plan.rate_hz))];
    if let Some(governor) = &plan.speed_loop {
        facts.push(fact("observer in the loop", governor.observer.to_owned()));
        facts.push(fact("proportional gain", format!("{} N m s/rad", significant(governor.proportional))));
        facts.push(fact("integral gain", format!("{} N m/rad", significant(governor.integral))));
        facts.push(fact("gain on the twist rate", format!("{} N m s/rad", significant(governor.damping))));
    }
    let lacks = plan.speed_loop.as_ref().and_then(|governor| governor.not_robust.clone());
    let summary = match (responses, lacks) {
        (None, _) => "The machine has no shaft, so there is no speed loop to draw.".to_owned(),
        (Some(responses), None) => format!("The loop is cut {}. {LINEAR}", responses.cut),
        (Some(responses), Some(why)) => format!("The loop lacks margins: {why}. It is cut {}. {LINEAR}", responses.cut),
    };
    Sheet {
        name: plan.name.clone(),
        kicker: "observer and speed loop".to_owned(),
        summary,
        facts,
        figures: responses.map_or_else(Vec::new, figures),
        tables: responses.map_or_else(Vec::new, |responses| tables(plan, responses)),
    }
    .page()
}

/// Keys of the two machines, and of their band.
fn machines(responses: &Responses) -> Vec<Key> {
    let by = responses.drawn_by;
    let factors = format!(
        "nearest to -1 within the tolerances: motor side {}, load side {}, stiffness {}, torque {}{}",
        by.motor_inertia,
        by.load_inertia,
        by.stiffness,
        by.torque,
        if by.is_late { ", late" } else { "" }
    );
    vec![Key::curve("nominal machine, all vibrations", "s0"), Key::curve(factors, "s1")]
}

fn figures(responses: &Responses) -> Vec<Figure> {
    let Responses { nominal, drawn, observer, .. } = responses;
    let locus = |class: &str, one: &One| Locus {
        class: class.to_owned(),
        real: one.real.clone(),
        imaginary: one.imaginary.clone(),
        distance: one.distance,
    };
    let both = machines(responses);
    let estimates = vec![Key::curve("estimate", "s0"), Key::curve("two masses, without sampling", "s1")];
    let mut figures = vec![
        Figure::new(
            "The loop",
            "Its response where it is cut, up to half the rate. The band holds the corners of the tolerances, with two \
             masses; marks are where the nominal gain passes 1.",
            both.clone(),
            bode(responses, [&nominal.open, &drawn.open], Some(&responses.open_within), None),
        ),
        Figure::new(
            "The loop in the complex plane",
            "Each circle is the largest about -1 that its response stays out of: its radius is the distance. The \
             dashed circle has the gain 1.",
            both.clone(),
            vec![nyquist(&[locus("s0", nominal), locus("s1", drawn)])],
        ),
        Figure::new(
            "The machine",
            "Motor speed per motor torque, in continuous time.",
            both.clone(),
            bode(responses, [&nominal.plant, &drawn.plant], Some(&responses.plant_within), Some("rad/s per N m")),
        ),
        Figure::new(
            "The observer: load speed",
            "Estimated load speed per measured motor speed, without a torque of the motor.",
            estimates.clone(),
            bode(responses, [&observer.load_speed, &observer.load_speed_of_two_masses], None, Some("rad/s per rad/s")),
        ),
        Figure::new(
            "The observer: shaft torque",
            "Estimated shaft torque per measured motor speed, without a torque of the motor.",
            estimates,
            bode(
                responses,
                [&observer.shaft_torque, &observer.shaft_torque_of_two_masses],
                None,
                Some("N m per rad/s"),
            ),
        ),
    ];
    let course: fn(&Steps) -> &Step = |steps| &steps.setpoint;
    let load: fn(&Steps) -> &Step = |steps| &steps.load;
    for (title, text, of) in [
        ("A step of the setpoint", "By 1 rad/s, without the ramp and below every limit.", course),
        ("A step of the load", "By 1 N m on the load, below every limit.", load),
    ] {
        let plots = steps(responses, of);
        if !plots.is_empty() {
            figures.push(Figure::new(title, text, both.clone(), plots));
        }
    }
    figures
}

/// Gain and phase of two responses over frequency; without a unit the gain is that of the loop, in decibels and with
/// its crossovers.
fn bode(responses: &Responses, both: [&Curve; 2], within: Option<&Range>, unit: Option<&str>) -> Vec<String> {
    let decibels = |gain: &f64| 20.0 * gain.log10();
    let gain = |curve: &Curve| match unit {
        Some(_) => curve.gain.clone(),
        None => curve.gain.iter().map(decibels).collect(),
    };
    let crossings = responses.nominal.crossings.iter().filter(|one| one.phase_margin.is_some() && unit.is_none());
    let marks: Vec<(f64, String)> = crossings.map(|one| (one.hz, format!("{} Hz", significant(one.hz)))).collect();
    let lines = |across: &str, logarithmic: bool, part: &dyn Fn(&Curve) -> Vec<f64>| {
        let curves = [("s1", both[1]), ("s0", both[0])];
        Lines {
            label: format!("{across} over frequency"),
            along: "frequency, Hz".to_owned(),
            across: across.to_owned(),
            places: responses.hz.clone(),
            curves: curves.map(|(class, curve)| Drawing { class: class.to_owned(), values: part(curve) }).into(),
            marks: marks.clone(),
            logarithmic,
            decades: true,
            bands: within
                .map(|range| Band { class: "s1".to_owned(), least: part(&range.least), most: part(&range.most) })
                .into_iter()
                .collect(),
            ..Lines::default()
        }
        .draw()
    };
    vec![
        lines(unit.unwrap_or("gain of the loop, dB"), unit.is_some(), &gain),
        lines("phase, degrees", false, &|curve| curve.phase.clone()),
    ]
}

/// Speeds and torque of a step, of each machine whose loop is stable.
fn steps(responses: &Responses, of: fn(&Steps) -> &Step) -> Vec<String> {
    let both = [("s1", &responses.drawn), ("s0", &responses.nominal)];
    let courses: Vec<(&str, &Step)> =
        both.into_iter().filter_map(|(class, one)| Some((class, of(one.steps.as_ref()?)))).collect();
    let parts: [(&str, fn(&Step) -> &Vec<f64>); 3] = [
        ("motor speed, rad/s", |step| &step.motor_speed),
        ("load speed, rad/s", |step| &step.load_speed),
        ("motor torque, N m", |step| &step.motor_torque),
    ];
    let plot = |(across, part): (&str, fn(&Step) -> &Vec<f64>)| {
        Lines {
            label: format!("{across} over time"),
            along: "time, s".to_owned(),
            across: across.to_owned(),
            places: responses.time.clone(),
            curves: courses
                .iter()
                .map(|(class, step)| Drawing { class: (*class).to_owned(), values: part(step).clone() })
                .collect(),
            ..Lines::default()
        }
        .draw()
    };
    if courses.is_empty() { Vec::new() } else { parts.map(plot).into() }
}

fn tables(plan: &Plan, responses: &Responses) -> Vec<Section> {
    let governor = plan.speed_loop.as_ref();
    let decibels = |factor: f64| significant(20.0 * factor.log10());
    let any = |value: Option<String>| value.unwrap_or_else(|| "any".to_owned());
    let row = |least: &LeastMargins| {
        [
            any(least.gain_up.map(decibels)),
            if least.gain_down > 0.0 { decibels(least.gain_down) } else { "any".to_owned() },
            any(least.phase.map(|phase| significant(phase.to_degrees()))),
            any(least.delay.map(|delay| significant(1e3 * delay))),
            significant(least.modulus),
        ]
    };
    let nominal = governor.and_then(|governor| governor.margins.as_ref()).map(|margins| row(&margins.least));
    let least = governor.and_then(|governor| governor.least_margins.as_ref()).map(row);
    let mut margins =
        Table::new(["margins", "gain up, dB", "gain down, dB", "phase, °", "delay, ms", "distance from -1"]);
    let ways = governor
        .map_or([const { None }; 2], |of| [&of.margins_motor_driving, &of.margins_load_driving].map(Option::as_ref));
    let with_losses = ["with losses, the motor driving", "with losses, the load driving"].into_iter().zip(ways);
    let with_losses = with_losses.filter_map(|(name, least)| Some((name, Some(row(least?)))));
    let rows = [("nominal", nominal)].into_iter().chain(with_losses).chain([("least within the tolerances", least)]);
    for (name, cells) in rows {
        let cells = cells.unwrap_or_else(|| std::array::from_fn(|_| "none".to_owned()));
        margins.row([name.to_owned()].into_iter().chain(cells));
    }
    let mut crossings =
        Table::new(["machine", "crosses", "Hz", "phase margin, °", "delay margin, ms", "gain margin, dB"]);
    let mut poles = Table::new(["machine", "Hz", "damping ratio", "z"]);
    for (name, one) in [("nominal", &responses.nominal), ("drawn", &responses.drawn)] {
        for crossing in &one.crossings {
            let circle = if crossing.phase_margin.is_some() { "gain 1" } else { "-180°" };
            let cell = |value: Option<f64>| value.map_or_else(String::new, significant);
            crossings.row([
                name.to_owned(),
                circle.to_owned(),
                significant(crossing.hz),
                cell(crossing.phase_margin),
                cell(crossing.delay_margin),
                cell(crossing.gain_margin),
            ]);
        }
        for pole in &one.poles {
            let place =
                if pole.im == 0.0 { format!("{:.5}", pole.re) } else { format!("{:.5} ± {:.5}j", pole.re, pole.im) };
            poles.row([name.to_owned(), significant(pole.hz), significant(pole.damping_ratio), place]);
        }
    }
    let text = "Of the machine with all its vibrations, and the least of each over two masses within the tolerances. \
        Each margin is the least over all crossings.";
    vec![
        Section::new("Margins", text, margins),
        Section::new("Crossovers", "", crossings),
        Section::new("Poles of the closed loop", "Their frequencies are natural ones, of ln(z) over a tick.", poles),
    ]
}
