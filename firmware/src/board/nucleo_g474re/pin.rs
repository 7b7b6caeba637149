//! Pins.

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, OutputPin};
use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::vals::{Moder, Pupdr};
use stm32_metapac::{GPIOA, GPIOB, GPIOC};

/// A pin of a port.
#[derive(Clone, Copy)]
pub struct Pin {
    port: Gpio,
    mask: u16,
}

const fn port(name: char) -> Gpio {
    match name {
        'A' => GPIOA,
        'B' => GPIOB,
        _ => GPIOC,
    }
}

/// Gives a pin to a peripheral.
#[inline(always)]
pub fn alternate(name: char, number: usize, function: u8, pull: Pupdr) {
    port(name).afr(number / 8).modify(|r| r.set_afr(number % 8, function));
    port(name).pupdr().modify(|r| r.set_pupdr(number, pull));
    port(name).moder().modify(|r| r.set_moder(number, Moder::ALTERNATE));
}

/// Gives a pin to a converter.
#[inline(always)]
pub fn analog(name: char, number: usize) {
    port(name).moder().modify(|r| r.set_moder(number, Moder::ANALOG));
}

impl Pin {
    /// An output, low.
    #[inline(always)]
    pub fn output(name: char, number: usize) -> Self {
        port(name).bsrr().write(|r| r.set_br(number, true));
        port(name).moder().modify(|r| r.set_moder(number, Moder::OUTPUT));
        Pin { port: port(name), mask: 1 << number }
    }

    /// An input, pulled nowhere.
    #[inline(always)]
    pub fn input(name: char, number: usize) -> Self {
        port(name).moder().modify(|r| r.set_moder(number, Moder::INPUT));
        Pin { port: port(name), mask: 1 << number }
    }

    /// Whether an input is high.
    pub fn is_high(&self) -> bool {
        self.port.idr().read().0 & u32::from(self.mask) != 0
    }
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.port.bsrr().write(|r| r.0 = u32::from(self.mask) << 16);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.port.bsrr().write(|r| r.0 = u32::from(self.mask));
        Ok(())
    }
}
