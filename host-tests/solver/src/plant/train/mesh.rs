//! Stiffness that changes with time: tooth pairs that come into contact and leave it `[Tang 1994 §1.1]`.

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
    /// `sum k_i e_i` over the pairs in contact, `e_i` the tooth error (m) that opens the mesh, N.
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

/// A spur pair with rectangular stiffness by the angle of its pinion; see [`Variation::spur`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Teeth {
    /// The coordinate whose angle counts.
    pub coordinate: usize,
    /// Teeth on a turn of it, above zero.
    pub count: f64,
    /// Between 1 and 2.
    pub contact_ratio: f64,
    /// Stiffness with two pairs in contact, N/m.
    pub double: f64,
    /// Stiffness with one pair in contact, N/m.
    pub single: f64,
    /// Stiffness of the pair that leaves, in double contact, N/m; half of `double` where both are alike.
    pub leaving: f64,
    /// Errors of one pair and the next, m.
    pub errors: [f64; 2],
}

impl Teeth {
    /// The angle, rad, at which a zone begins: double contact at even numbers, single at odd ones.
    pub(super) fn edge(&self, number: i64) -> f64 {
        let within = if number.rem_euclid(2) == 0 { 0.0 } else { self.contact_ratio - 1.0 };
        (number.div_euclid(2) as f64 + within) * TAU / self.count
    }

    /// The number of the zone that comes next after an angle.
    pub(super) fn next_edge(&self, angle: f64) -> i64 {
        let mut number = 2 * (angle * self.count / TAU).floor() as i64 - 1;
        while self.edge(number) <= angle {
            number += 1;
        }
        number
    }

    /// Error of both pairs together, by their stiffness: `sum k_i e_i/sum k_i`.
    fn double_error(&self, odd: bool) -> f64 {
        let [enters, leaves] = [usize::from(odd), usize::from(!odd)].map(|pair| self.errors[pair]);
        let share = self.leaving / self.double;
        (1.0 - share) * enters + share * leaves
    }

    /// Stiffness and error in front of an edge.
    pub(super) fn before(&self, edge: i64) -> (f64, f64) {
        let zone = edge - 1;
        let odd_pitch = zone.div_euclid(2).rem_euclid(2) == 1;
        match (zone.rem_euclid(2) == 0, odd_pitch) {
            (true, odd) => (self.double, self.double_error(odd)),
            (false, false) => (self.single, self.errors[0]),
            (false, true) => (self.single, self.errors[1]),
        }
    }
}

/// How the stiffness of a link goes with time.
#[derive(Debug, Clone, PartialEq)]
pub enum Variation {
    /// Zones that repeat without end; the first begins at time zero.
    Zones(Vec<Zone>),
    /// Zones of a spur pair that the angle of a coordinate goes through pitch by pitch, forwards or backwards; the
    /// first pitch begins at the angle zero. The mesh frequency follows the speed.
    Teeth(Teeth),
    /// About the link's stiffness, N/m or N m/rad, and a tooth error, m or rad, that opens the link.
    Harmonics {
        /// Base frequency, Hz, above zero.
        frequency: f64,
        /// Of the stiffness; together below it.
        stiffness: Vec<Harmonic>,
        error: Vec<Harmonic>,
    },
}

impl Variation {
    /// The zones of a spur pair with rectangular stiffness: `contact_ratio - 1` of the pitch with two pairs in
    /// contact, then the rest with one. `stiffness` is of one pair in either zone, N/m; `frequency` of the mesh, Hz.
    /// The error (m) stands on every second pair, so that a cycle lasts two pitches.
    #[must_use]
    pub fn spur(contact_ratio: f64, frequency: f64, double: f64, single: f64, error: f64) -> Self {
        Self::pairs(contact_ratio, frequency, [double, 0.5 * double], single, [error, 0.0])
    }

    /// [`spur`](Self::spur) with pairs of their own stiffness and error: in double contact of both pairs and of the one
    /// that leaves, N/m; of one pair and the next, m.
    #[must_use]
    pub fn pairs(
        contact_ratio: f64,
        frequency: f64,
        [double, leaving]: [f64; 2],
        single: f64,
        [one_error, next_error]: [f64; 2],
    ) -> Self {
        let pitch = 1.0 / frequency;
        let (two, one) = ((contact_ratio - 1.0) * pitch, (2.0 - contact_ratio) * pitch);
        let entering = double - leaving;
        let zone = |duration, stiffness, error_force| Zone { duration, stiffness, error_force };
        Self::Zones(vec![
            zone(two, double, entering * one_error + leaving * next_error),
            zone(one, single, single * one_error),
            zone(two, double, entering * next_error + leaving * one_error),
            zone(one, single, single * next_error),
        ])
    }

    /// Mean stiffness over a cycle.
    #[must_use]
    pub fn mean(&self, stiffness: f64) -> f64 {
        match self {
            Self::Zones(zones) => {
                let cycle: f64 = zones.iter().map(|zone| zone.duration).sum();
                zones.iter().map(|zone| zone.duration * zone.stiffness).sum::<f64>() / cycle
            }
            Self::Teeth(teeth) => (teeth.contact_ratio - 1.0) * (teeth.double - teeth.single) + teeth.single,
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
            Self::Teeth(_) | Self::Harmonics { .. } => None,
        }
    }

    /// Stiffness over a stretch, and the error that opens the link; `edge` is the tooth edge ahead.
    pub(super) fn over(&self, stiffness: f64, t: f64, h: f64, edge: i64) -> (Series, Series) {
        let (mut k, mut e) = (ZERO, ZERO);
        match self {
            Self::Zones(zones) => {
                let zone = zones[Self::zone_at(zones, t).0];
                k[0] = zone.stiffness;
                e[0] = zone.error_force / zone.stiffness;
            }
            Self::Teeth(teeth) => (k[0], e[0]) = teeth.before(edge),
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
            Self::Teeth(teeth) => (teeth.double.max(teeth.single), 0.0),
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
            Self::Teeth(teeth) => {
                positive("number of teeth", place, teeth.count)?;
                positive("stiffness of double contact", place, teeth.double)?;
                positive("stiffness of single contact", place, teeth.single)?;
                teeth.errors.iter().try_for_each(|error| finite("tooth error", place, *error))?;
                let within = teeth.leaving >= 0.0 && teeth.leaving <= teeth.double;
                in_range("stiffness of the leaving pair", place, teeth.leaving, within, "from 0 to that of both")?;
                let ratio = teeth.contact_ratio;
                in_range("contact ratio", place, ratio, ratio > 1.0 && ratio < 2.0, "between 1 and 2")
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
    use crate::plant::train::mesh::*;

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
