//! A bridge crane's travelling drive with a swinging load.
//!
//! 25 t of bridge and trolley and 15 t of load on 10 m of rope travel at 1.25 m/s on wheels of 0.5 m behind gears of
//! 30; two motors of 11 kW count as one of 147 N m at 150 rad/s. Masses, speed and power are of the size that makers
//! give for a crane of 16 t and 25 m of span. The load swings at 0.16 Hz, and acts on the motor as the shaft of this
//! drive: a spring of `m g/l`, for angles up to 15 degrees within 0.4 % of the frequency.
//!
//! The travelling resistance, 6 per mille of the weight with the gears' loss in it, lies in front of the swinging load.
//! Its known part is deducted from the drive's reported torque. To the observer the rest is a part of
//! the shaft torque and of the load torque alike, which changes nothing else while it is constant.

use driveline::configure::{Machine, Rating};
use driveline::design::{Disturbance, Encoder, RigidDesign, SpeedLoopTuning, Tolerance, Undescribed};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::{InputShaper, SetpointLag, SpeedLoop};
use driveline::machine::{Chain, Diameter, Efficiency, Inertia, Length, Mass, Ratio, Speed, Torque};
use driveline::number::Number;
use driveline::observer;
use driveline::scheduling::ShaperSlots;
use driveline::settings::{Bases, Screening};

use crate::scene::composed::{Beside, Composed, GovernedBy, OverWords};
use crate::scene::no_load::{NoLoadLearner, NoLoadRun};
use crate::scene::table::variants;
use crate::scene::{Input, Output};

/// Length of the rope that the observer and the speed loop are designed for.
pub const ROPE: Length = Length(10.0);

/// The machine, from the motors to the load.
pub struct CraneTravel;

impl Machine for CraneTravel {
    const CHAIN: Chain = Chain::motor(Inertia(0.2))
        .gear(Ratio(30.0), Efficiency(1.0))
        .drum(Diameter(0.5))
        .driven(Mass(25_000.0))
        .swinging(Mass(15_000.0), ROPE);
    /// Both motors.
    const RATING: Rating = Rating { torque: Torque(147.0), speed: Speed(150.0), torque_limit: Torque(290.0) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 1_000;
    /// The torque is known to 3 %, half for the uncertain travelling resistance and half for noise. The wind varies by
    /// a twentieth of rated torque in 100 s: this minimises noise plus lag.
    const DISTURBANCE: Disturbance = Disturbance {
        torque_accuracy: 0.03 * Self::RATING.torque.0,
        load_torque_step: 0.05 * Self::RATING.torque.0,
        within: 100.0,
    };
    /// One mass takes the swing for the load's doing. It must follow the motor at once, or a drive shaft's vibration comes
    /// back late: the torque counts as hardly known.
    const RIGID_OBSERVER: RigidDesign = Self::CHAIN.rigid().observer(
        Self::RATE,
        Self::ENCODER,
        Disturbance { torque_accuracy: 0.9 * Self::RATING.torque.0, ..Self::DISTURBANCE },
    );
    /// Half of the pendulum's frequency, with the design's active damping. Three times as much, which 6 dB and 30
    /// degrees would leave, excites a drive shaft of 3 to 12 Hz between motor and bridge.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning::with_bandwidth(&Self::TWO_MASS, 0.5);
    /// The chain takes motor and bridge for one mass. Between them are drive shafts from 2 Hz on, and the motors'
    /// inertia is a tenth of both.
    const TOLERANCE: Tolerance =
        Tolerance { undescribed: Undescribed { above: 10.0, weight: 9.0, damping_ratio: 0.02 }, ..Tolerance::USUAL };
    const RAMP: f64 = Self::RATING.speed.0 / 6.0;
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 2.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    /// In 15 ms the motor turns by less than half a turn.
    const SCREENING: Screening =
        Screening { max_coast: Self::RATE_HZ / 67, ..Self::RATING.screening(Self::ENCODER, Self::RATE) };
}

/// Mass of the empty hook (kg).
pub const HOOK: f64 = 300.0;

/// The same crane with a speed loop that holds the trolley's speed against the swing: at four times the pendulum's
/// frequency.
///
/// The load then swings as under a trolley on a given course, almost undamped, at a frequency of its rope's length and
/// hardly of its mass. The setpoint must not excite it.
pub struct StiffTravel;

impl Machine for StiffTravel {
    const CHAIN: Chain = CraneTravel::CHAIN;
    const RATING: Rating = CraneTravel::RATING;
    const ENCODER: Encoder = CraneTravel::ENCODER;
    const RATE_HZ: u32 = CraneTravel::RATE_HZ;
    const DISTURBANCE: Disturbance = CraneTravel::DISTURBANCE;
    /// A damping ratio of the swing of 0.008, at which nothing is taken of the twist rate, leaves 27 degrees of phase;
    /// one of 0.05 less than 6 dB below.
    const TUNING: SpeedLoopTuning = SpeedLoopTuning { bandwidth: 4.0, damping: 1.0, shaft_damping: 0.03 };
    const RAMP: f64 = CraneTravel::RAMP;
    /// Twice that of the other governor: its damping, of the whole swing, is within the base.
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 4.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
    const SCREENING: Screening = CraneTravel::SCREENING;
}

/// With an empty hook. A change of the speed leaves it swinging without damping at 0.16 Hz, with some 0.3 % of rated
/// torque. A window has one period: its mean is the steady torque. With windows of half a period the inertia was off by
/// 4.3 %, since the torque's error counts for the whole time from one steady speed to the next.
impl NoLoadRun for CraneTravel {
    const INERTIA: f64 = Self::TWO_MASS.motor_inertia + HOOK * TRAVEL * TRAVEL;
    const WINDOW: f64 = 6.3;
    const TEST_WEIGHT: f64 = WEIGHT * TRAVEL * TRAVEL;
    /// Nine tenths of 6 per mille of 40 t, as commissioning identified it.
    const FRICTION: f64 = 0.9 * 0.006 * 40_000.0 * 9.80665 * TRAVEL;
}

/// Mass of the test weight (kg), as for the proof of a crane.
pub const WEIGHT: f64 = 15_000.0;

/// Travel per angle of the motors (m/rad).
const TRAVEL: f64 = 0.25 / 30.0;

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 4096;

/// A speed loop that follows the ramp with a lag of half a period of the load's swing: the load hardly swings.
pub type Loop = SpeedLoop<SetpointLag>;

/// One mass: the load fixed to the trolley.
pub type Rigid<N> = GovernedBy<N, observer::RigidObserver, Loop>;
/// Two masses, semi-implicit step: the design's choice.
pub type SemiImplicit<N> = GovernedBy<N, observer::SemiImplicitObserver, Loop>;
/// The same, with torque offset and inertia learnt in a run with an empty hook, the torque constant in one with a test
/// weight.
pub type Learnt<N> = Composed<Drive<N, observer::SemiImplicitObserver, Loop>, NoLoadLearner<N, CraneTravel>>;

/// The drive of two masses, a stiff speed loop, and a setpoint that leaves no swing behind; taken every 0.2 s.
pub type ShapedDrive<N> = Drive<N, observer::SemiImplicitObserver, InputShaper<Loop, SLOTS>>;
/// The same with a shaper that follows the length of the rope from travel to travel.
pub type Shaped<N> = Composed<ShapedDrive<N>, ByRope<N>>;

/// Slots of the shaper: two parts are 3.2 s apart.
pub const SLOTS: usize = 32;

/// Its slots over the rope that the crane works with.
pub const BY_ROPE: ShaperSlots<3> =
    ShaperSlots::new(&StiffTravel::SHAPER, ROPE, [8.0, 10.0, 12.0], SLOTS as u32 / 2, StiffTravel::PERIOD);

/// Key of the operator's panel: the rope's length (mm), as the hoist has it. It is taken at rest, from 8 to 12 m; the
/// answer is the slot (ticks), or 0 where it is not taken.
pub const ROPE_KEY: u32 = 1;

/// The drive's constants, whose shaper is that of the rope.
pub struct ByRope<N: Number> {
    config: ConfigOf<ShapedDrive<N>>,
}

impl<N: Number> Beside<ShapedDrive<N>> for ByRope<N> {
    fn start(_: &mut ShapedDrive<N>, config: &ConfigOf<ShapedDrive<N>>) -> Self {
        ByRope { config: *config }
    }

    #[inline(always)]
    fn tick(&mut self, drive: &mut ShapedDrive<N>, _: &ConfigOf<ShapedDrive<N>>, input: &Input) -> Output {
        drive.advance(&self.config, input)
    }

    fn panel(
        &mut self,
        drive: &mut ShapedDrive<N>,
        _: &mut &'static ConfigOf<ShapedDrive<N>>,
        [key, value]: [u32; 2],
    ) -> u32 {
        if key != ROPE_KEY
            || !(8_000..=12_000).contains(&value)
            || drive.governor().governor().ramped_setpoint() != N::ZERO
        {
            return 0;
        }
        self.config.governor.slot = BY_ROPE.at(value as f32 * 1e-3);
        self.config.governor.slot
    }

    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<Self> {
        Some(ByRope { config: self.config })
    }
}

variants! {
    "rigid": Rigid for CraneTravel;
    "semi-implicit": SemiImplicit for CraneTravel;
    "learnt": Learnt for CraneTravel;
    "shaped": Shaped for StiffTravel;
}
