//! A tube mill that a slip-ring motor starts by resistors.
//!
//! A 500 kW, six-pole motor at 990 r/min has 4.82 kN m and 35 kg m2 by makers' tables for frame size 450, with its
//! coupling. Behind a gear of 55 it turns a tube of 2.4 m with its charge, 0.2 Mkg m2, at 18 r/min. The charge has to
//! be lifted from the first degree on: eight tenths of rated torque. The figures are of the size of a small cement
//! mill, not those of one machine.
//!
//! No governor commands this motor. The drive observes; beside it the starter cuts out six resistors one after another,
//! each at its speed, so that the torque never exceeds 1.8 times the rated one. The torque in its output is that of the
//! motor on the present step, by straight lines along its curve: what the drive would get where no current is
//! measured. The number of resistors that are cut out is in the telemetry.

use core::marker::PhantomData;

use driveline::configure::{Machine, Rating};
use driveline::design::{Encoder, TorqueCurve};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::{CurveConfig, ResistorStarter, ResistorStarterConfig};
use driveline::machine::{
    Chain, Characteristic, Damping, Efficiency, Induction, Inertia, Ratio, ResistorStart, Speed, Stiffness, Torque,
};
use driveline::number::{Fixed, Number};
use driveline::observer::TwoMassObserver;
use driveline::settings::Bases;
use driveline::telemetry::{Channel, Kind};

use crate::scene::composed::{Beside, Composed, OverWords};
use crate::scene::table::variants;
use crate::scene::{Input, Output};

/// Motor, gear, tube with its charge.
pub struct TubeMill;

impl Machine for TubeMill {
    const CHAIN: Chain = Chain::motor(Inertia(35.0))
        .shaft(Stiffness(2.0e5), Damping(200.0))
        .gear(Ratio(55.0), Efficiency(1.0))
        .rotor(Inertia(2.0e5));
    const RATING: Rating =
        Rating { torque: Torque(4_820.0), speed: Speed(103.67), torque_limit: Torque(1.8 * 4_820.0) };
    const ENCODER: Encoder = Encoder::lines(COUNTS / 4);
    const RATE_HZ: u32 = 1_000;
    /// That of the torque is fifty times the largest, for the slope of the motor's own curve: 4,800 N m s/rad.
    const BASES: Bases = Bases::new(&Self::TWO_MASS, 50.0 * Self::RATING.torque_limit.0, 1.34 * Self::RATING.speed.0);
}

/// Counts of the encoder on a turn.
pub const COUNTS: u32 = 8_192;

/// Resistors.
pub const STEPS: usize = 6;

/// 1000 r/min without load, breakdown at 2.5 times rated torque.
pub const MOTOR: Induction =
    Induction::new(Speed(TubeMill::RATING.speed.0), Torque(TubeMill::RATING.torque.0), Speed(104.72), 2.5);

/// The start.
pub const START: ResistorStart<STEPS> = MOTOR.resistor_start(Torque(TubeMill::RATING.torque_limit.0));

/// The contactors' time (s), which is less than that of the last step.
pub const INTERVAL: f64 = 0.05;

/// Points of a step's curve.
const POINTS: usize = 8;

/// The curve of a step from the speed at which it begins on.
const fn curve(step: usize) -> TorqueCurve<POINTS> {
    const SLIPS: [f64; POINTS] = [1.0, 0.999, 0.8, 0.62, 0.46, 0.3, 0.15, 0.0];
    let begins = if step == 0 { 0.0 } else { START.speeds[step - 1] };
    let (mut speeds, mut point) = ([0.0; POINTS], 1);
    while point < POINTS {
        speeds[point] = MOTOR.synchronous - SLIPS[point] * (MOTOR.synchronous - begins);
        point += 1;
    }
    TorqueCurve::of(&Characteristic::Induction(START.motor(&MOTOR, step)), speeds)
}

/// Constants of the start in a number.
pub struct Start<N: Number> {
    starter: ResistorStarterConfig<N, STEPS>,
    /// Of every step, and of the motor alone.
    curves: [CurveConfig<N, POINTS>; STEPS + 1],
}

/// A number that the start has constants in.
pub trait Starting: Number + 'static {
    /// The constants of the start in this number.
    const START: &'static Start<Self>;
}

macro_rules! starting {
    ($number:ty, $bases:expr) => {
        impl Starting for $number {
            const START: &'static Start<Self> = &Start {
                starter: ResistorStarterConfig::<$number, STEPS>::new(&START, INTERVAL, TubeMill::PERIOD, $bases),
                curves: {
                    let mut curves = [CurveConfig::<$number, POINTS>::new(&curve(0), 0.0, $bases); STEPS + 1];
                    let mut step = 1;
                    while step <= STEPS {
                        curves[step] = CurveConfig::<$number, POINTS>::new(&curve(step), 0.0, $bases);
                        step += 1;
                    }
                    curves
                },
            };
        }
    };
}

starting!(f32, Bases::SI);
starting!(Fixed, TubeMill::BASES);

/// The starter beside the drive.
#[derive(Clone, Copy)]
pub struct Starter<N> {
    starter: ResistorStarter,
    number: PhantomData<N>,
}

impl<N: Starting, D: OverWords<Number = N>> Beside<D> for Starter<N> {
    const CHANNELS: &'static [Channel<'static>] =
        &[Channel { name: "resistors cut out", unit: "", kind: Kind::Integer(1.0) }];

    fn start(_: &mut D, _: &ConfigOf<D>) -> Self {
        Starter { starter: ResistorStarter::default(), number: PhantomData }
    }

    /// Released and with a setpoint above zero it starts and runs; else the stator is off.
    #[inline(always)]
    fn tick(&mut self, drive: &mut D, config: &ConfigOf<D>, input: &Input) -> Output {
        let output = drive.advance(config, input);
        let torque = if input.flags & Input::RELEASED != 0 && N::from_word(input.setpoint) > N::ZERO {
            let speed = N::from_word(output.motor_speed);
            let step = self.starter.tick(&N::START.starter, speed);
            N::START.curves.get(step as usize).map_or(N::ZERO, |curve| curve.max_torque(speed))
        } else {
            self.starter.restart();
            N::ZERO
        };
        Output { torque: torque.to_word(), ..output }
    }

    fn channel(&self, _: usize) -> u32 {
        self.starter.step()
    }

    #[cfg(not(target_os = "none"))]
    fn copy(&self) -> Option<Self> {
        Some(*self)
    }
}

/// Two masses, and the starter.
pub type Resistors<N> = Composed<Drive<N, TwoMassObserver>, Starter<N>>;

variants! {
    "resistors": Resistors for TubeMill;
}
