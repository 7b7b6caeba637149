//! Stiffness that changes with time: tooth pairs that come into contact and leave it `[Tang 1994 ch. 1]`.

use std::f64::consts::TAU;

use super::super::error::{PlantError, finite, in_range, positive};
use super::super::event::Place;
use super::series::{Series, ZERO, add_harmonic};

/// One zone of a mesh cycle: as long as it lasts the same tooth pairs are in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zone {
    /// How long, s, above zero.
    pub duration: f64,
    /// Of all pairs in contact, N/m, above zero.
    pub stiffness: f64,
    /// `sum k_i e_i` over the pairs in contact, `e_i` the tooth error (m) that closes the mesh, N.
    pub error_force: f64,
}

/// One harmonic: `cosine cos(order omega t) + sine sin(order omega t)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harmonic {
    /// Multiple of the base frequency.
    pub order: f64,
    /// Of the unit of what swings.
    pub cosine: f64,
    /// Of the unit of what swings.
    pub sine: f64,
}

/// How the stiffness of a link goes with time.
#[derive(Debug, Clone, PartialEq)]
pub enum Variation {
    /// Zones that follow each other for ever; the first begins at time zero.
    Zones(Vec<Zone>),
    /// About the link's stiffness, N/m or N m/rad, and a tooth error, m or rad, that closes the link.
    Harmonics {
        /// Base frequency, Hz, above zero.
        frequency: f64,
        /// Of the stiffness; together below it.
        stiffness: Vec<Harmonic>,
        /// Of the error.
        error: Vec<Harmonic>,
    },
}

impl Variation {
    /// The zones of a spur pair with rectangular stiffness: `contact_ratio - 1` of the pitch with two pairs in
    /// contact, then the rest with one. `stiffness` is of one pair in either zone, N/m; `frequency` of the mesh, Hz.
    /// The error (m) stands on every second pair, so that a cycle lasts two pitches.
    #[must_use]
    pub fn spur(contact_ratio: f64, frequency: f64, double: f64, single: f64, error: f64) -> Self {
        let pitch = 1.0 / frequency;
        let (two, one) = ((contact_ratio - 1.0) * pitch, (2.0 - contact_ratio) * pitch);
        let pair = 0.5 * double;
        let zone = |duration, stiffness, error_force| Zone { duration, stiffness, error_force };
        Self::Zones(vec![
            zone(two, double, error * pair),
            zone(one, single, error * single),
            zone(two, double, error * pair),
            zone(one, single, 0.0),
        ])
    }

    /// Length of a cycle, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        match self {
            Self::Zones(zones) => zones.iter().map(|zone| zone.duration).sum(),
            Self::Harmonics { frequency, .. } => 1.0 / frequency,
        }
    }

    /// Mean stiffness over a cycle.
    #[must_use]
    pub fn mean(&self, stiffness: f64) -> f64 {
        match self {
            Self::Zones(zones) => zones.iter().map(|zone| zone.duration * zone.stiffness).sum::<f64>() / self.period(),
            Self::Harmonics { .. } => stiffness,
        }
    }

    /// The zone at a time: its place in the list, and when it ends, s.
    pub(super) fn zone_at(zones: &[Zone], time: f64) -> (usize, f64) {
        let period: f64 = zones.iter().map(|zone| zone.duration).sum();
        let mut cycle = (time / period).floor() - 1.0;
        // the same sums decide what has begun and what comes next, so that no rounding can skip a zone
        loop {
            let mut passed = 0.0;
            for (index, zone) in zones.iter().enumerate() {
                passed += zone.duration;
                let last = index + 1 == zones.len();
                let end = if last { (cycle + 1.0) * period } else { cycle * period + passed };
                if end > time {
                    return (index, end);
                }
            }
            cycle += 1.0;
        }
    }

    /// The next switch after `time`, s.
    pub(super) fn corner_after(&self, time: f64) -> Option<f64> {
        match self {
            Self::Zones(zones) => Some(Self::zone_at(zones, time).1),
            Self::Harmonics { .. } => None,
        }
    }

    /// Stiffness over a stretch, and the error that closes the link.
    pub(super) fn over(&self, stiffness: f64, t: f64, h: f64) -> (Series, Series) {
        let (mut k, mut e) = (ZERO, ZERO);
        match self {
            Self::Zones(zones) => {
                let zone = zones[Self::zone_at(zones, t).0];
                k[0] = zone.stiffness;
                e[0] = zone.error_force / zone.stiffness;
            }
            Self::Harmonics { frequency, stiffness: swings, error } => {
                k[0] = stiffness;
                for (into, harmonics) in [(&mut k, swings), (&mut e, error)] {
                    for harmonic in harmonics {
                        let omega = TAU * frequency * harmonic.order;
                        add_harmonic(into, (harmonic.cosine, harmonic.sine), omega, t, h);
                    }
                }
            }
        }
        (k, e)
    }

    /// Greatest stiffness, and the fastest rate, 1/s, at which it swings.
    pub(super) fn bounds(&self, stiffness: f64) -> (f64, f64) {
        match self {
            Self::Zones(zones) => (zones.iter().map(|zone| zone.stiffness).fold(0.0, f64::max), 0.0),
            Self::Harmonics { frequency, stiffness: swings, error } => {
                let rise: f64 = swings.iter().map(|h| h.cosine.hypot(h.sine)).sum();
                let order = swings.iter().chain(error).map(|h| h.order.abs()).fold(0.0, f64::max);
                (stiffness + rise, TAU * frequency * order)
            }
        }
    }

    pub(super) fn validate(&self, place: Place, stiffness: f64) -> Result<(), PlantError> {
        match self {
            Self::Zones(zones) => {
                if zones.is_empty() {
                    return Err(PlantError::Count { name: "zones of a mesh", found: 0, expected: 1 });
                }
                for zone in zones {
                    positive("duration of a zone", place, zone.duration)?;
                    positive("stiffness of a zone", place, zone.stiffness)?;
                    finite("error of a zone", place, zone.error_force)?;
                }
                Ok(())
            }
            Self::Harmonics { frequency, stiffness: swings, error } => {
                positive("mesh frequency", place, *frequency)?;
                for harmonic in swings.iter().chain(error) {
                    finite("order of a harmonic", place, harmonic.order)?;
                    finite("harmonic", place, harmonic.cosine)?;
                    finite("harmonic", place, harmonic.sine)?;
                }
                let rise: f64 = swings.iter().map(|h| h.cosine.hypot(h.sine)).sum();
                in_range("swing of the stiffness", place, rise, rise < stiffness, "less than the mean stiffness")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zone_begins_when_the_one_before_it_ends() {
        let Variation::Zones(zones) = Variation::spur(1.6, 710.0, 2.0, 1.0, 0.1) else { panic!("zones") };
        let mut time = 0.0;
        for step in 0..10_000 {
            let (index, end) = Variation::zone_at(&zones, time);
            assert_eq!(index, step % 4);
            time = end;
        }
        // ten thousand zones are 5000 pitches, each boundary rounded once
        assert!((time - 5000.0 / 710.0).abs() < 1e-14);
    }
}
