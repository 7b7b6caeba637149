#![no_std]
#![no_main]
//! The test rig on a NUCLEO-G474RE, a drive with all four parts: the control loop in the timer's interrupt, balancing,
//! the fluctuation's figures and telemetry in the main loop.
//!
//! The blue button stops the drive when it is touched. It starts it when it was pressed and let go, if the terminal has
//! permitted that ([`Operator`]). `cargo driveline watch` shows the telemetry; requests come as frames of [`Asking`].
//! See `doc/makers/boards.md`.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use core::sync::atomic::{AtomicU32, Ordering, compiler_fence};

use cortex_m::Peripherals;
use cortex_m::interrupt::free;
use cortex_m::peripheral::{DWT, NVIC};
use cortex_m_rt::entry;
use driveline::configure::Machine;
use driveline::number::Number;
use driveline::telemetry::{Channel as Column, Kind, Ring};
use driveline_firmware::board::nucleo_g474re::{
    Beside, Channel, Nucleo, Pin, Serial, Vibration, full_scale, start_tick, tick_taken,
};
use driveline_firmware::control_loop::main_loop_watch::Attended;
use driveline_firmware::control_loop::step::{Asked, Turn};
use driveline_firmware::control_loop::telemetry;
use driveline_firmware::panel::axis_panel::{AxisPanel, BetweenTicks};
use driveline_firmware::panel::operator::Operator;
use driveline_firmware::panel::serial_request::{self, Asking, RELEASE, Request, SEQUENCE, SPEED, Sequence, TIMEOUT};
use driveline_firmware::scene::panel_keys::{DONE, refused};
use driveline_firmware::scene::{Constants, Variant};
use driveline_firmware::scenes::test_rig::{self, Adviser, TestRig};
use driveline_hal::{FullScale, PwmTorque};
use stm32_metapac::{Interrupt, interrupt};

driveline_firmware::selected!("test-rig/f32/whole/10000");

/// State owned by the interrupt.
struct Control {
    scene: <Selected as Variant>::Scene,
    turn: Turn<Nucleo<PwmTorque<Channel<0>, f32>>, f32>,
    vibration: Vibration,
    attended: Attended,
    button: Pin,
    operator: Operator,
    /// Ticks until the next record.
    left: u32,
    /// Most cycles of a tick since the reset.
    worst: u32,
}

/// Uninitialised until the interrupt is unmasked.
struct Owned(UnsafeCell<MaybeUninit<Control>>);

// SAFETY: the interrupt alone uses it, and the main loop while interrupts are off.
unsafe impl Sync for Owned {}

static CONTROL: Owned = Owned(UnsafeCell::new(MaybeUninit::uninit()));

/// Values of a record: those of a scene, the two velocities, the last answer and its request's number, the last turn's
/// fluctuation, the last reset, the longest tick.
const VALUES: usize = telemetry::VALUES + 9;
/// Ticks between two records: a thousand of 81 bytes a second, seven eighths of what the port takes.
const TICKS: u32 = 10;
/// Records between two descriptions of the channels.
const DESCRIBED: u32 = 1_000;

static RECORDS: Ring<VALUES, 32> = Ring::new();
/// Turns of the main loop.
static TURNS: AtomicU32 = AtomicU32::new(0);
static REFERENCE: AtomicU32 = AtomicU32::new((test_rig::SPEED as f32).to_bits());
/// The last answer, and the number of its request.
static ANSWER: [AtomicU32; 2] = [const { AtomicU32::new(0) }; 2];
/// Why the board was reset last.
static RESET: AtomicU32 = AtomicU32::new(0);
/// Mean speed, delta of motor and load in the last turn that was finished.
static LAST_TURN: [AtomicU32; 3] = [const { AtomicU32::new(0) }; 3];

const COLUMNS: [Column<'static>; VALUES] = {
    let [a, b, c, d, e, f, g, h] = telemetry::channels::<Selected>();
    let first = Column { name: "vibration 1", unit: "m/s", kind: Kind::Single };
    let second = Column { name: "vibration 2", unit: "m/s", kind: Kind::Single };
    let [answer, request, reset] = [Column { name: "answer", unit: "", kind: Kind::Integer(1.0) }; 3];
    let mean = Column { name: "mean speed", unit: "rad/s", kind: Kind::Single };
    let motor = Column { name: "delta of motor", unit: "", kind: Kind::Single };
    let load = Column { name: "delta of load", unit: "", kind: Kind::Single };
    let request = Column { name: "request", ..request };
    let reset = Column { name: "last reset", ..reset };
    let worst = Column { name: "longest tick", unit: "cycles", kind: Kind::Integer(1.0) };
    [a, b, c, d, e, f, g, h, first, second, answer, mean, motor, load, request, reset, worst]
};

/// A tick.
#[interrupt]
fn TIM6_DAC() {
    tick_taken();
    // SAFETY: it was initialised before the interrupt was unmasked; the main loop uses it with interrupts off, and
    // nothing else does.
    let Control { scene, turn, vibration, attended, button, operator, left, worst } =
        unsafe { (*CONTROL.0.get()).assume_init_mut() };
    if !attended.check(TURNS.load(Ordering::Relaxed)) {
        // until it is started again: not by a main loop that comes back
        operator.stop();
    }
    let asked =
        Asked { released: operator.tick(button.is_high()), speed: f32::from_bits(REFERENCE.load(Ordering::Relaxed)) };
    let (input, output) = turn.run(asked, vibration.read(), |input, output| {
        let before = DWT::cycle_count();
        driveline_tick(scene, input, output);
        *worst = (*worst).max(DWT::cycle_count().wrapping_sub(before));
    });
    *left = left.wrapping_sub(1);
    if *left == 0 {
        *left = TICKS;
        let [a, b, c, d, e, f, g, h] = telemetry::values(&input, &output);
        let [first, second] = input.vibration;
        let [answer, request] = ANSWER.each_ref().map(|value| value.load(Ordering::Relaxed));
        let reset = RESET.load(Ordering::Relaxed);
        let [mean, motor, load] = LAST_TURN.each_ref().map(|value| value.load(Ordering::Relaxed));
        RECORDS.record(&[a, b, c, d, e, f, g, h, first, second, answer, mean, motor, load, request, reset, *worst]);
    }
}

#[entry]
fn main() -> ! {
    let full_scale = const { FullScale::<f32>::new(full_scale(TestRig::RATING.torque_limit.0)) };
    let (nucleo, Beside { vibration, serial, button, reset }) = Nucleo::torque_input(test_rig::COUNTS, full_scale);
    let control = Control {
        scene: Selected::start(),
        turn: Turn::new(nucleo),
        vibration,
        attended: Attended::default(),
        operator: Operator::new(button.is_high()),
        button,
        left: TICKS,
        worst: 0,
    };
    RESET.store(reset, Ordering::Relaxed);
    // SAFETY: nothing else in the image uses these registers of the core.
    let mut core = unsafe { Peripherals::steal() };
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    // SAFETY: the interrupt is masked.
    unsafe { (*CONTROL.0.get()).write(control) };
    start_tick(Selected::RATE_HZ);
    // it is in the memory before the interrupt may come: the registers are volatile, it is not
    compiler_fence(Ordering::Release);
    // SAFETY: the interrupt's state is initialised.
    unsafe { NVIC::unmask(Interrupt::TIM6_DAC) };

    let mut desk =
        Desk { serial, asking: Asking::default(), sequence: Sequence::default(), panel: AxisPanel::default() };
    let mut told = DESCRIBED;
    loop {
        TURNS.store(TURNS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
        desk.serve();
        desk.balance();
        desk.note_turn();
        if told >= DESCRIBED {
            told = 0;
            let Ok(()) = Column::send(&COLUMNS, &mut desk.serial);
        }
        let Ok(sent) = RECORDS.send(&mut desk.serial);
        told = told.saturating_add(sent);
    }
}

/// Answers: a time-out beyond the longest, a speed beyond its limit, requests before this one are missing.
const NO_TIMEOUT: u32 = refused(0);
const NO_SPEED: u32 = refused(97);
const REQUEST_MISSING: u32 = refused(98);

/// Tasks of the main loop: the terminal, the balancing and the fluctuation.
struct Desk {
    serial: Serial,
    asking: Asking,
    sequence: Sequence,
    panel: AxisPanel<TestRig, Adviser>,
}

impl Desk {
    /// Answers the requests that have arrived.
    fn serve(&mut self) {
        while let Some(byte) = self.serial.receive() {
            if let Some(request) = self.asking.take(byte) {
                let answer = match self.sequence.turn(&request) {
                    serial_request::Turn::Next => self.answer(&request),
                    serial_request::Turn::Repeated => continue,
                    serial_request::Turn::Missing => REQUEST_MISSING,
                };
                with_operator(|operator| operator.answered(answer));
                // no record has one request's number beside another's answer
                free(|_| {
                    for (kept, value) in ANSWER.iter().zip([answer, request.number.into()]) {
                        kept.store(value, Ordering::Relaxed);
                    }
                });
            }
        }
    }

    fn answer(&mut self, &Request { key, value, .. }: &Request) -> u32 {
        match (key, value) {
            (SEQUENCE, _) => DONE,
            (RELEASE, 1) => {
                with_operator(Operator::permit);
                DONE
            }
            (RELEASE, _) => {
                with_operator(Operator::stop);
                DONE
            }
            (TIMEOUT, ms) if with_operator(|operator| operator.set_timeout(ms)) => DONE,
            (TIMEOUT, _) => NO_TIMEOUT,
            (SPEED, _) if f32::from_bits(value).exceeds(<Selected as Constants>::CONFIG.limits.setpoint) => NO_SPEED,
            (SPEED, _) => {
                REFERENCE.store(value, Ordering::Relaxed);
                DONE
            }
            _ => self.panel.ask(<Selected as Constants>::CONFIG, &mut Interrupted, [key, value]),
        }
    }

    /// Balances by the head, where that is on.
    fn balance(&mut self) {
        self.panel.balance(<Selected as Constants>::CONFIG, &mut Interrupted);
    }

    /// Puts the fluctuation of a turn that was finished into the records.
    fn note_turn(&mut self) {
        if let Some(turn) = self.panel.new_turn(<Selected as Constants>::CONFIG, &mut Interrupted) {
            // no record has one turn's mean beside another's delta
            free(|_| {
                for (kept, value) in LAST_TURN.iter().zip(turn) {
                    kept.store(value.to_bits(), Ordering::Relaxed);
                }
            });
        }
    }
}

/// Does something with the interrupt's state between two ticks.
fn with_control<T>(action: impl FnOnce(&mut Control) -> T) -> T {
    free(|_| {
        // SAFETY: interrupts are off, and `main` has initialised it before there was anything to answer.
        action(unsafe { (*CONTROL.0.get()).assume_init_mut() })
    })
}

fn with_operator<T>(action: impl FnOnce(&mut Operator) -> T) -> T {
    with_control(|control| action(&mut control.operator))
}

/// The scene of the interrupt, once that is unmasked.
struct Interrupted;

impl BetweenTicks<<Selected as Variant>::Scene> for Interrupted {
    fn between_ticks<T>(&mut self, action: impl FnOnce(&mut <Selected as Variant>::Scene) -> T) -> T {
        with_control(|control| action(&mut control.scene))
    }
}
