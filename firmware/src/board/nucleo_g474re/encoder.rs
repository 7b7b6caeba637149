//! TIM2 as a counter of quadrature: A on PA15, B on PB3, index on PB10.
//!
//! It counts every edge, 32 bits. Where A and B change at once the timer flags a lost edge to the drive. The index's
//! rising edge captures the count (CH3).

use driveline_hal::Counter;
use stm32_metapac::TIM2;
use stm32_metapac::gpio::vals::Pupdr;
use stm32_metapac::timer::vals::{CcmrInputCcs, FilterValue, Sms};

use super::pin::alternate;

/// The direct input of a channel: TI1 for CH1, TI2 for CH2, TI3 for CH3.
const DIRECT: CcmrInputCcs = CcmrInputCcs::TI4;
/// Inputs are sampled at 170 MHz; eight like samples, 47 ns, are a level.
const FILTER: FilterValue = FilterValue::FCK_INT_N8;

/// Starts the timer.
pub fn start() {
    for (port, number) in [('A', 15), ('B', 3), ('B', 10)] {
        alternate(port, number, 1, Pupdr::PULL_UP);
    }
    TIM2.ccmr_input(0).modify(|r| {
        for channel in 0..2 {
            r.set_ccs(channel, DIRECT);
            r.set_icf(channel, FILTER);
        }
    });
    TIM2.ccmr_input(1).modify(|r| {
        r.set_ccs(0, DIRECT);
        r.set_icf(0, FILTER);
    });
    TIM2.ccer().modify(|r| r.set_cce(2, true));
    TIM2.smcr().modify(|r| r.set_sms(Sms::ENCODER_MODE_3));
    TIM2.arr().write_value(u32::MAX);
    TIM2.cr1().modify(|r| r.set_cen(true));
}

/// A and B changed at once: edges were lost.
#[derive(Clone, Copy, Debug)]
pub struct EdgesLost;

/// The counter.
#[derive(Clone, Copy, Debug)]
pub struct Timer2;

impl Timer2 {
    /// The count at the last index pulse, where there was one since the last call.
    #[inline]
    pub fn index() -> Option<u32> {
        // reading the capture clears its flag
        TIM2.sr().read().ccif(2).then(|| TIM2.ccr(2).read())
    }
}

impl Counter for Timer2 {
    type Error = EdgesLost;

    #[inline]
    fn count(&mut self) -> Result<u32, EdgesLost> {
        if TIM2.sr().read().terrif() {
            TIM2.sr().write(|r| {
                // writing ones changes nothing
                r.0 = u32::MAX;
                r.set_terrif(false);
            });
            return Err(EdgesLost);
        }
        Ok(TIM2.cnt().read())
    }
}
