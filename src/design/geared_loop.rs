//! The speed loop behind gears with losses.

use super::{
    Actuator, Averaging, Error, ExactStep, GovernorDesign, LoopObserver, Margins, PlacedObserver, Plant, RigidDesign,
    Robustness, SpeedLoopDesign, TwoMassDesign,
};
use crate::machine::{Losses, TwoMass};
use crate::math::sqrt;

/// Gears of a machine with losses, and what its observer deducts of them.
///
/// The friction of a gear is a share of the torque that it carries. While the machine turns one way and power flows one
/// way, it changes no more than the machine's data [Huang 1987 tables 1-2 to 1-4]: with a motor that feels b times the
/// torque T of the shaft, and a load that gets h T,
///
/// ```text
/// J_m w_m' = tau - b T,  J_l w_l' = h T - tau_l
/// ```
///
/// is a machine without losses of the stiffness b k, the damping b d and the load inertia b/h J_l. Motoring, b is one
/// over the efficiency before the shaft, h the efficiency behind it; overhauling, b is the first, and h one over the
/// second. An observer that deducts the friction is one for such a machine too, with b = 1 + lambda or 1 - lambda. So a
/// loop has its margins with losses where it has them round these two machines.
///
/// The observer takes the friction from the shaft torque of the last tick, here from that of the tick itself.
///
/// ```
#[doc = include_str!("../roll.txt")]
/// use driveline::design::{Actuator, LoopGears, LoopObserver, Robustness};
/// use driveline::machine::Losses;
/// let observer = LoopObserver::TwoMass(&Roll::OBSERVER);
/// let bears = |share: f64, friction: f64| {
///     let losses = Losses { before: [share, 2.0 - 1.0 / share], behind: [1.0; 2] };
///     let gears = LoopGears { losses, friction, behind: false };
///     gears.try_robust(&Roll::TWO_MASS, observer, &Roll::SPEED_LOOP, Actuator::DIRECT, &Robustness::USUAL).is_ok()
/// };
/// // a gear that loses 3 %, whose observer knows it; one that loses half, unknown to it
/// assert!(bears(0.97, 0.03) && !bears(0.52, 0.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LoopGears {
    /// The efficiencies.
    pub losses: Losses,
    /// Friction per torque before the shaft that the observer deducts,
    /// [`Gear::friction`](crate::settings::Gear::friction); zero without a
    /// [`GearedObserver`](crate::observer::GearedObserver).
    pub friction: f64,
    /// Whether it deducts the losses behind the shaft, as a [`LoadGearObserver`](crate::observer::LoadGearObserver).
    pub behind: bool,
}

/// Machine and observer while power flows one way: torque on the motor per torque of the shaft, torque on the load per
/// torque of the shaft.
#[derive(Clone, Copy)]
struct Flow {
    machine: [f64; 2],
    observer: [f64; 2],
}

impl LoopGears {
    /// No losses.
    pub const NONE: Self = Self { losses: Losses { before: [1.0; 2], behind: [1.0; 2] }, friction: 0.0, behind: false };

    /// The motor driving, and the load, unless a gear locks.
    const fn flows(&self) -> [Option<Flow>; 2] {
        let Losses { before: [to_shaft, from_shaft], behind: [to_load, from_load] } = self.losses;
        if to_shaft == 1.0 && from_shaft == 1.0 && to_load == 1.0 && from_load == 1.0 {
            return [None, None];
        }
        let driven = if from_shaft > 0.0 && from_load > 0.0 {
            Some(self.flow(from_shaft, 1.0 / from_load, 1.0 - self.friction))
        } else {
            None
        };
        [Some(self.flow(1.0 / to_shaft, to_load, 1.0 + self.friction)), driven]
    }

    const fn flow(&self, motor: f64, load: f64, found: f64) -> Flow {
        Flow { machine: [motor, load], observer: [found, if self.behind { load } else { 1.0 }] }
    }

    /// Whether a speed loop with its observer has the required margins round these two masses, whichever way power
    /// flows.
    ///
    /// # Errors
    /// [`Error::LoopUnstable`], [`Error::LoopGain`], [`Error::LoopPhase`], and those of
    /// [`ClosedLoop::of`](super::ClosedLoop::of).
    pub const fn try_robust(
        &self,
        machine: &TwoMass,
        observer: LoopObserver<'_>,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
        robustness: &Robustness,
    ) -> Result<(), Error> {
        let flows = self.flows();
        each!(way, 0..flows.len(), {
            if let Some(flow) = &flows[way] {
                let (machine, seen) = flow.round(machine, observer);
                get!(machine.try_margins(seen.observer(), speed_loop, actuator, robustness));
            }
        });
        Ok(())
    }

    /// Margins of a speed loop with its observer round these two masses: the motor driving, and the load; `None`
    /// without losses, and where a gear locks.
    ///
    /// # Errors
    /// [`Error::LoopUnstable`], and those of [`ClosedLoop::of`](super::ClosedLoop::of).
    pub const fn margins(
        &self,
        machine: &TwoMass,
        observer: LoopObserver<'_>,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
    ) -> Result<[Option<Margins>; 2], Error> {
        let (flows, mut found) = (self.flows(), [None; 2]);
        each!(way, 0..flows.len(), {
            if let Some(flow) = &flows[way] {
                let (machine, seen) = flow.round(machine, observer);
                let closed = get!(seen.observer().close(speed_loop, actuator));
                found[way] = Some(get!(closed.margins(&Plant::of(&machine))));
            }
        });
        Ok(found)
    }

    /// As [`try_robust`](Self::try_robust) for the governor of a slow actuator.
    ///
    /// # Errors
    /// Those of [`GovernorDesign::try_robust`].
    pub const fn try_robust_governor(
        &self,
        machine: &TwoMass,
        observer: LoopObserver<'_>,
        design: &GovernorDesign,
        averaging: Averaging,
        robustness: &Robustness,
    ) -> Result<(), Error> {
        let flows = self.flows();
        each!(way, 0..flows.len(), {
            if let Some(flow) = &flows[way] {
                let (machine, seen) = flow.round(machine, observer);
                // torques that the governor takes over those of the observer
                let taken = sqrt(1.0 - self.friction * self.friction) * flow.observer[1] / flow.observer[0];
                let (share, acceleration) = (taken * design.share, taken * design.acceleration);
                let design = GovernorDesign { share, acceleration, ..*design };
                get!(design.try_robust(&machine, Some(seen.observer()), averaging, robustness));
            }
        });
        Ok(())
    }
}

/// An observer of two masses or of one.
enum Seen {
    Two(PlacedObserver),
    One(RigidDesign),
}

impl Seen {
    const fn observer(&self) -> LoopObserver<'_> {
        match self {
            Seen::Two(observer) => LoopObserver::Placed(observer),
            Seen::One(observer) => LoopObserver::Rigid(observer),
        }
    }
}

/// The machine without losses that moves as one with them.
const fn lossless(machine: &TwoMass, [motor, load]: [f64; 2]) -> TwoMass {
    TwoMass {
        load_inertia: machine.load_inertia * motor / load,
        stiffness: machine.stiffness * motor,
        damping: machine.damping * motor,
        ..*machine
    }
}

impl Flow {
    /// The machine without losses, and the observer round it.
    const fn round(&self, machine: &TwoMass, observer: LoopObserver<'_>) -> (TwoMass, Seen) {
        let share = machine.load_inertia / machine.total_inertia();
        (lossless(machine, self.machine), self.observer(observer, share))
    }

    /// The observer for the machine that moves as its own with the losses that it deducts: the load torque in its unit.
    /// One mass gives the load's share of its inertia to the shaft.
    const fn observer(&self, observer: LoopObserver<'_>, share: f64) -> Seen {
        let unit = self.observer[0] / self.observer[1];
        match observer {
            LoopObserver::TwoMass(TwoMassDesign { machine, gains, period, .. })
            | LoopObserver::Placed(PlacedObserver { machine, gains, period, .. }) => {
                let machine = lossless(machine, self.observer);
                let [angle, motor_speed, twist, load_speed, load_torque] = *gains;
                Seen::Two(PlacedObserver {
                    period: *period,
                    machine,
                    step: ExactStep::new(&machine, *period),
                    gains: [angle, motor_speed, twist, load_speed, unit * load_torque],
                    poles: [(0.0, 0.0); 5],
                })
            }
            LoopObserver::Rigid(design) => {
                let mut design = *design;
                design.machine.inertia *= 1.0 + (unit - 1.0) * share;
                design.gains[2] *= unit;
                Seen::One(design)
            }
        }
    }
}
