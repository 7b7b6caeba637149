//! The main drive of a strip mill's stand: motor, coupling, pinion stand, spindles, rolls.
//!
//! A slow motor of 2.4 MW, 400 kN m at most, drives a four-high stand straight. Short shafts join motor, coupling and pinion stand, long spindles the rolls:
//! work rolls of 0.65 m and backup rolls of 1.4 m and 30 t each, which at the work rolls' speed have most of the 2500 kg m2. So the first resonance
//! lies at 10 Hz, where papers on the torsional vibration of mill drives have it. The figures are not those of one machine. The couplings' play is taken up as long as the stand rolls, so it is left out; a stand that reverses needs the observer of backlash.

use core::marker::PhantomData;

use driveline::design::{
    Disturbance, Encoder, LoadCycle, ObserverChoice, ObserverSelection, Rate, Requirement, RigidDesign,
    SpeedLoopDesign, SpeedLoopTuning, TwoMassDesign,
};
use driveline::drive::{Config, ConfigOf, Limits};
use driveline::governor::{SpeedLoop, SpeedLoopConfig};
use driveline::machine::{Chain, Damping, Inertia, Match, Stiffness, TwoMass};
use driveline::number::Fixed;
use driveline::observer::{self, RigidConfig, SemiImplicitConfig};
use driveline::settings::{Bases, Screening, SpeedLoopSettings};

use crate::scene::governed::governed;

/// The machine, from the motor to the rolls.
pub const CHAIN: Chain = Chain::motor(Inertia(3000.0))
    .shaft(Stiffness(6.0e7), Damping(1.0e4))
    .rotor(Inertia(300.0))
    .shaft(Stiffness(5.0e7), Damping(1.0e4))
    .rotor(Inertia(400.0))
    .shaft(Stiffness(6.0e6), Damping(4.0e3))
    .rotor(Inertia(2500.0));

/// Two masses with the chain's first resonance and antiresonance.
pub const REDUCED: TwoMass = CHAIN.reduce(Match::ResonanceAntiresonance);

/// Rated speed [rad/s].
pub const RATED_SPEED: f64 = 12.0;

/// Rated torque [N m].
pub const RATED_TORQUE: f64 = 2.0e5;

/// Largest torque [N m].
pub const TORQUE_LIMIT: f64 = 4.0e5;

/// Ticks a second.
pub const RATE_HZ: u32 = 10_000;

/// Counts of the encoder on a turn: a sine encoder of 4096 lines, interpolated 256 times.
pub const COUNTS: u32 = 1_048_576;

/// Half of rated torque in 10 s as a random walk: noise and lag are least together so.
pub const DISTURBANCE: Disturbance =
    Disturbance { torque_accuracy: 0.01 * RATED_TORQUE, load_torque_step: 0.5 * RATED_TORQUE, within: 10.0 };

/// The observer.
pub const OBSERVER: TwoMassDesign = REDUCED.observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// The observer that takes the machine for rigid.
pub const RIGID: RigidDesign = CHAIN.rigid().observer(Rate::hz(RATE_HZ), Encoder::lines(COUNTS / 4), DISTURBANCE);

/// What it needs for a strip that bites within 50 ms.
pub const SELECTION: ObserverSelection = REDUCED.select_observer(
    &LoadCycle {
        speed: RATED_SPEED,
        torque: 0.7 * RATED_TORQUE,
        change: 0.6 * RATED_TORQUE,
        rise: 0.05,
        every: 1.0,
        reverses: false,
    },
    &Requirement::USUAL,
    1.0 / RATE_HZ as f64,
);

const _: () = assert!(matches!(SELECTION.chosen, ObserverChoice::SemiImplicit));

/// The load's share of the inertia.
pub const LOAD_SHARE: f64 = REDUCED.load_inertia / (REDUCED.motor_inertia + REDUCED.load_inertia);

/// The speed loop: a tenth of the antiresonance, and next to nothing of the slip. With more, a lively observer and the vibration at 90 Hz that it does not know
/// would excite one another.
pub const LOOP: SpeedLoopDesign =
    REDUCED.speed_loop(Rate::hz(RATE_HZ), SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.05 });

/// The governor: rated speed in three seconds.
pub const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE_LIMIT, ramp: RATED_SPEED / 3.0 };

/// Bases of fixed point. They are far above what is reached, for the gains: a radian of innovation is much with such an encoder.
pub const BASES: Bases = Bases::new(&REDUCED, 20.0 * TORQUE_LIMIT, 4.0 * RATED_SPEED);

/// Plausibility limits of a sample. In 0.2 s the motor turns by less than half a turn.
pub const SCREENING: Screening = Screening {
    torque: 1.67 * TORQUE_LIMIT,
    setpoint: 1.2 * RATED_SPEED,
    innovation: core::f64::consts::TAU / 512.0,
    frozen_turn: 2.0 * core::f64::consts::TAU / COUNTS as f64,
    max_coast: RATE_HZ / 5,
};

/// The stand with a number and an observer.
pub struct StripMill<N, O>(PhantomData<(N, O)>);

governed! { StripMill, "strip-mill", 10000;
    "rigid": RigidObserver, RigidConfig(&RIGID, LOAD_SHARE);
    "semi-implicit": SemiImplicitObserver, SemiImplicitConfig(&OBSERVER);
}
