//! The verdict as tables, page and JSON.

use driveline_lab::generator::faults::{Fault, Outcome, PASSING, Wire};
use driveline_lab::generator::page;
use driveline_lab::generator::run::Moment;
use driveline_lab::generator::standard::{Figures, Steady, Step};
use driveline_lab::generator::trips::Latched;
use driveline_lab::generator::verdict::{Verdict, Verdicts, Way};
use driveline_qemu::measure::Spread;

fn verdicts() -> Verdicts {
    let step =
        Step { time: 1.0, load: [0.0, 0.5], drop: 0.0312, rise: 0.0034, coarse: 0.125, recovery: 0.25, precise: 1.25 };
    let steady = Steady { load: 0.5, mean: 1.0, band: 0.0011, swing: 0.02 };
    let figures = Figures { steps: vec![step], steady: vec![steady], top: 1.07 };
    let moments = (0..100).map(|tick| Moment { time: f64::from(tick), frequency: 1.0, ..Moment::default() }).collect();
    let verdict = Verdict {
        set: "diesel",
        variant: "f32/m4f".into(),
        way: Way::FeedForward,
        class: figures.class(),
        class_d: None,
        figures,
        tripped: false,
        torque: [0.0, 1.2],
        instructions: Spread { min: 50, median: 262, max: 353 },
        bit_exact: true,
        margins: [3.1, 39.0, 0.58],
        moments,
    };
    let outcome = |lasting, trip: Option<(String, f64)>| Outcome {
        wire: Wire::Angle,
        fault: Fault::NotANumber,
        lasting,
        trip,
        frequency: [0.99, 1.01],
        torque: [0.0, 0.83],
        after: 0.0,
        as_documented: true,
    };
    let faults = [outcome(Some(PASSING), None), outcome(None, Some(("sensor loss".into(), 0.016)))];
    let latched = Latched {
        what: "setpoint 115 %",
        trip: Some(("overspeed".into(), 0.432)),
        torque: [0.0, 0.91],
        top: 1.1,
        after: 0.0,
        stands: true,
        reset: true,
        lasting: false,
        as_documented: false,
    };
    Verdicts {
        verdicts: vec![verdict],
        faults: faults.map(|fault| ("f32/m4f".into(), fault)).into(),
        trips: vec![("f32/m4f".into(), latched)],
    }
}

#[test]
fn the_tables_say_what_was_measured() {
    let verdicts = verdicts();
    let diesel = page::diesel(&verdicts).to_string();
    let row = diesel.lines().find(|line| line.contains("f32/m4f")).unwrap();
    for text in ["with feed-forward", "precise", "0.11 %", "3.12 %", "0.34 %", "0.25 s", "1.25 s", "262 / 353", "yes"] {
        assert!(row.contains(text), "{row}: {text}");
    }
    // The limits stand above: ISO 8528-5's G3.
    assert!(diesel.lines().any(|line| line.contains("G3 allows") && line.contains("7.00 %") && line.contains("3.0 s")));
    let faults = page::faults(&verdicts).to_string();
    let row = faults.lines().find(|line| line.contains("not a number")).unwrap();
    for text in ["angle", "rides through, 99.0 to 101.0 %", "trips: sensor loss, after 0.016 s", "0.00 to 0.83", "yes"]
    {
        assert!(row.contains(text), "{row}: {text}");
    }
    let trips = page::trips(&verdicts).to_string();
    let row = trips.lines().find(|line| line.contains("115 %")).unwrap();
    for text in ["overspeed", "0.432 s", "0.00 to 0.91", "yes", "NO"] {
        assert!(row.contains(text), "{row}: {text}");
    }
}

#[test]
fn the_page_has_tables_plots_and_nothing_that_is_no_number() {
    let page = page::page(&verdicts());
    assert!(page.starts_with("<!doctype html>") && !page.contains("NaN") && !page.contains("http"));
    for text in [
        "ISO 8528-5",
        "the ripple is the firing",
        "A fault on every input",
        "Every trip, brought about",
        "frequency, %",
        "<svg",
        "phase 39°",
    ] {
        assert!(page.contains(text), "{text}");
    }
}

/// What did not run has no table of limits without a row, and no engine's words.
#[test]
fn the_page_of_one_set_says_nothing_of_the_other() {
    let diesel = verdicts();
    assert!(!page::page(&diesel).contains("NEMA SM 23"));
    let turbine =
        diesel.verdicts.into_iter().map(|one| Verdict { set: "turbine", class: None, class_d: Some(true), ..one });
    let page = page::page(&Verdicts { verdicts: turbine.collect(), faults: vec![], trips: vec![] });
    assert!(page.contains("NEMA SM 23") && !page.contains("ISO 8528-5") && !page.contains("firing"));
}

#[test]
fn the_json_has_every_figure() {
    let json = serde_json::to_value(verdicts()).unwrap();
    let one = &json["verdicts"][0];
    assert_eq!((one["way"].as_str(), one["class"].as_str()), (Some("feed-forward"), Some("precise")));
    assert_eq!(one["figures"]["steps"][0]["drop"].as_f64(), Some(0.0312));
    assert_eq!(json["faults"][1][1]["trip"][0].as_str(), Some("sensor loss"));
    assert_eq!(json["trips"][0][1]["trip"][0].as_str(), Some("overspeed"));
}
