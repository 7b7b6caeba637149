//! The loop that `design` draws against a measurement of it: the library's drive, tick by tick, on a machine of own
//! equations, with many sines added to its torque where the loop is cut.
//!
//! The machine is masses and springs in their own coordinates, its actuator a lag in continuous time. What goes round
//! the loop is `L = -M/(M + W)`: `M` the spectrum of the torque that the drive gives, `W` that of what is added. The
//! drawn steps and the observer are measured on the same drive.

use std::f64::consts::{PI, TAU};
use std::fs;
use std::process::Command;

use cargo_driveline::cosim::fmu::Fmu;
use cargo_driveline::machine_file::designs::Designs;
use cargo_driveline::machine_file::parse;
use driveline::drive::{Config, Drive, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::number::{Fixed, Number};
use driveline::observer::{RigidConfig, RigidObserver, TwoMassConfig, TwoMassObserver};
use driveline::sample::Sample;
use driveline::settings::{Bases, Gear, SpeedLoopSettings};
use driveline_qemu::clone::target_directory;
use nalgebra::{Complex, DMatrix};
use rustfft::FftPlanner;
use serde_json::Value;

use super::bench::Bench;

/// Periods of the lowest crossover in a window, so that lines lie within 1 % of where they are wanted.
const PERIODS: f64 = 120.0;
/// Share by which a figure of the page may differ.
const AGREES: f64 = 0.02;

/// A machine at the motor's speed: inertias, and springs as two masses, stiffness and damping. The motor is mass 0.
#[derive(Clone)]
struct Body {
    inertias: Vec<f64>,
    springs: Vec<(usize, usize, f64, f64)>,
    /// Ticks of dead time and a lag (s).
    delay: usize,
    lag: f64,
    /// The mass at the end of the chain.
    load: usize,
    /// Efficiency of a gear before the last spring, the motor driving.
    efficiency: f64,
    /// Setpoint (rad/s) and load torque (N m) that it is measured at.
    at: [f64; 2],
}

impl Body {
    /// Speeds of motor and load and torque of the motor in each tick, from rest. `entry` gives setpoint, added torque
    /// and load torque of a tick.
    fn run(&self, period: f64, ticks: usize, mut drive: Driven, entry: impl Fn(usize) -> [f64; 3]) -> Vec<[f64; 3]> {
        let step = tick(self, period);
        let (n, masses) = (step.nrows(), self.inertias.len());
        let (mut state, mut line) = (vec![0.0; n], vec![0.0; self.delay]);
        let mut shown = Vec::with_capacity(ticks);
        for k in 0..ticks {
            let [setpoint, added, load] = entry(k);
            let speeds = [state[masses], state[masses + self.load]];
            line.push(drive(counted(state[0]), state[2 * masses + 1], setpoint)[0]);
            state[2 * masses + 1] = 0.0;
            state.splice(n - 3.., [line.remove(0), added, load]);
            state = (0..n).map(|row| step.row(row).iter().zip(&state).map(|(a, b)| a * b).sum()).collect();
            shown.push([speeds[0], speeds[1], state[2 * masses + 1]]);
        }
        shown
    }
}

/// `exp(A)`: a series on a small part of it, then squared.
fn exponential(a: &DMatrix<f64>) -> DMatrix<f64> {
    let halvings = a.abs().max().max(1e-9).log2().ceil().max(0.0) as i32 + 6;
    let part = a / 2f64.powi(halvings);
    let n = a.nrows();
    let (mut term, mut sum) = (DMatrix::identity(n, n), DMatrix::identity(n, n));
    for k in 1..16 {
        term = &term * &part / f64::from(k);
        sum += &term;
    }
    (0..halvings).fold(sum, |power, _| &power * &power)
}

/// A drive: from angle, torque of the ended tick (N m) and setpoint (rad/s) to torque, load speed and shaft torque.
type Driven = Box<dyn FnMut(u32, f64, f64) -> [f64; 3]>;

/// An angle (rad) as an encoder without steps gives it.
fn counted(angle: f64) -> u32 {
    let turns = angle / TAU;
    ((turns - turns.floor()) * 4_294_967_296.0) as u64 as u32
}

/// Rows of the state after a tick: angles, speeds, the lagging torque, its mean over the tick; then command, torque
/// added to the motor's, and torque that the last mass of the chain is loaded by.
fn tick(body: &Body, period: f64) -> DMatrix<f64> {
    let masses = body.inertias.len();
    let (lagging, mean, command, added) = (2 * masses, 2 * masses + 1, 2 * masses + 2, 2 * masses + 3);
    let mut rates = DMatrix::zeros(added + 2, added + 2);
    rates[(masses + body.load, added + 1)] = -1.0 / body.inertias[body.load];
    for mass in 0..masses {
        rates[(mass, masses + mass)] = 1.0;
    }
    for (index, &(a, b, stiffness, damping)) in body.springs.iter().enumerate() {
        // what the motor's side feels of the torque that the spring has
        let felt = if index + 1 == body.springs.len() { 1.0 / body.efficiency } else { 1.0 };
        for (on, from, sign) in [(a, a, -felt), (a, b, felt), (b, b, -1.0), (b, a, 1.0)] {
            rates[(masses + on, from)] += sign * stiffness / body.inertias[on];
            rates[(masses + on, masses + from)] += sign * damping / body.inertias[on];
        }
    }
    rates[(masses, added)] = 1.0 / body.inertias[0];
    let acts = if body.lag > 0.0 { lagging } else { command };
    rates[(masses, acts)] = 1.0 / body.inertias[0];
    rates[(mean, acts)] = 1.0 / period;
    if body.lag > 0.0 {
        rates[(lagging, command)] = 1.0 / body.lag;
        rates[(lagging, lagging)] = -1.0 / body.lag;
    }
    exponential(&(rates * period))
}

/// The loop at the lines of a window of so many ticks, as its torque (N m) in a window once all has settled.
fn measured(body: &Body, period: f64, ticks: usize, lines: &[usize], size: f64, drive: Driven) -> Vec<Complex<f64>> {
    let mut planner = FftPlanner::new();
    // phases that grow with the square of the line's number: no peak
    let mut added = vec![Complex::from(0.0); ticks];
    for (n, &line) in lines.iter().enumerate() {
        added[line] = Complex::from_polar(size, PI * (n * n) as f64 / lines.len() as f64);
    }
    planner.plan_fft_inverse(ticks).process(&mut added);
    let [setpoint, load] = body.at;
    let shown = body.run(period, 2 * ticks, drive, |k| [setpoint, added[k % ticks].re, load]);
    let mut given: Vec<_> = shown[ticks..].iter().map(|shown| Complex::from(shown[2])).collect();
    planner.plan_fft_forward(ticks).process(&mut given);
    let mut put: Vec<Complex<f64>> = added.iter().map(|value| Complex::from(value.re)).collect();
    planner.plan_fft_forward(ticks).process(&mut put);
    lines.iter().map(|&line| -given[line] / (given[line] + put[line])).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

/// The drive of a file as a function from angle and torque (N m) to torque, in one number.
macro_rules! drive {
    ($number:ty, $from:expr, $text:expr, $bases:expr) => {{
        let machine = parse("machine", $text).unwrap();
        let two = machine.two_masses().unwrap();
        let designs = Designs::of(&machine, &two).unwrap();
        let (rate, encoder, _) = machine.tuning();
        let rating = machine.rating();
        let bases: Bases = $bases(&rating, &designs);
        let limits = Limits::<$number>::try_new(&rating.screening(encoder, rate), bases).unwrap();
        let settings = SpeedLoopSettings { torque_limit: rating.torque_limit.0, ramp: 1e3 * designs.ramp };
        let governor = SpeedLoopConfig::<$number>::try_new(&designs.speed_loop, settings, bases).unwrap();
        let from = $from;
        macro_rules! observed {
            ($observer:ty, $config:expr) => {{
                let config = Config { limits, observer: $config, fluctuation: (), governor, balancer: () };
                let mut drive = Drive::<$number, $observer, SpeedLoop>::new(&config, 0);
                Box::new(move |angle, heard: f64, setpoint: f64| {
                    let sample =
                        Sample { angle, torque: from(heard / bases.torque), setpoint: from(setpoint / bases.speed) };
                    let command = drive.tick(&config, &sample);
                    assert!(command.faults.is_none(), "{:?}", command.faults);
                    let found = drive.estimate(&config);
                    let [torque, shaft_torque] =
                        [command.torque, found.shaft_torque].map(|t| t.to_real() * bases.torque);
                    [torque, found.load_speed.to_real() * bases.speed, shaft_torque]
                }) as Driven
            }};
        }
        if designs.is_rigid() {
            let share = two.load_inertia / two.total_inertia();
            observed!(RigidObserver, RigidConfig::<$number>::try_new(&designs.rigid, share, bases).unwrap())
        } else {
            observed!(TwoMassObserver, TwoMassConfig::<$number>::try_new(&designs.two_masses, bases).unwrap())
        }
    }};
}

fn single(text: &str) -> Driven {
    drive!(f32, |value: f64| value as f32, text, |_, _| Bases::SI)
}

fn fixed(text: &str) -> Driven {
    use driveline::configure::Rating;
    let bases = |rating: &Rating, d: &Designs| {
        let none = Gear { efficiency: 1.0, inertia: d.two.motor_inertia, deadband: 0.0 };
        rating.bases(&d.two_masses, &d.rigid, &none, &d.speed_loop)
    };
    drive!(Fixed, Fixed::from_f64, text, bases)
}

/// The drive as `export fmu` writes it, with its ramp and the losses that it knows.
fn exported(text: &str, number: &str) -> Driven {
    let folder = tempfile::tempdir().unwrap();
    let (file, fmu) = (folder.path().join("machine.toml"), folder.path().join("drive.fmu"));
    fs::write(&file, text).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-driveline"));
    command.args(["driveline", "export", "fmu", "--number", number, "--out"]).args([&fmu, &file]);
    let run = command.env("CARGO_TARGET_DIR", target_directory().unwrap().join("exported/target")).output().unwrap();
    assert!(run.status.success(), "{run:?}");
    let mut fmu = Fmu::open(&fmu).unwrap();
    let of = |causality: &str, names: [&str; 3]| {
        names.map(|name| fmu.description.scalar(name, causality).unwrap().reference)
    };
    let inputs = of("input", ["motor_angle", "motor_torque", "speed_setpoint"]);
    let outputs = of("output", ["torque_setpoint", "load_speed", "shaft_torque"]);
    let period = 1.0 / f64::from(parse("machine", text).unwrap().control.rate_hz);
    fmu.instance.begin().unwrap();
    fmu.instance.start().unwrap();
    let mut tick = 0.0;
    Box::new(move |angle, heard, setpoint| {
        let turned = f64::from(angle) / 4_294_967_296.0 * TAU;
        fmu.instance.set(&inputs, &[turned, heard, setpoint]).unwrap();
        fmu.instance.step(tick * period, period).unwrap();
        tick += 1.0;
        let mut found = [0.0; 3];
        fmu.instance.get(&outputs, &mut found).unwrap();
        found
    })
}

/// The drawn steps against those of the drive, small enough for no limit and no ramp: the largest deviation over the largest value.
fn stepped(responses: &Value, body: &Body, rate: f64, limit: f64, drive: &dyn Fn() -> Driven) -> f64 {
    let time = numbers(&responses["time"]);
    let ticks: Vec<usize> = time.iter().map(|time| (time * rate).round() as usize).collect();
    let mut worst: f64 = 0.0;
    for (key, entry) in [("setpoint", [1.0, 0.0, 0.0]), ("load", [0.0, 0.0, 1.0])] {
        let courses = ["motor_speed", "load_speed", "motor_torque"];
        let courses = courses.map(|course| numbers(&responses["nominal"]["steps"][key][course]));
        let sizes = courses.each_ref().map(|course| course.iter().fold(0.0, |most: f64, value| most.max(value.abs())));
        let share = 0.01 * limit / sizes[2];
        let shown = body.run(1.0 / rate, ticks.last().unwrap() + 1, drive(), |_| entry.map(|value| value * share));
        for (course, size) in (0..3).zip(sizes) {
            for (tick, drawn) in ticks.iter().zip(&courses[course]) {
                worst = worst.max((shown[*tick][course] / share - drawn).abs() / size);
            }
        }
    }
    worst
}

/// The drawn observer against the drive's estimates while it turns and swings and no torque is heard, at the places.
fn observed(responses: &Value, rate: f64, places: &[f64], drive: &dyn Fn() -> Driven) -> f64 {
    let hz = numbers(&responses["hz"]);
    let mut worst: f64 = 0.0;
    for &place in places {
        // a whole number of ticks in a period, and of periods before it has settled
        let period = (rate / place).round() as usize;
        let omega = TAU * rate / period as f64;
        let mut drive = drive();
        let settled = period * (1.0 + 3.0 * rate / period as f64).ceil() as usize;
        let size = 0.01;
        let mut sums = [Complex::from(0.0); 2];
        for k in 0..settled + period {
            let turned = omega * k as f64 / rate;
            let [_, load_speed, shaft_torque] = drive(counted(size * turned.sin() + 20.0 * k as f64 / rate), 0.0, 0.0);
            if k >= settled {
                let share = Complex::from_polar(2.0 / period as f64, -turned) * Complex::i();
                sums[0] += share * load_speed;
                sums[1] += share * shaft_torque;
            }
        }
        let speed = Complex::new(0.0, omega * size);
        for (key, sum) in ["load_speed", "shaft_torque"].into_iter().zip(sums) {
            let curve = &responses["observer"][key];
            let [gain, phase] = ["gain", "phase"].map(|part| {
                let values = numbers(&curve[part]);
                let k = hz.partition_point(|hz| *hz < omega / TAU).clamp(1, hz.len() - 1);
                let share = (omega / TAU - hz[k - 1]) / (hz[k] - hz[k - 1]);
                values[k - 1] + (values[k] - values[k - 1]) * share
            });
            worst = worst.max((sum / speed / Complex::from_polar(gain, phase.to_radians()) - 1.0).norm());
        }
    }
    worst
}

/// What is measured.
#[derive(Clone, Copy)]
enum By {
    /// The parts of the drive, without its ramp.
    Single,
    /// The same in fixed point.
    Fixed,
    /// The exported FMU in a number, and the margins that it is compared with.
    Exported(&'static str, &'static str),
}

/// What a file's page says, against the measurement. Gives the largest deviations: of the drawn response, of the
/// margins, of the steps, of the observer; of an exported drive the margins' alone.
fn compared(name: &str, text: &str, body: &Body, by: By) -> [f64; 4] {
    let bench = Bench::with("machine.toml", text);
    let run = bench.run(&["design", "machine.toml", "--json", "--html", "machine.html"]);
    let said: Value = serde_json::from_slice(&run.stdout).unwrap_or_else(|_| panic!("{name}: {run:?}"));
    let key = if let By::Exported(_, key) = by { key } else { "margins" };
    let (rate, margins, responses) = (said["rate_hz"].as_f64().unwrap(), &said["speed_loop"][key], &said["responses"]);
    assert!(!margins.is_null(), "{name}: {said:#?}");
    let (hz, nominal) = (numbers(&responses["hz"]), &responses["nominal"]);
    let drawn: Vec<Complex<f64>> = numbers(&nominal["real"])
        .into_iter()
        .zip(numbers(&nominal["imaginary"]))
        .map(|(re, im)| Complex::new(re, im))
        .collect();

    // lines: over the band of the crossovers, and close to each place that a margin is read at
    let crossings = nominal["crossings"].as_array().unwrap();
    let at = |crossing: &Value| crossing["hz"].as_f64().unwrap();
    let nearest =
        (0..drawn.len()).min_by(|&a, &b| (drawn[a] + 1.0).norm().total_cmp(&(drawn[b] + 1.0).norm())).unwrap();
    let places: Vec<f64> = crossings.iter().map(at).chain([hz[nearest]]).collect();
    let lowest = places.iter().copied().fold(f64::INFINITY, f64::min);
    let highest = places.iter().copied().fold(0.0, f64::max);
    let ticks = (PERIODS * rate / lowest).round() as usize;
    let band = (0..30).map(|n| 0.5 * lowest * (2.6 * highest / lowest).powf(f64::from(n) / 29.0));
    let close = places.iter().flat_map(|&place| (-6..=6).map(move |n| place * (1.0 + 0.01 * f64::from(n))));
    let mut lines: Vec<usize> = band.chain(close).map(|hz| (hz / rate * ticks as f64).round() as usize).collect();
    lines.retain(|&line| line > 0 && line < ticks / 2);
    lines.sort_unstable();
    lines.dedup();

    // all sines together stay below a third of the largest torque, and far above a unit of fixed point
    let limit = parse("machine", text).unwrap().rating().torque_limit.0;
    let size = 0.05 * limit / (lines.len() as f64).sqrt();
    let drive = || match by {
        By::Single => single(text),
        By::Fixed => fixed(text),
        By::Exported(number, _) => exported(text, number),
    };
    let found = measured(body, 1.0 / rate, ticks, &lines, size, drive());
    let found: Vec<(f64, Complex<f64>)> =
        lines.iter().map(|&line| line as f64 * rate / ticks as f64).zip(found).collect();

    // the drawn response at the lines, between its points
    let response = found.iter().map(|&(at, value)| {
        let k = hz.partition_point(|hz| *hz < at).clamp(1, hz.len() - 1);
        let share = (at - hz[k - 1]) / (hz[k] - hz[k - 1]);
        (drawn[k - 1] + (drawn[k] - drawn[k - 1]) * share - value).norm() / value.norm()
    });
    let response = response.fold(0.0, f64::max);

    // margins of the measured lines alone
    let between = |a: f64, b: f64, x: f64, y: f64| x + (y - x) * a / (a - b);
    let (mut gain, mut phase, mut delay) = (f64::INFINITY, f64::INFINITY, f64::INFINITY);
    for pair in found.windows(2) {
        let ((low, a), (high, b)) = (pair[0], pair[1]);
        let (u, v) = (a.norm().ln(), b.norm().ln());
        if (u < 0.0) != (v < 0.0) {
            let value = Complex::new(between(u, v, a.re, b.re), between(u, v, a.im, b.im));
            phase = phase.min((-value).arg().abs());
            delay = delay.min((value.arg() + PI) / (TAU * between(u, v, low, high)));
        }
        if (a.im < 0.0) != (b.im < 0.0) && a.re < 0.0 && b.re < 0.0 {
            let size = -between(a.im, b.im, a.re, b.re);
            gain = gain.min(if size < 1.0 { 1.0 / size } else { f64::INFINITY });
        }
    }
    let distance = found.iter().map(|(_, value)| (value + 1.0).norm()).fold(f64::INFINITY, f64::min);
    let mut worst: f64 = 0.0;
    for (key, found) in [("gain_up", gain), ("phase", phase), ("delay", delay), ("modulus", distance)] {
        let shown = margins[key].as_f64().unwrap_or(f64::INFINITY);
        let off = if shown == found { 0.0 } else { (found / shown - 1.0).abs() };
        println!("{name}: {key} {shown:.5}, measured {found:.5}, off by {:.2} %", 100.0 * off);
        worst = worst.max(off);
    }
    println!("{name}: {} lines, response off by {:.2} % at most", lines.len(), 100.0 * response);
    if let By::Exported(..) = by {
        return [0.0, worst, 0.0, 0.0];
    }
    let [steps, observer] = [stepped(responses, body, rate, limit, &drive), observed(responses, rate, &places, &drive)];
    println!("{name}: steps off by {:.2} % of their largest, observer by {:.2} %", 100.0 * steps, 100.0 * observer);
    // the page has the figures of the JSON
    let html = bench.read("machine.html");
    let shown = driveline_report::format::significant(margins["phase"].as_f64().unwrap().to_degrees());
    assert!(html.contains(&format!(">{shown}<")), "{name}: no {shown} on the page");
    [response, worst, steps, observer]
}

fn two_masses([motor, load]: [f64; 2], stiffness: f64, damping: f64) -> Body {
    Body { inertias: vec![motor, load], springs: vec![(0, 1, stiffness, damping)], ..BARE }
}

/// Two masses without a spring.
const BARE: Body =
    Body { inertias: Vec::new(), springs: Vec::new(), delay: 0, lag: 0.0, load: 1, efficiency: 1.0, at: [0.0; 2] };

/// The tail of a file: encoder, rate, disturbance, limits.
fn tail(lines: u32, rate: u32, accuracy: f64, step: f64, within: f64, torque: f64, speed: f64) -> String {
    format!(
        "[encoder]\nlines = {lines}\n[control]\nrate_hz = {rate}\n[disturbance]\ntorque_accuracy = {accuracy}\n\
         load_torque_step = {step}\nwithin = {within}\n[limits]\ntorque = {torque}\nspeed = {speed}\n"
    )
}

/// Margins and response of the page are those of the drive that turns, within 2 %: of the examples, and of machines
/// that are none.
#[test]
fn the_loop_on_the_page_is_the_one_that_turns() {
    let own = |name: &str| fs::read_to_string(format!("{}/machines/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    // metres of the load per radian of the motor: the drum's radius over gear and falls
    let travel = 0.4 / 31.5 / 2.0;
    let square = travel * travel;
    let hoist = Body {
        inertias: vec![0.62, 0.08, 12_000.0 * square],
        springs: vec![(0, 1, 5.0e4, 2.0), (1, 2, 2.9e6 * square, 3.6e3 * square)],
        load: 2,
        ..BARE
    };
    // two gears of 3 and 4, an actuator that is late and slow, and few ticks
    let geared = format!(
        "name = \"geared\"\n[[element]]\nkind = \"motor\"\ninertia = 0.02\n[[element]]\nkind = \"gear\"\nratio = 3\n\
         [[element]]\nkind = \"shaft\"\nstiffness = 900.0\ndamping = 1.5\n[[element]]\nkind = \"rotor\"\n\
         label = \"middle\"\ninertia = 0.09\n[[element]]\nkind = \"gear\"\nratio = 4\n[[element]]\nkind = \"shaft\"\n\
         stiffness = 60000.0\ndamping = 60.0\n[[element]]\nkind = \"rotor\"\ninertia = 1.5\n{}\
         [actuator]\ndelay = 0.001\nbandwidth = 200.0\n[speed_loop]\nbandwidth = 0.3\n\
         [tolerance]\ndelay = 0\nlag = 0.0001\n",
        tail(4096, 1_000, 0.3, 3.0, 2.0, 30.0, 200.0)
    );
    let geared_body = Body {
        inertias: vec![0.02, 0.09 / 9.0, 1.5 / 144.0],
        springs: vec![(0, 1, 900.0 / 9.0, 1.5 / 9.0), (1, 2, 60_000.0 / 144.0, 60.0 / 144.0)],
        delay: 1,
        lag: 1.0 / (TAU * 200.0),
        load: 2,
        ..BARE
    };
    // a pump on a branch of the motor, turning twice as fast; a fast drive
    let branched = format!(
        "name = \"branched\"\n[[element]]\nkind = \"motor\"\nlabel = \"motor\"\ninertia = 0.004\n[[element]]\n\
         kind = \"shaft\"\nstiffness = 3000.0\ndamping = 0.3\n[[element]]\nkind = \"rotor\"\ninertia = 0.006\n\
         [[branch]]\nat = \"motor\"\n[[branch.element]]\nkind = \"gear\"\nratio = 0.5\n[[branch.element]]\n\
         kind = \"shaft\"\nstiffness = 1500.0\ndamping = 0.3\n[[branch.element]]\nkind = \"rotor\"\ninertia = 0.0001\n{}",
        tail(8192, 40_000, 0.05, 2.0, 0.5, 20.0, 300.0)
    );
    let branched_body = Body {
        inertias: vec![0.004, 0.006, 0.0001 / 0.25],
        springs: vec![(0, 1, 3000.0, 0.3), (0, 2, 1500.0 / 0.25, 0.3 / 0.25)],
        ..BARE
    };
    // a fan behind two couplings; the hoist while it lifts its load, with the loss of its gear
    let fan = format!(
        "name = \"fan\"\n[[element]]\nkind = \"motor\"\ninertia = 1.1\n[[element]]\nkind = \"shaft\"\nstiffness = 6400.0\n\
         damping = 3.0\n[[element]]\nkind = \"rotor\"\nlabel = \"hub\"\ninertia = 0.4\n[[element]]\nkind = \"shaft\"\n\
         stiffness = 190000.0\ndamping = 4.0\n[[element]]\nkind = \"rotor\"\ninertia = 7.5\n{}",
        tail(1024, 5_000, 4.0, 200.0, 20.0, 700.0, 180.0)
    );
    let fan_body = Body {
        inertias: vec![1.1, 0.4, 7.5],
        springs: vec![(0, 1, 6_400.0, 3.0), (1, 2, 190_000.0, 4.0)],
        load: 2,
        at: [40.0, 0.0],
        ..BARE
    };
    let lifting = Body {
        inertias: hoist.inertias.clone(),
        springs: hoist.springs.clone(),
        efficiency: 0.94,
        at: [60.0, 12_000.0 * 9.80665 * travel],
        ..hoist.clone()
    };
    let roll = two_masses([0.35, 0.48], 2.0e4, 0.5);
    let nominal = |number| By::Exported(number, "margins");
    let cases = [
        ("roll", own("roll"), two_masses([0.35, 0.48], 2.0e4, 0.5), By::Single),
        ("roll in fixed point", own("roll"), two_masses([0.35, 0.48], 2.0e4, 0.5), By::Fixed),
        ("hoist", own("hoist"), hoist, By::Single),
        ("geared", geared.clone(), geared_body.clone(), By::Single),
        ("branched", branched, branched_body, By::Single),
        ("roll, FMU", own("roll"), roll, nominal("f32")),
        ("geared, FMU in fixed point", geared, geared_body, nominal("fixed")),
        ("fan, FMU", fan, fan_body, nominal("f32")),
        ("hoist that lifts, FMU", own("hoist"), lifting, By::Exported("f32", "margins_motor_driving")),
    ];
    for (name, text, body, by) in &cases {
        let found = compared(name, text, body, *by);
        assert!(found.iter().all(|off| *off < AGREES), "{name}: {found:?}");
    }
}
