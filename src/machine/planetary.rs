//! A planetary set of one sun, planets, a held ring and a carrier as output (2K-H).

use super::error::{not_negative, positive};
use super::{Chain, Efficiency, Error, Inertia, Mass, Ratio};

/// A planetary set driven at the sun, with the ring held and the carrier as output [Wang 1989 example 1-4].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Planetary {
    /// Teeth of the sun.
    pub sun_teeth: u32,
    /// Teeth of the ring.
    pub ring_teeth: u32,
    /// Module \[m\].
    pub module: f64,
    /// Number of planets.
    pub planets: u32,
    /// Inertia of the sun \[kg m2\].
    pub sun: Inertia,
    /// Inertia of one planet about its own axis \[kg m2\].
    pub planet: Inertia,
    /// Mass of one planet \[kg\].
    pub planet_mass: Mass,
    /// Inertia of the carrier without the planets \[kg m2\].
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

    /// Inertia of the whole set at the sun \[kg m2\], without losses.
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

    /// Inertia of the whole set at the carrier \[kg m2\], without losses: `ratio^2` of that at the sun.
    #[must_use]
    pub const fn inertia_at_carrier(&self) -> f64 {
        self.inertia_at_sun() * self.ratio() * self.ratio()
    }
}

impl Chain {
    /// A planetary set with its sun on the present mass; what follows turns with the carrier.
    #[must_use]
    pub const fn planetary(self, set: Planetary) -> Self {
        match self.try_planetary(set) {
            Ok(chain) => chain,
            Err(error) => error.stop(),
        }
    }

    /// [`planetary`](Self::planetary), with an error for a value out of range.
    ///
    /// # Errors
    /// [`Error::PlanetaryTeeth`], [`Error::PlanetaryInertia`], [`Error::GearEfficiency`], [`Error::RotaryAfterDrum`].
    pub const fn try_planetary(self, set: Planetary) -> Result<Self, Error> {
        if set.sun_teeth == 0 || set.ring_teeth <= set.sun_teeth || set.planets == 0 {
            return Err(Error::PlanetaryTeeth);
        }
        if !(positive(set.module)
            && not_negative(set.sun.0)
            && not_negative(set.planet.0)
            && not_negative(set.planet_mass.0)
            && not_negative(set.carrier.0)
            && positive(set.inertia_at_sun()))
        {
            return Err(Error::PlanetaryInertia);
        }
        match self.try_rotor(Inertia(set.inertia_at_sun())) {
            Ok(chain) => chain.try_gear(Ratio(set.ratio()), set.efficiency),
            Err(error) => Err(error),
        }
    }
}
