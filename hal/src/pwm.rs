//! A torque as the duty of one PWM channel.

use driveline::axis::TorqueOutput;
use driveline::fault::Faults;
use embedded_hal::pwm::SetDutyCycle;

use super::{FullScale, Scaled};

/// One channel whose half duty is no torque: full scale forwards at the largest duty, backwards at none.
///
/// It is a drive's torque input of both signs behind a low-pass, or a DC motor's full bridge in locked anti-phase.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PwmTorque<P, N: Scaled> {
    channel: P,
    full_scale: FullScale<N>,
}

impl<P: SetDutyCycle, N: Scaled> PwmTorque<P, N> {
    /// A channel whose full duty is `full_scale`.
    pub const fn new(channel: P, full_scale: FullScale<N>) -> Self {
        PwmTorque { channel, full_scale }
    }

    /// The channel again.
    pub fn release(self) -> P {
        self.channel
    }
}

impl<P: SetDutyCycle, N: Scaled> TorqueOutput<N> for PwmTorque<P, N> {
    #[inline]
    fn set_torque(&mut self, torque: N, _angle: u32) -> Result<(), Faults> {
        let fraction = self.full_scale.fraction(torque);
        let most = self.channel.max_duty_cycle();
        let set = self.channel.set_duty_cycle(duty(fraction.unwrap_or(0), most));
        if set.is_err() {
            // the duty may be any now; no torque is worth a second try
            let _ = self.channel.set_duty_cycle(duty(0, most));
        }
        if set.is_ok() && fraction.is_some() { Ok(()) } else { Err(Faults::TORQUE_OUTPUT) }
    }
}

/// The duty of a fraction in 1/32768, half of `most` at zero; rounded, held within 0 to `most`.
#[inline(always)]
pub(super) fn duty(fraction: i32, most: u16) -> u16 {
    let fraction = fraction.clamp(-32768, 32768) + 32768;
    // below 2^16 x 2^16 + 2^15
    ((fraction as u64 * most as u64 + 32768) >> 16) as u16
}
