//! The ranges that a number in a machine file may lie in.
//!
//! The bounds are wide on purpose: they refuse what no machine has (and what would overflow a product of a few
//! quantities), not what is unusual.

use std::fmt;

/// A physical quantity: its unit and the numbers it may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// Unit as it is written in a message; empty for a pure number.
    pub unit: &'static str,
    /// Smallest number allowed.
    pub least: f64,
    /// Largest number allowed.
    pub most: f64,
    /// Zero is allowed although it lies below `least`.
    pub zero: bool,
    /// Only whole numbers are allowed.
    pub whole: bool,
}

/// Twelve decades either side of one SI unit: a watch's balance wheel has 1e-9 kg m2, a tanker 3e8 kg; products of
/// four such numbers stay within the range of `f64`.
const FAR: f64 = 1e12;

const fn positive(unit: &'static str) -> Quantity {
    Quantity { unit, least: 1.0 / FAR, most: FAR, zero: false, whole: false }
}

const fn not_negative(unit: &'static str) -> Quantity {
    Quantity { zero: true, ..positive(unit) }
}

impl Quantity {
    /// Moment of inertia.
    pub const INERTIA: Self = positive("kg m²");
    /// Torsional stiffness.
    pub const STIFFNESS: Self = positive("N m/rad");
    /// Torsional damping.
    pub const DAMPING: Self = not_negative("N m s/rad");
    /// Stiffness of a rope at the load, all falls together.
    pub const ROPE_STIFFNESS: Self = positive("N/m");
    /// Damping of a rope at the load, all falls together.
    pub const ROPE_DAMPING: Self = not_negative("N s/m");
    pub const MASS: Self = positive("kg");
    /// Diameter; a kilometre is more than any drum has.
    pub const DIAMETER: Self = Quantity { least: 1e-6, most: 1e3, ..positive("m") };
    /// Length of a shaft, rod or pendulum, or lead of a screw.
    pub const LENGTH: Self = Quantity { least: 1e-6, most: 1e4, ..positive("m") };
    /// A length that may be none: a bore, a distance, a slack.
    pub const BORE: Self = Quantity { least: 1e-6, most: 1e4, ..not_negative("m") };
    /// Shear modulus: from rubber's to diamond's.
    pub const MODULUS: Self = Quantity { least: 1e4, most: 1e12, ..positive("Pa") };
    /// Mass of a part that may be left out.
    pub const PART_MASS: Self = not_negative("kg");
    /// Inertia of a part that may be left out.
    pub const PART_INERTIA: Self = not_negative("kg m²");
    /// Teeth or planets.
    pub const TEETH: Self = Quantity { least: 1.0, most: 1e4, whole: true, ..positive("") };
    /// Speed of the motor's side over speed of the load's side.
    pub const RATIO: Self = Quantity { least: 1e-6, most: 1e6, ..positive("") };
    /// Share of the power that passes.
    pub const EFFICIENCY: Self = Quantity { least: 1e-3, most: 1.0, ..positive("") };
    /// Share of the load's power that passes back; zero or below for a gear that locks itself.
    pub const BACK_EFFICIENCY: Self = Quantity { least: -1e3, most: 1.0, ..positive("") };
    /// Falls of rope that carry the load.
    pub const FALLS: Self = Quantity { least: 1.0, most: 64.0, whole: true, ..positive("") };
    /// Whole angle of a gap between its two flanks; more than a turn is not a gap.
    pub const GAP: Self = Quantity { most: std::f64::consts::TAU, ..not_negative("rad") };
    /// Lines of an encoder on a turn; four counts a line fit the 2^32 of an angle word.
    pub const LINES: Self = Quantity { least: 1.0, most: 1_073_741_824.0, whole: true, ..positive("") };
    /// Amplitude of an interpolation error, as a fraction of a signal period.
    pub const INTERPOLATION: Self = Quantity { most: 0.5, ..not_negative("") };
    /// Amplitude of an angle's error once a turn.
    pub const ECCENTRICITY: Self = Quantity { most: 0.1, ..not_negative("rad") };
    /// Natural frequency of a speed loop over the antiresonance.
    pub const BANDWIDTH: Self = Quantity { least: 1e-3, most: 0.999, ..positive("of the antiresonance") };
    /// Control ticks a second.
    pub const RATE: Self = Quantity { least: 1.0, most: 10_000_000.0, whole: true, ..positive("Hz") };
    pub const TORQUE: Self = positive("N m");
    pub const SPEED: Self = positive("rad/s");
    /// Acceleration of the speed's setpoint.
    pub const RAMP: Self = positive("rad/s²");
    /// Resistance of a motor's circuit.
    pub const RESISTANCE: Self = positive("ohm");
    /// Torque over current (V s), or over its square (H).
    pub const FLUX: Self = positive("V s or H");
    /// Density; osmium has 22,600.
    pub const DENSITY: Self = Quantity { least: 1.0, most: 1e5, ..positive("kg/m³") };
    /// Young's modulus.
    pub const YOUNG: Self = Quantity { least: 1e6, most: 1e13, ..positive("Pa") };
    /// Poisson's ratio.
    pub const POISSON: Self = Quantity { least: 1e-6, most: 0.5, zero: true, ..positive("") };
    /// Equal elements that a piece of shaft is cut into.
    pub const PIECES: Self = Quantity { least: 1.0, most: 400.0, whole: true, ..positive("") };
    /// A node of the shaft.
    pub const NODE: Self = Quantity { least: 1.0, most: 400.0, zero: true, whole: true, unit: "" };
    /// Modes of a rotor to be balanced.
    pub const MODES: Self = Quantity { least: 1.0, most: 8.0, zero: true, whole: true, unit: "" };
    /// Stiffness of a bearing.
    pub const BEARING: Self = positive("N/m");
    /// Coupling of the two directions of a bearing by its stiffness.
    pub const CROSS: Self = Quantity { least: -FAR, most: FAR, zero: true, whole: false, unit: "N/m" };
    pub const BEARING_DAMPING: Self = not_negative("N s/m");
    pub const UNBALANCE: Self = not_negative("kg m");
    /// Phase or angle in degrees; ten turns either way are more than anybody writes.
    pub const DEGREES: Self = Quantity { unit: "degrees", least: -3600.0, most: 3600.0, zero: true, whole: false };
    pub const TIME: Self = positive("s");
    /// Frequency of something that repeats.
    pub const FREQUENCY: Self = positive("Hz");
    /// Delay of an actuator; no drive's torque takes a second to begin.
    pub const DELAY: Self = Quantity { most: 1.0, ..not_negative("s") };
    /// Bandwidth of an actuator: its lag is at most 1.6 s.
    pub const ACTUATOR_BANDWIDTH: Self = Quantity { least: 0.1, ..positive("Hz") };
    /// Time in which something comes about, none for a step.
    pub const RISE: Self = not_negative("s");

    /// Any number: a torque, a speed, an angle of either sign.
    pub const ANY: Self = Quantity { least: -FAR, ..positive("") };
    /// Speed in either direction.
    pub const EITHER_SPEED: Self = Quantity { unit: "rad/s", ..Self::ANY };
    /// Direction of a line.
    pub const DIRECTION: Self =
        Quantity { least: -std::f64::consts::TAU, most: std::f64::consts::TAU, unit: "rad", ..Self::ANY };
    /// Coefficient of dry friction.
    pub const FRICTION: Self = Quantity { least: 1e-6, most: 1.0, ..not_negative("") };
    /// Radius of a pin that may be without friction.
    pub const PIN: Self = Quantity { least: 1e-6, most: 1e3, ..not_negative("m") };
    /// Lift of a cam, in either direction.
    pub const LIFT: Self = Quantity { least: -1e3, most: 1e3, unit: "m", ..Self::ANY };
    /// Terms of a Fourier series.
    pub const TERMS: Self = Quantity { least: 1.0, most: 500.0, whole: true, ..positive("") };
    /// Order of an excitation: times per turn.
    pub const ORDER: Self = Quantity { least: 1e-3, most: 1e4, ..positive("") };
    /// Turns of a cycle.
    pub const TURNS: Self = Quantity { least: 1.0, most: 100.0, whole: true, ..positive("") };
    /// A number that is not negative.
    pub const SIZE: Self = not_negative("");
    /// Stiffness of any link, N m/rad or N/m; zero leaves a damper alone.
    pub const SPRING: Self = not_negative("N m/rad or N/m");
    /// Damping of any link, N m s/rad or N s/m.
    pub const DAMPER: Self = not_negative("N m s/rad or N s/m");
    /// Inertia, or mass where the coordinate is a way.
    pub const INERTIA_OR_MASS: Self = positive("kg m² or kg");
    /// Amplitude of a vibration, in whatever unit.
    pub const AMPLITUDE: Self = not_negative("");
    /// A weight of balancing, in whatever unit.
    pub const WEIGHT: Self = not_negative("");
    /// A place along a rotor, either way from where it is counted.
    pub const PLACE: Self = Quantity { least: -1e4, most: 1e4, zero: true, whole: false, unit: "m" };
    /// Speed in turns a minute.
    pub const RPM: Self = positive("rpm");
    /// Balance quality grade.
    pub const GRADE: Self = positive("mm/s");
    /// Number of something on a rotor.
    pub const COUNT: Self = Quantity { least: 1.0, most: 360.0, whole: true, ..positive("") };
    /// A share of a whole.
    pub const SHARE: Self = Quantity { least: 1e-9, most: 1.0, ..not_negative("") };

    /// Whether a number is one of this quantity's.
    pub fn allows(self, number: f64) -> bool {
        let within = number >= self.least && number <= self.most || self.zero && number == 0.0;
        within && (!self.whole || number.fract() == 0.0)
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.whole { "a whole number" } else { "a number" };
        let zero = if self.zero { "zero or " } else { "" };
        write!(f, "{kind}, {zero}{} to {}", Short(self.least), Short(self.most))?;
        if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

/// A number as people write it: plain where that is short, a large power of two as one, with an exponent elsewhere.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        let exponent = self.0.log2();
        if exponent >= 20.0 && exponent.fract() == 0.0 {
            write!(f, "2^{exponent}")
        } else if size != 0.0 && !(1e-3..1e6).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", (self.0 * 1e3).round() / 1e3)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Quantity;

    #[test]
    fn ranges_refuse_what_no_machine_has() {
        for absurd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e300, 1e-300] {
            assert!(!Quantity::INERTIA.allows(absurd), "{absurd}");
        }
        assert!(Quantity::DAMPING.allows(0.0));
        assert!(!Quantity::DAMPING.allows(-0.1));
        assert!(!Quantity::FALLS.allows(2.5));
        assert!(!Quantity::EFFICIENCY.allows(1.01));
    }
}
