//! 170 MHz from the crystal of 24 MHz; the clocks of the peripherals.

use stm32_metapac::flash::vals::Latency;
use stm32_metapac::pwr::vals::Vos;
use stm32_metapac::rcc::vals::{Adcsel, Hpre, Pllm, Plln, Pllr, Pllsrc, Sw, Uartsel};
use stm32_metapac::{FLASH, PWR, RCC};

/// Clock of the core, the buses and the timers (Hz): 24 MHz / 6 x 85 / 2.
pub const CLOCK_HZ: u32 = 170_000_000;

/// Starts the clocks. Without a crystal it waits indefinitely, all outputs off.
pub fn start() {
    RCC.apb1enr1().modify(|r| r.set_pwren(true));
    // above 150 MHz: the bus at half, range 1 boost, wait states, the PLL, a microsecond, the bus at full (RM0440, PWR,
    // dynamic voltage scaling). The bus is halved before, not with, the switch: a new divider acts some cycles late
    RCC.cfgr().modify(|r| r.set_hpre(Hpre::DIV2));
    PWR.cr1().modify(|r| r.set_vos(Vos::RANGE1));
    PWR.cr5().modify(|r| r.set_r1mode(false));
    FLASH.acr().modify(|r| {
        r.set_latency(Latency::WS4);
        r.set_prften(true);
        r.set_icen(true);
        r.set_dcen(true);
    });
    while FLASH.acr().read().latency() != Latency::WS4 {}
    RCC.cr().modify(|r| r.set_hseon(true));
    while !RCC.cr().read().hserdy() {}
    RCC.pllcfgr().modify(|r| {
        r.set_pllsrc(Pllsrc::HSE);
        r.set_pllm(Pllm::DIV6);
        r.set_plln(Plln::MUL85);
        r.set_pllr(Pllr::DIV2);
        r.set_pllren(true);
    });
    RCC.cr().modify(|r| r.set_pllon(true));
    while !RCC.cr().read().pllrdy() {}
    RCC.cfgr().modify(|r| r.set_sw(Sw::PLL1_R));
    while RCC.cfgr().read().sws() != Sw::PLL1_R {}
    // 2 us of the 85 MHz that the core has
    cortex_m::asm::delay(CLOCK_HZ / 1_000_000);
    RCC.cfgr().modify(|r| r.set_hpre(Hpre::DIV1));

    RCC.ahb1enr().modify(|r| {
        r.set_dma1en(true);
        r.set_dmamux1en(true);
    });
    RCC.ahb2enr().modify(|r| {
        r.set_gpioaen(true);
        r.set_gpioben(true);
        r.set_gpiocen(true);
        r.set_adc12en(true);
    });
    RCC.apb1enr1().modify(|r| {
        r.set_tim2en(true);
        r.set_tim4en(true);
        r.set_tim6en(true);
        // the backup registers
        r.set_rtcapben(true);
    });
    RCC.apb1enr2().modify(|r| r.set_lpuart1en(true));
    RCC.apb2enr().modify(|r| {
        r.set_syscfgen(true);
        r.set_tim1en(true);
    });
    RCC.ccipr().modify(|r| {
        r.set_adc12sel(Adcsel::SYS);
        r.set_lpuart1sel(Uartsel::PCLK1);
    });
    // where the crystal fails, TIM1 breaks; the NMI never ends, and the watchdog resets
    RCC.cr().modify(|r| r.set_csson(true));
    // the bits take two cycles of the bus to act: RM0440, 7.2.17
    let _ = RCC.ccipr().read();
}
