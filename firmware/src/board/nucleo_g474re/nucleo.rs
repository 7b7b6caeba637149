//! The board: angle in, torque out, the power stage on and off.

use driveline::axis::{Board, Enabling, TorqueOutput};
use driveline::fault::Faults;
use driveline_hal::{EnableChain, EnableLine, FullScale, PhaseConfig, PwmTorque, Quadrature, ThreePhase};
use stm32_metapac::{FLASH, PWR, RCC, TAMP};

use super::bridge::{self, Channel, Outputs};
use super::encoder::Timer2;
use super::pin::Pin;
use super::reset::word;
use super::serial::Serial;
use super::tick::tick_is_due;
use super::vibration::Vibration;
use super::watchdog::Watchdog;
use super::{clock, encoder};

/// An encoder, a torque output on TIM1, its outputs and a line that enables the drive.
pub struct Nucleo<T> {
    encoder: Quadrature<Timer2>,
    torque: T,
    /// On from the first to the last, off from the last to the first: the drive is enabled once it is given no torque.
    chain: (Outputs, EnableChain<Pin, 1>),
    enabled: bool,
    watchdog: Watchdog,
}

/// Parts beside the motor.
pub struct Beside {
    /// Two velocity sensors.
    pub vibration: Vibration,
    /// The terminal.
    pub serial: Serial,
    /// The blue button, with a resistor of its own.
    pub button: Pin,
    /// Why the board was reset last: [`word`].
    pub reset: u32,
}

impl Nucleo<PwmTorque<Channel<0>, f32>> {
    /// A drive that controls its current. Its torque input is the difference of PA8 and PA7, each behind a low-pass:
    /// switched off both are low, and the difference is no torque.
    pub fn torque_input(counts_per_turn: u32, full_scale: FullScale<f32>) -> (Self, Beside) {
        Self::with(counts_per_turn, false, PwmTorque::new(Channel, full_scale))
    }
}

impl Nucleo<ThreePhase<Channel<0>, Channel<1>, Channel<2>, f32>> {
    /// The bridge of a small synchronous motor.
    pub fn three_phase(counts_per_turn: u32, config: PhaseConfig<f32>) -> (Self, Beside) {
        Self::with(counts_per_turn, true, ThreePhase::new((Channel, Channel, Channel), config))
    }
}

impl<T> Nucleo<T> {
    /// Starts the clock, every peripheral, one phase or all three, and the watchdog; the outputs stay off.
    #[inline(always)]
    fn with(counts_per_turn: u32, three: bool, torque: T) -> (Self, Beside) {
        clock::start();
        let drive_enable = Pin::output('C', 10);
        bridge::start(three);
        encoder::start();
        let beside = Beside {
            vibration: Vibration::start(),
            serial: Serial::start(),
            button: Pin::input('C', 13),
            reset: last_reset(),
        };
        let nucleo = Nucleo {
            encoder: Quadrature::new(Timer2, counts_per_turn, 32),
            torque,
            chain: (Outputs, EnableChain::new([EnableLine::high(drive_enable)])),
            enabled: false,
            watchdog: Watchdog::start(),
        };
        (nucleo, beside)
    }
}

/// Why the board was reset last; the registers are then ready for the next time.
fn last_reset() -> u32 {
    PWR.cr1().modify(|r| r.set_dbp(true));
    let word = word(RCC.csr().read().0, FLASH.optr().read().0, TAMP.bkpr(0).read().0);
    RCC.csr().modify(|r| r.set_rmvf(true));
    TAMP.bkpr(0).write(|r| r.0 = 0);
    word
}

impl<T: TorqueOutput<f32>> Board<f32> for Nucleo<T> {
    #[inline]
    fn angle(&mut self) -> Result<u32, Faults> {
        if let Some(count) = Timer2::index() {
            self.encoder.index(count);
        }
        self.encoder.read()
    }

    #[inline]
    fn set_torque(&mut self, torque: f32, angle: u32) -> Result<(), Faults> {
        self.torque.set_torque(torque, angle)?;
        // the break input has switched the outputs off, or the core's lockup has
        if self.enabled && !bridge::outputs_are_on() { Err(Faults::TORQUE_OUTPUT) } else { Ok(()) }
    }

    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
        let set = self.chain.set_enabled(enabled);
        self.enabled = enabled && set.is_ok();
        set
    }

    /// Feeds the watchdog where the tick has ended before the next one is due: ticks that are all too long are none.
    #[inline]
    fn alive(&mut self) {
        if !tick_is_due() {
            self.watchdog.feed();
        }
    }
}
