//! A chain of elements, from the motor on, referred to the motor's shaft as it is built.

mod readings;

use super::error::{not_negative, positive};
use super::refer::{Flow, Side, refer_gap, refer_inertia, refer_stiffness};
use super::{Damping, Efficiency, Error, Gap, Inertia, Ratio, Stiffness};

/// The most masses that a chain can hold, the motor included.
pub const CAPACITY: usize = 16;

/// A shaft or rope of a chain, referred to the motor.
///
/// ```
/// use driveline::machine::{Chain, Damping, Efficiency, Inertia, Ratio, Shaft, Stiffness};
/// // behind a gear of 5 a stiffness is 25 times smaller at the motor
/// const ROLL: Chain = Chain::motor(Inertia(0.4)).gear(Ratio(5.0), Efficiency(0.97))
///     .shaft(Stiffness(5.0e5), Damping(10.0)).rotor(Inertia(12.0));
/// let Shaft { stiffness, efficiency, .. } = ROLL.shafts()[0];
/// assert!((stiffness - 2.0e4).abs() < 1e-9 && (efficiency - 0.97).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Shaft {
    /// Stiffness (N m/rad).
    pub stiffness: f64,
    /// Viscous damping (N m s/rad).
    pub damping: f64,
    /// Whole free travel of the backlash in series with it (rad); 0 without one.
    pub gap: f64,
    /// Efficiency of the gears between its two masses while the motor drives.
    pub efficiency: f64,
    /// The same while the load drives.
    pub back_efficiency: f64,
}

/// Efficiencies of a chain on either side of its softest shaft, each while the motor drives and while the load does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Losses {
    /// Between the motor and the shaft.
    pub before: [f64; 2],
    /// Between the shaft and the load.
    pub behind: [f64; 2],
}

/// Efficiencies of two gears in a row, while the motor drives and while the load does. Where the second one locks, the
/// motor has to drive the first.
pub(super) const fn in_a_row(first: [f64; 2], second: [f64; 2]) -> [f64; 2] {
    let back = if second[1] > 0.0 { first[1] * second[1] } else { second[1] / first[0] };
    [first[0] * second[0], back]
}

impl Shaft {
    pub(crate) const NONE: Self =
        Self { stiffness: 0.0, damping: 0.0, gap: 0.0, efficiency: 1.0, back_efficiency: 1.0 };
}

/// A machine as an ordered chain from the motor, referred to the motor's shaft.
///
/// Each element follows the one before it. A [`shaft`](Self::shaft) or [`rope`](Self::rope) opens a new mass, which
/// stays empty until a rotor, a planetary set or a mass is put on it; two shafts with nothing between them become
/// one (stiffnesses in series, gaps added, damping by equal loss). A backlash belongs to the shaft before it when
/// nothing lies between, or else to the next one.
///
/// The losses of a gear belong to the next shaft; where a shaft ends in the gear and another one follows, and in a
/// belt, to the shaft before. With no shaft after it they act between the last shaft and the load
/// ([`losses`](Self::losses)), not on a branch on its mass.
///
/// The chain is referred without losses, as the observer requires: energy is conserved, and friction, constant or slow,
/// becomes part of the estimated load torque, unless the chain begins with [`starting`](Self::starting) or
/// [`braking`](Self::braking).
///
/// ```
/// use driveline::machine::{Chain, Damping, Inertia, Stiffness};
/// let roll = Chain::motor(Inertia(0.35)).shaft(Stiffness(2.0e4), Damping(0.5)).rotor(Inertia(0.48));
/// assert!((roll.total_inertia() - 0.83).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Chain {
    pub(super) inertia: [f64; CAPACITY],
    pub(super) shaft: [Shaft; CAPACITY - 1],
    pub(super) count: usize,
    /// Motor turns per turn of the present shaft.
    pub(super) ratio: f64,
    /// Travel per motor angle (m/rad) once a drum has been passed, 0 before.
    pub(super) travel: f64,
    pub(super) efficiency: f64,
    /// The same while the load drives.
    pub(super) back_efficiency: f64,
    pub(super) flow: Flow,
    /// A gap that waits for the next shaft (rad).
    pub(super) gap: f64,
    /// Largest twist of a shaft per torque of the motor (rad/(N m)).
    twist: f64,
    /// Efficiencies that wait for the next shaft, while the motor drives and while the load does.
    waiting: [f64; 2],
    /// Those of gears that the last shaft ends in.
    ending: [f64; 2],
    /// Weight torque without losses (N m).
    pub(super) gravity: f64,
    /// Lengths of the rope (m): the shortest, that of its stiffness, the longest; zeros without them.
    pub(super) lengths: [f64; 3],
    /// The least and the largest load (kg); zeros without them.
    pub(super) loads: [f64; 2],
    /// The first element that was refused, and why.
    pub(super) error: Option<Error>,
}

impl Chain {
    /// Begins a chain with the motor's own inertia (kg m2).
    ///
    /// An element that is wrong, or that cannot follow, is left out, and the chain carries the first such
    /// [`error`](Self::error) to its end: what is made of the chain stops with its sentence, or returns it from its
    /// `try_` form.
    ///
    /// Refused: [`Error::MotorInertia`].
    #[must_use]
    pub const fn motor(inertia: Inertia) -> Self {
        let right = positive(inertia.0);
        let mut masses = [0.0; CAPACITY];
        masses[0] = if right { inertia.0 } else { 1.0 };
        Self {
            inertia: masses,
            shaft: [Shaft::NONE; CAPACITY - 1],
            count: 1,
            ratio: 1.0,
            travel: 0.0,
            efficiency: 1.0,
            back_efficiency: 1.0,
            flow: Flow::Lossless,
            gap: 0.0,
            twist: 0.0,
            waiting: [1.0; 2],
            ending: [1.0; 2],
            gravity: 0.0,
            lengths: [0.0; 3],
            loads: [0.0; 2],
            error: if right { None } else { Some(Error::MotorInertia) },
        }
    }

    /// Leaves an element out.
    pub(super) const fn refuse(mut self, error: Error) -> Self {
        if self.error.is_none() {
            self.error = Some(error);
        }
        self
    }

    /// Why an element was refused, the first one that was.
    #[must_use]
    pub const fn error(&self) -> Option<Error> {
        self.error
    }

    /// Refers the following elements with the losses of motoring: inertias and stiffnesses over the efficiency
    /// [Huang 1987 tables 1-2 to 1-4].
    #[must_use]
    pub const fn starting(mut self) -> Self {
        self.flow = Flow::Motoring;
        self
    }

    /// Refers the following elements with the losses of overhauling: inertias and stiffnesses times the efficiency
    /// [Huang 1987 tables 1-2 to 1-4].
    #[must_use]
    pub const fn braking(mut self) -> Self {
        self.flow = Flow::Overhauling;
        self
    }

    /// A shaft to the next mass: stiffness (N m/rad) and damping (N m s/rad) on its own speed.
    ///
    /// Refused: [`Error::ShaftStiffness`], [`Error::ShaftDamping`], [`Error::RotaryAfterDrum`],
    /// [`Error::TooManyMasses`].
    #[must_use]
    pub const fn shaft(self, stiffness: Stiffness, damping: Damping) -> Self {
        if self.travel != 0.0 {
            return self.refuse(Error::RotaryAfterDrum);
        }
        let referred = refer_stiffness(stiffness.0, self.ratio, self.loss(), Side::Load, self.flow);
        if !positive(stiffness.0) || !positive(referred) {
            return self.refuse(Error::ShaftStiffness);
        }
        if !not_negative(damping.0) {
            return self.refuse(Error::ShaftDamping);
        }
        let mut this = self.link(referred, refer_stiffness(damping.0, self.ratio, self.loss(), Side::Load, self.flow));
        this.twist = this.twist.max(this.ratio / stiffness.0);
        this
    }

    /// Largest twist of a [`shaft`](Self::shaft) under a torque of the motor that the load holds (rad, on the shaft's
    /// own ends); belts and ropes are left out.
    #[must_use]
    pub const fn largest_twist(&self, torque: f64) -> f64 {
        self.twist * torque
    }

    /// A rotor on the present mass: inertia (kg m2) on its own speed.
    ///
    /// Refused: [`Error::RotorInertia`], [`Error::RotaryAfterDrum`].
    #[must_use]
    pub const fn rotor(mut self, inertia: Inertia) -> Self {
        if self.travel != 0.0 {
            return self.refuse(Error::RotaryAfterDrum);
        }
        let referred = refer_inertia(inertia.0, self.ratio, self.loss(), Side::Load, self.flow);
        if !positive(inertia.0) || !positive(referred) {
            return self.refuse(Error::RotorInertia);
        }
        self.inertia[self.count - 1] += referred;
        self
    }

    /// A gear: the following elements turn `ratio` times slower. Its wheels are rotors before and after it.
    ///
    /// Refused: [`Error::GearRatio`], [`Error::GearEfficiency`], [`Error::RotaryAfterDrum`].
    #[must_use]
    pub const fn gear(self, ratio: Ratio, efficiency: Efficiency) -> Self {
        self.lossy(ratio, efficiency, efficiency)
    }

    const fn lossy(mut self, ratio: Ratio, efficiency: Efficiency, back: Efficiency) -> Self {
        if self.travel != 0.0 {
            return self.refuse(Error::RotaryAfterDrum);
        }
        if !positive(ratio.0) || !positive(self.ratio * ratio.0) {
            return self.refuse(Error::GearRatio);
        }
        if !(efficiency.0 > 0.0 && efficiency.0 <= 1.0 && back.0.is_finite() && back.0 <= 1.0) {
            return self.refuse(Error::GearEfficiency);
        }
        self.ratio *= ratio.0;
        [self.efficiency, self.back_efficiency] =
            in_a_row([self.efficiency, self.back_efficiency], [efficiency.0, back.0]);
        self.waiting = in_a_row(self.waiting, [efficiency.0, back.0]);
        if self.ends_in_shaft() { self.settle() } else { self }
    }

    /// Whether the last mass is still empty.
    pub(super) const fn ends_in_shaft(&self) -> bool {
        self.count > 1 && self.inertia[self.count - 1] == 0.0
    }

    /// Gives the efficiencies that wait to the end of the last shaft.
    pub(super) const fn settle(mut self) -> Self {
        self.ending = in_a_row(self.ending, self.waiting);
        self.waiting = [1.0; 2];
        self
    }

    /// Gives the efficiencies at the end of the last shaft to that shaft.
    pub(super) const fn close(mut self) -> Self {
        if self.count > 1 {
            let last = &mut self.shaft[self.count - 2];
            [last.efficiency, last.back_efficiency] = in_a_row([last.efficiency, last.back_efficiency], self.ending);
            self.ending = [1.0; 2];
        }
        self
    }

    /// Efficiencies before and behind the softest shaft.
    ///
    /// The two masses that stand for the chain have the torque of that shaft. A chain without a shaft has all its
    /// losses before it.
    #[must_use]
    pub const fn losses(&self) -> Losses {
        let mut softest = 0;
        each!(j, 1.., j + 1 < self.count, {
            if self.shaft[j].stiffness < self.shaft[softest].stiffness {
                softest = j;
            }
        });
        let mut before = [1.0; 2];
        let mut behind = [1.0; 2];
        each!(j, 0.., j + 1 < self.count, {
            let Shaft { efficiency, back_efficiency, .. } = self.shaft[j];
            let side = if j <= softest { &mut before } else { &mut behind };
            *side = in_a_row(*side, [efficiency, back_efficiency]);
        });
        let end = if self.count > 1 { &mut behind } else { &mut before };
        *end = in_a_row(*end, in_a_row(self.ending, self.waiting));
        Losses { before, behind }
    }

    /// A gear that loses more while the load drives it, such as a worm: efficiency with the motor driving, then with
    /// the load driving. With equal losses in both directions the second is `2 - 1/first`. A gear whose second is
    /// zero or below locks itself: lowering needs the motor to drive.
    ///
    /// Refused: as [`gear`](Self::gear).
    #[must_use]
    pub const fn worm(self, ratio: Ratio, driving: Efficiency, driven: Efficiency) -> Self {
        self.lossy(ratio, driving, driven)
    }

    /// The efficiency that the chain is referred with.
    pub(super) const fn loss(&self) -> f64 {
        match self.flow {
            Flow::Overhauling => self.back_efficiency,
            Flow::Motoring | Flow::Lossless => self.efficiency,
        }
    }

    /// A backlash: the whole free travel (rad) on its own speed. Referred to the motor it is `ratio` times as wide.
    ///
    /// Refused: [`Error::BacklashGap`], [`Error::RotaryAfterDrum`].
    #[must_use]
    pub const fn backlash(self, gap: Gap) -> Self {
        if self.travel != 0.0 {
            return self.refuse(Error::RotaryAfterDrum);
        }
        if !not_negative(gap.0) {
            return self.refuse(Error::BacklashGap);
        }
        self.slacken(refer_gap(gap.0, self.ratio, Side::Load))
    }

    /// Puts a gap (rad at the motor) in series with the shaft before it, or keeps it for the next one.
    pub(super) const fn slacken(mut self, gap: f64) -> Self {
        if self.ends_in_shaft() {
            self.shaft[self.count - 2].gap += gap;
        } else {
            self.gap += gap;
        }
        self
    }

    /// Adds a referred shaft: a new mass, or a spring in series where the present mass is empty.
    pub(super) const fn link(self, stiffness: f64, damping: f64) -> Self {
        let mut this = self.close();
        if this.inertia[this.count - 1] == 0.0 {
            let last = &mut this.shaft[this.count - 2];
            let joined = super::refer::series(last.stiffness, stiffness);
            // Both carry one torque: the losses d (tau/k)^2 of each add up.
            let (a, b) = (joined / last.stiffness, joined / stiffness);
            last.damping = last.damping * a * a + damping * b * b;
            last.stiffness = joined;
            last.gap += this.gap;
        } else if this.count == CAPACITY {
            return this.refuse(Error::TooManyMasses);
        } else {
            let [efficiency, back_efficiency] = this.waiting;
            this.shaft[this.count - 1] = Shaft { stiffness, damping, gap: this.gap, efficiency, back_efficiency };
            this.count += 1;
        }
        this.gap = 0.0;
        this.waiting = [1.0; 2];
        this
    }

    /// The chain with its last shaft and the two masses of it alone: what follows on it is referred as on the whole.
    ///
    /// For chains of more masses than one can hold, which are built piece by piece. Weight and efficiencies are those
    /// of the whole.
    #[must_use]
    pub const fn continued(mut self) -> Self {
        if self.count > 2 {
            let (last, shaft) = (self.count - 1, self.shaft[self.count - 2]);
            let [near, far] = [self.inertia[last - 1], self.inertia[last]];
            (self.inertia, self.shaft) = ([0.0; CAPACITY], [Shaft::NONE; CAPACITY - 1]);
            (self.inertia[0], self.inertia[1], self.shaft[0]) = (near, far, shaft);
            self.count = 2;
        }
        self
    }
}
