//! The governor alone, and the cost of each of its parts, on the diesel genset's constants.

use driveline::governor::{
    ActiveDamping, Barred, Curve, Droop, FeedForward, Governor, HasRunSequence, MovingAverage, RunRequest, Sequencer,
    Slew, SpeedGovernor, SpeedGovernorConfig, SpeedLoop, SymmetricLimit, TorqueRange,
};
use driveline::number::{Fixed, Number, StateOf};
use driveline::sample::{Command, Estimate};

use super::Bench;
use crate::board::Board;
use crate::scene::{Constants, Of};
use crate::scenes::generator::{self, parts};
use crate::scenes::hoist::{Hoist, Reduced};
use crate::self_test::inputs::Program;

/// One call's state: the constants and the governor.
type Governed<'c, N, G> = (&'c <G as Governor<N>>::Config, G);

fn input<N: Number>(inputs: &mut Program) -> (Estimate<N>, N) {
    let mut number = || N::from_word(inputs.next_word());
    let estimate =
        Estimate { motor_speed: number(), shaft_torque: number(), load_speed: number(), load_torque: number() };
    (estimate, number())
}

#[inline(never)]
fn command<N: Number, G: Governor<N>>(
    state: &mut Governed<'_, N, G>,
    (estimate, setpoint): &(Estimate<N>, N),
    command: &mut Command<N>,
) {
    state.1.set_setpoint(*setpoint);
    command.torque = state.1.command(state.0, estimate);
}

macro_rules! governors {
    ($run:ident, $number:ident) => {
        /// The governors with this number.
        pub fn $run<B: Board>(bench: &mut Bench<'_, B>) {
            type N = $number;
            const GAINS: driveline::governor::Gains<N> = parts::$run::GAINS;
            macro_rules! one {
                ($name:literal, $shape:ty, $added:ty, $limit:ty, $modes:ty, $s:expr, $f:expr, $l:expr, $m:expr) => {
                    let config = SpeedGovernorConfig {
                        gains: GAINS,
                        shape: $s,
                        compensation: $f,
                        limit: $l,
                        sequence: $m,
                        filter: (),
                    };
                    let governor = <StateOf<SpeedGovernor<$shape, $added, $limit, $modes>, N>>::default();
                    bench.measure($name, (&config, governor), input::<N>, command);
                };
            }
            use parts::$run as p;
            let hoist = &<Of<Hoist<10_000>, Reduced<N>> as Constants>::CONFIG.governor;
            bench.measure("governor/speed-loop", (hoist, SpeedLoop::<(), _>::default()), input::<N>, command);
            one!("governor/core", (), (), SymmetricLimit, (), (), (), p::SYMMETRIC, ());
            one!("governor/between", (), (), TorqueRange, (), (), (), p::BETWEEN, ());
            one!("governor/droop", Droop, (), SymmetricLimit, (), p::DROOP, (), p::SYMMETRIC, ());
            one!("governor/barred", Barred<1>, (), SymmetricLimit, (), p::BARRED, (), p::SYMMETRIC, ());
            one!("governor/feed-forward", (), FeedForward, SymmetricLimit, (), (), p::FORWARD, p::SYMMETRIC, ());
            one!("governor/damping", (), ActiveDamping, SymmetricLimit, (), (), p::DAMPING, p::SYMMETRIC, ());
            one!("governor/curve", (), (), Curve<4>, (), (), (), p::CURVE, ());
            one!("governor/slew", (), (), Slew<SymmetricLimit>, (), (), (), p::SLEW, ());
            let config = SpeedGovernorConfig {
                gains: GAINS,
                shape: (),
                compensation: (),
                limit: p::SYMMETRIC,
                sequence: (),
                filter: p::MEAN,
            };
            type Average = MovingAverage<{ generator::FIRING }>;
            let governor = <StateOf<SpeedGovernor<(), (), SymmetricLimit, (), Average>, N>>::default();
            bench.measure("governor/mean", (&config, governor), input::<N>, command);
            let mut modes = <StateOf<SpeedGovernor<(), (), SymmetricLimit, Sequencer>, N>>::default();
            modes.sequencer_mut().request(RunRequest::Start);
            let config = SpeedGovernorConfig {
                gains: GAINS,
                shape: (),
                compensation: (),
                limit: p::SYMMETRIC,
                sequence: p::WIDE,
                filter: (),
            };
            bench.measure("governor/modes", (&config, modes), input::<N>, command);
            let mut whole = <StateOf<generator::Governor, N>>::default();
            whole.sequencer_mut().request(RunRequest::Start);
            let config = SpeedGovernorConfig {
                gains: GAINS,
                shape: (p::DROOP, p::BARRED),
                compensation: p::FORWARD,
                limit: p::CURVE,
                sequence: p::WIDE,
                filter: p::MEAN,
            };
            bench.measure("governor/whole", (&config, whole), input::<N>, command);
        }
    };
}

governors!(single, f32);
governors!(fixed, Fixed);
