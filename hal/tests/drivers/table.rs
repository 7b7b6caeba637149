//! `doc/adapters.md`: every fault of every adapter with what the drive does, from runs of an axis on mocked buses.
//!
//! The test compares; `DRIVELINE_WRITE=1 cargo test -p driveline-hal --test drivers table` writes the file anew.

use std::cell::{Cell, RefCell};
use std::fmt::Write as _;
use std::rc::Rc;

use driveline::axis::{AngleSensor, Enabling, TRIPPING, TorqueOutput, VibrationSensor};
use driveline::fault::Faults;
use driveline::settings::{Teeth, ToothClock};
use driveline::wheel::{ToothedWheel, ToothedWheelConfig};
use driveline_hal::{
    AdcVibration, Adxl355, Along, AwaitedAngle, AwaitedTorque, Chip, Dac, EnableChain, EnableLine, FullScale,
    MagneticEncoder, PerCount, PhaseConfig, PwmTorque, Quadrature, Range, SpiDac, ThreePhase, Tmc4671, TripLine,
};
use embedded_hal_mock::eh1::digital::{Mock as Pin, State, Transaction as Level};
use embedded_hal_mock::eh1::pwm::{Mock as Pwm, Transaction as Duty};

use super::angle::{Counts, Frames, Wrong};
use super::bus::{Expected, FAILED};
use super::chips::{self, Wired, awaited, polled};
use super::scripted::{CAUGHT, CONFIG, Scripted, WANTED, Whole, governing, turned};
use super::vibration;

/// 60-2, on a clock of 1 MHz.
const WHEEL: ToothedWheelConfig<58> =
    ToothedWheelConfig::new(&Teeth::gap(60, 2), ToothClock { turns: 1, clock: 1e6, lowest_speed: 1.0 });

/// The tick whose angle is the first that is wrong.
const AT: u64 = 2 * CAUGHT + 50;
/// Ticks of a run.
const END: u64 = AT + 600;

const HEADER: &str = "\
# Every fault of every adapter, and what the drive does

Written by a test (`hal/tests/drivers/table.rs`) from runs on mocked buses, and checked by it. The
drive is the hoist's, in `f32` at 10,000 ticks a second, on an axis that trips as a rule does (`axis::TRIPPING`); the
motor turns at 30 rad/s when the fault comes. An adapter is a driver of `driveline-hal`, or the library's
`ToothedWheel`.

The drivers on SPI do the same where they are awaited (feature `async`): whichever transaction fails, both forms
give the same and send the same (`hal/tests/drivers/awaited.rs`). A future may be dropped at any
point. What was dropped is the fault of the rows that say so.

| adapter | fault | flags in that tick | torque in that tick | if it was one tick | if it stays |
|---|---|---|---|---|---|
";

struct Table(String);

impl Table {
    fn row(&mut self, cells: [&str; 6]) {
        writeln!(self.0, "| {} |", cells.join(" | ")).unwrap();
    }
}

/// What an axis did from the fault on.
struct Ran {
    flags: Faults,
    torque: f32,
    /// Ticks from the fault until flags are none again.
    again: Option<u64>,
    /// Ticks from the fault until it tripped.
    tripped: Option<u64>,
}

fn run(mut axis: Whole<Scripted>) -> Ran {
    let mut ran = Ran { flags: Faults::NONE, torque: 0.0, again: None, tripped: None };
    while axis.board().tick < END {
        let tick = axis.board().tick;
        let command = axis.tick(CONFIG, WANTED);
        if tick < AT {
            assert_eq!(command.faults, Faults::NONE, "tick {tick}");
        } else if ran.flags.is_none() {
            (ran.flags, ran.torque) = (command.faults, command.torque);
            ran.tripped = command.faults.contains(Faults::TRIPPED).then_some(tick - AT);
        } else {
            if command.faults.is_none() && ran.again.is_none() {
                ran.again = Some(tick - AT);
            }
            if command.faults.contains(Faults::TRIPPED) && ran.tripped.is_none() {
                ran.tripped = Some(tick - AT);
            }
        }
    }
    ran
}

fn torque_cell(torque: f32) -> &'static str {
    if torque == 0.0 { "none" } else { "goes on, by prediction" }
}

fn once_cell(ran: &Ran) -> String {
    match (ran.tripped, ran.again) {
        (Some(after), _) => trip_cell(after),
        (None, Some(1)) => "the next tick is sound".into(),
        (None, Some(after)) => format!("sound after {after} ticks"),
        (None, None) => "never sound again".into(),
    }
}

fn trip_cell(after: u64) -> String {
    let ms = after as f64 / 10.0;
    match after {
        0 => "trips at once".into(),
        1 => format!("trips after a tick, {ms} ms"),
        _ => format!("trips after {after} ticks, {ms} ms"),
    }
}

fn stays_cell(ran: &Ran) -> String {
    ran.tripped.map_or_else(|| "never trips".into(), trip_cell)
}

/// An axis whose angles come from a sensor.
fn with_angle(mut sensor: impl AngleSensor + 'static) -> Whole<Scripted> {
    let mut board = Scripted::sound();
    board.angle = Box::new(move |_| sensor.angle());
    governing(board)
}

fn angle_row(table: &mut Table, adapter: &str, fault: &str, axis: impl Fn(&dyn Fn(u64) -> bool) -> Whole<Scripted>) {
    let once = run(axis(&|tick| tick == AT));
    let stays = run(axis(&|tick| tick >= AT));
    assert_eq!((stays.flags, stays.torque), (once.flags, once.torque), "{adapter} {fault}");
    assert!(once.flags.contains(Faults::ANGLE_MISSING), "{adapter} {fault}: {}", once.flags);
    let flags = once.flags.to_string();
    table.row([adapter, fault, &flags, torque_cell(once.torque), &once_cell(&once), &stays_cell(&stays)]);
}

fn quadrature(table: &mut Table) {
    angle_row(table, "Quadrature", "the timer gives no count", |wrong| {
        let counts: Vec<_> = (0..END).map(|tick| (!wrong(tick)).then_some(turned(tick) >> 16)).collect();
        with_angle(Quadrature::new(Counts(counts.into_iter()), 1 << 16, 16))
    });
    angle_row(table, "Quadrature", "the index shows that lines were lost", |wrong| {
        let counts: Vec<_> = (0..END).map(|tick| Some(turned(tick) >> 16)).collect();
        let wrong: Vec<_> = (0..END).map(wrong).collect();
        let mut encoder = Quadrature::new(Counts(counts.into_iter()), 1 << 16, 16);
        let mut board = Scripted::sound();
        board.angle = Box::new(move |tick| {
            // the index at a place of its own each time that it is wrong, and never else
            if wrong[tick as usize] {
                encoder.index((turned(AT) >> 16) + 1000 * (tick % 7) as u32);
                encoder.index((turned(AT) >> 16) + 1000 * (tick % 7) as u32 + 500);
            }
            encoder.angle()
        });
        governing(board)
    });
}

fn magnetic(table: &mut Table) {
    for (wrong, fault) in [
        (Wrong::Bus, "the bus fails"),
        (Wrong::Parity, "wrong parity"),
        (Wrong::ErrorBit, "error bit"),
        (Wrong::Magnet, "field too weak"),
        (Wrong::Low, "line stuck low"),
        (Wrong::High, "line stuck high"),
    ] {
        angle_row(table, "MagneticEncoder", fault, |is_wrong| {
            let mut frames = Frames::default();
            for tick in 0..END {
                let counts = (turned(tick) >> 18) as u16;
                if is_wrong(tick) { frames.wrong(counts, wrong) } else { frames.good(counts) }
            }
            with_angle(MagneticEncoder::new(frames.expected.bus(), Chip::As5047P))
        });
    }
}

fn awaited_angle(table: &mut Table) {
    angle_row(table, "AwaitedAngle", "it did not come before the tick", |wrong| {
        let late: Vec<_> = (0..END).map(wrong).collect();
        let mut angle = AwaitedAngle::new();
        let mut board = Scripted::sound();
        board.angle = Box::new(move |tick| {
            let fetched = angle.fetch(async { (chips::pause().await, Ok(turned(tick))).1 });
            let _ = polled(fetched, if late[tick as usize] { 1 } else { 2 });
            angle.angle()
        });
        governing(board)
    });
}

/// A wheel of 60-2 on the motor, its teeth at the times at which the motor passes them, those of `lost` left out and
/// those of `more` added.
fn on_wheel(lost: impl Fn(u32) -> bool, more: Option<f64>) -> (Ran, Vec<Faults>) {
    // a tick is 100 counts
    let turn = std::f64::consts::TAU / super::scripted::SPEED * 1e6;
    let mut teeth: Vec<_> = (0..60_u32 * 12)
        .filter(|&place| place % 60 < 58 && !lost(place))
        .map(|place| (f64::from(place) / 60.0 * turn) as u32)
        .chain(more.map(|place| (place / 60.0 * turn) as u32))
        .collect();
    teeth.sort_unstable();
    let mut teeth = teeth.into_iter().peekable();
    let mut wheel = ToothedWheel::<()>::default();
    let mut board = Scripted::sound();
    board.angle = Box::new(move |tick| {
        let now = tick as u32 * 100;
        while let Some(time) = teeth.next_if(|&time| time <= now) {
            wheel.tooth(&WHEEL, time);
        }
        (&mut wheel, &WHEEL, now).angle()
    });
    let mut axis = Whole::new(board, CONFIG, TRIPPING);
    // two turns until the place is known, and half a turn to govern
    while axis.board().tick < 2 * 2095 + 600 {
        axis.tick(CONFIG, WANTED);
    }
    axis.start(CONFIG).unwrap();
    let mut ran = Ran { flags: Faults::NONE, torque: 0.0, again: None, tripped: None };
    let (mut first, mut in_turn) = (0, Vec::new());
    while axis.board().tick < 10 * 2095 {
        let tick = axis.board().tick;
        let command = axis.tick(CONFIG, WANTED);
        if ran.flags.is_none() {
            (ran.flags, ran.torque, first) = (command.faults, command.torque, tick);
        } else if command.faults.contains(Faults::TRIPPED) && ran.tripped.is_none() {
            ran.tripped = Some(tick - first);
        } else if command.faults.is_none() && ran.again.is_none() {
            ran.again = Some(tick - first);
        }
        if ran.tripped.is_none() && !command.faults.is_none() && in_turn.last() != Some(&command.faults) {
            in_turn.push(command.faults);
        }
    }
    (ran, in_turn)
}

fn wheel(table: &mut Table) {
    assert!(on_wheel(|_| false, None).1.is_empty());
    // An edge too many is left out.
    assert!(on_wheel(|_| false, Some(190.4)).1.is_empty());
    for (fault, (ran, in_turn)) in [
        ("a tooth too few", on_wheel(|place| place == 190, None)),
        ("the teeth stay away", on_wheel(|place| place >= 190, None)),
    ] {
        let flags: Vec<_> = in_turn.iter().map(|faults| faults.to_string()).collect();
        let flags = flags.join("; then ");
        assert!(in_turn.iter().any(|faults| faults.contains(Faults::ANGLE_MISSING)), "{fault}: {flags}");
        let once = if fault == "the teeth stay away" { "-".into() } else { once_cell(&ran) };
        table.row(["ToothedWheel", fault, &flags, torque_cell(ran.torque), &once, &stays_cell(&ran)]);
    }
}

/// A run in which `output` takes the torque, from the tick of the fault on; what it had before is what the drive gave
/// without it.
fn with_torque(mut output: impl TorqueOutput<f32> + 'static) -> Ran {
    let mut board = Scripted::sound();
    let tick = Rc::new(Cell::new(0));
    let now = tick.clone();
    board.angle = Box::new(move |tick| {
        now.set(tick);
        Ok(turned(tick))
    });
    board.torque = Box::new(move |torque| if tick.get() < AT { Ok(()) } else { output.set_torque(torque, 0) });
    run(governing(board))
}

const FULL: FullScale<f32> = FullScale::<f32>::new(1e9);

/// A torque whose way out is dropped after its first poll, once.
#[derive(Default)]
struct Late {
    torque: AwaitedTorque<f32>,
    again: bool,
}

impl TorqueOutput<f32> for Late {
    fn set_torque(&mut self, torque: f32, angle: u32) -> Result<(), Faults> {
        let set = self.torque.set_torque(torque, angle);
        let _ = polled(self.torque.give(async |_| (chips::pause().await, Ok(())).1), if self.again { 2 } else { 1 });
        self.again = true;
        set
    }
}

fn torque_row(table: &mut Table, adapter: &str, fault: &str, ran: &Ran) {
    let flags = ran.flags.to_string();
    assert!(ran.flags.contains(Faults::TORQUE_OUTPUT | Faults::TRIPPED) && ran.torque == 0.0, "{adapter}: {flags}");
    table.row([adapter, fault, &flags, torque_cell(ran.torque), &stays_cell(ran), &stays_cell(ran)]);
}

/// Full scale is far above any torque here, so that every duty is half, every code the middle and every target zero:
/// one that fails, then those of the trip.
fn torque(table: &mut Table) {
    let duty = || Duty::set_duty_cycle(500);
    let most = || Duty::max_duty_cycle(1000);
    let failing = Pwm::new(&[most(), duty().with_error(FAILED), duty(), most(), duty()]);
    torque_row(table, "PwmTorque", "the channel fails", &with_torque(PwmTorque::new(failing.clone(), FULL)));
    let sound = [most(), duty(), most(), duty(), most(), duty()];
    let failing_phase = [most(), duty().with_error(FAILED), most(), duty(), most(), duty()];
    let config = PhaseConfig { full_scale: FULL, pole_pairs: 4, zero: 0 };
    let phases = [Pwm::new(&sound), Pwm::new(&failing_phase), Pwm::new(&sound)];
    let [a, b, c] = phases.clone();
    torque_row(table, "ThreePhase", "one of the channels fails", &with_torque(ThreePhase::new((a, b, c), config)));
    phases.into_iter().chain([failing]).for_each(|mut channel| channel.done());
    let mut expected = Expected::default();
    expected.failure();
    expected.write(&[0, 0x80, 0]);
    expected.write(&[0, 0x80, 0]);
    let dac = SpiDac::new(expected.bus(), Dac::Ad5662, FULL);
    torque_row(table, "SpiDac", "the bus fails", &with_torque(dac));
    for (fault, read_back) in [("the bus fails", None), ("reads back another target", Some([0, 0, 9, 0, 0]))] {
        let mut expected = Expected::default();
        expected.write(&[0xe4, 0, 0, 0, 0]);
        match read_back {
            None => expected.failure(),
            Some(answer) => expected.exchange(&[0x64, 0, 0, 0, 0], &answer),
        }
        for _ in 0..2 {
            expected.write(&[0xe4, 0, 0, 0, 0]);
            expected.exchange(&[0x64, 0, 0, 0, 0], &[0; 5]);
        }
        torque_row(table, "Tmc4671", fault, &with_torque(Tmc4671::new(expected.bus(), FULL)));
    }
    torque_row(table, "AwaitedTorque", "it did not arrive before the next tick", &with_torque(Late::default()));
    // a torque that is no number never comes from a drive; an output is asked here all the same
    let mut output = PwmTorque::new(Pwm::new(&[most(), duty()]), FULL);
    assert_eq!(output.set_torque(f32::NAN, 0), Err(Faults::TORQUE_OUTPUT));
    table.row([
        "any torque output",
        "a torque that is no number",
        "torque output",
        "none",
        "trips at once",
        "trips at once",
    ]);
    output.release().done();
}

/// A board whose enable chain is of two mocked pins.
fn enable(table: &mut Table) {
    let set = Level::set;
    let (on, off) = (State::High, State::Low);
    let mut pins = Vec::new();
    let mut axis = |first: &[Level], second: &[Level]| {
        let (first, second) = (Pin::new(first), Pin::new(second));
        pins.extend([first.clone(), second.clone()]);
        let mut chain = EnableChain::new([EnableLine::high(first), EnableLine::high(second)]);
        let mut board = Scripted::sound();
        board.enable = Box::new(move |enabled| chain.set_enabled(enabled));
        let mut axis = Whole::new(board, CONFIG, TRIPPING);
        for _ in 0..CAUGHT {
            axis.tick(CONFIG, WANTED);
        }
        axis
    };
    let mut refused =
        axis(&[set(off), set(on), set(off), set(off)], &[set(off), set(on).with_error(FAILED), set(off), set(off)]);
    assert_eq!(refused.start(CONFIG), Err(Faults::ENABLE));
    let command = refused.tick(CONFIG, WANTED);
    assert!(!refused.is_enabled() && command.torque == 0.0 && command.faults == Faults::TRIPPED);
    let flags = format!("{} from the start", Faults::ENABLE);
    table.row(["EnableChain", "a line does not go on", &flags, "none", "stays off; all lines off", "stays off"]);
    let mut stuck =
        axis(&[set(off), set(on), set(off), set(off)], &[set(off), set(on), set(off).with_error(FAILED), set(off)]);
    stuck.start(CONFIG).unwrap();
    stuck.trip();
    let command = stuck.tick(CONFIG, WANTED);
    assert!(command.faults == Faults::TRIPPED && command.torque == 0.0, "{}", command.faults);
    // the same, and the line obeys never
    // off once at first, and then at the trip and in each of forty ticks
    let failing: Vec<_> = [set(off), set(on)].into_iter().chain((0..41).map(|_| set(off).with_error(FAILED))).collect();
    let others: Vec<_> = [set(off), set(on)].into_iter().chain((0..41).map(|_| set(off))).collect();
    let mut stuck = axis(&others, &failing);
    stuck.start(CONFIG).unwrap();
    stuck.trip();
    for _ in 0..40 {
        let command = stuck.tick(CONFIG, WANTED);
        assert!(command.torque == 0.0 && command.faults == Faults::TRIPPED | Faults::ENABLE);
    }
    pins.into_iter().for_each(|mut pin| pin.done());
    let flags = (Faults::TRIPPED | Faults::ENABLE).to_string();
    let stays = "asked again in every tick";
    table.row([
        "EnableChain",
        "a line does not go off",
        &flags,
        "none",
        "asked again in the next tick; all others off",
        stays,
    ]);
    let mut trip =
        TripLine::new(EnableLine::high(Pin::new(&[set(off), set(on).with_error(FAILED), set(off)]))).unwrap();
    assert_eq!(trip.set_enabled(true), Err(Faults::ENABLE));
    let flags = format!("{} from the start", Faults::ENABLE);
    table.row(["Trip", "the pin does not go on", &flags, "none", "stays off; the pin off", "stays off"]);
    trip.release().release().done();
}

fn vibration_rows(table: &mut Table) {
    let mut row = |adapter: &str, fault: &str, sample: Result<Option<f32>, Faults>| {
        let mut axis = governing(Scripted::sound());
        let faults = axis.vibration(CONFIG, sample.map(|sample| sample.map(|_| ())));
        let expected = if fault.contains("clipped") { Faults::VIBRATION_CLIPPED } else { Faults::VIBRATION_MISSING };
        assert_eq!(faults, expected);
        assert_eq!(axis.tick(CONFIG, WANTED).faults, Faults::NONE);
        let doubted = "the reading is doubted, and says why";
        table.row([adapter, fault, &faults.to_string(), "goes on", doubted, doubted]);
    };
    let one = |make: &dyn Fn(&mut Expected)| {
        let mut expected = Expected::default();
        vibration::started(&mut expected);
        make(&mut expected);
        vibration::sensor(expected)
    };
    row("Adxl355", "the bus fails", one(&|expected| expected.failure()).vibration());
    row("Adxl355", "clipped", one(&|expected| vibration::burst(expected, 1, (1 << 19) - 1)).vibration());
    row("Adxl355", "trimming lost, or a line stuck high", one(&|e| vibration::burst(e, 0x11, 0)).vibration());
    let mut waiting = one(&|expected| (0..4).for_each(|_| vibration::burst(expected, 0, 0)));
    (0..3).for_each(|_| assert_eq!(waiting.vibration(), Ok(None)));
    row("Adxl355", "no new sample for three polls, or a line stuck low", waiting.vibration());
    let chip = Wired::new(chips::Adxl355 { z: 0, ready: true }, None);
    let dropped = Adxl355::start(chip, Along::Z, Range::G2, PerCount::<f32>::new(1.0), 3);
    let mut dropped = dropped.map_err(|(faults, _)| faults).unwrap();
    assert_eq!(polled(dropped.vibration_async(), 2), None);
    row("Adxl355", "the last read was dropped while it was awaited", awaited(dropped.vibration_async()));
    let mut adc = AdcVibration::new(2048, 4095, PerCount::<f32>::new(0.01));
    adc.mean(&[2048], 1).unwrap();
    row("AdcVibration", "no new transfer", adc.mean(&[2048], 1).map(Some));
    row("AdcVibration", "clipped, or a wire broken", adc.mean(&[4095], 2).map(Some));
    row("AdcVibration", "no conversion", adc.mean(&[], 3).map(Some));
}

#[test]
fn the_table_is_what_the_runs_give() {
    let table = RefCell::new(Table(HEADER.into()));
    for rows in [quadrature, magnetic, awaited_angle, wheel, torque, enable, vibration_rows] {
        rows(&mut table.borrow_mut());
    }
    let written = table.into_inner().0;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../doc/adapters.md");
    if std::env::var_os("DRIVELINE_WRITE").is_some() {
        std::fs::write(path, &written).unwrap();
    }
    let kept = std::fs::read_to_string(path).unwrap_or_default();
    assert!(kept == written, "doc/adapters.md is not what the runs give now:\n{written}");
}
