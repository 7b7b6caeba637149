//! The main drive of a strip mill's stand: motor, coupling, pinion stand, spindles, rolls.
//!
//! A slow motor of 2.4 MW, 400 kN m at most, drives a four-high stand straight. Short shafts join motor, coupling and
//! pinion stand, long spindles the rolls: work rolls of 0.65 m and backup rolls of 1.4 m and 30 t each, which at the
//! work rolls' speed have most of the 2500 kg m2. So the first resonance lies at 10 Hz, where papers on the torsional
//! vibration of mill drives have it. The figures are not those of one machine. The couplings' play is taken up as long
//! as the stand rolls, so it is left out; a stand that reverses needs the observer of backlash.

use driveline::configure::{HasLife, Machine, Rating};
use driveline::design::{Encoder, SpeedLoopDesign, SpeedLoopTuning};
use driveline::drive::Drive;
use driveline::fatigue::{Rainflow, WoehlerLine};
use driveline::governor::{DampingLag, SetpointLag, SpeedLoop};
use driveline::machine::{Chain, Damping, Inertia, Speed, Stiffness, Torque};
use driveline::observer;
use driveline::settings::{Bases, Screening};

use crate::panel::life::LifePanel;
use crate::scene::composed::{Composed, GovernedBy};
use crate::scene::table::variants;

/// Motor, coupling, pinion stand, rolls.
pub struct StripMill;

impl Machine for StripMill {
    const CHAIN: Chain = Chain::motor(Inertia(3000.0))
        .shaft(Stiffness(6.0e7), Damping(1.0e4))
        .rotor(Inertia(300.0))
        .shaft(Stiffness(5.0e7), Damping(1.0e4))
        .rotor(Inertia(400.0))
        .shaft(Stiffness(6.0e6), Damping(4.0e3))
        .rotor(Inertia(2500.0));
    const RATING: Rating = Rating { torque: Torque(2.0e5), speed: Speed(12.0), torque_limit: Torque(4.0e5) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 10_000;
    /// A tenth of the antiresonance, and a shaft that is damped after a strip's bite. Without the damping's lag a
    /// fast observer and the vibration at 90 Hz, which its model leaves out, would excite one another.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 0.1, damping: 1.0, shaft_damping: 0.15 };
    const SPEED_LOOP: SpeedLoopDesign =
        Self::TWO_MASS.speed_loop(Self::RATE, Self::TUNING).with_damping_lag(1.0 / Self::TWO_MASS.resonance());
    const RAMP: f64 = Self::RATING.speed.0 / 3.0;
    /// They are far above the operating range, for the gains: a radian of innovation is much with such an encoder.
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 20.0 * Self::RATING.torque_limit.0, 4.0 * Self::RATING.speed.0);
    /// In 0.2 s the motor turns by less than half a turn.
    const SCREENING: Screening = Screening {
        innovation: core::f64::consts::TAU / 512.0,
        max_coast: Self::RATE_HZ / 5,
        ..Self::RATING.screening(Self::ENCODER, Self::RATE)
    };
}

impl HasLife for StripMill {
    /// Of a spindle's neck, assumed: rated torque, swelling, is what it endures; slopes as in Miner's elementary rule.
    const SHAFT: WoehlerLine = WoehlerLine { knee: 0.5 * Self::RATING.torque.0, cycles: 2.0e6, slope: 5.0, below: 5.0 };
}

/// Counts of the encoder on a turn: a sine encoder of 4096 lines, interpolated 256 times.
pub const COUNTS: u32 = 1_048_576;

/// A speed loop with lags that keep the spindles from swinging at the run-up and after a bite.
type Loop = SpeedLoop<(SetpointLag, DampingLag)>;

/// One mass.
pub type Rigid<N> = GovernedBy<N, observer::RigidObserver, Loop>;
/// Two masses, semi-implicit step: the design's choice.
pub type SemiImplicit<N> = GovernedBy<N, observer::SemiImplicitObserver, Loop>;
/// The same with the life of the spindles counted, in 128 classes of 9.4 kN m.
pub type Life<N> = Composed<Drive<N, observer::SemiImplicitObserver, Loop, Rainflow<128>>, LifePanel<StripMill>>;

variants! {
    "rigid": Rigid for StripMill;
    "semi-implicit": SemiImplicit for StripMill;
    "life": Life for StripMill;
}
