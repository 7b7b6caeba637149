//! `cargo driveline balancing` as an engineer meets it.

use driveline::balancing::Complex;
use serde_json::Value;

use super::bench::{Bench, answered};

const FAN: &str = include_str!("../../rotors/fan-balance.toml");

fn balanced(text: &str) -> String {
    Bench::with("field.toml", text).said(&["balancing", "field.toml"])
}

fn json(text: &str) -> Value {
    answered("balancing", text)
}

/// The first line of the error; a faulty file is exit code 2.
fn refused(text: &str) -> String {
    Bench::with("field.toml", text).refused(&["balancing", "field.toml"]).lines().next().unwrap().to_owned()
}

fn near(value: &Value, expected: f64, tolerance: f64) {
    assert!((value.as_f64().unwrap() - expected).abs() < tolerance, "{value} {expected}");
}

/// Weights of the published case, to the nine digits that balancing.json has it in; the phase of the first is
/// 50.18891873739672 degrees.
#[test]
fn the_published_fan() {
    let outcome = json(FAN);
    let planes = outcome["planes"].as_array().unwrap();
    near(&planes[0]["weight"]["amplitude"], 2.9513806082910325, 3e-9);
    near(&planes[0]["weight"]["degrees"], 50.18891873739672, 1e-7);
    near(&planes[1]["weight"]["amplitude"], 2.8441376945975025, 3e-9);
    near(&planes[1]["weight"]["degrees"], 278.1159343862014, 1e-7);
    near(&outcome["condition"], 2.635601240525888, 1e-9);
    // the holes' residual by hand: what the fitted weights are off by, through the influence coefficients, is below
    // that of half a weight of 0.5 g in each hole
    for row in outcome["rows"].as_array().unwrap() {
        near(&row["predicted"]["amplitude"], 0.0, 1e-12);
        assert!(row["predicted_with_holes"]["amplitude"].as_f64().unwrap() < 2.0 * 4.41 * 0.25 * 2.0_f64.sqrt());
    }
    // (2.9514 + 2.8441) g at 250 mm, U = 9549 G m/n
    near(&outcome["grade"]["now_g_mm"], 5.795518302888535 * 250.0, 1e-6);
    near(&outcome["grade"]["permissible_g_mm"], 9_549.296_585_513_72 * 2.5 * 12.0 / 1480.0, 1e-9);
    assert_eq!(outcome["grade"]["passed"], true);
}

/// A correction that does as its coefficients say, one that does the opposite, and none.
#[test]
fn a_correction_that_misses_is_told() {
    let after = |readings: &str| {
        json(&format!("{FAN}[[correction]]\nweights = [[2.91, 50], [2.78, 279]]\nreadings = {readings}\n"))
    };
    assert_eq!(after("[[0.9, 140], [0.8, 310]]")["missed"], serde_json::Value::Null);
    assert_eq!(json(FAN)["missed"], serde_json::Value::Null);
    let missed = &after("[[14.0, 238], [26.0, 296]]")["missed"];
    near(&missed[0], 26.0, 1e-12);
    assert!(missed[1].as_f64().unwrap() < 1.0, "{missed}");
}

#[test]
fn amplitudes_alone() {
    // v0 = 5, influence 0.4 at 60 degrees from it, 10 g: x = 4; |5 + 4 e^{i (60 + alpha)}|
    let amplitude = |alpha: f64| (25.0 + 16.0 + 40.0 * (60.0 + alpha).to_radians().cos()).sqrt();
    let text = format!(
        "name = \"grinder\"\nplanes = [\"wheel\"]\n[amplitudes]\nbaseline = 5.0\nweight = 10.0\n\
         runs = [[0, {}], [120, {}], [240, {}]]\n",
        amplitude(0.0),
        amplitude(120.0),
        amplitude(240.0)
    );
    let outcome = json(&text);
    // 5/4 of 10 g at 180 - 60 degrees
    near(&outcome["weights"][0]["amplitude"], 12.5, 1e-9);
    near(&outcome["weights"][0]["degrees"], 120.0, 1e-9);
}

/// Every wrong use of the file is refused at its place.
#[test]
fn faults_are_placed() {
    let line = |needle: &str, after: &str| {
        let start = FAN.find(after).unwrap();
        FAN[..start + FAN[start..].find(needle).unwrap()].lines().count()
    };
    let zero = FAN.replacen("weight = [2.5, 0] ", "weight = [0, 0] ", 1);
    let said = refused(&zero);
    let at = line("= [2.5, 0]", "[[trial]]");
    assert!(
        said.contains(&format!("field.toml:{at}:10")) && said.contains("trial weight in plane 1 is zero"),
        "{said}"
    );
    let said = refused(&FAN.replacen("rpm = 1482", "rpm = 1600", 1));
    assert!(said.contains("trial[0].rpm") && said.contains("another speed"), "{said}");
    let said = refused(&FAN.replacen("[[4.9, 114], [9.2, 347]]", "[[4.9, 114]]", 1));
    assert!(said.contains("trial[0].readings") && said.contains("1 of them are missing"), "{said}");
    let said = refused(&FAN.replacen("[\"bearing A\", \"bearing B\"]", "[\"bearing A\"]", 1));
    assert!(said.contains("2 planes cannot be separated by 1 readings"), "{said}");
    let radians = FAN
        .replace("[7.2, 238], [13.5, 296]", "[7.2, 4.154], [13.5, 5.166]")
        .replace("[4.9, 114], [9.2, 347]", "[4.9, 1.99], [9.2, 6.056]")
        .replace("[4.0, 79], [12.0, 292]", "[4.0, 1.379], [12.0, 5.096]");
    let said = refused(&radians);
    assert!(said.contains("baseline.readings") && said.contains("radians"), "{said}");
    let said = refused(&FAN.replacen("plane = \"free end\"", "plane = \"fan end\"", 1));
    assert!(said.contains("trial[1].plane") && said.contains("\"drive end\" or \"free end\""), "{said}");
    let missing = format!("{}{}", &FAN[..FAN.find("[[trial]]\nplane = \"free").unwrap()], "");
    assert!(refused(&missing).contains("a [[trial]] of plane \"free end\""));
    let said = refused(&FAN.replacen("rpm = 1480", "rmp = 1480", 1));
    assert!(said.contains("`baseline.rpm`") || said.contains("unknown key"), "{said}");
    // every prefix of the file is either a whole one or a fault with a place, and none a panic
    for end in (0..FAN.len()).filter(|end| FAN.is_char_boundary(*end)).step_by(7) {
        if let Err(fault) = cargo_driveline::machine_file::balance::parse("field.toml", &FAN[..end]) {
            assert!(fault.to_string().starts_with("field.toml:"), "{fault}");
        }
    }
}

/// Text of the fan, with this beside the baseline's keys, that is before the first table.
fn with(keys: &str) -> String {
    FAN.replacen("[baseline]", &format!("{keys}\n[baseline]"), 1)
}

/// Where a text stands in another one: `:line:column: `.
fn place(text: &str, needle: &str) -> String {
    let start = text.find(needle).unwrap();
    let line = text[..start].lines().count() + usize::from(text[..start].ends_with('\n'));
    let column = start - text[..start].rfind('\n').map_or(0, |end| end + 1) + 1;
    format!("field.toml:{line}:{column}: ")
}

/// What is wrong is told at its line and column, by key, with what stands there and what should.
#[track_caller]
fn refused_at(text: &str, needle: &str, words: &[&str]) {
    let said = refused(text);
    assert!(said.contains(&place(text, needle)), "{said}, not at {}", place(text, needle));
    for word in words {
        assert!(said.contains(word), "{said}, without {word}");
    }
}

#[test]
fn settings_that_cannot_be_are_placed() {
    refused_at(&with("limits = [0, 10]"), "0, 10]", &["`limits[0]`", "found 0"]);
    refused_at(&with("weighting = [0, 0]"), "[0, 0]", &["`weighting`", "2 planes cannot be separated by 0 readings"]);
    refused_at(&with("weighting = [1, 0]"), "[1, 0]", &["`weighting`", "2 planes cannot be separated by 1 readings"]);
    let light = "[0.5, 1.0, 1.5, 2.0, 2.5, 3.0]";
    refused_at(&FAN.replacen(light, "[0.01]", 1), "[0.01]", &["`holes[0].weights`", "more than its holes can take"]);
    refused_at(&FAN.replacen(light, "[]", 1), "[]\n", &["`holes[0].weights`", "one weight at least"]);
    refused_at(&FAN.replacen("count = 12", "angles = []", 1), "[]\n", &["`holes[0].angles`", "one angle at least"]);
    refused_at(&FAN.replacen("count = 12", "angles = [0, 90, 360]", 1), "360]", &["`holes[0].angles[2]`"]);
    refused_at(&FAN.replacen("count = 12", "angles = [0, 1.57, 3.14, 4.71]", 1), "[0, 1.57", &["radians"]);
    let twice = FAN.replacen("plane = \"free end\"\ncount", "plane = \"drive end\"\ncount", 1);
    let said = refused(&twice);
    assert!(said.contains("`holes[1].plane`") && said.contains("no [[holes]] yet"), "{said}");
    assert!(
        said.contains(&format!("field.toml:{}:9: ", twice[..twice.rfind("plane = ").unwrap()].lines().count() + 1))
    );
    let grams = FAN.replacen("radius = 0.25 ", "# radius ", 1);
    refused_at(&grams, "[rotor]", &["`rotor.radius`", "in g"]);
    let half = FAN.replacen("radius = 0.25 ", "radius = 0.25\nspan = 0.9\ncentre = 0.4", 1);
    refused_at(&half, "[rotor]", &["`rotor.planes_at`", "2 places"]);
}

#[test]
fn known_influences_are_told_apart_from_trial_runs() {
    let known = "[[influence]]\nplane = \"drive end\"\ncoefficients = [[4, 200], [5, 100]]\n\
                 [[influence]]\nplane = \"free end\"\ncoefficients = [[3, 120], [2, 250]]\n";
    let said = refused(&format!("{FAN}{known}"));
    assert!(said.contains("`trial[0].plane`") && said.contains("no trial run beside [[influence]]"), "{said}");
    let alone = format!("{}{known}", &FAN[..FAN.find("[[trial]]").unwrap()]);
    near(&json(&alone)["rows"][0]["predicted"]["amplitude"], 0.0, 1e-12);
    let twice = alone.replacen("plane = \"free end\"", "plane = \"drive end\"", 1);
    assert!(refused(&twice).contains("`influence[1].plane`"));
    let radians =
        alone.replace("200]", "3.49]").replace("100]", "1.74]").replace("120]", "2.09]").replace("250]", "4.36]");
    assert!(refused(&radians).contains("radians"));
}

/// A fan that answers exactly: its runs with weights on, for a plane tried again and again.
struct Exact {
    influence: [[Complex<f64>; 2]; 2],
    on: [Complex<f64>; 2],
    text: String,
}

impl Exact {
    fn new(trials: &str) -> Self {
        let z = |amplitude: f64, degrees: f64| Complex::from_polar(amplitude, degrees.to_radians());
        let influence = [[z(1.0, 40.0), z(0.4, 200.0)], [z(0.5, 310.0), z(0.9, 80.0)]];
        let text =
            format!("name = \"exact\"\nplanes = [\"p\", \"q\"]\nsensors = [\"a\", \"b\"]\ntrials = \"{trials}\"\n");
        let mut exact = Exact { influence, on: [z(0.0, 0.0); 2], text };
        let readings = exact.readings();
        exact.text += &format!("[baseline]\nrpm = 1500\nreadings = {readings}\n");
        exact
    }

    fn readings(&self) -> String {
        let found = [Complex::from_polar(3.0, 2.0), Complex::from_polar(2.0, 1.0)];
        let row = |row: &[Complex<f64>; 2]| row.iter().zip(&self.on).zip(&found).map(|((a, w), u)| a * (w + u)).sum();
        let rows: Vec<Complex<f64>> = self.influence.iter().map(row).collect();
        let told = |z: &Complex<f64>| format!("[{}, {}]", z.norm(), z.arg().to_degrees().rem_euclid(360.0));
        format!("[{}]", rows.iter().map(told).collect::<Vec<_>>().join(", "))
    }

    /// A run with more weight in a plane, which comes off again or stays.
    fn trial(&mut self, plane: usize, weight: [f64; 2], stays: bool) {
        let more = Complex::from_polar(weight[0], weight[1].to_radians());
        self.on[plane] += more;
        let readings = self.readings();
        self.text += &format!(
            "[[trial]]\nplane = \"{}\"\nweight = [{}, {}]\nrpm = 1500\nreadings = {readings}\n",
            ["p", "q"][plane],
            weight[0],
            weight[1]
        );
        if !stays {
            self.on[plane] -= more;
        }
    }
}

/// A plane that is tried twice, with its weight off or on in between: both runs count, and the weights are the right
/// ones. The trial weights that stay are part of what is on the rotor.
#[test]
fn a_plane_may_be_tried_twice() {
    for stays in [false, true] {
        let mut exact = Exact::new(if stays { "stay" } else { "removed" });
        for (plane, weight) in [(0, [1.0, 30.0]), (1, [1.5, 200.0]), (0, [0.7, 110.0]), (0, [0.5, 0.0])] {
            exact.trial(plane, weight, stays);
        }
        let outcome = json(&exact.text);
        // what was found is 3 at 2 rad and 2 at 1 rad: all of it goes, and what the trials have added; the readings
        // have 15 digits
        for (plane, found) in [Complex::from_polar(3.0, 2.0), Complex::from_polar(2.0, 1.0)].into_iter().enumerate() {
            let wanted = -(found + exact.on[plane]);
            let weight = &outcome["planes"][plane]["weight"];
            near(&weight["amplitude"], wanted.norm(), 1e-12);
            near(&weight["degrees"], wanted.arg().to_degrees().rem_euclid(360.0), 1e-10);
        }
    }
}

/// Two runs of a plane that contradict each other: the mean by the squares of their weights, and none is dropped.
#[test]
fn contradicting_trials_both_count() {
    let text = |readings: [f64; 2]| {
        let trial = |weight: f64, reading: f64| {
            format!("[[trial]]\nplane = \"p\"\nweight = [{weight}, 0]\nrpm = 1500\nreadings = [[{reading}, 0]]\n")
        };
        format!(
            "name = \"one\"\nplanes = [\"p\"]\nsensors = [\"a\"]\n[baseline]\nrpm = 1500\nreadings = [[10, 0]]\n{}{}",
            trial(1.0, readings[0]),
            trial(2.0, readings[1])
        )
    };
    // influences 2 (of a weight of 1) and 4 (of 2): (2 + 4 * 4)/5
    let outcome = json(&text([12.0, 18.0]));
    near(&outcome["planes"][0]["weight"]["amplitude"], 10.0 / 3.6, 1e-12);
    near(&outcome["planes"][0]["weight"]["degrees"], 180.0, 1e-10);
}

/// A trial weight that changes 10 by less than a tenth is named with its change; the heaviest of a plane counts.
#[test]
fn a_trial_weight_that_changes_little_is_told() {
    let trial = |reading: f64| format!("[[trial]]\nplane = \"p\"\nweight = [1, 0]\nreadings = [[{reading}, 0]]\n");
    let file = "name = \"one\"\nplanes = [\"p\"]\nsensors = [\"a\"]\n[baseline]\nreadings = [[10, 0]]\n";
    let warning = "trial weight of p: changes the readings by";
    for (readings, told) in [(&[10.5][..], Some("5.00 %")), (&[10.5, 9.2], Some("8.00 %")), (&[10.5, 11.5], None)] {
        let text = format!("{file}{}", readings.iter().map(|reading| trial(*reading)).collect::<String>());
        let said = balanced(&text);
        let line = said.lines().find(|line| line.starts_with(warning));
        assert_eq!(line.is_some(), told.is_some(), "{said}");
        assert!(line.is_none_or(|line| line.contains(told.unwrap_or_default())), "{said}");
        let largest = readings.iter().map(|reading| f64::abs(reading - 10.0) / 10.0).fold(0.0, f64::max);
        near(&json(&text)["planes"][0]["change_by_trial"], largest, 1e-12);
    }
}

/// A reading that is weighted with zero is shown, and counts for nothing.
#[test]
fn a_reading_that_is_left_out_is_not_in_the_headline() {
    let three = FAN
        .replacen("[\"bearing A\", \"bearing B\"]", "[\"bearing A\", \"bearing B\", \"casing\"]", 1)
        .replacen("weight_unit", "weighting = [1, 1, 0]\nweight_unit", 1)
        .replacen("[13.5, 296]]", "[13.5, 296], [99, 10]]", 1)
        .replacen("[9.2, 347]]", "[9.2, 347], [98, 12]]", 1)
        .replacen("[12.0, 292]]", "[12.0, 292], [97, 8]]", 1);
    let outcome = json(&three);
    near(&outcome["planes"][0]["weight"]["amplitude"], 2.9513806082910325, 3e-9);
    assert_eq!((&outcome["rows"][1]["counts"], &outcome["rows"][2]["counts"]), (&true.into(), &false.into()));
    let said = balanced(&three);
    assert!(said.contains("goes from 13.5 to") && said.contains("casing (left out)"), "{said}");
    assert!(!said.lines().next().unwrap().contains("99"), "{said}");
}

/// A plane that nothing feels.
#[test]
fn a_plane_without_effect_is_left_out_in_words() {
    let known = "[[influence]]\nplane = \"drive end\"\ncoefficients = [[4, 200], [5, 100]]\n\
                 [[influence]]\nplane = \"free end\"\ncoefficients = [[0, 0], [0, 0]]\n";
    let outcome = json(&format!("{}{known}", &FAN[..FAN.find("[[trial]]").unwrap()]));
    assert_eq!(outcome["planes"][1]["left_out"], "not used: a weight here changes no reading that counts");
}

/// The tolerance at the bearings, by hand: the fan's 12 kg at 154.985 rad/s in G 2.5 may have 193.5 g mm; with the
/// centre of mass at 0.3 m of 0.8 m bearing A carries five eighths.
#[test]
fn the_grade_is_split_between_the_bearings() {
    let split = "radius = 0.25\nspan = 0.8\ncentre = 0.3\nplanes_at = [0.2, 0.6]";
    let outcome = json(&FAN.replacen("radius = 0.25 ", split, 1));
    let whole = 9_549.296_585_513_72 * 2.5 * 12.0 / 1480.0;
    let grade = &outcome["grade"];
    near(&grade["bearings"][0]["permissible_g_mm"], whole * 0.625, 1e-9);
    near(&grade["bearings"][1]["permissible_g_mm"], whole * 0.375, 1e-9);
    // 2.9514 g at 50.189 degrees, a quarter of the way to B, and 2.8441 g at 278.116 degrees, three quarters, each at
    // 250 mm; the weights are those of the published case
    let unbalance = |grams: f64, degrees: f64| Complex::from_polar(grams * 250.0, degrees.to_radians());
    let (p, q) = (unbalance(2.9513806082910325, 50.18891873739672), unbalance(2.8441376945975025, 278.1159343862014));
    near(&grade["bearings"][0]["now_g_mm"], (p * 0.75 + q * 0.25).norm(), 1e-5);
    near(&grade["bearings"][1]["now_g_mm"], (p * 0.25 + q * 0.75).norm(), 1e-5);
    let said = balanced(&FAN.replacen("radius = 0.25 ", split, 1));
    assert!(said.contains("at bearing A: ") && said.contains("split between the bearings"), "{said}");
}

fn grinder(rest: &str, runs: &[f64]) -> String {
    // v0 = 5, influence 0.4 at 60 degrees from it, 10 g: x = 4; |5 + 4 e^{i (60 + alpha)}|
    let run = |alpha: &f64| format!("[{alpha}, {}]", (41.0 + 40.0 * (60.0 + alpha).to_radians().cos()).sqrt());
    let runs: Vec<String> = runs.iter().map(run).collect();
    format!(
        "name = \"grinder\"\nunit = \"mm/s\"\nplanes = [\"wheel\"]\n[amplitudes]\nbaseline = 5.0\nweight = 10.0\nruns \
            = [{}]\n{rest}",
        runs.join(", ")
    )
}

/// Holes, rotor and page of a file without phases.
#[test]
fn amplitudes_alone_have_holes_a_grade_and_a_page() {
    let rest = "[[holes]]\nplane = \"wheel\"\nangles = [0, 90, 180, 270]\nweights = [2.5, 5, 7.5, 10]\n\
                [rotor]\nmass = 8\nrpm = 3000\ngrade = 6.3\nradius = 0.1\n";
    let text = grinder(rest, &[0.0, 120.0, 240.0]);
    let outcome = json(&text);
    let answer = &outcome["answers"][0];
    // 12.5 g at 120 degrees: 10 g at 90 degrees and 7.5 at 180 come nearest of what there is
    assert_eq!(answer["holes"].as_array().unwrap().len(), 2);
    let wanted = Complex::from_polar(12.5, 120_f64.to_radians());
    let holes = Complex::new(-7.5, 10.0);
    near(&answer["predicted"], 5.0 * (1.0 - holes / wanted).norm(), 1e-9);
    near(&answer["grade"]["now_g_mm"], 1250.0, 1e-6);
    near(&answer["grade"]["predicted_g_mm"], (wanted - holes).norm() * 100.0, 1e-6);
    let said = Bench::with("field.toml", &text).said(&["balancing", "field.toml", "--html", "page.html"]);
    for word in ["add 12.5 g at 120.0°", "in hole 2", "permissible", "page: page.html"] {
        assert!(said.contains(word), "{word} in {said}");
    }
    // two runs: two answers, each with its holes
    let two = json(&grinder(rest, &[0.0, 120.0]));
    assert_eq!((two["answers"].as_array().unwrap().len(), two["weights"].as_array().unwrap().len()), (2, 2));
    let said = balanced(&grinder("", &[0.0, 120.0]));
    assert!(
        said.contains("Two trial runs leave two answers") && said.contains("answer 2: predicted: 0 mm/s"),
        "{said}"
    );
}

#[test]
fn amplitudes_alone_refuse_what_they_cannot_use() {
    let sound = grinder("", &[0.0, 120.0, 240.0]);
    let two = sound.replacen("[\"wheel\"]", "[\"wheel\", \"motor\"]", 1);
    refused_at(&two, "[\"wheel\", ", &["`planes`", "cannot separate two"]);
    refused_at(&sound.replacen("weight = 10.0", "weight = 0", 1), "0\nruns", &["`amplitudes.weight`", "is zero"]);
    refused_at(&sound.replacen("baseline = 5.0", "baseline = 0", 1), "0\nweight", &["`amplitudes.baseline`"]);
    // keys that readings with phases have
    refused_at(&format!("machine = \"hard-bearing\"\n{sound}"), "\"hard", &["`machine`", "only beside [baseline]"]);
    refused_at(&format!("sensors = [\"A\"]\n{sound}"), "[\"A", &["`sensors`", "not beside [amplitudes]"]);
    refused_at(&grinder("", &[0.0]), "[[0, ", &["`amplitudes.runs`", "three runs"]);
    refused_at(&grinder("", &[30.0, 30.0, 30.0]), "[[30, ", &["`amplitudes.runs`", "different angles"]);
    refused_at(&grinder("", &[0.5, 2.1, 4.2]), "[[0.5, ", &["`amplitudes.runs`", "radians"]);
    let limited = sound.replacen("planes", "limits = [1]\nplanes", 1);
    refused_at(&limited, "[1]", &["`limits`", "not beside [amplitudes]"]);
    let heavy = grinder("[[holes]]\nplane = \"wheel\"\ncount = 8\nweights = [0.1]\n", &[0.0, 120.0, 240.0]);
    refused_at(&heavy, "[0.1]", &["`holes[0].weights`", "more than its holes can take"]);
}

/// One plane, no speed: the weight of a reading of 10 that 2 g at zero raise to 14 is 5 g opposite.
const PLAIN: &str = "name = \"plain\"\nplanes = [\"p\"]\nsensors = [\"a\"]\n[baseline]\nreadings = [[10, 0]]\n\
                     [[trial]]\nplane = \"p\"\nweight = [2, 0]\nreadings = [[14, 0]]\n";

#[test]
fn a_file_needs_no_speed() {
    let outcome = json(PLAIN);
    near(&outcome["planes"][0]["weight"]["amplitude"], 5.0, 1e-12);
    assert!(outcome["rows"][0].get("rpm").is_none());
    let one = PLAIN.replacen("weight = [2, 0]", "weight = [2, 0]\nrpm = 1500", 1);
    refused_at(&one, "1500", &["`trial[0].rpm`", "the baseline has none"]);
    // and where the baseline has one, the others need none
    near(&json(&PLAIN.replacen("[baseline]", "[baseline]\nrpm = 1500", 1))["rows"][0]["rpm"], 1500.0, 1e-9);
}

/// 1 oz is 28.349523125 g, 1 in 25.4 mm, 1 lb 16 oz, by definition: the same 5 units at 0.1 m in each.
#[test]
fn ounces_and_pounds() {
    let rotor = "[rotor]\nmass = 10\nrpm = 3000\ngrade = 2.5\nradius = 0.1\n";
    for (unit, g_mm) in
        [("oz", 5.0 * 28.349523125 * 100.0), ("oz in", 5.0 * 28.349523125 * 25.4), ("lb", 80.0 * 28.349523125 * 100.0)]
    {
        let text = PLAIN.replacen("planes", &format!("weight_unit = \"{unit}\"\nplanes"), 1) + rotor;
        near(&json(&text)["grade"]["now_g_mm"], g_mm, 1e-9 * g_mm);
    }
}

/// The fan with its phases counted as lag, its weights against the rotation, and both in radians: the published
/// weights.
#[test]
fn angles_are_counted_as_the_file_says() {
    let turn = |text: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    };
    let mut lag = with("phase_sense = \"lag\"\nweight_sense = \"against rotation\"");
    for (from, to) in [
        ("[7.2, 238], [13.5, 296]", "[7.2, 122], [13.5, 64]"),
        ("[4.9, 114], [9.2, 347]", "[4.9, 246], [9.2, 13]"),
        ("[4.0, 79], [12.0, 292]", "[4.0, 281], [12.0, 68]"),
    ] {
        lag = turn(&lag, from, to);
    }
    let outcome = json(&lag);
    near(&outcome["planes"][0]["weight"]["amplitude"], 2.9513806082910325, 3e-9);
    near(&outcome["planes"][0]["weight"]["degrees"], 360.0 - 50.18891873739672, 1e-7);
    near(&outcome["rows"][0]["now"]["degrees"], 122.0, 1e-9);
    // the circle of holes is its own mirror image
    near(&outcome["grade"]["predicted_g_mm"], json(FAN)["grade"]["predicted_g_mm"].as_f64().unwrap(), 1e-6);

    let mut radians = with("angle_unit = \"radians\"");
    for [amplitude, degrees] in
        [[7.2, 238.0], [13.5, 296.0], [4.9, 114.0], [9.2, 347.0], [4.0, 79.0], [12.0, 292.0_f64]]
    {
        let amplitude = format!("{amplitude:.1}");
        let from = format!("[{amplitude}, {degrees}]");
        radians = turn(&radians, &from, &format!("[{amplitude}, {}]", degrees.to_radians()));
    }
    near(&json(&radians)["planes"][0]["weight"]["degrees"], 50.18891873739672, 1e-7);
}

/// 5 g at 180 degrees between blades at 150 and 210: each takes 5/(2 cos 30).
#[test]
fn a_weight_is_split_between_two_angles() {
    let outcome = json(&format!("{PLAIN}[[split]]\nplane = \"p\"\nangles = [150, 210]\n"));
    let share = 5.0 / (2.0 * 30_f64.to_radians().cos());
    near(&outcome["planes"][0]["split"][0]["weight"], share, 1e-12);
    near(&outcome["planes"][0]["split"][1]["weight"], share, 1e-12);
    let alike = format!("{PLAIN}[[split]]\nplane = \"p\"\nangles = [30, 210]\n");
    refused_at(&alike, "[30, 210]", &["`split[0].angles`", "neither alike nor opposite"]);
}

/// What is in the plane: a correction of 4 g, and 1 g more; a trial weight that stays counts, too.
#[test]
fn the_total_of_a_plane() {
    let outcome = json(&format!("{PLAIN}[[correction]]\nweights = [[4, 180]]\nreadings = [[2, 0]]\n"));
    near(&outcome["planes"][0]["weight"]["amplitude"], 1.0, 1e-12);
    near(&outcome["planes"][0]["total"]["amplitude"], 5.0, 1e-12);
    let outcome = json(&PLAIN.replacen("planes", "trials = \"stay\"\nplanes", 1));
    near(&outcome["planes"][0]["weight"]["amplitude"], 7.0, 1e-12);
    near(&outcome["planes"][0]["total"]["amplitude"], 5.0, 1e-12);
}

/// The coefficients that are printed are a file without trial runs: it gives the same weights to the six digits.
#[test]
fn the_coefficients_are_those_of_a_file() {
    let said = balanced(FAN);
    let start = said.find("[[influence]]").unwrap();
    let end = said[start..].find("page:").map_or(said.len(), |end| start + end);
    let known = format!("{}{}", &FAN[..FAN.find("[[trial]]").unwrap()], &said[start..end]);
    near(&json(&known)["planes"][1]["weight"]["amplitude"], 2.8441376945975025, 1e-4);
}

/// Run-out of 1 in the readings of 10 and 14: 9 and 13, so 4.5 g.
#[test]
fn run_out_is_taken_off() {
    let outcome = json(&format!("{PLAIN}[run_out]\nreadings = [[1, 0]]\n"));
    near(&outcome["planes"][0]["weight"]["amplitude"], 4.5, 1e-12);
}

#[test]
fn a_limit_for_some_planes_and_the_cost_of_leaving_one_out() {
    let outcome = json(&with("limits = [2, \"none\"]"));
    let weight = &outcome["planes"][0]["weight"]["amplitude"];
    assert!(weight.as_f64().unwrap() <= 2.0, "{weight}");
    assert!(outcome["planes"][1]["weight"]["amplitude"].as_f64().unwrap() > 2.0);
    // one plane of the fan alone: least squares by hand, w = -sum conj(a) v / sum |a|^2
    let outcome = json(FAN);
    let z = |amplitude: f64, degrees: f64| Complex::from_polar(amplitude, degrees.to_radians());
    let v = [z(7.2, 238.0), z(13.5, 296.0)];
    let a = [(z(4.0, 79.0) - v[0]) / 2.5, (z(12.0, 292.0) - v[1]) / 2.5];
    let w = -(a[0].conj() * v[0] + a[1].conj() * v[1]) / (a[0].norm_sqr() + a[1].norm_sqr());
    let left = (v[0] + a[0] * w).norm().max((v[1] + a[1] * w).norm());
    near(&outcome["planes"][0]["largest_without"], left, 1e-9);
}

const MACHINE: &str = r#"
name = "armature"
unit = "N"
planes = ["drive end", "free end"]
sensors = ["bearing A", "bearing B"]
machine = "hard-bearing"
weight_unit = "g mm"

[baseline]
rpm = 600
readings = [[1.4, 25], [0.9, 310]]

[rotor]
mass = 40.0
rpm = 1480
grade = 6.3
width = 0.4
diameter = 0.3
span = 0.7
centre = 0.33
planes_at = [0.2, 0.5]
"#;

/// Forces in the bearings over omega^2, resolved into the planes by levers: 0.5 and 0.2 of 0.3 m.
#[test]
fn a_hard_bearing_machine_needs_no_trial_runs() {
    let square = (600.0 * std::f64::consts::TAU / 60.0_f64).powi(2);
    let at = |force: f64, degrees: f64| Complex::from_polar(force / square, degrees.to_radians());
    let (a, b) = (at(1.4, 25.0), at(0.9, 310.0));
    let outcome = json(MACHINE);
    let polar = |value: &Value, amplitude: &str, angle: &str| {
        let number = |key: &str| value[key].as_f64().unwrap();
        Complex::from_polar(number(amplitude), number(angle).to_radians())
    };
    for (plane, expected) in [(0, (a * 0.5 - b * 0.2) / 0.3), (1, (b * 0.5 - a * 0.2) / 0.3)] {
        let found = polar(&outcome["planes"][plane]["weight"], "amplitude", "degrees");
        // some hundred g mm, by a few roundings of a condition of 3
        assert!((found + expected * 1e6).norm() < 1e-9, "{plane}: {found} {expected}");
    }
    let parts = &outcome["grade"]["parts"];
    assert!((polar(parts, "static_g_mm", "static_degrees") - (a + b) * 1e6).norm() < 1e-9, "{parts}");
    let couple = b * (0.7 - 0.33) - a * 0.33;
    assert!((polar(parts, "couple_g_mm2", "couple_degrees") - couple * 1e9).norm() < 1e-6, "{parts}");
    assert_eq!(outcome["grade"]["one_plane_suffices"], false);
    assert_eq!(json(&MACHINE.replace("width = 0.4", "width = 0.06"))["grade"]["one_plane_suffices"], true);
    let text = balanced(MACHINE);
    for word in ["static unbalance now", "couple unbalance now", "two: width over diameter"] {
        assert!(text.contains(word), "{word} in {text}");
    }
    // without holes nothing is left, which has no angle
    let bearing = text.lines().find(|line| line.contains("at bearing A")).unwrap();
    assert!(bearing.contains(" now, 0 g mm predicted, ") && bearing.ends_with(": predicted within it"), "{bearing}");
}

/// The same forces with the sensors the other way round, each named by its bearing.
#[test]
fn the_bearings_of_a_hard_bearing_machine_go_by_the_names_of_the_sensors() {
    let named = |names: [&str; 2]| MACHINE.replace("[\"bearing A\", \"bearing B\"]", &format!("{names:?}"));
    let swapped = |names| named(names).replace("[[1.4, 25], [0.9, 310]]", "[[0.9, 310], [1.4, 25]]");
    let expected = json(MACHINE);
    for text in [
        swapped(["bearing b", "bearing a"]),
        swapped(["B 1", "A 1"]),
        swapped(["b1", "a1"]),
        swapped(["bearing B, radial", "bearing A, radial"]),
        swapped(["force (B)", "force (A)"]),
        swapped(["B-side", "A: fan"]),
        swapped(["bearingB", "bearing_A"]),
        swapped(["probe in a housing B", "probe on A"]),
        named(["left", "right"]),
        named(["on a motor side", "fan side"]),
        // of other words
        named(["BASE", "BrgAb"]),
    ] {
        let found = json(&text);
        for plane in [0, 1] {
            let [found, expected] = [&found, &expected].map(|outcome| &outcome["planes"][plane]["weight"]);
            // a few roundings of some hundred g mm
            near(&found["amplitude"], expected["amplitude"].as_f64().unwrap(), 1e-9);
            near(&found["degrees"], expected["degrees"].as_f64().unwrap(), 1e-9);
        }
    }
    for names in [["bearing A", "frame"], ["left A", "right A"], ["A by B", "B"], ["b-side", "a-side"]] {
        let said = refused(&named(names));
        assert!(said.contains("`sensors`") && said.contains("one with \"B\""), "{said}");
    }
}

#[test]
fn what_a_hard_bearing_machine_lacks_is_told() {
    for (from, to, expected) in [
        ("span = 0.7\ncentre = 0.33\nplanes_at = [0.2, 0.5]", "", "[rotor] with `span`, `centre` and `planes_at`"),
        ("rpm = 600\n", "", "`baseline`: found a table, expected `rpm`"),
        ("\"bearing B\"]", "\"bearing B\", \"frame\"]", "`sensors`"),
        ("hard-bearing", "soft", "\"none\" or \"hard-bearing\""),
        ("diameter = 0.3\n", "", "`diameter`: a number"),
        ("width = 0.4\n", "", "`width`: a number"),
        (
            "[rotor]",
            "[[trial]]\nplane = \"drive end\"\nweight = [1, 0]\nreadings = [[1, 0], [1, 0]]\n\n[rotor]",
            "no trial run beside [[influence]] or `machine`",
        ),
    ] {
        let three = to.contains("frame");
        let text = MACHINE.replace(from, to);
        let text = if three { text.replace("[0.9, 310]]", "[0.9, 310], [0.1, 10]]") } else { text };
        assert_ne!(text, MACHINE);
        let said = refused(&text);
        assert!(said.contains(expected), "{said}");
    }
}
