//! The verdict as tables and as a page.

use super::faults::Outcome;
use super::standard::{CLASS_D, CLASSES, TRIP};
use super::verdict::{Verdict, Verdicts};
use driveline_report::chart::{Panel, panels};
use driveline_report::{Fact, Figure, Section, Sheet, Table};

fn percent(fraction: f64) -> String {
    format!("{:.2} %", 100.0 * fraction)
}

fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "NO" }
}

/// The standards' limits, as the first rows of the table.
fn allowed(table: &mut Table, turbine: bool) {
    if turbine {
        let [regulation, variation, rise] = CLASS_D;
        let row = ["NEMA SM 23 class D allows", "", "", &percent(regulation), &format!("± {}", percent(variation))];
        table.row(row.into_iter().map(str::to_owned).chain(["".to_owned(), percent(rise)]));
        return;
    }
    for class in CLASSES {
        table.row([
            format!("{} allows", class.name),
            String::new(),
            String::new(),
            percent(class.band),
            percent(class.drop),
            percent(class.rise),
            format!("{:.1} s", class.recovery),
        ]);
    }
}

/// The verdict on the diesel sets against ISO 8528-5.
pub fn diesel(verdicts: &Verdicts) -> Table {
    let mut table = Table::new([
        "variant",
        "governed",
        "class",
        "band",
        "drop",
        "rise",
        "recovery to ±1 %",
        "to ±0.10 %",
        "tripped",
        "torque",
        "instructions",
        "bit exact",
    ]);
    allowed(&mut table, false);
    for one in verdicts.verdicts.iter().filter(|one| one.set == "diesel") {
        let figures = &one.figures;
        table.row([
            one.variant.clone(),
            one.way.name().to_owned(),
            one.class.unwrap_or("none").to_owned(),
            percent(figures.band()),
            percent(figures.drop()),
            percent(figures.rise()),
            format!("{:.2} s", figures.recovery(0.02)),
            format!("{:.2} s", figures.recovery(0.002)),
            if one.tripped { "YES" } else { "no" }.to_owned(),
            format!("{:.2} to {:.2}", one.torque[0], one.torque[1]),
            format!("{} / {}", one.instructions.median, one.instructions.max),
            yes(one.bit_exact).to_owned(),
        ]);
    }
    table
}

/// The verdict on the turbine sets against NEMA SM 23.
pub fn turbine(verdicts: &Verdicts) -> Table {
    let mut table = Table::new([
        "variant",
        "governed",
        "class D",
        "regulation",
        "variation",
        "drop",
        "rise",
        "tripped",
        "torque",
        "instructions",
        "bit exact",
    ]);
    allowed(&mut table, true);
    for one in verdicts.verdicts.iter().filter(|one| one.set == "turbine") {
        let figures = &one.figures;
        table.row([
            one.variant.clone(),
            one.way.name().to_owned(),
            yes(one.class_d == Some(true)).to_owned(),
            percent(figures.regulation()),
            format!("± {}", percent(0.5 * figures.band())),
            percent(figures.drop()),
            percent(figures.rise()),
            if one.tripped { "YES" } else { "no" }.to_owned(),
            format!("{:.2} to {:.2}", one.torque[0], one.torque[1]),
            format!("{} / {}", one.instructions.median, one.instructions.max),
            yes(one.bit_exact).to_owned(),
        ]);
    }
    table
}

/// Every load step.
pub fn steps(verdicts: &Verdicts) -> Table {
    let mut table =
        Table::new(["set", "variant", "governed", "load", "drop", "rise", "recovery to ±1 %", "to ±0.10 %"]);
    for one in &verdicts.verdicts {
        for step in &one.figures.steps {
            table.row([
                one.set.to_owned(),
                one.variant.clone(),
                one.way.name().to_owned(),
                format!("{:.0} to {:.0} %", 100.0 * step.load[0], 100.0 * step.load[1]),
                percent(step.drop),
                percent(step.rise),
                format!("{:.2} s", step.recovery),
                format!("{:.2} s", step.precise),
            ]);
        }
    }
    table
}

fn outcome(one: &Outcome) -> String {
    let [low, high] = one.frequency;
    match &one.trip {
        Some((trip, after)) => format!("trips: {trip}, after {after:.3} s"),
        None => format!("rides through, {:.1} to {:.1} %", 100.0 * low, 100.0 * high),
    }
}

/// Faults against outcomes: one row a fault, passing and for good.
pub fn faults(verdicts: &Verdicts) -> Table {
    let mut table =
        Table::new(["variant", "input", "fault", "for 5 ms", "for good", "torque", "after a trip", "as documented"]);
    for pair in verdicts.faults.chunks(2) {
        let [(variant, passing), (_, lasting)] = pair else { continue };
        let [least, most] = [passing.torque[0].min(lasting.torque[0]), passing.torque[1].max(lasting.torque[1])];
        table.row([
            variant.clone(),
            format!("{:?}", passing.wire).to_lowercase(),
            match passing.fault {
                super::faults::Fault::NotANumber => "not a number".to_owned(),
                fault => format!("{fault:?}").to_lowercase(),
            },
            outcome(passing),
            outcome(lasting),
            format!("{least:.2} to {most:.2}"),
            format!("{:.2}", passing.after.max(lasting.after)),
            yes(passing.as_documented && lasting.as_documented).to_owned(),
        ]);
    }
    table
}

/// Every trip: what brought it about, and whether it stood until it was reset.
pub fn trips(verdicts: &Verdicts) -> Table {
    let mut table = Table::new([
        "variant",
        "cause",
        "trip",
        "after",
        "torque before",
        "after it",
        "stands",
        "is reset",
        "as documented",
    ]);
    for (variant, one) in &verdicts.trips {
        let (trip, after) = one.trip.clone().unwrap_or(("none".to_owned(), f64::NAN));
        table.row([
            variant.clone(),
            one.what.to_owned(),
            trip,
            if after.is_nan() { String::new() } else { format!("{after:.3} s") },
            format!("{:.2} to {:.2}", one.torque[0], one.torque[1]),
            format!("{:.2}", one.after),
            yes(one.stands).to_owned(),
            if one.lasting && !one.reset { "not while its cause lasts" } else { yes(one.reset) }.to_owned(),
            yes(one.as_documented).to_owned(),
        ]);
    }
    table
}

fn plot(one: &Verdict) -> Figure {
    let time: Vec<f64> = one.moments.iter().map(|moment| moment.time).collect();
    let of = |value: &dyn Fn(&super::run::Moment) -> f64| one.moments.iter().map(value).collect::<Vec<f64>>();
    let frequency = of(&|moment| 100.0 * moment.frequency.clamp(0.8, 1.2));
    let command = of(&|moment| 100.0 * moment.command);
    let load = of(&|moment| 100.0 * moment.load[0]);
    let estimate = of(&|moment| 100.0 * moment.load[1].clamp(-0.5, 2.0));
    let drawn = [
        Panel { name: "frequency, %", series: vec![("estimate", &frequency)], levels: vec![100.0, 100.0 * TRIP] },
        Panel { name: "torque commanded, %", series: vec![("estimate", &command)], levels: vec![] },
        Panel { name: "load torque, %", series: vec![("estimate", &estimate), ("truth", &load)], levels: vec![] },
    ];
    let title = format!("{}, {}, {}", one.set, one.variant, one.way.name());
    let swing = if one.set == "diesel" { ": the ripple is the firing's, which the speed filter averages" } else { "" };
    let text = format!(
        "Frequency by the electrical period; lines at 100 % and at the trip. Below, the load as it is (wide) and as it \
            is estimated tick by \
            tick (fine){swing}."
    );
    let plots = vec![panels(&time, &drawn, 500, &title)];
    Figure { title, text, plots, ..Figure::default() }
}

pub fn page(verdicts: &Verdicts) -> String {
    let fact = |name: &str, value: String| Fact { name: name.to_owned(), value };
    let mut facts = Vec::new();
    for one in verdicts.verdicts.iter().filter(|one| one.variant.starts_with("f32")) {
        let [gain, phase, modulus] = one.margins;
        facts.push(fact(
            &format!("margins, {}, {}", one.set, one.way.name()),
            format!("gain {gain:.2}, phase {phase:.0}°, modulus {modulus:.2}"),
        ));
    }
    let with_trips = (!verdicts.trips.is_empty()).then(|| {
        let text = "On the diesel. The cause goes a second after the time that the trip may take; the run switch goes \
            off half a second later, which \
            resets it. Torques are of rated.";
        Section::new("Every trip, brought about", text, trips(verdicts))
    });
    let with_faults = (!verdicts.faults.is_empty()).then(|| {
        let text = "At half load, on the diesel. Implausible inputs are replaced; where an input is lost for longer \
            than its timeout, the drive trips and commands no torque. Torques are of rated.";
        Section::new("A fault on every input", text, faults(verdicts))
    });
    let ran = |set: &str| verdicts.verdicts.iter().any(|one| one.set == set);
    let with_diesel = ran("diesel").then(|| {
        let text = "Load steps of 0-50-80-100 % and the loss of it all. Frequencies by the electrical period.";
        Section::new("Diesel set against ISO 8528-5", text, diesel(verdicts))
    });
    let with_turbine = ran("turbine").then(|| {
        let text = "Load steps of a quarter, and the loss of it all.";
        Section::new("Turbine set against NEMA SM 23", text, turbine(verdicts))
    });
    let with_steps = Section::new("Every load step", "", steps(verdicts));
    Sheet {
        kicker: "generator sets".to_owned(),
        name: "Generator sets".to_owned(),
        summary: "A diesel set of 400 kW and a turbine set of 2 MW, governed from the flywheel's angle and the \
            actuator's position: the \
            firmware runs in QEMU, tick by tick against the full plant."
            .to_owned(),
        facts,
        tables: [with_diesel, with_turbine, Some(with_steps), with_faults, with_trips].into_iter().flatten().collect(),
        figures: verdicts.verdicts.iter().map(plot).collect(),
    }
    .page()
}
