//! The page on troubleshooting: every flag and every message of it is provoked.

use std::collections::BTreeSet;

use driveline::axis::{Axis, Board, TRIPPING};
use driveline::fault::Faults;
use driveline::prelude::*;

use super::typed;

const PAGE: &str = include_str!("../../../../doc/troubleshooting.md");

/// The first cells of the tables under a heading.
fn rows(heading: &str) -> BTreeSet<String> {
    let (_, after) = PAGE.split_once(&format!("\n## {heading}\n")).unwrap();
    let section = after.split("\n## ").next().unwrap();
    let cells = section.lines().filter_map(|line| line.strip_prefix("| `")?.split_once("` |"));
    cells.map(|(cell, _)| cell.to_owned()).collect()
}

/// Makes a file of an example by a change with `sed`, and gives it to a command.
const PROVOKED: [(&str, &str); 20] = [
    ("the table … as in the file of", "sed '/^.disturbance/,/^$/d' roll.toml > m.toml; design m.toml"),
    ("found an unknown key, expected only", "sed 's/damping/dampng/' roll.toml > m.toml; modes m.toml"),
    ("expected a number, 1e-12 to 1e12", "sed 's/= 0.48/= -0.48/' roll.toml > m.toml; modes m.toml"),
    ("a table [run]", "simulate roll.toml"),
    ("the sample rate cannot follow the shaft", "sed 's/2.0e4/2.0e8/' roll.toml > m.toml; design m.toml"),
    ("the speed loop is unstable at this sample rate", "sed 's/= 10000/= 200/' roll.toml > m.toml; design m.toml"),
    (
        "the speed loop lacks margins: … it has all margins",
        "{ cat mill.toml; echo '[speed_loop]'; echo 'bandwidth = 0.7'; } > m.toml; design m.toml",
    ),
    (
        "the observer of two masses has all margins",
        "{ cat roll.toml; echo '[actuator]'; echo 'delay = 0.001'; } > m.toml; design m.toml",
    ),
    (
        "mends it alone; the shafts may need damping",
        "{ cat roll.toml; echo '[actuator]'; echo 'bandwidth = 20.0'; } > m.toml; design m.toml",
    ),
    ("one mass would do, but lacks margin", "design roll.toml"),
    ("it has branches; leave them out", "new twin --machine ship.toml"),
    ("the weight of … is not held by", "sed 's/= 12000.0/= 24000.0/' hoist.toml > m.toml; new heavy --machine m.toml"),
    (
        "is too fast for a rotor of the motor's inertia",
        "sed 's/speed = 150.0/speed = 1500.0/' roll.toml > m.toml; design m.toml",
    ),
    ("exists and is not empty; name a new folder", "mkdir full; touch full/x; new full"),
    ("expected a column of time, … or --rate", "identify bench.csv"),
    (
        "no machine is identified: the torque excites … frequencies at most",
        "identify bench.csv --rate 2500 --torque-constant 0.564 --to 0.2",
    ),
    ("angle jump in … ticks", "replay bench.csv --machine roll.toml --rate 2500 --torque-constant 0.564"),
    (
        "expected a stiffness of at most … or a run of at most",
        "sed 's/^time = .*/time = 1000.0/' start.toml > m.toml; simulate m.toml",
    ),
    ("put a weight there and run again", "sed 's/= .2.5, 0.  /= [0, 0]  /' fan.toml > m.toml; balancing m.toml"),
    ("has no such key with a number: write the key", "campaign roll.toml --tune speed_loop.bandwidth=0.1..0.8"),
];

/// Whether a text has the parts of a message, between its `…`, in their order.
fn says(printed: &str, message: &str) -> bool {
    let mut rest = printed;
    message.split('…').all(|part| match rest.split_once(part.trim()) {
        Some((_, after)) => {
            rest = after;
            true
        }
        None => false,
    })
}

#[test]
fn every_message_is_provoked() {
    let folder = tempfile::tempdir().unwrap();
    let examples = [
        ("roll", "roll.toml"),
        ("hoist", "hoist.toml"),
        ("mill", "mill.toml"),
        ("ship", "ship.toml"),
        ("hoist-start", "start.toml"),
        ("fan-balance", "fan.toml"),
        ("bench-log", "bench.csv"),
    ];
    for (example, file) in examples {
        typed(&format!("cargo driveline example {example} > {file}"), folder.path());
    }
    for (message, provocation) in PROVOKED {
        let (before, command) = provocation.rsplit_once("; ").unwrap_or((":", provocation));
        let printed = typed(&format!("{before}; cargo driveline {command}"), folder.path());
        assert!(says(&printed, message), "`{message}` is not printed by `{provocation}`:\n{printed}");
    }
    assert_eq!(rows("By message"), PROVOKED.map(|(message, _)| message.to_owned()).into());
}

/// The README's roll.
struct Roll;
impl Machine for Roll {
    const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
    const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
}

type RollDrive<N> = Drive<N, TwoMassObserver, SpeedLoop>;
static CONFIG: ConfigOf<RollDrive<f32>> = RollDrive::<f32>::configure::<Roll>();
static FIXED: ConfigOf<RollDrive<Fixed>> = RollDrive::<Fixed>::configure::<Roll>();

/// A drive behind a motor that has turned at a speed (rad/s) for 0.2 s, the angle of its last tick and a tick's turn.
fn turning(speed: f64) -> (RollDrive<f32>, u32, u32) {
    let step = (speed / f64::from(Roll::RATE_HZ) / std::f64::consts::TAU * 4_294_967_296.0) as u32;
    let (mut drive, mut angle) = (RollDrive::<f32>::new(&CONFIG, 0), 0_u32);
    for _ in 0..2000 {
        angle = angle.wrapping_add(step);
        drive.tick(&CONFIG, &Sample::si::<Roll>(angle, 0.0, speed as f32));
    }
    (drive, angle, step)
}

/// A board one of whose parts fails.
struct Failing(Faults);
impl Failing {
    fn part(&self, fault: Faults) -> Result<(), Faults> {
        if self.0 == fault { Err(fault) } else { Ok(()) }
    }
}
impl Board<f32> for Failing {
    fn angle(&mut self) -> Result<u32, Faults> {
        self.part(Faults::ANGLE_MISSING).map(|()| 0)
    }
    fn set_torque(&mut self, _: f32, _: u32) -> Result<(), Faults> {
        self.part(Faults::TORQUE_OUTPUT)
    }
    fn set_enabled(&mut self, _: bool) -> Result<(), Faults> {
        self.part(Faults::ENABLE)
    }
}

fn on_board(fault: Faults) -> Faults {
    let mut axis = Axis::<Failing, RollDrive<f32>>::new(Failing(fault), &CONFIG, TRIPPING);
    let begun = axis.start(&CONFIG).err().unwrap_or_default();
    begun | axis.tick(&CONFIG, 0.0).faults
}

#[test]
fn every_flag_is_provoked() {
    let ticked = |angle: fn(u32, u32) -> u32, torque, setpoint| {
        let (mut drive, last, step) = turning(100.0);
        drive.tick(&CONFIG, &Sample::si::<Roll>(angle(last, step), torque, setpoint)).faults
    };
    let next = |last: u32, step: u32| last.wrapping_add(step);
    let lost = || {
        let (mut drive, ..) = turning(100.0);
        (0..1000).map(|_| drive.coast(&CONFIG, 0.0, 100.0).faults).fold(Faults::NONE, |all, one| all | one)
    };
    let beyond = || {
        let (mut drive, mut all) = (RollDrive::<Fixed>::new(&FIXED, 0), Faults::NONE);
        // one and a half times the rated speed, which the base does not hold
        for tick in 0..4000_u32 {
            let angle = tick.wrapping_mul(15_400_000);
            all |= drive.tick(&FIXED, &Sample::si::<Roll>(angle, 0.0, 0.0)).faults;
        }
        all
    };
    assert!(ticked(next, 0.0, 100.0).is_none(), "a sound sample has no flag");
    let provoked = [
        (Faults::TORQUE, ticked(next, f32::NAN, 100.0)),
        (Faults::SETPOINT, ticked(next, 0.0, 1.0e4)),
        (Faults::ANGLE_JUMP, ticked(|last, _| last.wrapping_add(1 << 30), 0.0, 100.0)),
        (Faults::ANGLE_FROZEN, ticked(|last, _| last, 0.0, 100.0)),
        (Faults::ANGLE_LOST, lost()),
        (Faults::RANGE, beyond()),
        (Faults::TICK_MISSED, turning(100.0).0.make_up(&CONFIG, 0.0, 3)),
        (Faults::ANGLE_MISSING, on_board(Faults::ANGLE_MISSING)),
        (Faults::TORQUE_OUTPUT, on_board(Faults::TORQUE_OUTPUT)),
        (Faults::ENABLE, on_board(Faults::ENABLE)),
        (Faults::TRIPPED, on_board(Faults::TORQUE_OUTPUT)),
    ];
    let mut named = BTreeSet::new();
    for (flag, raised) in provoked {
        assert!(raised.contains(flag), "{flag:?} is not in {raised:?}");
        named.extend(Faults::NAMES.into_iter().find(|(one, _)| *one == flag).map(|(_, name)| name.to_owned()));
    }
    // those of a vibration sensor and of the supervision are provoked by their own tests
    let all: BTreeSet<String> = Faults::NAMES.iter().map(|(_, name)| (*name).to_owned()).collect();
    assert_eq!(rows("By flag"), named);
    let elsewhere: BTreeSet<String> = all.difference(&named).cloned().collect();
    assert!(elsewhere.iter().all(|name| PAGE.contains(&format!("`{name}`"))), "{elsewhere:?}");
}
