//! A torque as the duties of a three-phase bridge.
//!
//! The voltage stands a quarter turn (electrical) before the field, and is proportional to the commanded torque: at a
//! standstill the current, hence the torque, follows it through the winding's resistance; at speed the induced voltage
//! takes its share, as a DC motor's does. That is enough for a small machine. A large one has a drive that controls its
//! current.
//!
//! The three voltages are shifted together by half of the sum of their largest and least. That does not change what is
//! between the terminals, and they fit a bridge 2/sqrt(3) times as well as three sines do.

use driveline::axis::TorqueOutput;
use driveline::fault::Faults;
use embedded_hal::pwm::SetDutyCycle;

use super::pwm::duty;
use super::sine::sine;
use super::{FullScale, Scaled};

/// A third of a turn.
const THIRD: u32 = 1_431_655_765;

/// The motor behind a bridge.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseConfig<N: Scaled> {
    /// Torque at which the phase voltage is half of the bridge's supply: at a standstill that voltage over the
    /// winding's resistance times the motor's torque constant.
    pub full_scale: FullScale<N>,
    /// Pairs of poles.
    pub pole_pairs: u32,
    /// Angle of the motor at which phase a's axis and the magnet's agree (2^-32 turn).
    pub zero: u32,
}

/// Three channels, one for each half bridge.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ThreePhase<P, Q, R, N: Scaled> {
    phases: (P, Q, R),
    config: PhaseConfig<N>,
}

impl<P, Q, R, N> ThreePhase<P, Q, R, N>
where
    P: SetDutyCycle,
    Q: SetDutyCycle,
    R: SetDutyCycle,
    N: Scaled,
{
    /// The bridge's phases a, b and c.
    pub const fn new(phases: (P, Q, R), config: PhaseConfig<N>) -> Self {
        ThreePhase { phases, config }
    }

    /// The channels again.
    pub fn release(self) -> (P, Q, R) {
        self.phases
    }

    /// Sets three voltages, each in 1/32768 of half the supply; every channel is set, whatever the others do.
    ///
    /// # Errors
    /// [`Faults::TORQUE_OUTPUT`] where one could not be set; all are then set to half duty, no voltage between any two.
    pub fn set_voltages(&mut self, [a, b, c]: [i32; 3]) -> Result<(), Faults> {
        let (p, q, r) = &mut self.phases;
        let set = [
            p.set_duty_cycle(duty(a, p.max_duty_cycle())).is_ok(),
            q.set_duty_cycle(duty(b, q.max_duty_cycle())).is_ok(),
            r.set_duty_cycle(duty(c, r.max_duty_cycle())).is_ok(),
        ];
        if set == [true; 3] {
            return Ok(());
        }
        let _ = p.set_duty_cycle(duty(0, p.max_duty_cycle()));
        let _ = q.set_duty_cycle(duty(0, q.max_duty_cycle()));
        let _ = r.set_duty_cycle(duty(0, r.max_duty_cycle()));
        Err(Faults::TORQUE_OUTPUT)
    }
}

impl<P, Q, R, N> TorqueOutput<N> for ThreePhase<P, Q, R, N>
where
    P: SetDutyCycle,
    Q: SetDutyCycle,
    R: SetDutyCycle,
    N: Scaled,
{
    fn set_torque(&mut self, torque: N, angle: u32) -> Result<(), Faults> {
        let fraction = self.config.full_scale.fraction(torque);
        let electrical = angle.wrapping_sub(self.config.zero).wrapping_mul(self.config.pole_pairs);
        let set = self.set_voltages(voltages(fraction.unwrap_or(0), electrical));
        if fraction.is_some() { set } else { Err(Faults::TORQUE_OUTPUT) }
    }
}

/// The phases' voltages for one a quarter turn before `electrical`, shifted into the middle of the bridge.
fn voltages(quadrature: i32, electrical: u32) -> [i32; 3] {
    let along = |axis: u32| -((quadrature * sine(electrical.wrapping_sub(axis))) >> 15);
    let [a, b, c] = [along(0), along(THIRD), along(THIRD.wrapping_mul(2))];
    let middle = (a.max(b).max(c) + a.min(b).min(c)) >> 1;
    [a - middle, b - middle, c - middle]
}
