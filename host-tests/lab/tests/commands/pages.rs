//! Every kind of page in a browser, on a narrow and a wide screen and in print.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use serde_json::Value;

use crate::browser::Browser;
use crate::sample;

/// Pages that a command writes within seconds: name of the page and arguments.
const QUICK: [(&str, &str); 11] = [
    ("modes", "modes hoist.toml"),
    ("design", "design mill.toml"),
    ("modes-train", "modes gear-pair.toml"),
    ("campbell", "modes ship.toml"),
    ("rotor", "rotor three_discs.toml"),
    ("balancing", "balancing fan-balance.toml"),
    ("simulate", "simulate gear-pair.toml"),
    ("simulate-branches", "simulate tilting.toml"),
    ("identify", "identify two-mass-bench.csv --rate 2500 --torque-constant 0.564 --to 5 --toml bench.toml"),
    ("replay", "replay two-mass-bench.csv --machine bench.toml --rate 2500 --torque-constant 0.564 --from 5"),
    ("campaign", "campaign roll.toml --draws 12 --results roll.draws"),
];

/// Pages of commands that compile: firmware for QEMU, or a drive for a machine that is an FMU.
const COMPILED: [(&str, &str); 2] =
    [("run", "run hoist --quick --all"), ("cosim", "cosim machines/roll.toml PLANT --time 0.2")];

/// Largest page (bytes): a phone opens it, and a mail takes it.
const LARGEST: u64 = 5_000_000;

fn driveline(place: &Path, arguments: &[&str]) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
    let output = command.args(arguments).current_dir(place).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {output:?}");
}

/// Opens every page of a folder in every view.
fn read(folder: &Path) {
    let mut browser = Browser::start();
    let mut found = Vec::new();
    let mut pages: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    pages.retain(|path| path.extension().is_some_and(|extension| extension == "html"));
    pages.sort();
    for page in &pages {
        let (name, address) = (page.file_stem().unwrap().to_string_lossy(), format!("file://{}", page.display()));
        let size = fs::metadata(page).unwrap().len();
        assert!(size < LARGEST, "{name}: {size} bytes");
        browser.open(&address);
        // A4 with margins of 1 cm, at 96 pixels an inch
        for (width, medium) in [(400, "screen"), (1300, "screen"), (718, "print")] {
            browser.show(width, medium);
            let script = format!("{}({})", include_str!("pages.js").trim_end(), width == 400);
            for finding in browser.run(&script).as_array().unwrap() {
                found.push(format!("{name}, {width} {medium}: {}", finding.as_str().unwrap()));
            }
        }
        let asked = std::mem::take(&mut browser.asked);
        found.extend(asked.iter().filter(|asked| **asked != address).map(|asked| format!("{name} loads {asked}")));
        found.extend(browser.said.drain(..).map(|said| format!("{name} says {said}")));
    }
    println!("measured: {} pages in 3 views, {} findings", pages.len(), found.len());
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
#[ignore = "needs Chromium: cargo lab check --only pages"]
fn pages_read_well_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let own = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../command"));
    for files in ["machines", "trains", "rotors", "recordings"] {
        for file in fs::read_dir(own.join(files)).unwrap().map(Result::unwrap) {
            fs::copy(file.path(), folder.path().join(file.file_name())).unwrap();
        }
    }
    for (name, line) in QUICK {
        let page = format!("{name}.html");
        driveline(folder.path(), &[&line.split(' ').collect::<Vec<_>>()[..], &["--html", &page]].concat());
    }
    fs::write(folder.path().join("run.html"), sample::report().page()).unwrap();
    read(folder.path());
}

#[test]
#[ignore = "needs Chromium, and QEMU for minutes: cargo lab check --long --only pages"]
fn pages_of_firmware_read_well_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let (own, plant) = (Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../command")), folder.path().join("plant.fmu"));
    let plant = plant.to_str().unwrap();
    driveline(own, &["export", "fmu", "machines/roll.toml", "--of", "plant", "--out", plant]);
    for (name, line) in COMPILED {
        let page = folder.path().join(format!("{name}.html"));
        let words = line.split(' ').map(|word| if word == "PLANT" { plant } else { word });
        driveline(own, &[&words.collect::<Vec<_>>()[..], &["--html", page.to_str().unwrap()]].concat());
    }
    read(folder.path());
}

/// The page that designs: in both widths, with the figures of the commands, a slider, a recording, readings.
#[test]
#[ignore = "needs Chromium: cargo lab check --only pages"]
fn the_design_answers_in_a_browser() {
    let folder = tempfile::tempdir().unwrap();
    let printed = |arguments: &[&str]| -> Value {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lab"));
        let output = command.args(arguments).arg("--json").current_dir(folder.path()).output().unwrap();
        let mut value: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{output:?}"));
        value.as_object_mut().unwrap().remove("schema");
        value
    };
    driveline(folder.path(), &["page"]);
    let file = folder.path().join("driveline.html");
    let size = fs::metadata(&file).unwrap().len();
    assert!(size < 1_000_000, "{size} bytes");
    let address = format!("file://{}", file.display());
    let mut browser = Browser::start();
    let begin = Instant::now();
    browser.open(&address);
    browser.wait("document.querySelector('#result g.plot') && !busy");
    println!("measured: {size} bytes, first curve after {:.1} s", begin.elapsed().as_secs_f64());

    let own = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../command"));
    for name in ["roll", "hoist", "axis", "mill", "fan-balance"] {
        let toml = format!("{name}.toml");
        let (place, command) = if name == "fan-balance" { ("rotors", "balancing") } else { ("machines", "design") };
        fs::copy(own.join(place).join(&toml), folder.path().join(&toml)).unwrap();
        let mut ask = |part: &str| {
            let request = format!("ask({{do: '{command}', name: '{toml}', text: examples['{name}'], json: true}})");
            browser.run(&format!("{request}.then((answer) => answer.{part})")).as_str().unwrap().to_owned()
        };
        if command == "design" {
            // its plots too, in the six digits of each: sine and logarithm are those of another library
            assert!(serde_json::from_str::<Value>(&ask("json")).unwrap() == printed(&[command, &toml]), "{name}");
        } else {
            // weights are not rounded in the JSON, but in the page
            driveline(folder.path(), &[command, &toml, "--html", "weights.html"]);
            assert!(ask("page") == fs::read_to_string(folder.path().join("weights.html")).unwrap(), "{name}");
        }
        browser.run(&format!("put('{toml}', examples['{name}'])"));
        browser.wait("!busy && document.getElementById('error').hidden");
        for width in [400, 1300] {
            browser.show(width, "screen");
            let script = format!("{}({})", include_str!("pages.js").trim_end(), width == 400);
            assert_eq!(browser.run(&script), serde_json::json!([]), "{name}, {width}");
        }
    }

    // a slider moves its number, and the loop follows
    let slide = "(async () => { await put('roll.toml', examples.roll); const all = []; for (let n = 0; n < 7; n++) { \
        const slider = document.querySelector('#knobs input[type=range]'); slider.value = 0.1 * n; \
        slider.dispatchEvent(new Event('input')); while (busy) await new Promise((done) => setTimeout(done, 1)); \
        all.push(+document.documentElement.dataset.took); } return all.sort((a, b) => a - b)[3]; })()";
    println!("measured: a slider is answered in {:.0} ms", browser.run(slide).as_f64().unwrap());
    assert!(browser.run("$('text').value").as_str().unwrap().contains("inertia = 0.804"), "0.35 * 4 ** 0.6");

    // a recording gives the machine of the command
    let csv = fs::read_to_string(own.join("recordings/two-mass-bench.csv")).unwrap();
    fs::write(folder.path().join("bench.csv"), &csv).unwrap();
    let line = "identify bench.csv --rate 2500 --torque-constant 0.564 --to 5 --toml bench.toml";
    printed(&line.split(' ').collect::<Vec<_>>());
    let drop = format!(
        "(async () => {{ [$('rate').value, $('constant').value, $('to').value] = [2500, 0.564, 5]; \
         await take(new File([{}], 'bench.csv')); return $('text').value + $('error').textContent; }})()",
        serde_json::json!(csv)
    );
    assert_eq!(browser.run(&drop), fs::read_to_string(folder.path().join("bench.toml")).unwrap());

    // a fault has its place, and what was shown stays
    let fault = "put('roll.toml', examples.roll.replace('inertia', 'inertai'))";
    browser.run(fault);
    browser
        .wait("!busy && $('error').textContent.includes('roll.toml:4:1') && document.querySelector('#result g.plot')");
    assert_eq!(browser.said, Vec::<String>::new());
    assert!(browser.asked.iter().all(|asked| *asked == address || asked.starts_with("blob:")), "{:?}", browser.asked);
}
