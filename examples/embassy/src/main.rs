//! A drive in a task of Embassy, on a NUCLEO-G474RE. **It has not run on hardware.**
//!
//! The task runs 10,000 times a second on an executor of its own, in an interrupt above that of the main loop: whatever
//! the main loop awaits, the tick comes first. Encoder: TIM3 on PA6 and PA7. Torque: DAC1 on PA4, half of its range for
//! none. The blue button switches the setpoint.
//!
//! Enable line, brake, watchdog and the board's faults are left out: `doc/makers/boards.md` has them. The drivers may
//! panic.
//! The handler here then stops the core, and the output keeps its last torque: on a machine it must switch the power
//! stage off.
#![no_std]
#![no_main]

use core::sync::atomic::{AtomicU32, Ordering};

use driveline::prelude::*;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_stm32::dac::{DacChannel, Value};
use embassy_stm32::gpio::{Input, Pull};
use embassy_stm32::interrupt::{self, InterruptExt, Priority};
use embassy_stm32::mode::Blocking;
use embassy_stm32::peripherals::TIM3;
use embassy_stm32::rcc::{Pll, PllMul, PllPreDiv, PllRDiv, PllSource, Sysclk};
use embassy_stm32::timer::qei::{self, Qei};
use embassy_stm32::{Config, interrupt as handler};
use embassy_time::{Duration, Ticker, Timer};
use panic_halt as _;

/// Motor, coupling and roll.
struct Roll;
impl Machine for Roll {
    const CHAIN: Chain = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
    const RATING: Rating = Rating { torque: Torque(300.0), speed: Speed(150.0), torque_limit: Torque(550.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 10_000;
}
type RollDrive = Drive<f32, TwoMassObserver, SpeedLoop>;
static CONFIG: ConfigOf<RollDrive> = RollDrive::configure::<Roll>();

/// Counts of the encoder on a turn: four edges of each line.
const COUNTS: u16 = 4 * 2048;

/// Speed setpoint (rad/s), as the bits of an `f32`: the button's task writes it, the drive's reads it.
static SETPOINT: AtomicU32 = AtomicU32::new(0);

static CONTROL: InterruptExecutor = InterruptExecutor::new();

// the interrupt of a peripheral that is not used
#[handler]
unsafe fn UART4() {
    // SAFETY: this interrupt, and no other, is the one that the executor is started with.
    unsafe { CONTROL.on_interrupt() }
}

/// The drive: a tick each time that the ticker expires.
#[embassy_executor::task]
async fn control(encoder: Qei<'static, TIM3>, mut output: DacChannel<'static, Blocking>) {
    // 2^32 to a turn; the timer wraps with the turn
    let angle = || u32::from(encoder.count()) << (32 - COUNTS.trailing_zeros());
    let mut drive = RollDrive::new(&CONFIG, angle());
    let mut torque = 0.0;
    let mut ticker = Ticker::every(Duration::from_hz(Roll::RATE_HZ.into()));
    loop {
        // a tick that is late by a period is followed by the next at once, with an angle that is hardly older
        ticker.next().await;
        let setpoint = f32::from_bits(SETPOINT.load(Ordering::Relaxed));
        let command = drive.tick(&CONFIG, &Sample::si::<Roll>(angle(), torque, setpoint));
        torque = command.torque_si::<Roll>();
        let share = torque / Roll::RATING.torque_limit.0 as f32;
        output.set(Value::Bit12Right((2048.0 + 2047.0 * share) as u16));
    }
}

/// 170 MHz from HSI16: after reset the core runs at 16 MHz, and the executor's instructions come on top of the tick.
fn clock() -> Config {
    let mut config = Config::default();
    config.rcc.pll = Some(Pll {
        source: PllSource::HSI,
        prediv: PllPreDiv::DIV4,
        mul: PllMul::MUL85,
        divp: None,
        divq: None,
        divr: Some(PllRDiv::DIV2),
    });
    config.rcc.sys = Sysclk::PLL1_R;
    // voltage range for more than 150 MHz
    config.rcc.boost = true;
    config
}

/// The main loop: the blue button switches between standstill and a tenth of the rated speed.
#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let p = embassy_stm32::init(clock());
    let encoder = Qei::new(p.TIM3, p.PA6, p.PA7, qei::Config { auto_reload: COUNTS - 1, ..Default::default() });
    let mut output = DacChannel::new_blocking(p.DAC1, p.PA4);
    output.set(Value::Bit12Right(2048));
    interrupt::UART4.set_priority(Priority::P6);
    let spawner = CONTROL.start(interrupt::UART4);
    if let Ok(task) = control(encoder, output) {
        spawner.spawn(task);
    }
    let button = Input::new(p.PC13, Pull::Down);
    let (mut running, mut pressed) = (false, false);
    loop {
        // longer than its contacts bounce
        Timer::after(Duration::from_millis(20)).await;
        let now = button.is_high();
        if now && !pressed {
            running = !running;
            let setpoint = if running { 0.1 * Roll::RATING.speed.0 as f32 } else { 0.0 };
            SETPOINT.store(setpoint.to_bits(), Ordering::Relaxed);
        }
        pressed = now;
    }
}
