//! A drive in a task of RTIC, on a NUCLEO-G474RE. **It has not run on hardware.**
//!
//! The task is the interrupt of TIM6, 10,000 times a second, above everything else; RTIC locks what it shares with the
//! main loop. Encoder: TIM3 on PA6 and PA7. Torque: DAC1 on PA4, half of its range for none. The blue button switches
//! the setpoint. Registers: ST RM0440; names in capitals are its own.
//!
//! Enable line, brake, watchdog and the board's faults are left out: `doc/makers/boards.md` has them.
#![no_std]
#![no_main]

use panic_halt as _;

#[rtic::app(device = stm32_metapac, peripherals = false)]
mod app {
    use driveline::prelude::*;
    use stm32_metapac::gpio::vals::{Moder, Pupdr};
    use stm32_metapac::timer::vals::{CcmrInputCcs, Sms};
    use stm32_metapac::{DAC1, GPIOA, GPIOC, RCC, TIM3, TIM6};

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
    /// Clock after reset, HSI16 (Hz): a tenth of it is enough for the tick.
    const CLOCK_HZ: u32 = 16_000_000;

    #[shared]
    struct Shared {
        /// Speed setpoint (rad/s).
        setpoint: f32,
    }

    #[local]
    struct Local {
        drive: RollDrive,
        /// Torque of the last tick (N m).
        torque: f32,
    }

    #[init]
    fn init(_: init::Context) -> (Shared, Local) {
        RCC.ahb2enr().modify(|r| {
            r.set_gpioaen(true);
            r.set_gpiocen(true);
            r.set_dac1en(true);
        });
        RCC.apb1enr1().modify(|r| {
            r.set_tim3en(true);
            r.set_tim6en(true);
        });
        for pin in [6, 7] {
            GPIOA.afr(0).modify(|r| r.set_afr(pin, 2));
            GPIOA.moder().modify(|r| r.set_moder(pin, Moder::ALTERNATE));
        }
        GPIOC.pupdr().modify(|r| r.set_pupdr(13, Pupdr::PULL_DOWN));
        GPIOC.moder().modify(|r| r.set_moder(13, Moder::INPUT));
        // the direct inputs of both channels, every edge
        TIM3.ccmr_input(0).modify(|r| {
            r.set_ccs(0, CcmrInputCcs::TI4);
            r.set_ccs(1, CcmrInputCcs::TI4);
        });
        TIM3.smcr().modify(|r| r.set_sms(Sms::ENCODER_MODE_3));
        TIM3.arr().write(|r| r.set_arr(COUNTS - 1));
        TIM3.cr1().modify(|r| r.set_cen(true));
        put(0.0);
        DAC1.cr().modify(|r| r.set_en(0, true));
        TIM6.arr().write(|r| r.set_arr((CLOCK_HZ / Roll::RATE_HZ - 1) as u16));
        TIM6.dier().modify(|r| r.set_uie(true));
        TIM6.cr1().modify(|r| r.set_cen(true));
        (Shared { setpoint: 0.0 }, Local { drive: RollDrive::new(&CONFIG, angle()), torque: 0.0 })
    }

    /// Angle of the motor, 2^32 to a turn; the timer wraps with the turn.
    fn angle() -> u32 {
        u32::from(TIM3.cnt().read().cnt()) << (32 - COUNTS.trailing_zeros())
    }

    /// Gives a torque (N m).
    fn put(torque: f32) {
        let share = torque / Roll::RATING.torque_limit.0 as f32;
        DAC1.dhr12r(0).write(|r| r.set_dhr((2048.0 + 2047.0 * share) as u16));
    }

    /// The drive: a tick.
    #[task(binds = TIM6_DAC, priority = 2, shared = [setpoint], local = [drive, torque])]
    fn control(mut context: control::Context) {
        TIM6.sr().write(|r| r.set_uif(false));
        let setpoint = context.shared.setpoint.lock(|setpoint| *setpoint);
        let control::LocalResources { drive, torque, .. } = context.local;
        let command = drive.tick(&CONFIG, &Sample::si::<Roll>(angle(), *torque, setpoint));
        *torque = command.torque_si::<Roll>();
        put(*torque);
    }

    /// The main loop: the blue button switches between standstill and a tenth of the rated speed.
    #[idle(shared = [setpoint])]
    fn idle(mut context: idle::Context) -> ! {
        let (mut running, mut pressed) = (false, false);
        loop {
            // longer than its contacts bounce
            cortex_m::asm::delay(CLOCK_HZ / 50);
            let now = GPIOC.idr().read().idr(13) == stm32_metapac::gpio::vals::Idr::HIGH;
            if now && !pressed {
                running = !running;
                context.shared.setpoint.lock(|setpoint| {
                    *setpoint = if running { 0.1 * Roll::RATING.speed.0 as f32 } else { 0.0 };
                });
            }
            pressed = now;
        }
    }
}
