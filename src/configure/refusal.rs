//! Why a machine is refused: the sentence of a compile error, with the figures of the machine in it.
//!
//! What is checked here stops in the user's constant, so that the compiler shows the user's line.

use super::{Configure, Machine, Rating};
use crate::machine::{Speed, Torque};
use crate::number::Number;

/// Bytes of a sentence.
const LONGEST: usize = 400;

/// A sentence with figures.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Refusal {
    text: [u8; LONGEST],
    length: usize,
}

impl Refusal {
    /// A sentence, or its beginning.
    #[must_use]
    pub const fn new(text: &str) -> Self {
        Self { text: [0; LONGEST], length: 0 }.and(text)
    }

    /// The sentence goes on.
    #[must_use]
    pub const fn and(mut self, text: &str) -> Self {
        let (bytes, mut at) = (text.as_bytes(), 0);
        while at < bytes.len() && self.length < LONGEST {
            self.text[self.length] = bytes[at];
            self.length += 1;
            at += 1;
        }
        self
    }

    /// A figure of three digits or more.
    #[must_use]
    pub const fn figure(mut self, value: f64) -> Self {
        if !value.is_finite() {
            return self.and("no number");
        }
        if value < 0.0 {
            self = self.and("-");
        }
        let (mut rest, mut power) = (value.abs(), 0_i32);
        if rest >= 1e9 || (rest > 0.0 && rest < 1e-3) {
            while rest >= 10.0 {
                rest *= 0.1;
                power += 1;
            }
            while rest < 1.0 {
                rest *= 10.0;
                power -= 1;
            }
        }
        let mut decimals = 0;
        while decimals < 5 && rest < 100.0 && (rest - (rest + 0.5) as u64 as f64).abs() > 5e-4 * rest {
            rest *= 10.0;
            decimals += 1;
        }
        self = self.digits((rest + 0.5) as u64, decimals);
        if power == 0 {
            self
        } else {
            self.and(if power < 0 { "e-" } else { "e" }).digits(power.unsigned_abs() as u64, 0)
        }
    }

    const fn digits(mut self, value: u64, decimals: u32) -> Self {
        let mut place = 1;
        let mut left = 1;
        while value / place >= 10 || left <= decimals {
            place *= 10;
            left += 1;
        }
        while left > 0 {
            if left == decimals {
                self = self.and(".");
            }
            const DIGITS: &str = "0123456789";
            let digit = (value / place % 10) as usize;
            self = self.and(DIGITS.split_at(digit).1.split_at(1).0);
            left -= 1;
            if place > 1 {
                place /= 10;
            }
        }
        self
    }

    /// The sentence.
    #[must_use]
    pub const fn as_str(&self) -> &str {
        match core::str::from_utf8(self.text.split_at(self.length).0) {
            Ok(text) => text,
            Err(_) => "",
        }
    }

    /// Stops with the sentence: a compile error in a constant.
    pub(crate) const fn stop(&self) -> ! {
        panic!("{}", self.as_str())
    }
}

/// What a part needs of the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Needs {
    /// A shaft that the sample rate can follow.
    pub shaft: bool,
    /// A gear with losses.
    pub losses: bool,
    /// Ticks in a cycle at rated speed, and in a turn of a longer cycle.
    pub ticks: f64,
}

impl Needs {
    /// Nothing.
    pub const NONE: Self = Self { shaft: false, losses: false, ticks: 0.0 };
    /// A shaft.
    pub const SHAFT: Self = Self { shaft: true, ..Self::NONE };

    /// A gear with losses, and what the observer inside needs.
    #[must_use]
    pub const fn with_losses(self) -> Self {
        Self { losses: true, ..self }
    }
}

/// Why the machine `M` is refused before anything is designed for it: by a drive with these needs.
pub(super) const fn of_machine<M: Machine>(observer: &Needs, fluctuation: &Needs) -> Option<Refusal> {
    let Rating { torque: Torque(torque), speed: Speed(speed), torque_limit: Torque(limit) } = M::RATING;
    if !(torque > 0.0 && torque.is_finite()) {
        return Some(Refusal::new("RATING: `torque` must be positive and finite"));
    }
    if !(speed > 0.0 && speed.is_finite()) {
        return Some(Refusal::new("RATING: `speed` must be positive and finite"));
    }
    if !(limit >= torque && limit.is_finite()) {
        return Some(
            Refusal::new(
                "RATING: `torque_limit` must be finite and at least `torque`: it is the largest torque that the drive \
                may command, ",
            )
            .figure(limit)
            .and(" N m where `torque` is ")
            .figure(torque)
            .and(" N m"),
        );
    }
    if let Err(error) = M::CHAIN.check() {
        return Some(Refusal::new("CHAIN: ").and(error.message()));
    }
    if let Err(error) = M::RATE.period() {
        return Some(Refusal::new("RATE_HZ: ").and(error.message()));
    }
    match M::ENCODER.resolution() {
        Err(error) => return Some(Refusal::new("ENCODER: ").and(error.message())),
        Ok(count) if M::ENCODER.has_few_lines() => {
            return Some(Refusal::new("ENCODER: ").figure(core::f64::consts::TAU / count).and(
                " counts a turn are not those of lines: write an encoder of 12 bits as `Encoder::counts(1 << 12)`, \
                    and a coarse one by its counts too",
            ));
        }
        Ok(_) => {}
    }
    let inertia = M::CHAIN.masses()[0];
    if !M::RATING.is_within(inertia, M::PERIPHERAL_SPEED) {
        return Some(
            Refusal::new("RATING: at this `speed` (rad/s), ")
                .figure(speed)
                .and(
                    ", the peripheral speed of the motor's rotor would be over `PERIPHERAL_SPEED`: write r/min as \
                    `Speed::rpm(1480.0)`, or name `PERIPHERAL_SPEED` for so fast a motor; the first inertia of CHAIN \
                    is ",
                )
                .figure(inertia)
                .and(" kg m2: 1 g cm2 is 1e-7 kg m2"),
        );
    }
    let run_up = M::RATING.run_up(M::CHAIN.total_inertia());
    if !(run_up <= M::RUN_UP) {
        return Some(
            Refusal::new("CHAIN: ")
                .figure(M::CHAIN.total_inertia())
                .and(" kg m2 at the motor would take ")
                .figure(run_up)
                .and(" s to rated speed by rated torque, `RUN_UP` allows ")
                .figure(M::RUN_UP)
                .and(
                    " s: give inertias in kg m2 (1 kg cm2 is 1e-4), `Ratio` as motor turns per turn of the load, \
                    `torque` in N m, or name `RUN_UP` for such a flywheel",
                ),
        );
    }
    let twist = M::CHAIN.largest_twist(torque);
    if !(twist <= M::SHAFT_TWIST) {
        return Some(
            Refusal::new("CHAIN: a shaft would twist by ")
                .figure(twist)
                .and(" rad under rated torque, `SHAFT_TWIST` allows ")
                .figure(M::SHAFT_TWIST)
                .and(
                    " rad: give `Stiffness` in N m/rad (1 N m/degree is 57.3 N m/rad), or name `SHAFT_TWIST` for so \
                    soft a coupling",
                ),
        );
    }
    let turns = M::CYCLE.turns as f64 / M::CYCLE.cycles as f64;
    let ticks = turns.min(1.0) * core::f64::consts::TAU / (speed * M::PERIOD);
    if ticks < fluctuation.ticks {
        return Some(Refusal::new("RATE_HZ: ").figure(ticks).and(" ticks a turn, ").figure(fluctuation.ticks).and(
            " needed: at rated speed a cycle has fewer than 96 ticks, or 160 beside a waveform, the least for its \
                extremes: raise the rate, or measure the waveform alone",
        ));
    }
    if observer.losses
        && let Some(refusal) = loses::<M>()
    {
        return Some(refusal);
    }
    if observer.shaft { follows::<M>() } else { None }
}

/// Why the gear's losses cannot be. Apart: a constant that a function names is evaluated before its first line.
const fn loses<M: Machine>() -> Option<Refusal> {
    let efficiency = M::GEAR.efficiency;
    if efficiency == 1.0 {
        return Some(Refusal::new(
            "CHAIN: a `GearedObserver` needs a gear with losses: add `.gear(Ratio(5.0), Efficiency(0.97))` before \
            the softest shaft, or take the observer inside it",
        ));
    }
    if efficiency < 0.1 {
        return Some(
            Refusal::new("CHAIN: an efficiency of ")
                .figure(efficiency)
                .and(" locks every gear: a loss of 3 % is `Efficiency(0.97)`"),
        );
    }
    None
}

/// Why the sample rate cannot follow the shaft.
const fn follows<M: Machine>() -> Option<Refusal> {
    let Err(crate::design::Error::SampleRate) = M::TWO_MASS.try_follow(M::RATE) else {
        return None;
    };
    Some(
        Refusal::new("RATE_HZ: ")
            .figure(M::RATE_HZ as f64)
            .and(" ticks a second, more than ")
            .figure(M::TWO_MASS.damped_resonance() / core::f64::consts::PI)
            .and(" needed: ")
            .and(crate::design::Error::SampleRate.message()),
    )
}

/// Stops in the constant of whoever calls it, before anything is designed.
pub(crate) const fn stop_refused<C: Configure<M, N>, M: Machine, N: Number>() {
    if let Some(refusal) = &C::REFUSED {
        refusal.stop()
    }
}

/// The constants. Apart from the check: a constant that a function names is evaluated before its first line.
pub(crate) const fn constants<C: Configure<M, N>, M: Machine, N: Number>() -> C::Config {
    C::CONFIG
}

#[cfg(test)]
mod tests {
    use super::Refusal;

    #[test]
    fn figures_have_three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (96.0, "96"),
            (83.78, "83.8"),
            (0.86, "0.86"),
            (0.02181, "0.0218"),
            (1_234.5, "1235"),
            (2.5e12, "2.5e12"),
            (4.0e-7, "4e-7"),
            (-150.0, "-150"),
            (f64::NAN, "no number"),
        ] {
            assert_eq!(Refusal::new("").figure(value).as_str(), text);
        }
        assert_eq!(Refusal::new(&"a".repeat(500)).as_str().len(), 400);
    }
}
