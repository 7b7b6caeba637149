//! The loop of a governor with a late actuator, by its frequency response: dead times of any length, and estimates with
//! a lag.

use super::ExactStep;
use super::complex::{Complex, over, plus, scaled, times};
use super::controller::Observer;
use super::natural_damping::{DampedStep, NaturalDamping};
use crate::machine::TwoMass;
use crate::math::{atan2, exp, ln, sin_cos};

/// Average of the speed that a governor takes, with its response.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Averaging {
    /// None.
    None,
    /// The mean over so many ticks, of the load torque as well.
    Ticks(u32),
    /// The speed without its ripple over a cycle of this time (s): `(1 - exp(-s T)) (1/(s T) + 1/2)`.
    Cycle(f64),
}

impl Averaging {
    /// Delay that the gains have to allow for (s): half of the interval of a mean over ticks. The average over a cycle
    /// follows an acceleration without one.
    #[must_use]
    pub const fn delay(self, period: f64) -> f64 {
        match self {
            Self::Ticks(ticks) if ticks > 1 => 0.5 * ticks as f64 * period,
            _ => 0.0,
        }
    }

    const fn response(self, frequency: f64, period: f64) -> Complex {
        match self {
            Self::None => (1.0, 0.0),
            Self::Ticks(ticks) => {
                let half = 0.5 * frequency * period;
                let (whole, _) = sin_cos(ticks as f64 * half);
                let (sine, cosine) = sin_cos((ticks as f64 - 1.0) * half);
                let size = whole / (ticks as f64 * sin_cos(half).0);
                (size * cosine, -size * sine)
            }
            Self::Cycle(time) => {
                let angle = frequency * time;
                let (sine, cosine) = sin_cos(angle);
                times((1.0 - cosine, sine), (0.5, -1.0 / angle))
            }
        }
    }
}

/// How close to a resonance the response is looked at, over its frequency: no shaft has so little damping.
pub(super) const NARROWEST: f64 = 1e-7;

/// The loop cut at the torque, which acts one tick after its sample.
#[derive(Clone, Copy)]
pub(super) struct LateLoop {
    pub step: ExactStep,
    pub machine: TwoMass,
    pub period: f64,
    pub proportional: f64,
    pub integral: f64,
    pub late: Late,
    /// The natural damping and its step; none on a free machine.
    pub natural: Option<(NaturalDamping, DampedStep)>,
    pub averaging: Averaging,
    /// The observer whose estimates the governor takes; without one the speed is known.
    pub observer: Option<Observer>,
}

/// Delays beyond the tick, in continuous time.
#[derive(Clone, Copy)]
pub(super) struct Late {
    /// Dead time and lag of the actuator.
    pub delay: f64,
    pub lag: f64,
    /// Share of the load torque that is fed forward, share of the inertia that is given against the acceleration, and
    /// the lag of the estimated load torque.
    pub share: f64,
    pub inertia: f64,
    pub estimate: f64,
}

impl LateLoop {
    /// Response at a frequency (rad/s), positive where the feedback opposes.
    pub(super) const fn response(&self, frequency: f64) -> Complex {
        let [by_motion, told] = self.parts(frequency);
        over(by_motion, told)
    }

    /// The response as a ratio: by the machine's motion, over 1 and what the governor gives by the reported torque
    /// alone. Their sum is zero at the poles of the closed loop, and itself has those of machine and governor alone.
    const fn parts(&self, frequency: f64) -> [Complex; 2] {
        let (sine, cosine) = sin_cos(0.5 * frequency * self.period);
        // z - 1 without cancellation.
        let d = (-2.0 * sine * sine, 2.0 * sine * cosine);
        let z = (1.0 + d.0, d.1);
        if let Some((_, step)) = &self.natural {
            let [motor, load] = step.response(d);
            let (jm, jl) = (self.machine.motor_inertia, self.machine.load_inertia);
            let momentum = (jm * motor.0 + jl * load.0, jm * motor.1 + jl * load.1);
            if let Some(observer) = &self.observer {
                return self.seen(observer, Some(motor), z, d, frequency);
            }
            let moved = times((d.0 / self.period, d.1 / self.period), momentum);
            return self.with_late(times(self.controller(z, d), motor), moved, z, frequency);
        }
        if let Some(observer) = &self.observer {
            return self.seen(observer, None, z, d, frequency);
        }
        let n = &self.step;
        let (a, b) = ((d.0 - n.n11, d.1), (d.0 - n.n22, d.1));
        let determinant = times(a, b);
        let determinant = (determinant.0 - n.n12 * n.n21, determinant.1);
        let numerator = (n.n21 * n.g1 + a.0 * n.g2, a.1 * n.g2);
        let slip = over(numerator, determinant);
        let slip = (slip.0 / self.machine.motor_inertia, slip.1 / self.machine.motor_inertia);
        let total = self.machine.total_inertia();
        let mean = over((self.period / total, 0.0), d);
        let load = self.machine.load_inertia / total;
        let motor = (mean.0 + load * slip.0, mean.1 + load * slip.1);
        let speed = times(self.controller(z, d), motor);
        self.with_late(speed, (1.0, 0.0), z, frequency)
    }

    /// Response of the proportional and integral controller.
    const fn controller(&self, z: Complex, d: Complex) -> Complex {
        let integral = over(z, d);
        (self.proportional + self.integral * self.period * integral.0, self.integral * self.period * integral.1)
    }

    /// The response with delays: `A (V L + (g + s) F M)/(1 - g F A + s (1 - F) A)`. M is the mean torque that
    /// accelerates the masses, by their motion, over the torque that acts: 1 without natural damping. V is the average
    /// of the speed, and part of F where it averages the load torque too.
    const fn with_late(&self, speed: Complex, moved: Complex, z: Complex, frequency: f64) -> [Complex; 2] {
        let average = self.averaging.response(frequency, self.period);
        let prompt = over(times(average, speed), z);
        let Late { delay, lag, share, inertia, estimate } = self.late;
        let actuator = actuator(delay, lag, frequency);
        let taken = share + inertia;
        let filter = over(over((taken, 0.0), (1.0, frequency * estimate)), z);
        let filter = if let Averaging::Ticks(_) = self.averaging { times(filter, average) } else { filter };
        // Acts on the reported torque: (g + s) F - s/z.
        let own = over((inertia, 0.0), z);
        let fed = times((filter.0 - own.0, filter.1 - own.1), actuator);
        let seen = times(filter, moved);
        [times(actuator, (prompt.0 + seen.0, prompt.1 + seen.1)), (1.0 - fed.0, -fed.1)]
    }

    /// With an observer, which is told the torque as reported. Its estimates are `E_t tau + E_i (theta - P^ tau)`, with
    /// its model's angle `P^`; the machine's is `P g tau` with the torque times g. The governor gives `-c` of them, so
    /// `1 + A c (E_t - E_i P^) + g A c E_i P` is zero at the closed loop's poles.
    const fn seen(
        &self,
        observer: &Observer,
        damped: Option<Complex>,
        z: Complex,
        d: Complex,
        frequency: f64,
    ) -> [Complex; 2] {
        let machine = Observer::of_two_masses(&self.machine, &self.step, [0.0; 5], self.period).driven(d);
        // a natural damping changes the angle as it changes the speed
        let angle = match damped {
            Some(speed) => times(machine.angle, over(speed, machine.speed)),
            None => machine.angle,
        };
        let (told, corrected) = (observer.driven(d), observer.corrected(z, d));
        let Late { delay, lag, share, inertia, .. } = self.late;
        let acceleration = inertia * self.machine.total_inertia() / self.machine.load_inertia;
        let average = self.averaging.response(frequency, self.period);
        let of_speed = times(average, self.controller(z, d));
        let of_load = if let Averaging::Ticks(_) = self.averaging { average } else { (1.0, 0.0) };
        let of_load = scaled(-share - acceleration, of_load);
        let acts = over(actuator(delay, lag, frequency), z);
        let by_correction = plus(
            plus(times(of_speed, corrected.speed), times(of_load, corrected.load_torque)),
            scaled(acceleration, corrected.shaft_torque),
        );
        let by_torque = plus(times(of_speed, told.speed), scaled(acceleration, told.shaft_torque));
        let by_torque = plus(by_torque, scaled(-1.0, times(by_correction, told.angle)));
        [times(times(acts, by_correction), angle), plus((1.0, 0.0), times(acts, by_torque))]
    }

    /// 1 and the response. With an observer it is the sum of both parts, whose poles are those of the machine, of the
    /// integral and of the observer, all known.
    const fn returned(&self, frequency: f64) -> Complex {
        let [by_motion, told] = self.parts(frequency);
        let sum = plus(by_motion, told);
        if self.observer.is_some() { sum } else { over(sum, told) }
    }

    /// Whether the closed loop of a proportional and integral controller is stable, by Nyquist's criterion. A free
    /// mass has two poles at the origin, none to its right, so the response turns about -1 by half a turn from zero
    /// frequency to the Nyquist frequency. A pole less at the origin takes a quarter of a turn off, one to its right
    /// adds half a turn, and a load torque that is fed forward whole a quarter.
    pub(super) const fn is_stable(&self, bandwidth: f64) -> bool {
        let nyquist = core::f64::consts::PI / self.period;
        let (ws, wr) = (self.machine.antiresonance(), self.machine.resonance());
        let (mut slowest, mut expected) = (1e-3 * bandwidth, 0.75);
        if let Some((natural, _)) = &self.natural {
            let rate = natural.sum() / self.machine.total_inertia();
            expected += natural.unstable_vibrations(&self.machine) as f64;
            // Below a tenth of the slowest frequency the pole is as good as at the origin.
            if rate.abs() > 0.1 * slowest {
                slowest = if rate.abs() < bandwidth { 1e-2 * rate.abs() } else { slowest };
                expected += if rate < 0.0 { 0.5 } else { -0.5 };
                // An integral on a damped mass turns the response by a quarter, below its corner.
                let corner = 0.1 * self.integral / natural.sum().abs();
                slowest = if corner < slowest { corner } else { slowest };
            }
        }
        // Ever finer towards the resonance, where a lightly damped shaft turns the response within its damping.
        let (beside, wide) = (NARROWEST * wr, 0.1 * wr);
        let ranges = [
            (0.0, 1e-3 * bandwidth),
            (0.0, 0.8 * ws),
            (0.0, wr - wide),
            (wr, wr - beside),
            (0.0, wr + beside),
            (wr, wr + wide),
            (0.0, nyquist),
        ];
        let (mut turned, mut low) = (0.0, slowest);
        let mut before = self.returned(low);
        each!(k, 0..ranges.len(), {
            let (about, to) = ranges[k];
            let high = if to < nyquist { to } else { nyquist };
            if high > low {
                let factor = exp(ln((high - about) / (low - about)) / 80.0);
                each!(point, 0..80, {
                    low = if point == 79 { high } else { about + (low - about) * factor };
                    let after = self.returned(low);
                    let turn = over(after, before);
                    turned += atan2(turn.1, turn.0);
                    before = after;
                });
            }
        });
        // Every unstable pole turns it back by half a turn.
        turned > expected * core::f64::consts::PI
    }
}

/// Response of the actuator.
const fn actuator(delay: f64, lag: f64, frequency: f64) -> Complex {
    let (sine, cosine) = sin_cos(frequency * delay);
    over((cosine, -sine), (1.0, frequency * lag))
}
