//! Any drive train: chains, branches and closed loops, gear meshes, torsion with lateral motion, cranks, unbalances,
//! friction.
//!
//! A train is a list of coordinates (angles, or ways of a mass) and of links between any of them. Each link has an
//! elongation that is a sum over coordinates, so that a shaft, a geared shaft, a bearing and a tooth mesh are the
//! same thing with other terms:
//!
//! `J_j v_j' = torques_j - viscous_j v_j - sum_l c_lj F_l`, `F_l = k_l(t) x_l + d_l dx_l/dt`, `x_l = sum_j c_lj q_j -
//! error - half the gap` `[Pfützner 1980 (1.6)]`, `[Tang 1994 (1.5)]`; with a crank `J w' + J'(phi)
//! w^2/2` stands on the left `[derived]`.
//!
//! Between events (a flank met or left, a stop, a slip, a switch of stiffness, a corner of a torque) the motion is
//! the sum of its Taylor series, which for a linear train is the series of the matrix exponential; a linear train
//! without events goes through a whole tick by the exponential itself. A stretch is made so short that what is left
//! out lies below rounding: nothing is approximated but by the last digit of `f64`, not with a stiffness that swings
//! nor with a motor's curve either. Events are the roots of those polynomials, isolated by bounds, so that a grazing
//! contact is found whatever the length of the tick.
//!
//! | term | meaning | unit |
//! |---|---|---|
//! | coordinate | an angle or a way, with its inertia or mass | rad or m; kg m2 or kg |
//! | link | elongation `x`, stiffness `k`, damping `d`, force `F` | rad or m; N m/rad or N/m; N m or N |
//! | dynamic factor | greatest force of a link over its static or mean force | 1 |
//!
//! ```
//! use driveline_solver::plant::train::{Coordinate, Link, Signal, Source, Train};
//! // one motor drives two rolls through a pinion stand: a branch behind each shaft
//! let mut stand = Train::new()
//!     .coordinate(Coordinate::new(12.0).source(Source::Constant(800.0)))
//!     .coordinate(Coordinate::new(3.0).source(Source::Constant(-400.0)))
//!     .coordinate(Coordinate::new(3.0).source(Source::Constant(-400.0)))
//!     .link(Link::shaft(0, 1, 2.0e5).damping(40.0))
//!     .link(Link::shaft(0, 2, 2.0e5).damping(40.0).gap(0.01))
//!     .build()?;
//! stand.watch(Signal::Force(0));
//! for _ in 0..1000 {
//!     stand.advance(1e-4);
//! }
//! let peak = stand.extremes(Signal::Force(0)).map(|e| e.peak);
//! assert!(peak > Some(500.0));
//! # Ok::<(), driveline_solver::plant::PlantError>(())
//! ```

pub mod converge;
mod coupling;
mod crank;
mod event;
mod friction;
mod leap;
mod link;
mod linkage;
mod mesh;
mod modes;
mod motion;
mod pins;
pub(super) mod plant;
mod rank;
mod reading;
mod rigid;
mod rigid_gear;
mod rubbing;
mod series;
mod signal;
mod sized;
mod source;
mod spur_pair;
mod start;
mod state;
mod steady;
mod stiffest;
mod stretch;
mod unbalance;
mod varying;

pub use crank::Crank;
pub use friction::Friction;
pub use link::Link;
pub use linkage::{FourBar, Orders, Toggle};
pub use mesh::{Harmonic, Teeth, Variation, Zone};
pub use modes::TrainModes;
pub use motion::Motion;
use pins::Pinned;
pub use pins::{FourBarPins, Pins, StrokeLoad};
pub(super) use rank::Elimination;
pub use rigid::RigidPart;
pub use rigid_gear::RigidGear;
pub use rubbing::rubbing;
pub use signal::Signal;
pub use source::{Source, Waveform};
pub use spur_pair::{SpurBearing, SpurPair, SpurWheel};
pub use steady::Cycle;
pub use stiffest::Stiffest;
pub use unbalance::Unbalance;

use super::error::{PlantError, finite, in_range, not_negative, positive};
use super::event::Place;

/// An angle or a way, and what acts on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Coordinate {
    inertia: f64,
    viscous: f64,
    speed: f64,
    angle: f64,
    crank: Option<Crank>,
    pins: Option<Pinned>,
    law: Option<Orders>,
    gear: Option<RigidGear>,
    sources: Vec<Source>,
}

impl Coordinate {
    /// Of this inertia, kg m2, or mass, kg, above zero; at rest at zero.
    #[must_use]
    pub fn new(inertia: f64) -> Self {
        Self {
            inertia,
            viscous: 0.0,
            speed: 0.0,
            angle: 0.0,
            crank: None,
            pins: None,
            law: None,
            gear: None,
            sources: Vec::new(),
        }
    }

    /// With viscous friction to the ground, N m s/rad, zero or above.
    #[must_use]
    pub fn viscous(mut self, viscous: f64) -> Self {
        self.viscous = viscous;
        self
    }

    /// With this speed at the start, rad/s.
    #[must_use]
    pub fn speed(mut self, speed: f64) -> Self {
        self.speed = speed;
        self
    }

    /// With this angle at the start, rad. It does not stretch a link; see [`Link::elongated`].
    #[must_use]
    pub fn angle(mut self, angle: f64) -> Self {
        self.angle = angle;
        self
    }

    /// With a crank, rod and slider.
    #[must_use]
    pub fn crank(mut self, crank: Crank) -> Self {
        self.crank = Some(crank);
        self
    }

    /// With dry friction in the pins of its crank, which only turns forwards. Their forces are those of the slider's
    /// mass and of these forces on it, which act on the crank by sources of their own; forces at the same angle add.
    /// The mass of the rod does not load them.
    #[must_use]
    pub fn pins(mut self, pins: Pins, forces: &[StrokeLoad]) -> Self {
        self.pins = Pinned::of(pins, forces);
        self
    }

    /// With dry friction in the pins of a four-bar behind it, whose crank only turns forwards. Their forces are those
    /// of the rocker's inertia about its pivot (kg m2), which is part of the [law of inertia](Self::inertia_law), and
    /// of these torques on the rocker, which act on the crank by sources of their own. The mass of the coupler does
    /// not load them.
    #[must_use]
    pub fn four_bar_pins(
        mut self,
        bars: FourBar,
        rocker_inertia: f64,
        pins: FourBarPins,
        torques: &[StrokeLoad],
    ) -> Self {
        self.pins = Pinned::four_bar(bars, rocker_inertia, pins, torques);
        self
    }

    /// Whether dry friction in its pins takes a torque, so that it may only turn forwards.
    #[must_use]
    pub fn has_loaded_pins(&self) -> bool {
        self.pins.as_ref().is_some_and(|pins| pins.is_loaded(self.crank))
    }

    /// With an inertia by its angle beside its own, kg m2: of a mechanism behind it.
    #[must_use]
    pub fn inertia_law(mut self, law: Orders) -> Self {
        self.law = Some(law);
        self
    }

    /// With a lossy gear in it, which has no shaft behind it.
    #[must_use]
    pub fn gear(mut self, gear: RigidGear) -> Self {
        self.gear = Some(gear);
        self
    }

    /// With a torque more.
    #[must_use]
    pub fn source(mut self, source: Source) -> Self {
        self.sources.push(source);
        self
    }

    fn is_cranked(&self) -> bool {
        self.crank.is_some() || self.pins.is_some() || self.law.is_some()
    }

    /// Inertia at an angle, rad, with what a crank or a law adds; kg m2 or kg.
    fn inertia_at(&self, angle: f64) -> f64 {
        let crank = self.crank.map_or(0.0, |crank| crank.inertia(angle).0);
        self.inertia + crank + self.law.as_ref().map_or(0.0, |law| law.at(angle))
    }
}

/// The description of a train.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Train {
    coordinates: Vec<Coordinate>,
    links: Vec<Link>,
    frictions: Vec<Friction>,
    unbalances: Vec<Unbalance>,
}

impl Train {
    /// Of nothing yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// With one coordinate more. They are counted from 0.
    #[must_use]
    pub fn coordinate(mut self, coordinate: Coordinate) -> Self {
        self.coordinates.push(coordinate);
        self
    }

    /// With a torque more on a coordinate that is there already; on none that is not.
    #[must_use]
    pub fn source(mut self, coordinate: usize, source: Source) -> Self {
        if let Some(coordinate) = self.coordinates.get_mut(coordinate) {
            coordinate.sources.push(source);
        }
        self
    }

    /// With a lossy gear in a coordinate that is there already; in none that is not.
    #[must_use]
    pub fn gear(mut self, coordinate: usize, gear: RigidGear) -> Self {
        if let Some(coordinate) = self.coordinates.get_mut(coordinate) {
            coordinate.gear = Some(gear);
        }
        self
    }

    /// With one link more, counted from 0.
    #[must_use]
    pub fn link(mut self, link: Link) -> Self {
        self.links.push(link);
        self
    }

    /// With dry friction, counted from 0.
    #[must_use]
    pub fn friction(mut self, friction: Friction) -> Self {
        self.frictions.push(friction);
        self
    }

    /// With an unbalance that couples two coordinates.
    #[must_use]
    pub fn unbalance(mut self, unbalance: Unbalance) -> Self {
        self.unbalances.push(unbalance);
        self
    }

    /// Gives a coordinate so much dry friction against the ground: which friction that is, and whether it is a new one,
    /// 1, or one that is gone, -1.
    fn rub(&mut self, at: usize, torque: f64) -> (usize, i8) {
        match self.ground_friction(at) {
            None if torque == 0.0 => (0, 0),
            None => {
                self.frictions.push(Friction::ground(at, torque));
                (self.frictions.len() - 1, 1)
            }
            Some(s) if torque == 0.0 && self.frictions[s].losses.is_empty() => {
                self.frictions.remove(s);
                (s, -1)
            }
            Some(s) => {
                (self.frictions[s].kinetic, self.frictions[s].breakaway) = (torque, torque);
                (s, 0)
            }
        }
    }

    fn validate(&self) -> Result<(), PlantError> {
        if self.coordinates.is_empty() {
            return Err(PlantError::Count { name: "coordinates of a train", found: 0, expected: 1 });
        }
        for (j, coordinate) in self.coordinates.iter().enumerate() {
            let place = Place::Node(j);
            positive("inertia", place, coordinate.inertia)?;
            not_negative("viscous friction", place, coordinate.viscous)?;
            finite("speed at the start", place, coordinate.speed)?;
            finite("angle at the start", place, coordinate.angle)?;
            coordinate.crank.map_or(Ok(()), |crank| crank.validate(place))?;
            if let Some(pins) = &coordinate.pins {
                pins.validate(coordinate.crank, |angle| coordinate.inertia_at(angle), Place::Pins(j))?;
            }
            if let Some(law) = &coordinate.law {
                let least = law.least();
                in_range("law of inertia", place, least, least + coordinate.inertia > 0.0, "an inertia above zero")?;
            }
            coordinate.sources.iter().try_for_each(|source| source.validate(place))?;
        }
        for (l, link) in self.links.iter().enumerate() {
            link.validate(l, self.coordinates.len())?;
        }
        for friction in &self.frictions {
            friction.validate(self.coordinates.len())?;
        }
        for unbalance in &self.unbalances {
            self.validate_unbalance(unbalance)?;
        }
        self.validate_gears()?;
        match self.rubbing_crank() {
            Some((friction, at)) => Err(PlantError::Parameter {
                name: "dry friction against what moves, on a crank or mechanism,",
                place: Place::Node(at),
                value: self.frictions[friction].kinetic,
                expected: "friction against the ground at rest, or on another coordinate, behind a shaft",
            }),
            None => Ok(()),
        }
    }

    /// A dry friction against what moves, on a coordinate whose inertia changes with its angle: its index and that of
    /// the coordinate. What rests on the ground rests at any inertia; what is held to something that moves does not.
    pub fn rubbing_crank(&self) -> Option<(usize, usize)> {
        let moving = self.frictions.iter().enumerate().filter(|(_, one)| one.terms.len() > 1 || one.surface != 0.0);
        let mut rubbing = moving.flat_map(|(index, one)| one.terms.iter().map(move |term| (index, term.0)));
        rubbing.find(|&(_, at)| self.coordinates.get(at).is_some_and(Coordinate::is_cranked))
    }

    fn validate_unbalance(&self, unbalance: &Unbalance) -> Result<(), PlantError> {
        let n = self.coordinates.len();
        for at in [unbalance.turning, unbalance.way] {
            if at >= n {
                return Err(PlantError::Count { name: "coordinate of an unbalance", found: at, expected: n });
            }
        }
        if unbalance.turning == unbalance.way {
            return Err(PlantError::Count { name: "coordinates of an unbalance", found: 1, expected: 2 });
        }
        let place = Place::Node(unbalance.turning);
        finite("gravity of an unbalance", place, unbalance.gravity)?;
        let shared =
            |at: usize| self.unbalances.iter().filter(|other| [other.turning, other.way].contains(&at)).count() as f64;
        // with every coupling of a coordinate below its share, the inertias together stay positive
        let product = self.coordinates[unbalance.turning].inertia * self.coordinates[unbalance.way].inertia;
        let most = (product / (shared(unbalance.turning) * shared(unbalance.way))).sqrt();
        in_range(
            "moment of an unbalance",
            place,
            unbalance.moment,
            unbalance.moment.abs() < most,
            "less than its inertias carry",
        )?;
        let lossy = self.links.iter().filter(|link| link.is_lossy()).map(|link| link.terms[0].0);
        let rubbing = self.frictions.iter().flat_map(|friction| friction.terms.iter().map(|term| term.0));
        let cranked = (0..n).filter(|&at| self.coordinates[at].is_cranked());
        match lossy.chain(rubbing).chain(cranked).find(|&at| at == unbalance.turning || at == unbalance.way) {
            Some(at) => Err(PlantError::Parameter {
                name: "unbalance with dry friction, a lossy gear or a crank",
                place: Place::Node(at),
                value: unbalance.moment,
                expected: "those on another coordinate, behind a shaft",
            }),
            None => Ok(()),
        }
    }
}
