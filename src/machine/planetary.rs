//! A planetary set of one sun, planets, a ring and a carrier (2K-H), any of sun, ring and carrier held.

use super::error::{not_negative, positive};
use super::{Chain, Efficiency, Error, Inertia, Mass, Ratio};

/// A planetary set; by default with the sun as input, the ring held and the carrier as output [Wang 1989 example 1-4].
/// [`PlanetaryGear`] has other inputs and held members.
///
/// Speeds follow from Willis: seen from the carrier, sun and ring turn as
/// `z_sun (w_sun - w_H) = -z_ring (w_ring - w_H)`, and a planet as `z_planet (w - w_H) = -z_sun (w_sun - w_H)`
/// \[derived\]. The inertia at the input is that of each part times the square of its speed over the input's [Wang 1989
/// example 1-4].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias = "epicyclic gear")]
pub struct Planetary {
    /// Teeth of the sun.
    pub sun_teeth: u32,
    /// Teeth of the ring.
    pub ring_teeth: u32,
    /// Module (m).
    pub module: f64,
    /// Number of planets.
    pub planets: u32,
    /// Inertia of the sun (kg m2).
    pub sun: Inertia,
    /// Inertia of one planet about its own axis (kg m2).
    pub planet: Inertia,
    /// Mass of one planet (kg).
    pub planet_mass: Mass,
    /// Inertia of the carrier without the planets (kg m2).
    pub carrier: Inertia,
    /// Efficiency of the set.
    pub efficiency: Efficiency,
}

impl Planetary {
    /// Speed of the sun over speed of the carrier: `(z_sun + z_ring)/z_sun`.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        (self.sun_teeth as f64 + self.ring_teeth as f64) / self.sun_teeth as f64
    }

    /// Speed of a planet about its own axis in space over speed of the sun (negative: it turns against the sun).
    #[must_use]
    pub const fn planet_speed(&self) -> f64 {
        // z_planet = (z_ring - z_sun)/2; relative to the carrier the ring turns at -omega_H and drives the planet.
        let planet_teeth = (self.ring_teeth as f64 - self.sun_teeth as f64) / 2.0;
        (1.0 - self.ring_teeth as f64 / planet_teeth) / self.ratio()
    }

    /// Inertia of the whole set at the sun (kg m2), without losses.
    #[must_use]
    pub const fn inertia_at_sun(&self) -> f64 {
        let carrier_speed = 1.0 / self.ratio();
        let planet_teeth = (self.ring_teeth as f64 - self.sun_teeth as f64) / 2.0;
        let radius = self.module * (self.sun_teeth as f64 + planet_teeth) / 2.0;
        let spin = self.planet_speed();
        let planet =
            self.planet.0 * spin * spin + self.planet_mass.0 * (radius * carrier_speed) * (radius * carrier_speed);
        self.sun.0 + self.planets as f64 * planet + self.carrier.0 * carrier_speed * carrier_speed
    }

    /// Checks common to every input member.
    const fn check(&self) -> Result<(), Error> {
        if self.sun_teeth == 0 || self.ring_teeth <= self.sun_teeth || self.planets == 0 {
            return Err(Error::PlanetaryTeeth);
        }
        let parts = not_negative(self.sun.0)
            && not_negative(self.planet.0)
            && not_negative(self.planet_mass.0)
            && not_negative(self.carrier.0);
        if positive(self.module) && parts { Ok(()) } else { Err(Error::PlanetaryInertia) }
    }
}

/// A member of a planetary set: input, held, or output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Member {
    /// The sun.
    Sun,
    /// The ring.
    Ring,
    /// The carrier of the planets.
    Carrier,
}

/// A planetary set with one member as input and another held; the third is the output.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlanetaryGear {
    /// The set.
    pub set: Planetary,
    /// Inertia of the ring (kg m2).
    pub ring: Inertia,
    /// The member on the motor's side.
    pub input: Member,
    /// The held member.
    pub held: Member,
}

impl PlanetaryGear {
    /// Speeds of sun, ring, carrier and planet (about its own axis in space) over that of the input; negative where
    /// opposite to it.
    const fn speeds(&self) -> [f64; 4] {
        let (sun, ring) = (self.set.sun_teeth as f64, self.set.ring_teeth as f64);
        let both = sun + ring;
        let [w_sun, w_ring, w_carrier] = match (self.input, self.held) {
            (Member::Sun, Member::Ring) => [1.0, 0.0, sun / both],
            (Member::Carrier, Member::Ring) => [both / sun, 0.0, 1.0],
            (Member::Ring, Member::Sun) => [0.0, 1.0, ring / both],
            (Member::Carrier, Member::Sun) => [0.0, both / ring, 1.0],
            (Member::Sun, Member::Carrier) => [1.0, -sun / ring, 0.0],
            (Member::Ring, Member::Carrier) => [-ring / sun, 1.0, 0.0],
            // refused by `check`
            _ => [f64::NAN; 3],
        };
        let planet = (ring - sun) / 2.0;
        [w_sun, w_ring, w_carrier, w_carrier - (w_sun - w_carrier) * sun / planet]
    }

    /// Speed of the input over that of the output; negative where opposite, as with the carrier held.
    #[must_use]
    pub const fn ratio(&self) -> f64 {
        let [sun, ring, carrier, _] = self.speeds();
        1.0 / match (self.input, self.held) {
            (Member::Ring | Member::Carrier, Member::Carrier | Member::Ring) => sun,
            (Member::Sun | Member::Carrier, Member::Carrier | Member::Sun) => ring,
            _ => carrier,
        }
    }

    /// Inertia of the whole set at the input (kg m2), without losses.
    #[must_use]
    pub const fn inertia(&self) -> f64 {
        let [sun, ring, carrier, planet] = self.speeds();
        let set = &self.set;
        let planet_teeth = (set.ring_teeth as f64 - set.sun_teeth as f64) / 2.0;
        let way = set.module * (set.sun_teeth as f64 + planet_teeth) / 2.0 * carrier;
        let planets = set.planets as f64 * (set.planet.0 * planet * planet + set.planet_mass.0 * way * way);
        set.sun.0 * sun * sun + planets + set.carrier.0 * carrier * carrier + self.ring.0 * ring * ring
    }
}

impl Chain {
    /// A planetary set with one member on the present mass and another held; the following elements turn with the
    /// third. Its direction is left out: it does not affect a chain.
    ///
    /// Refused: [`Error::PlanetaryMembers`], and those of [`planetary`](Self::planetary).
    #[must_use]
    pub const fn planetary_gear(self, gear: PlanetaryGear) -> Self {
        if matches!(
            (gear.input, gear.held),
            (Member::Sun, Member::Sun) | (Member::Ring, Member::Ring) | (Member::Carrier, Member::Carrier)
        ) {
            return self.refuse(Error::PlanetaryMembers);
        }
        if let Err(error) = gear.set.check() {
            return self.refuse(error);
        }
        if !(not_negative(gear.ring.0) && positive(gear.inertia())) {
            return self.refuse(Error::PlanetaryInertia);
        }
        self.with_set(gear.inertia(), gear.ratio().abs(), gear.set.efficiency)
    }

    /// A planetary set with its sun on the present mass; the following elements turn with the carrier.
    ///
    /// Refused: [`Error::PlanetaryTeeth`], [`Error::PlanetaryInertia`], [`Error::GearEfficiency`],
    /// [`Error::RotaryAfterDrum`].
    #[must_use]
    pub const fn planetary(self, set: Planetary) -> Self {
        if let Err(error) = set.check() {
            return self.refuse(error);
        }
        if !positive(set.inertia_at_sun()) {
            return self.refuse(Error::PlanetaryInertia);
        }
        self.with_set(set.inertia_at_sun(), set.ratio(), set.efficiency)
    }

    /// A shaft that ends in the set carries its losses.
    const fn with_set(self, inertia: f64, ratio: f64, efficiency: Efficiency) -> Self {
        let ends_in_shaft = self.ends_in_shaft();
        let chain = self.rotor(Inertia(inertia)).gear(Ratio(ratio), efficiency);
        if ends_in_shaft { chain.settle() } else { chain }
    }
}
