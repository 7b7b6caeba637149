//! The record of a stop, replayed: the same commands, bit for bit.

use driveline::configure::Machine;
use driveline::drive::{Composition, ConfigOf, Drive, Recorded};
use driveline::fault::Faults;
use driveline::governor::{SpeedLoop, Supervised};
use driveline::number::{Fixed, Number};
use driveline::observer::TwoMassObserver;
use driveline::sample::Sample;

use crate::machines::Hoist;
use crate::run::{Drawn, held, seen};

/// A hoist that lifts, misses ticks and angles, and jams; in the words of its number.
fn jam<D: Composition + Clone>(config: &ConfigOf<D>, base: [f64; 2]) {
    let number = |value: f64, base: f64| -> D::Number {
        let value = value / base;
        if base == 1.0 {
            D::Number::from_word((value as f32).to_bits())
        } else {
            D::Number::from_word(Fixed::from_f64(value).to_bits() as u32)
        }
    };
    let [torque_base, speed_base] = base;
    let mut plant = held::<Hoist>(&Drawn::NOMINAL, 747.0);
    let start = plant.angle[0];
    let mut drive = Recorded::<D>::new(config, 0);
    let mut commands = Vec::new();
    let mut reported = D::Number::ZERO;
    for tick in 0..40_000 {
        let hold = tick < 1_000;
        plant.brake = if hold { 3_000.0 } else { 0.0 };
        if tick == 30_000 {
            plant.jammed = Some(2);
        }
        if tick == 29_990 {
            // a tick does not run
            plant.advance(reported.to_real() * torque_base, 1e-4);
        }
        let angle = seen::<Hoist>(plant.angle[0] - start);
        let setpoint = number(155.0, speed_base);
        let command = if hold {
            drive.hold(config, angle, number(747.0, torque_base))
        } else if tick % 97 == 0 && tick < 30_000 {
            drive.coast(config, reported, setpoint)
        } else {
            drive.tick_after(config, &Sample { angle, torque: reported, setpoint }, u32::from(tick == 29_990))
        };
        commands.push((command.torque.to_word(), command.faults));
        reported = command.torque;
        if !drive.reason().is_none() {
            break;
        }
        plant.advance(command.torque.to_real() * torque_base, 1e-4);
    }
    assert!(drive.reason().contains(Faults::LOAD_BLOCKED), "{}", drive.reason());
    let mut replayed = Vec::new();
    drive.replay(config, |command| replayed.push((command.torque.to_word(), command.faults)));
    assert!(replayed.len() >= 64 && replayed.len() <= 128, "{}", replayed.len());
    assert_eq!(replayed, commands[commands.len() - replayed.len()..]);
    // the last commands differ from one another: a replay of something else would be seen
    assert!(replayed.windows(2).filter(|pair| pair[0].0 != pair[1].0).count() > 32);

    // the record stays until it is released
    let ticks = drive.ticks();
    drive.tick(config, &Sample { angle: 0, torque: D::Number::ZERO, setpoint: D::Number::ZERO });
    assert_eq!(drive.ticks(), ticks);
    drive.release();
    assert_eq!((drive.ticks(), drive.reason()), (0, Faults::NONE));
}

#[test]
fn the_record_of_a_stop_gives_the_same_commands_again() {
    type Watched<N> = Drive<N, TwoMassObserver, Supervised<SpeedLoop>>;
    jam::<Watched<f32>>(&Watched::<f32>::configure::<Hoist>(), [1.0, 1.0]);
    let bases = Hoist::BASES;
    jam::<Watched<Fixed>>(&Watched::<Fixed>::configure::<Hoist>(), [bases.torque, bases.speed]);
}
