//! Error against time and flash of seven subjects, on one page: collected from the pages and budgets that measure them.

mod life;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::Path;

use cargo_driveline::cli::design::rates::M4F;
use driveline_qemu::measure::budgets::{Budget, Budgets};
use driveline_report::chart::{Dot, fronts, scatter};
use driveline_report::format::{grouped, significant};
use driveline_report::{Arrangement, Figure, Key, Section, Sheet, Table};
use driveline_solver::noise::Noise;
use serde::Deserialize;

use crate::extremes::{Cases, waveform};

const POINTS: &str = include_str!("atlas.toml");

/// A core: its name, clock (Hz), and the cycles of an instruction, least and most, where its manual prints cycles.
///
/// The cycles are those of the hoist's four images: their intervals over their bounds, on the page of the worst case.
pub const CORES: [(&str, &str, f64, Option<[f64; 2]>); 3] = [
    ("m4f", "M4F, 168 MHz", M4F.0, Some(M4F.1)),
    ("m3", "M3, 72 MHz", 72e6, Some([1.62, 2.21])),
    ("m33", "M33, 110 MHz", 110e6, None),
];

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    m33: BTreeMap<String, u64>,
    subject: Vec<Subject>,
}

/// A subject of the atlas.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subject {
    pub name: String,
    /// What the error is of.
    pub error: String,
    /// What the cost is of.
    pub call: String,
    pub points: Vec<Point>,
}

/// A part on a machine.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    pub machine: String,
    pub part: String,
    error: Option<f64>,
    #[serde(default = "one")]
    of: f64,
    /// The page that has the error, and the words of its row.
    pub page: Option<String>,
    #[serde(default)]
    pub row: Vec<String>,
    live: Option<String>,
    bench: Option<String>,
    images: Option<[String; 2]>,
    less: Option<[String; 2]>,
    counts: Option<[u64; 2]>,
    ms: Option<f64>,
    flash: Option<String>,
    less_flash: Option<String>,
    /// Instructions on each core.
    #[serde(skip)]
    pub instructions: [Option<u64>; 3],
    #[serde(skip)]
    bytes: Option<u64>,
}

const fn one() -> f64 {
    1.0
}

impl Point {
    /// The error, in the subject's unit.
    pub fn value(&self) -> f64 {
        self.error.unwrap_or(f64::NAN) / self.of
    }

    /// Time on a core, least and most (s): of an instruction at least a cycle where no manual prints more.
    fn time(&self, core: usize) -> Option<[f64; 2]> {
        let (_, _, clock, cycles) = CORES[core];
        let count = self.instructions[core]? as f64;
        Some(cycles.unwrap_or([1.0, f64::NAN]).map(|cycles| cycles * count / clock))
    }
}

/// The atlas.
#[derive(Debug)]
pub struct Atlas {
    pub subjects: Vec<Subject>,
}

impl Atlas {
    /// Reads the points, and their costs from `budgets.toml` in a folder.
    ///
    /// # Errors
    /// Points or budgets that cannot be read; a cost that the budgets do not have.
    pub fn read(root: &Path) -> Result<Self, String> {
        let File { m33, mut subject } = toml::from_str(POINTS).map_err(|error| error.to_string())?;
        let budgets = Budgets::read(&root.join("budgets.toml")).map_err(|error| error.to_string())?;
        let of = |name: &str, core: &str| {
            budgets.of(name, core).ok_or_else(|| format!("budgets.toml has no `{name}` on {core}"))
        };
        // a bound where there is one
        let instructions = |budget: Budget| budget.longest.or(budget.median).unwrap_or(0);
        let flash = |name: &str| Ok::<_, String>(of(name, "m4f")?.flash.unwrap_or(0));
        let empty = flash("empty/f32/none/10000")?;
        for point in subject.iter_mut().flat_map(|subject| &mut subject.points) {
            if let Some(name) = &point.bench {
                let [m4f, m3] = [of(name, "m4f")?, of(name, "m3")?].map(instructions);
                point.instructions = [Some(m4f), Some(m3), m33.get(name).copied()];
            }
            if let Some([single, fixed]) = &point.images {
                let mut counts = [of(single, "m4f")?, of(fixed, "m3")?].map(instructions);
                let mut third = m33.get(single).copied();
                point.bytes = Some(flash(single)? - empty);
                if let Some([single, fixed]) = &point.less {
                    let less = [of(single, "m4f")?, of(fixed, "m3")?].map(instructions);
                    counts = [counts[0] - less[0], counts[1] - less[1]];
                    third = third.zip(m33.get(single)).map(|(all, less)| all - less);
                    point.bytes = point.bytes.zip(flash(single).ok()).map(|(all, less)| all + empty - less);
                }
                point.instructions = [Some(counts[0]), Some(counts[1]), third];
            }
            if let Some([m4f, m3]) = point.counts {
                point.instructions = [Some(m4f), Some(m3), point.instructions[2]];
            }
            if let Some(name) = &point.flash {
                point.bytes = Some(flash(name)? - point.less_flash.as_deref().map_or(Ok(empty), flash)?);
            }
            if let Some(live) = &point.live {
                point.error = Some(100.0 * measured(live)?);
            }
        }
        Ok(Self { subjects: subject })
    }

    /// The images in `f32` whose ticks are a cost.
    pub fn images(&self) -> BTreeSet<&str> {
        let points = self.subjects.iter().flat_map(|subject| &subject.points);
        points.flat_map(|point| point.images.iter().chain(&point.less)).map(|[single, _]| single.as_str()).collect()
    }

    /// The page in Markdown, with the table of stiff and extreme cases.
    pub fn markdown(&self, extremes: &Cases) -> String {
        let mut text = "# Atlas\n\n`cargo lab atlas --markdown doc/makers/atlas.md --picture doc/atlas.svg` has written \
            this page. It collects the errors of [Peers](peers.md), [Drawn machines](drawn-machines.md) and \
            [Results](results.md) and the counts of `budgets.toml`. **On the front** no other part for the same machine \
            has a smaller error for less.\n\n![Error against microseconds, seven subjects](../atlas.svg)\n\n\
            Microseconds are instructions, counted in QEMU or bounded by the machine code, at the clock that stands \
            there. They are not measured on silicon. "
            .to_owned();
        let cycles = CORES.iter().filter_map(|(_, name, _, cycles)| Some((name.split(',').next()?, (*cycles)?)));
        let cycles: Vec<_> =
            cycles.map(|(core, [least, most])| format!("on the {core} {least:.2} to {most:.2} cycles")).collect();
        // Writing to a `String` cannot fail.
        let _ = write!(
            text,
            "An instruction takes {}, as the intervals of the hoist's images in \
             [Worst case](worst-case.md#as-it-is-called). No manual prints the cycles of the M33: its time is the \
             least, one cycle an instruction. Flash is that of the M4F image beyond an empty one.\n\n",
            cycles.join(", ")
        );
        for subject in &self.subjects {
            let _ = writeln!(
                text,
                "## {}\n\nError: {}. Cost: a {}.\n\n{}",
                subject.name,
                subject.error,
                subject.call,
                self.table(subject).markdown()
            );
        }
        let _ = writeln!(
            text,
            "The solver's points are of 2026-11-23 (x86_64, CPython 3.11.7, scipy 1.17.1, openTorsion 0.3.2). The full \
             solver is compiled; the right-hand sides of the others are Python. scipy starts afresh at each corner of \
             the load and at each flank of the gap; openTorsion has no gaps.\n\n## Stiff and extreme cases\n\n{}\n\
             The test `nothing_is_wrong_without_a_word` runs them. Times are those of the host.\n\n{}",
            extremes.summary().markdown(),
            extremes.table().markdown()
        );
        text.truncate(text.trim_end().len());
        text + "\n"
    }

    /// A subject's points: error, cost on each core, flash, front, source.
    pub fn table(&self, subject: &Subject) -> Table {
        let on_host = subject.points.iter().all(|point| point.ms.is_some());
        let costs = if on_host {
            vec!["ms".to_owned()]
        } else {
            CORES.iter().flat_map(|(_, name, ..)| [format!("instructions, {name}"), "µs".to_owned()]).collect()
        };
        let flash = (!on_host).then(|| "flash".to_owned());
        let first = ["machine", "part", "error"].map(str::to_owned);
        let last = ["on the front of".to_owned()];
        let mut table = Table::new(first.into_iter().chain(costs).chain(flash).chain(last));
        let on = [0, 1].map(|core| fronts(&dots(subject, core)));
        for (at, point) in subject.points.iter().enumerate() {
            let mut row = vec![point.machine.clone(), point.part.clone(), significant(point.value())];
            if let Some(ms) = point.ms {
                row.push(significant(ms));
                row.push(if on[0][at] { "this host" } else { "" }.to_owned());
                table.row(row);
                continue;
            }
            for (core, (_, _, _, cycles)) in CORES.iter().enumerate() {
                row.push(point.instructions[core].map_or_else(String::new, |count| grouped(count as i64)));
                row.push(point.time(core).map_or_else(String::new, |[least, most]| {
                    let [least, most] = [least, most].map(|time| significant(1e6 * time));
                    if cycles.is_some() { format!("{least} to {most}") } else { format!("{least} and more") }
                }));
            }
            row.push(point.bytes.map_or_else(String::new, |bytes| grouped(bytes as i64)));
            let fronts = ["M4F", "M3"].into_iter().zip(on.iter().map(|on| on[at])).filter(|(_, on)| *on);
            row.push(fronts.map(|(core, _)| core).collect::<Vec<_>>().join(", "));
            table.row(row);
        }
        table
    }

    /// A plot for each subject.
    fn plots(&self, size: [f64; 2]) -> Vec<String> {
        let plot = |subject: &Subject| {
            let axis =
                if subject.points.iter().all(|point| point.ms.is_some()) { "ms on the host" } else { "µs, M4F" };
            scatter(&dots(subject, 0), [axis, "error"], size, &subject.name)
        };
        self.subjects.iter().map(plot).collect()
    }

    /// One picture of all plots, four in a row, with its own style.
    pub fn picture(&self) -> String {
        let [width, height] = [300.0, 230.0];
        let rows = self.subjects.len().div_ceil(4) as f64;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\"><style>{STYLE}</style>\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>",
            4.0 * width,
            rows * height
        );
        for (at, plot) in self.plots([width, height]).into_iter().enumerate() {
            let (x, y) = ((at % 4) as f64 * width, (at / 4) as f64 * height);
            let place = format!("<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" ");
            svg.push_str(&plot.replacen("<svg ", &place, 1));
        }
        svg + "</svg>\n"
    }

    /// The page in a browser.
    pub fn page(&self, extremes: &Cases) -> String {
        let figure = Figure {
            title: "Error against time".to_owned(),
            text: "A colour is a machine. Full points are on its front: no other part for it has a smaller error for \
                less time."
                .to_owned(),
            legend: Vec::<Key>::new(),
            plots: self.plots([540.0, 340.0]),
            arrangement: Arrangement::Paired,
        };
        let section = |subject: &Subject| {
            Section::new(&subject.name, format!("{}, a {}", subject.error, subject.call), self.table(subject))
        };
        let extremes = [
            Section::new("Stiff and extreme cases", "", extremes.summary()),
            Section::new("Each case", "", extremes.table()),
        ];
        Sheet {
            name: "atlas".to_owned(),
            kicker: "error against time and flash".to_owned(),
            summary: "Counts of instructions at a stated clock, not silicon.".to_owned(),
            figures: vec![figure],
            tables: self.subjects.iter().map(section).chain(extremes).collect(),
            ..Sheet::default()
        }
        .page()
    }
}

/// The points of a subject over the microseconds of a core, in the middle of their interval, or milliseconds.
fn dots(subject: &Subject, core: usize) -> Vec<Dot> {
    let mut machines: Vec<&str> = Vec::new();
    let dot = |point| {
        let Point { machine, part, ms, .. }: &Point = point;
        let group = machines.iter().position(|known| known == machine).unwrap_or_else(|| {
            machines.push(machine);
            machines.len() - 1
        });
        let time = point.time(core).map(|[least, most]| 1e6 * if most > 0.0 { 0.5 * (least + most) } else { least });
        let cost = ms.or(time).unwrap_or(f64::NAN);
        Dot { cost, error: point.value(), group, shape: group, name: part.clone() }
    };
    subject.points.iter().map(dot).collect()
}

const STYLE: &str = "text{font:11px sans-serif;fill:#59616b}.name{font-size:13px;font-weight:600;fill:#1b1f24}\
    .number{font-size:10px;fill:#1b1f24}.grid{stroke:#eceef0}.edge{stroke:#8b939c}\
    .point{fill:currentColor;stroke:#fff}.off{opacity:.4}\
    .s0{color:#2073e5}.s1{color:#c45b05}.s2{color:#257049}.s3{color:#7b46a6}.s4{color:#830355}.s5{color:#7a7b89}";

/// Median error over 200 drawn inputs, of what no page has.
fn measured(live: &str) -> Result<f64, String> {
    let mut noise = Noise::new(2026);
    let mut errors = Vec::new();
    for _ in 0..200 {
        let mut between = |low: f64, high: f64| low * (high / low).powf(0.5 * (1.0 + noise.uniform()));
        let (delta, ticks, counts) = (between(1e-3, 0.1), between(100.0, 1000.0), between(1e3, 1e5).round());
        let found = match live {
            "waveform" => waveform::waveform(delta, ticks, counts, 32).map(|found| found.error),
            "extremes" => waveform::extremes(delta, ticks).map(|found| found.error),
            "life 16" => Ok(life::error::<16>(&mut noise)),
            "life 64" => Ok(life::error::<64>(&mut noise)),
            "life 128" => Ok(life::error::<128>(&mut noise)),
            other => return Err(format!("nothing measures `{other}`")),
        };
        errors.extend(found);
    }
    errors.sort_by(f64::total_cmp);
    errors.get(errors.len() / 2).copied().ok_or_else(|| format!("no result of `{live}`"))
}
