//! Dry friction in the pins of a slider-crank or a four-bar that is driven forwards.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::error::{PlantError, finite, in_range, not_negative};
use super::super::event::Place;
use super::crank::{Crank, Work};
use super::linkage::{FourBar, Orders};
use super::mesh::Harmonic;
use super::series::{Series, Turn, ZERO, product, quotient};

/// Angles of a turn at which a train's pins are tried for jamming.
const TRIED: i32 = 4096;

/// Pins of a slider-crank: the main bearing of the crank, the crank pin, and the wrist pin at the slider.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pins {
    /// Coefficient of friction of all three.
    pub coefficient: f64,
    /// Radius of the main bearing, m.
    pub main: f64,
    /// Radius of the crank pin, m.
    pub crank: f64,
    /// Radius of the wrist pin, m.
    pub wrist: f64,
}

/// Pins of a four-bar: the main bearing of the crank, the crank pin, the pin between coupler and rocker, and the pivot
/// of the rocker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FourBarPins {
    /// Coefficient of friction of all four.
    pub coefficient: f64,
    /// Radius of the main bearing, m.
    pub main: f64,
    /// Radius of the crank pin, m.
    pub crank: f64,
    /// Radius of the pin between coupler and rocker, m.
    pub rocker: f64,
    /// Radius of the rocker's pivot, m.
    pub pivot: f64,
}

/// A force (N) on the slider of a crank, or a torque (N m) on the rocker of a four-bar, from one angle of the crank to
/// another, rad: `from` within a turn, `to` behind it by a turn at most. A force is positive outwards, away from the
/// crank, a torque as the rocker's angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeLoad {
    /// Force, N, or torque, N m.
    pub load: f64,
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
}

impl Pins {
    /// The torque at the crank that the pins take under a force of 1 N in the rod along the slider's way, of either
    /// sense, at an angle (rad): `mu/cos beta (r_main + r_crank (1 + beta') + r_wrist |beta'|)`, `beta` the angle of
    /// the rod to the slider's way and `beta'` its derivative by the angle of the crank. Derived: the rod passes on the
    /// force over `cos beta`, and each pin turns in its eye at the difference of the speeds of its two parts.
    ///
    /// Of the first order in the coefficient: friction turns the forces in the pins by the friction circles, which this
    /// leaves out.
    #[must_use]
    pub fn loss(&self, crank: &Crank, angle: f64) -> f64 {
        let lambda = crank.radius / crank.rod;
        let upright = (1.0 - (lambda * angle.sin()).powi(2)).sqrt();
        let swing = lambda * angle.cos() / upright;
        self.coefficient * (self.main + self.crank * (1.0 + swing) + self.wrist * swing.abs()) / upright
    }
}

impl FourBarPins {
    /// The torque at the crank that the pins take under a torque of 1 N m on the rocker, of either sense, at an angle
    /// of the crank (rad): `mu/(c sin(psi - theta)) (r_main + r_crank (1 - theta') + r_rocker |theta' - psi'| +
    /// r_pivot |psi'|)`, `theta` and `psi` the angles of coupler and rocker, with their derivatives by that of the
    /// crank, `c` the rocker. Derived: the coupler passes on the torque over its arm about the rocker's pivot, and
    /// each pin turns in its eye at the difference of the speeds of its two parts. Of the first order in the
    /// coefficient, as [`Pins::loss`].
    #[must_use]
    pub fn loss(&self, bars: &FourBar, angle: f64) -> f64 {
        let [coupler, rocker] = bars.rates(angle);
        self.smooth(bars, angle, [(coupler - rocker).signum(), rocker.signum()])
    }

    /// The same with the senses in which the coupler turns on the rocker, and the rocker.
    fn smooth(&self, bars: &FourBar, angle: f64, senses: [f64; 2]) -> f64 {
        let ([theta, psi], [coupler, rocker]) = (bars.angles(angle), bars.rates(angle));
        let slips = self.main
            + self.crank * (1.0 - coupler)
            + self.rocker * senses[0] * (coupler - rocker)
            + self.pivot * senses[1] * rocker;
        self.coefficient * slips / (bars.rocker * (psi - theta).sin().abs())
    }
}

/// The parts of a mechanism in whose pins there is friction.
#[derive(Debug, Clone, PartialEq)]
enum Parts {
    /// The coordinate's own crank.
    Crank(Pins),
    FourBar(Box<Rocker>),
}

#[derive(Debug, Clone, PartialEq)]
struct Rocker {
    bars: FourBar,
    pins: FourBarPins,
    /// About its pivot, kg m2.
    inertia: f64,
    /// Its speed per speed of the crank.
    slope: Orders,
    /// What the pins take, by the senses: both backwards, the rocker forwards, the coupler forwards, both.
    loss: [Orders; 4],
}

/// Which of the four a pair of senses is.
fn quarter(senses: [f64; 2]) -> usize {
    2 * usize::from(senses[0] > 0.0) + usize::from(senses[1] > 0.0)
}

/// Pins with what loads them beside the mass of the slider or the inertia of the rocker.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pinned {
    parts: Parts,
    /// Angles, rad within a turn and rising, at which a load begins or ends or the turning in a pin reverses.
    ends: Vec<f64>,
    /// From each end to the next: force on the slider, N, or torque on the rocker, N m, and the senses in which the
    /// pins turn: the rod, or the coupler on the rocker and the rocker.
    pieces: Vec<(f64, [f64; 2])>,
}

impl Pinned {
    /// None where nothing rubs; numbers out of range are kept for [`validate`](Self::validate).
    pub fn of(pins: Pins, loads: &[StrokeLoad]) -> Option<Self> {
        let rub = rubs(pins.coefficient, &[pins.main, pins.crank, pins.wrist], loads);
        let senses = |angle: f64| [angle.cos().signum(), 1.0];
        rub.then(|| Self::pieces(Parts::Crank(pins), &[FRAC_PI_2, 3.0 * FRAC_PI_2], loads, senses))
    }

    /// The same for a four-bar, whose rocker has an inertia about its pivot, kg m2.
    pub fn four_bar(bars: FourBar, inertia: f64, pins: FourBarPins, loads: &[StrokeLoad]) -> Option<Self> {
        if !rubs(pins.coefficient, &[pins.main, pins.crank, pins.rocker, pins.pivot], loads) {
            return None;
        }
        let loss = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]]
            .map(|senses| Orders::sampled(|angle| pins.smooth(&bars, angle, senses)));
        let slope = Orders::sampled(|angle| bars.rates(angle)[1]);
        let [stretched, folded] = bars.dead_centres();
        let senses = |angle: f64| {
            let [coupler, rocker] = bars.rates(angle);
            [(coupler - rocker).signum(), rocker.signum()]
        };
        let parts = Parts::FourBar(Box::new(Rocker { bars, pins, inertia, slope, loss }));
        // the angle between coupler and rocker is least and greatest where the crank lies along the ground
        Some(Self::pieces(parts, &[0.0, PI, stretched, folded], loads, senses))
    }

    fn pieces(parts: Parts, corners: &[f64], loads: &[StrokeLoad], senses: impl Fn(f64) -> [f64; 2]) -> Self {
        let turns = |angle: f64| angle.rem_euclid(TAU);
        let mut ends: Vec<f64> = loads.iter().flat_map(|load| [turns(load.from), turns(load.to)]).collect();
        ends.extend(corners);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let next = ends.iter().skip(1).copied().chain([ends[0] + TAU]);
        let piece = |(from, to): (&f64, f64)| {
            let middle = 0.5 * (from + to);
            let acts = |load: &&StrokeLoad| turns(middle - load.from) < load.to - load.from;
            (loads.iter().filter(acts).map(|load| load.load).sum(), senses(middle))
        };
        let pieces = ends.iter().zip(next).map(piece).collect();
        Self { parts, ends, pieces }
    }

    /// Ends that lie at or before an angle, rad.
    pub fn passed(&self, angle: f64) -> i64 {
        let turn = (angle / TAU).floor();
        let within = self.ends.iter().filter(|end| **end <= angle - TAU * turn).count();
        turn as i64 * self.ends.len() as i64 + within as i64
    }

    /// Angle of the end after so many, rad.
    pub fn end(&self, passed: i64) -> f64 {
        let count = self.ends.len() as i64;
        TAU * passed.div_euclid(count) as f64 + self.ends[passed.rem_euclid(count) as usize]
    }

    /// Force on the slider, N, or torque on the rocker, N m, and the senses of the pins behind so many ends.
    pub fn piece(&self, passed: i64) -> (f64, [f64; 2]) {
        self.pieces[(passed - 1).rem_euclid(self.pieces.len() as i64) as usize]
    }

    /// The mass of the slider, kg, or the inertia of the rocker, kg m2.
    fn moved(&self, crank: Option<Crank>) -> f64 {
        match &self.parts {
            Parts::Crank(_) => crank.map_or(0.0, |crank| crank.slider_mass),
            Parts::FourBar(rocker) => rocker.inertia,
        }
    }

    /// Whether the slider, the rocker or a load on it presses on the pins.
    pub fn is_loaded(&self, crank: Option<Crank>) -> bool {
        self.moved(crank) > 0.0 || self.pieces.iter().any(|piece| piece.0 != 0.0)
    }

    /// Pins of a slider-crank.
    pub fn of_crank(&self) -> Option<&Pins> {
        if let Parts::Crank(pins) = &self.parts { Some(pins) } else { None }
    }

    /// Those of a four-bar, with its bars and the inertia of its rocker.
    pub fn of_four_bar(&self) -> Option<(&FourBarPins, &FourBar, f64)> {
        if let Parts::FourBar(rocker) = &self.parts { Some((&rocker.pins, &rocker.bars, rocker.inertia)) } else { None }
    }

    /// What swings with the angle of a four-bar.
    pub fn orders(&self) -> impl Iterator<Item = &Orders> {
        let rocker = if let Parts::FourBar(rocker) = &self.parts { Some(rocker) } else { None };
        rocker.into_iter().flat_map(|rocker| rocker.loss.iter().chain([&rocker.slope]))
    }

    /// The pins take their torque from what the rod or coupler carries, and that carries what speeds the slider or the
    /// rocker up. Where a change of that torque would change the force by as much again, the crank jams. With the
    /// coordinate's inertia (kg m2) at an angle (rad).
    pub fn validate(&self, crank: Option<Crank>, inertia: impl Fn(f64) -> f64, place: Place) -> Result<(), PlantError> {
        let (coefficient, radii, load, lighter) = match &self.parts {
            Parts::Crank(pins) => (
                pins.coefficient,
                vec![pins.main, pins.crank, pins.wrist],
                ["force on a slider", "end of a force on a slider"],
                "pins that let the crank turn: less friction, smaller radii, a lighter slider or more inertia of the \
                 crank",
            ),
            Parts::FourBar(four) => (
                four.pins.coefficient,
                vec![four.pins.main, four.pins.crank, four.pins.rocker, four.pins.pivot],
                ["torque on a rocker", "end of a torque on a rocker"],
                "pins that let the crank turn: less friction, smaller radii, less inertia of the rocker or more of \
                 the crank",
            ),
        };
        not_negative("coefficient of friction of the pins", place, coefficient)?;
        radii.into_iter().try_for_each(|radius| not_negative("radius of a pin", place, radius))?;
        self.ends.iter().try_for_each(|end| finite(load[1], place, *end))?;
        self.pieces.iter().try_for_each(|piece| finite(load[0], place, piece.0))?;
        let of_crank = |crank: Crank| {
            let mass = crank.slider_mass;
            let pins = self.of_crank().copied();
            move |angle: f64| mass * crank.slope(angle).abs() * pins.map_or(0.0, |pins| pins.loss(&crank, angle))
        };
        let share: Box<dyn Fn(f64) -> f64> = match (&self.parts, crank) {
            (Parts::Crank(_), Some(crank)) => Box::new(of_crank(crank)),
            (Parts::Crank(_), None) => {
                let expected = "pins of a coordinate with a crank";
                return Err(PlantError::Parameter { name: "pins", place, value: coefficient, expected });
            }
            (Parts::FourBar(rocker), _) => {
                not_negative("inertia of a rocker", place, rocker.inertia)?;
                let turning = "a crank as the shortest bar, which with the longest one is shorter than the other two";
                let turns = rocker.bars.is_crank_rocker();
                in_range("crank of a four-bar", place, rocker.bars.crank, turns, turning)?;
                let resolved = self.orders().flat_map(|orders| &orders.0).all(|h| h.cosine.is_finite());
                let apart = "bars that are not so near to lying in one line";
                in_range("crank between the pins", place, rocker.bars.crank, resolved, apart)?;
                let Rocker { bars, pins, inertia, .. } = **rocker;
                Box::new(move |angle| inertia * bars.rates(angle)[1].abs() * pins.loss(&bars, angle))
            }
        };
        let angles = (0..TRIED).map(|i| TAU * f64::from(i) / f64::from(TRIED));
        let most = angles.map(|angle| share(angle) / inertia(angle)).fold(0.0, f64::max);
        in_range("coefficient of friction of the pins", place, coefficient, most < 0.99, lighter)
    }
}

/// Whether there is friction, or a number out of range.
fn rubs(coefficient: f64, radii: &[f64], loads: &[StrokeLoad]) -> bool {
    let is_size = |value: &f64| *value >= 0.0 && value.is_finite();
    let mut given = loads.iter().flat_map(|load| [load.load, load.from, load.to]);
    let in_range = radii.iter().chain([&coefficient]).all(is_size) && given.all(f64::is_finite);
    !in_range || (coefficient > 0.0 && radii.iter().any(|radius| *radius > 0.0))
}

/// Where a pinned crank is: ends passed, and the sense of the force in its rod or coupler.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pinning {
    /// The coordinate.
    pub at: usize,
    pub passed: i64,
    /// Of the force along the slider's way that the rod takes from the slider, positive outwards; of the torque that
    /// the coupler takes from the rocker.
    pub pull: f64,
}

/// The pins' loss over a stretch and what it does to the inertia, as series. `g` is [`Pins::loss`] or
/// [`FourBarPins::loss`], `y` the way of the slider or the angle of the rocker, `m` its mass or inertia, `F` the force
/// or torque on it, `s` the sense of `Q = F - m d(y' w)/dt`. They take `s g Q`, so that
///
/// `(J + m y' (y' - s g)) w' + m y'' (y' - s g) w^2 = torque + F y' - s g F`.
#[derive(Debug, Clone)]
pub(super) struct Loss {
    profile: Profile,
    mass: f64,
    load: f64,
    pull: f64,
    /// `y'`.
    slope: Series,
    /// `g`, and its derivative by the angle.
    loss: Series,
    loss_slope: Series,
}

/// Where `g` and `y'` come from.
#[derive(Debug, Clone)]
enum Profile {
    Crank { pins: Pins, sense: f64, over: Box<[Series; 2]> },
    FourBar { slope: Vec<(Harmonic, Turn)>, loss: Vec<(Harmonic, Turn)> },
}

impl Loss {
    pub fn new(pinned: &Pinned, pinning: &Pinning, crank: Option<Crank>) -> Self {
        let (load, senses) = pinned.piece(pinning.passed);
        let turns = |orders: &Orders| orders.0.iter().map(|h| (*h, Turn::new(h.order))).collect();
        let profile = match &pinned.parts {
            Parts::Crank(pins) => Profile::Crank { pins: *pins, sense: senses[0], over: Box::new([ZERO; 2]) },
            Parts::FourBar(rocker) => {
                Profile::FourBar { slope: turns(&rocker.slope), loss: turns(&rocker.loss[quarter(senses)]) }
            }
        };
        let mass = pinned.moved(crank);
        Self { profile, mass, load, pull: pinning.pull, slope: ZERO, loss: ZERO, loss_slope: ZERO }
    }

    /// Fills in coefficient `k` from those of the angle, and of a crank, up to it; what is added to that of the
    /// inertia, and to that of what the square of the speed pushes by.
    pub fn extend(&mut self, crank: Option<(&Crank, &Work)>, angle: &Series, k: usize) -> [f64; 2] {
        match &mut self.profile {
            Profile::Crank { pins, sense, over } => {
                let Some((crank, work)) = crank else { return [0.0; 2] };
                let [loss_over, loss_slope_over] = &mut **over;
                let (r, one) = (crank.radius, if k == 0 { 1.0 } else { 0.0 });
                let Pins { coefficient, main, crank: pin, wrist } = *pins;
                let size = coefficient * crank.rod;
                let swing = size * (pin + *sense * wrist) * r;
                // g S = mu l (r_main + r_crank + (r_crank +- r_wrist) r L), and S' = -r^2 u
                loss_over[k] = size * (main + pin) * one + swing * work.lean[k];
                self.loss[k] = quotient(loss_over, &work.reach, &self.loss, k);
                loss_slope_over[k] = swing * work.lean_slope[k] + r * r * product(&self.loss, &work.share, k);
                self.loss_slope[k] = quotient(loss_slope_over, &work.reach, &self.loss_slope, k);
                self.slope[k] = work.slider[0][k];
            }
            Profile::FourBar { slope, loss } => {
                for (h, turn) in slope {
                    turn.extend(angle, k);
                    self.slope[k] += h.cosine * turn.cosine[k] + h.sine * turn.sine[k];
                }
                for (h, turn) in loss {
                    turn.extend(angle, k);
                    self.loss[k] += h.cosine * turn.cosine[k] + h.sine * turn.sine[k];
                    self.loss_slope[k] += h.order * (h.sine * turn.cosine[k] - h.cosine * turn.sine[k]);
                }
            }
        }
        let mass = -self.pull * self.mass;
        [mass * product(&self.loss, &self.slope, k), mass * product(&self.loss_slope, &self.slope, k)]
    }

    /// Coefficient `k` of the torque of the pins under the force on the slider or the torque on the rocker.
    pub fn torque(&self, k: usize) -> f64 {
        -self.pull * self.load * self.loss[k]
    }

    /// Coefficient `k` of the force that the rod takes from the slider, or the torque that the coupler takes from the
    /// rocker, and what sizes its rounding, from coefficient `k + 1` of the speed, of which `step` is the time.
    pub fn carried(&self, speed: &Series, k: usize, step: f64) -> (f64, f64) {
        let load = if k == 0 { self.load } else { 0.0 };
        let mass = self.mass / step;
        let size: f64 = (0..=k + 1).map(|i| (self.slope[i] * speed[k + 1 - i]).abs()).sum();
        (load - mass * product(&self.slope, speed, k + 1), load.abs() + mass * size)
    }
}
