//! A supervised drive in closed loop with a machine that fails.

use driveline::design::Spread;
use driveline::drive::{ConfigOf, Drive};
use driveline::fault::Faults;
use driveline::governor::{SpeedLoop, Supervised};
use driveline::observer::TwoMassObserver;
use driveline::sample::Sample;

use crate::machines::Tested;
use crate::plant::Plant;

pub type Watched = Drive<f32, TwoMassObserver, Supervised<SpeedLoop>>;

/// What fails.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    None,
    /// The load cannot move.
    Jam,
    /// The weak shaft breaks.
    Break,
    /// A coupling in it slips at two fifths of its torque.
    Slip,
    /// A lowered load lands.
    Land,
    /// The power stage ends at two fifths of the present torque.
    Saturate,
    /// The torque constant is half.
    Half,
    /// The report is this much higher.
    Report(f64),
    /// A brake at the motor drags with half of rated torque, for half a second.
    Drag,
    /// The brake opens 0.3 s late.
    Late,
    /// The angle counts backwards, or with another ratio.
    Ratio(f64),
    /// A phase of the motor is dead: half of the torque, in pulses eight times a turn.
    Phase,
    /// The brake slips while it is closed.
    Brake,
}

impl Fault {
    /// The cause that belongs to it.
    pub fn cause(self) -> Faults {
        match self {
            Fault::None => Faults::NONE,
            Fault::Jam | Fault::Drag | Fault::Late => Faults::LOAD_BLOCKED,
            Fault::Break | Fault::Slip | Fault::Land => Faults::LOAD_LOST,
            Fault::Saturate | Fault::Half | Fault::Phase | Fault::Ratio(_) => Faults::NOT_FOLLOWED,
            Fault::Report(_) => Faults::TORQUE_REPORT,
            Fault::Brake => Faults::BRAKE_SLIP,
        }
    }
}

/// A machine as it is, over the one that the drive is told of.
#[derive(Clone, Copy, Debug)]
pub struct Drawn {
    /// Inertia at the motor and of the last mass.
    pub inertia: [f64; 2],
    /// Stiffness of the weak shaft.
    pub stiffness: f64,
    /// Torque constant.
    pub constant: f64,
    /// Torque that is not reported, over rated.
    pub offset: f64,
    /// Noise of the report, over rated.
    pub noise: f64,
    /// Share of the load.
    pub load: f64,
    /// Delay of the fault (s).
    pub later: f64,
    pub draws: Draws,
}

impl Drawn {
    /// As described.
    pub const NOMINAL: Self = Drawn {
        inertia: [1.0; 2],
        stiffness: 1.0,
        constant: 1.0,
        offset: 0.0,
        noise: 0.0,
        load: 1.0,
        later: 0.0,
        draws: Draws(1),
    };

    /// Within the tolerances of the machine.
    pub fn of<M: Tested>(draws: &mut Draws) -> Self {
        let tolerance = M::TOLERANCE;
        let mut of = |spread: Spread| spread.min * (spread.max / spread.min).powf(draws.unit());
        Drawn {
            inertia: [of(tolerance.motor_inertia), of(M::DRAWN_LOAD)],
            stiffness: of(tolerance.stiffness),
            constant: of(tolerance.torque),
            offset: tolerance.offset * (2.0 * draws.unit() - 1.0),
            noise: 0.01,
            load: 0.8 + 0.2 * draws.unit(),
            later: 0.3 * draws.unit(),
            draws: Draws(draws.0 ^ 0x5DEE_CE66),
        }
    }

    /// Makes a machine as described this one.
    pub fn apply(&self, plant: &mut Plant) {
        let last = plant.inertia.len() - 1;
        plant.inertia[0] *= self.inertia[0];
        plant.inertia[last] *= self.inertia[1];
        plant.shafts[plant.weak][0] *= self.stiffness;
    }
}

/// xorshift64* [Marsaglia 2003, J. Stat. Softw. 8(14)].
#[derive(Clone, Copy, Debug)]
pub struct Draws(pub u64);

impl Draws {
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Sum of twelve uniform numbers: variance 1.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

/// A run's result.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// First and last cause, and the time behind the fault (s).
    pub first: Faults,
    pub last: Faults,
    pub after: f64,
    /// Largest torque of the weak shaft and speed of any mass behind the fault.
    pub torque: f64,
    pub speed: f64,
}

/// A drawn machine at rest under a held load.
pub fn held<M: Tested>(drawn: &Drawn, torque: f64) -> Plant {
    let mut plant = M::plant();
    drawn.apply(&mut plant);
    (plant.rope, plant.load) = (M::DUTY.rope, torque);
    plant.rest(torque);
    plant
}

/// What the encoder of a machine shows where the motor has turned so far (rad), 2^32 to the turn.
pub fn seen<M: Tested>(turned: f64) -> u32 {
    let resolution = M::ENCODER.resolution().unwrap();
    let count = (turned / resolution).floor();
    (count * resolution / core::f64::consts::TAU * 4_294_967_296.0).round() as i64 as u32
}

pub fn run<M: Tested>(
    config: &ConfigOf<Watched>,
    drawn: &Drawn,
    fault: Fault,
    told: Option<Faults>,
    after: f64,
) -> Outcome {
    let mut duty = M::DUTY;
    // a lifted load is its own weight
    let share = if duty.held > 0.0 { drawn.inertia[1] } else { drawn.load };
    (duty.held, duty.load, duty.fails) = (duty.held * share, duty.load * share, duty.fails + drawn.later);
    let mut draws = drawn.draws;
    let period = 1.0 / f64::from(M::RATE_HZ);
    let hold = 0.5;
    let lowering = fault == Fault::Land;
    let speed = if lowering { -duty.speed } else { duty.speed };
    let at = match fault {
        Fault::Late | Fault::Ratio(_) => hold,
        Fault::Brake => 0.2 * hold,
        _ => duty.fails + hold,
    };
    let rated = M::RATING.torque.0;
    let mut drive = Watched::new(config, 0);
    let mut outcome = Outcome::default();
    let mut reported = 0.0;
    let mut stopped_at = None;
    let mut plant = held::<M>(drawn, duty.held);
    let start = plant.angle[0];
    plant.brake = 4.0 * rated;
    let (mut slip_torque, mut before) = (0.0, 0.0_f64);
    let ticks = ((at + after) / period) as usize;
    for tick in 0..ticks {
        let time = tick as f64 * period;
        let failed = fault != Fault::None && time >= at;
        let gone = time - at;
        let open = hold + if fault == Fault::Late { 0.3 } else { 0.0 };
        plant.brake = if time < open { 4.0 * rated } else { 0.0 };
        plant.load = duty.load_at(time - hold, period);
        if failed {
            match fault {
                Fault::Jam | Fault::Land => plant.jammed = Some(duty.jam),
                Fault::Break => plant.shafts[plant.weak] = [0.0, 0.0],
                Fault::Slip => {
                    if plant.slipping.is_none() {
                        slip_torque = 0.4 * plant.torque(plant.weak).abs();
                    }
                    plant.slipping = Some(slip_torque);
                }
                Fault::Drag if gone < 0.5 => plant.brake += 0.5 * rated,
                Fault::Brake => {
                    plant.brake = 0.0;
                    plant.load = duty.held + 0.3 * rated;
                }
                _ => {}
            }
        }
        if stopped_at.is_some_and(|stopped| time > stopped + 0.08) {
            plant.brake += 2.0 * rated;
        }
        let ratio = if let Fault::Ratio(ratio) = fault { ratio } else { 1.0 };
        let angle = seen::<M>(ratio * (plant.angle[0] - start));
        if let Some(cause) = told
            && gone >= 0.005
            && drive.governor().cause().is_none()
        {
            drive.governor_mut().stop(cause);
        }
        let command = if time < hold {
            drive.hold(config, angle, duty.held as f32)
        } else {
            drive.tick(config, &Sample { angle, torque: reported as f32, setpoint: speed as f32 })
        };
        let mut torque = f64::from(command.torque);
        if !failed {
            before = torque;
        }
        reported = torque + drawn.noise * M::RATING.torque.0 * draws.normal();
        torque = torque * drawn.constant + drawn.offset * M::RATING.torque.0;
        if failed {
            match fault {
                Fault::Half => torque *= 0.5,
                Fault::Phase => torque *= 0.5 + 0.5 * (8.0 * plant.angle[0]).cos(),
                Fault::Saturate => {
                    let most = 0.4 * before.abs();
                    torque = torque.clamp(-most, most);
                }
                Fault::Report(jump) => reported *= 1.0 + jump,
                _ => {}
            }
        }
        let causes = command.faults & Faults::SUPERVISION;
        if outcome.first.is_none() && !(causes.is_none()) {
            outcome.first = causes;
            outcome.after = gone;
        }
        outcome.last = causes;
        if command.faults.contains(Faults::STOPPED) && stopped_at.is_none() {
            stopped_at = Some(time);
        }
        if failed {
            outcome.torque = outcome.torque.max(plant.torque(plant.weak).abs());
            outcome.speed = plant.speed[..=plant.weak].iter().fold(outcome.speed, |most, v| most.max(v.abs()));
        }
        plant.advance(torque, period);
    }
    outcome
}
