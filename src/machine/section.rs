//! Shafts from their dimensions: stepped, hollow and tapered.

use core::f64::consts::PI;

use super::error::{not_negative, positive};
use super::{Density, Diameter, Error, Inertia, Length, ShearModulus, Stiffness};

impl ShearModulus {
    /// Steel, 79.3 GPa: E = 206 GPa over 2 (1 + 0.3) [EN 1993-1-1 takes 81 GPa].
    pub const STEEL: Self = Self(79.3e9);
}

impl Density {
    /// Steel, 7850 kg/m3 [EN 1991-1-1, table A.4].
    pub const STEEL: Self = Self(7850.0);
}

/// A piece of a shaft: a cylinder or a cone, solid or with a cylindrical bore.
///
/// A section twists by `tau/(G J_p(x))` along its length, `J_p = pi (D^4 - d^4)/32`; the sections of a stepped shaft
/// carry one torque, so that their compliances add up [Wang 1989 §1-3, (1-16)].
///
/// ```
/// use driveline::machine::{Chain, Damping, Diameter, Inertia, Length, Section, ShearModulus, Stiffness, stepped};
///
/// const SHAFT: [Section; 3] = [
///     Section::solid(Length(0.30), Diameter(0.060)),
///     Section::tapered(Length(0.05), Diameter(0.060), Diameter(0.080)),
///     Section::solid(Length(0.45), Diameter(0.080)).bored(Diameter(0.030)),
/// ];
/// const K: Stiffness = stepped(&SHAFT, ShearModulus::STEEL);
/// const DRIVE: Chain = Chain::motor(Inertia(0.2)).shaft(K, Damping(1.0)).rotor(Inertia(1.5));
/// assert!((DRIVE.shafts()[0].stiffness - K.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Section {
    /// Length (m).
    pub length: Length,
    /// Outer diameter at either end (m).
    pub diameter: [Diameter; 2],
    /// Diameter of the bore (m), 0 for a solid section.
    pub bore: Diameter,
}

impl Section {
    /// A solid cylinder.
    #[must_use]
    pub const fn solid(length: Length, diameter: Diameter) -> Self {
        Self { length, diameter: [diameter; 2], bore: Diameter(0.0) }
    }

    /// A solid cone from one diameter to another.
    #[must_use]
    pub const fn tapered(length: Length, from: Diameter, to: Diameter) -> Self {
        Self { length, diameter: [from, to], bore: Diameter(0.0) }
    }

    /// The same with a cylindrical bore along the axis.
    #[must_use]
    pub const fn bored(mut self, bore: Diameter) -> Self {
        self.bore = bore;
        self
    }

    /// Whether every dimension is in its range.
    ///
    /// # Errors
    /// [`Error::SectionLength`], [`Error::SectionDiameter`].
    pub const fn check(&self) -> Result<(), Error> {
        let (a, b, bore) = (self.diameter[0].0, self.diameter[1].0, self.bore.0);
        if !positive(self.length.0) {
            Err(Error::SectionLength)
        } else if !(positive(a) && positive(b) && not_negative(bore) && bore < a && bore < b) {
            Err(Error::SectionDiameter)
        } else {
            Ok(())
        }
    }

    /// Integral of `dx/(D^4 - d^4)` over the section (1/m3).
    ///
    /// A cylinder and a solid cone in closed form. A bored cone in partial fractions has the difference of two near
    /// equal terms where the taper is slight. It is integrated by Gauss and Legendre's rule of 16 points on 8 equal
    /// pieces: within 1e-12 up to ends as two to one and a bore of nine tenths of the thin end.
    const fn slenderness(&self) -> f64 {
        let (l, a, b, bore) = (self.length.0, self.diameter[0].0, self.diameter[1].0, self.bore.0);
        if a == b {
            return l / ((a - bore) * (a + bore) * (a * a + bore * bore));
        }
        if bore == 0.0 {
            let product = a * b;
            return l * (a * a + product + b * b) / (3.0 * product * product * product);
        }
        let pieces = 8;
        let mut sum = 0.0;
        each!(piece, 0..pieces, {
            each!(point, 0..8, {
                let (at, weight) = GAUSS[point];
                let mut side = -1.0;
                while side < 2.0 {
                    let x = (piece as f64 + 0.5 * (1.0 + side * at)) / pieces as f64;
                    let d = a + (b - a) * x;
                    sum += weight / ((d - bore) * (d + bore) * (d * d + bore * bore));
                    side += 2.0;
                }
            });
        });
        l * sum / (2.0 * pieces as f64)
    }

    /// Torsional stiffness (N m/rad).
    ///
    /// # Panics
    /// At compile time in a constant, where a dimension is out of its range.
    #[must_use]
    pub const fn stiffness(&self, modulus: ShearModulus) -> Stiffness {
        stepped(&[*self], modulus)
    }

    stops! {
        /// Moment of inertia about the axis (kg m2).
        pub const fn inertia(&self, density: Density) -> Inertia = try_inertia
    }

    /// [`inertia`](Self::inertia), with an error for a value out of range.
    ///
    /// # Errors
    /// As [`check`](Self::check), and [`Error::Density`].
    pub const fn try_inertia(&self, density: Density) -> Result<Inertia, Error> {
        get!(self.check());
        if !positive(density.0) {
            return Err(Error::Density);
        }
        let (a, b, bore) = (self.diameter[0].0, self.diameter[1].0, self.bore.0);
        let (a2, b2, bore2) = (a * a, b * b, bore * bore);
        // The mean of D^4 over a cone.
        let mean = (a2 * a2 + a2 * a * b + a2 * b2 + a * b * b2 + b2 * b2) / 5.0;
        Ok(Inertia(density.0 * PI / 32.0 * self.length.0 * (mean - bore2 * bore2)))
    }
}

/// Torsional stiffness of a stepped shaft (N m/rad): its sections in series.
///
/// # Panics
/// At compile time in a constant, where a dimension or the modulus is out of its range or there is no section.
#[must_use]
pub const fn stepped(sections: &[Section], modulus: ShearModulus) -> Stiffness {
    or_stop!(try_stepped(sections, modulus))
}

/// [`stepped`], with an error for a value out of range.
///
/// # Errors
/// [`Error::ShearModulus`], [`Error::SectionLength`] (of no section too), [`Error::SectionDiameter`].
pub const fn try_stepped(sections: &[Section], modulus: ShearModulus) -> Result<Stiffness, Error> {
    if !positive(modulus.0) {
        return Err(Error::ShearModulus);
    }
    if sections.is_empty() {
        return Err(Error::SectionLength);
    }
    let mut sum = 0.0;
    each!(j, 0..sections.len(), {
        get!(sections[j].check());
        sum += sections[j].slenderness();
    });
    Ok(Stiffness(modulus.0 * PI / (32.0 * sum)))
}

/// Points and weights of Gauss and Legendre's rule of 16 points, one side of it
/// [Abramowitz and Stegun 1964, table 25.4].
const GAUSS: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_4, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_7, 0.149_595_988_816_576_73),
    (0.755_404_408_355_003, 0.124_628_971_255_533_87),
    (0.865_631_202_387_831_7, 0.095_158_511_682_492_78),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_89),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_095),
];
