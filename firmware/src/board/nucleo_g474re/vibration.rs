//! Two velocity sensors on PA0 (ADC1) and PA1 (ADC2): eight conversions a tick each, at the beat of TIM4, through DMA.
//!
//! The DMA fills a ring of two ticks; a tick takes the half that is not being filled.

use core::cell::UnsafeCell;
use core::ptr;

use driveline::configure::HasVibration;
use driveline::fault::Faults;
use driveline_hal::{AdcVibration, PerCount};
use stm32_metapac::adc::Adc;
use stm32_metapac::adc::vals::{Dmacfg, Dmaen, Exten, Ovrmod, SampleTime};
use stm32_metapac::adccommon::vals::{Ckmode, Presc};
use stm32_metapac::bdma::vals::{Dir, Size};
use stm32_metapac::timer::vals::Mms;
use stm32_metapac::{ADC1, ADC2, ADC12_COMMON, DMA1, DMAMUX1, TIM4};

use super::clock::CLOCK_HZ;
use super::pin::analog;
use crate::scenes::test_rig::TestRig;

/// Conversions a tick.
const SLICE: usize = 8;
/// Conversions a second.
const CONVERSIONS_HZ: u32 = 8 * 10_000;
/// Trigger of a regular conversion: TIM4_TRGO (RM0440, EXTSEL of ADC1 and ADC2).
const BY_TIM4: u8 = 12;
/// Requests to the DMA (RM0440, table of DMAMUX inputs).
const REQUESTS: [u8; 2] = [5, 36];
/// 12 bits.
const MOST: u16 = 4095;
/// Half of the range is the largest velocity; a count is given in 1/256.
const PER_COUNT: PerCount<f32> = PerCount::<f32>::new(TestRig::VIBRATION_LIMIT / 2048.0 / 256.0);

/// Buffer of the DMA.
struct Ring(UnsafeCell<[u16; 2 * SLICE]>);

// SAFETY: written by the DMA alone, read by volatile reads of a half that it does not write at the time.
unsafe impl Sync for Ring {}

static RINGS: [Ring; 2] = [const { Ring(UnsafeCell::new([0; 2 * SLICE])) }; 2];

/// Two sensors.
pub struct Vibration {
    sensors: [AdcVibration<f32>; 2],
    transfers: [u32; 2],
}

impl Vibration {
    /// Starts converters and DMA; their beat comes with the ticks.
    pub fn start() -> Self {
        analog('A', 0);
        analog('A', 1);
        // 42.5 MHz
        ADC12_COMMON.ccr().modify(|r| {
            r.set_ckmode(Ckmode::ASYNCHRONOUS);
            r.set_presc(Presc::DIV4);
        });
        start_converter(ADC1, 0, 1);
        start_converter(ADC2, 1, 2);
        TIM4.arr().write(|r| r.set_arr((CLOCK_HZ / CONVERSIONS_HZ - 1) as u16));
        TIM4.cr2().modify(|r| r.set_mms(Mms::UPDATE));
        // it starts with the ticks: `start_tick`
        let sensor = AdcVibration::new(MOST / 2 + 1, MOST, PER_COUNT);
        Vibration { sensors: [sensor; 2], transfers: [0; 2] }
    }

    /// The velocities of the last tick.
    ///
    /// # Errors
    /// [`Faults::VIBRATION_MISSING`] where one is missing or clipped.
    #[inline]
    pub fn read(&mut self) -> Result<[f32; 2], Faults> {
        let first = self.channel::<0>();
        let second = self.channel::<1>();
        Ok([first?, second?])
    }

    #[inline(always)]
    fn channel<const CHANNEL: usize>(&mut self) -> Result<f32, Faults> {
        let flags = DMA1.isr().read();
        if flags.htif(CHANNEL) || flags.tcif(CHANNEL) {
            DMA1.ifcr().write(|r| {
                r.set_htif(CHANNEL, true);
                r.set_tcif(CHANNEL, true);
            });
            self.transfers[CHANNEL] = self.transfers[CHANNEL].wrapping_add(1);
        }
        // more than a half is left: the first is being filled
        let filling_first = usize::from(DMA1.ch(CHANNEL).ndtr().read().ndt()) > SLICE;
        let from = if filling_first { SLICE } else { 0 };
        let start = RINGS[CHANNEL].0.get().cast::<u16>();
        let slice: [u16; SLICE] = core::array::from_fn(|at| {
            // SAFETY: within the ring, for both halves.
            unsafe { ptr::read_volatile(start.add(from + at)) }
        });
        self.sensors[CHANNEL].mean(&slice, self.transfers[CHANNEL])
    }
}

/// Calibrates a converter and lets it fill its ring.
#[inline(always)]
fn start_converter(converter: Adc, ring: usize, input: u8) {
    // out of deep power-down first, and only then the regulator: RM0440, 21.4.6
    converter.cr().write(|r| r.set_advregen(false));
    converter.cr().modify(|r| r.set_advregen(true));
    // the regulator takes 20 us: DS12288, tADCVREG_SETUP
    cortex_m::asm::delay(CLOCK_HZ / 50_000);
    converter.cr().modify(|r| r.set_adcal(true));
    while converter.cr().read().adcal() {}
    // four clocks of the converter between calibration and use
    cortex_m::asm::delay(32);
    converter.cr().modify(|r| r.set_aden(true));
    while !converter.isr().read().adrdy() {}
    converter.smpr().modify(|r| r.set_smp(input.into(), SampleTime::CYCLES24_5));
    converter.sqr1().modify(|r| {
        r.set_l(0);
        r.set_sq(0, input);
    });
    converter.cfgr().modify(|r| {
        r.set_dmaen(Dmaen::ENABLE);
        r.set_dmacfg(Dmacfg::CIRCULAR);
        r.set_exten(Exten::RISING_EDGE);
        r.set_extsel(BY_TIM4);
        r.set_ovrmod(Ovrmod::OVERWRITE);
    });
    DMAMUX1.ccr(ring).write(|r| r.set_dmareq_id(REQUESTS[ring]));
    let channel = DMA1.ch(ring);
    channel.par().write_value(converter.dr().as_ptr() as u32);
    channel.mar().write_value(RINGS[ring].0.get() as u32);
    channel.ndtr().write(|r| r.set_ndt(2 * SLICE as u16));
    channel.cr().write(|r| {
        r.set_dir(Dir::FROM_PERIPHERAL);
        r.set_circ(true);
        r.set_minc(true);
        r.set_psize(Size::BITS16);
        r.set_msize(Size::BITS16);
        r.set_en(true);
    });
    converter.cr().modify(|r| r.set_adstart(true));
}
