//! The adapters on SPI, awaited: the same frames and faults as where they block, and what a dropped future leaves.

use driveline::axis::{AngleSensor, Parts, TRIPPING, TorqueOutput, VibrationSensor};
use driveline::fault::Faults;
use driveline_hal::{
    Adxl355, Along, AwaitedAngle, AwaitedTorque, Chip, Dac, FullScale, MagneticEncoder, PerCount, Range, SpiDac,
    Tmc4671,
};

use super::chips::{self, As5047P, Taker, Wired, awaited, polled};
use super::scripted::{CAUGHT, CONFIG, WANTED, Whole, turned};

const FULL: FullScale<f32> = FullScale::<f32>::new(10.0);
const PER_COUNT: PerCount<f32> = PerCount::<f32>::new(1.0);
const MISSING: Result<u32, Faults> = Err(Faults::ANGLE_MISSING);
/// More polls than any call of these adapters takes: six transactions of two waits.
const ALL: usize = 14;

/// No transaction fails, then each of the first sixteen: more than the runs below have.
fn failing() -> impl Iterator<Item = Option<usize>> {
    std::iter::once(None).chain((0..16).map(Some))
}

/// The form that blocks and the one that is awaited give the same and send the same, each on a bus of its own.
fn same<C: chips::Chip, T: PartialEq + std::fmt::Debug>(
    bus: impl Fn() -> Wired<C>,
    blocks: impl Fn(Wired<C>) -> T,
    waits: impl Fn(Wired<C>) -> T,
) {
    let (one, other) = (bus(), bus());
    assert_eq!(blocks(one.clone()), waits(other.clone()));
    assert_eq!(one.seen.borrow().sent, other.seen.borrow().sent);
    assert!(!one.seen.borrow().sent.is_empty());
}

#[test]
fn whichever_frame_of_an_encoder_fails_both_forms_do_the_same() {
    for (error, diagnosis) in [(false, 0x0180), (true, 0x0180), (false, 0x0880)] {
        let between = |bus: &Wired<As5047P>, round: u16| {
            let mut chip = bus.chip.borrow_mut();
            chip.angle = 1000 * round;
            chip.error |= error && round == 2;
            chip.diagnosis = if round == 2 { diagnosis } else { 0x0180 };
        };
        for failing in failing() {
            same(
                || Wired::new(As5047P::at(0), failing),
                |bus| {
                    let mut encoder = MagneticEncoder::new(bus.clone(), Chip::As5047P);
                    [1, 2, 3, 4].map(|round| (between(&bus, round), encoder.angle()).1)
                },
                |bus| {
                    let mut encoder = MagneticEncoder::new(bus.clone(), Chip::As5047P);
                    [1, 2, 3, 4].map(|round| (between(&bus, round), awaited(encoder.angle_async())).1)
                },
            );
        }
    }
}

#[test]
fn whichever_frame_of_an_accelerometer_fails_both_forms_do_the_same() {
    let rounds: [i32; 12] = std::array::from_fn(|round| round as i32);
    let between = |bus: &Wired<chips::Adxl355>, round: i32| {
        *bus.chip.borrow_mut() = chips::Adxl355 { z: 100 * round, ready: round % 6 == 0 };
    };
    for failing in failing() {
        same(
            || Wired::new(chips::Adxl355 { z: 0, ready: false }, failing),
            |bus| {
                let started = Adxl355::start(bus.clone(), Along::Z, Range::G4, PER_COUNT, 3);
                let mut sensor = started.map_err(|(faults, _)| faults)?;
                Ok::<_, Faults>(rounds.map(|round| (between(&bus, round), sensor.vibration()).1))
            },
            |bus| {
                let started = awaited(Adxl355::start_async(bus.clone(), Along::Z, Range::G4, PER_COUNT, 3));
                let mut sensor = started.map_err(|(faults, _)| faults)?;
                Ok::<_, Faults>(rounds.map(|round| (between(&bus, round), awaited(sensor.vibration_async())).1))
            },
        );
    }
}

#[test]
fn whichever_frame_of_a_torque_fails_both_forms_do_the_same() {
    let torques = [1.0, -2.0, f32::NAN, 3.0, f32::INFINITY];
    for failing in failing() {
        for stuck in [false, true] {
            same(
                || Wired::new(Taker { stuck, ..Taker::default() }, failing),
                |bus| torques.map(|torque| Tmc4671::new(bus.clone(), FULL).set_torque(torque, 0)),
                |bus| torques.map(|torque| awaited(Tmc4671::new(bus.clone(), FULL).set_torque_async(torque))),
            );
        }
        for dac in [Dac::Ad5662, Dac::Mcp4921] {
            same(
                || Wired::new(Taker::default(), failing),
                |bus| torques.map(|torque| SpiDac::new(bus.clone(), dac, FULL).set_torque(torque, 0)),
                |bus| torques.map(|torque| awaited(SpiDac::new(bus.clone(), dac, FULL).set_torque_async(torque))),
            );
        }
    }
}

#[test]
fn an_angle_that_was_dropped_half_way_is_never_given_later() {
    for trouble in [false, true] {
        for polls in 0..ALL {
            let bus = Wired::new(As5047P::at(1000), None);
            let mut encoder = MagneticEncoder::new(bus.clone(), Chip::As5047P);
            assert_eq!(awaited(encoder.angle_async()), Ok(1000 << 18));
            bus.chip.borrow_mut().angle = 2000;
            bus.chip.borrow_mut().error = trouble;
            let dropped = polled(encoder.angle_async(), polls);
            // two frames of two waits, and one more to clear an error
            assert_eq!(dropped.is_some(), polls > if trouble { 6 } else { 4 }, "{polls}");
            bus.chip.borrow_mut().angle = 3000;
            let next = awaited(encoder.angle_async());
            // the error bit may still stand
            assert!(next == Ok(3000 << 18) || trouble && next == MISSING, "{polls}: {next:?}");
            bus.chip.borrow_mut().angle = 4000;
            assert_eq!(awaited(encoder.angle_async()), Ok(4000 << 18), "{polls}");
        }
    }
}

#[test]
fn a_diagnosis_of_before_the_drop_is_not_taken_for_new() {
    for polls in 0..4 {
        let bus = Wired::new(As5047P::at(1000), None);
        let mut encoder = MagneticEncoder::new(bus.clone(), Chip::As5047P);
        assert!(awaited(encoder.angle_async()).is_ok());
        assert_eq!(polled(encoder.angle_async(), polls), None);
        // the magnet goes
        bus.chip.borrow_mut().diagnosis = 0x0980;
        let next = [(); 2].map(|()| awaited(encoder.angle_async()));
        // without a drop the diagnosis is that of the tick before, as where it blocks
        let before = if polls == 0 { Ok(1000 << 18) } else { MISSING };
        assert_eq!(next, [before, MISSING], "{polls}");
    }
}

#[test]
fn a_sample_that_was_dropped_is_a_missing_one_and_not_given_later() {
    let bus = Wired::new(chips::Adxl355 { z: 0, ready: false }, None);
    let started = awaited(Adxl355::start_async(bus.clone(), Along::Z, Range::G2, PER_COUNT, 3));
    let mut sensor = started.map_err(|(faults, _)| faults).unwrap();
    for polls in 1..3 {
        *bus.chip.borrow_mut() = chips::Adxl355 { z: 100, ready: true };
        assert_eq!(polled(sensor.vibration_async(), polls), None);
        *bus.chip.borrow_mut() = chips::Adxl355 { z: 200, ready: true };
        assert_eq!(awaited(sensor.vibration_async()), Err(Faults::VIBRATION_MISSING));
        assert_eq!(awaited(sensor.vibration_async()), Ok(None));
        *bus.chip.borrow_mut() = chips::Adxl355 { z: 300, ready: true };
        assert_eq!(awaited(sensor.vibration_async()), Ok(Some(300.0)));
    }
    // a future that was never polled has taken nothing
    bus.chip.borrow_mut().ready = true;
    drop(sensor.vibration_async());
    assert_eq!(awaited(sensor.vibration_async()), Ok(Some(300.0)));
}

#[test]
fn a_sensor_whose_every_poll_is_dropped_has_missing_samples_where_it_blocks_too() {
    let bus = Wired::new(chips::Adxl355 { z: 0, ready: false }, None);
    let mut sensor = Adxl355::start(bus, Along::Z, Range::G2, PER_COUNT, 3).map_err(|(faults, _)| faults).unwrap();
    assert_eq!(polled(sensor.vibration_async(), 1), None);
    assert_eq!(sensor.vibration(), Err(Faults::VIBRATION_MISSING));
}

#[test]
fn a_torque_that_was_dropped_half_way_is_followed_by_the_next_as_ever() {
    for polls in 0..ALL {
        let bus = Wired::new(Taker::default(), None);
        let mut drive = Tmc4671::new(bus.clone(), FULL);
        let _ = polled(drive.set_torque_async(5.0), polls);
        assert_eq!(awaited(drive.set_torque_async(-5.0)), Ok(()));
        assert_eq!(bus.chip.borrow().taken, [0xc0, 0, 0, 0]);
    }
}

type OnTask = Whole<Parts<AwaitedAngle, AwaitedTorque<f32>, super::chips::Stage>>;

/// An axis between awaits that has been governing a turning motor, and its DAC.
fn governing() -> (OnTask, Wired<Taker>) {
    let bus = Wired::new(Taker::default(), None);
    let parts = Parts { angle: AwaitedAngle::new(), torque: AwaitedTorque::new(), enable: chips::Stage::default() };
    let mut axis = OnTask::new(parts, CONFIG, TRIPPING);
    for tick in 0..2 * CAUGHT {
        if tick == CAUGHT {
            axis.start(CONFIG).unwrap();
        }
        awaited(axis.board().angle.fetch(async { Ok(turned(tick)) }));
        let faults = axis.tick(CONFIG, WANTED).faults;
        give(&mut axis, &bus, ALL);
        assert!(tick <= CAUGHT || faults == Faults::NONE, "tick {tick}: {faults}");
    }
    (axis, bus)
}

/// Hands the torque over, or is dropped after so many polls.
fn give(axis: &mut OnTask, bus: &Wired<Taker>, polls: usize) {
    let mut dac = SpiDac::new(bus.clone(), Dac::Ad5662, FullScale::<f32>::new(1000.0));
    let _ = polled(axis.board().torque.give(async |torque| dac.set_torque_async(torque).await), polls);
}

/// A tick, whose angle may be dropped.
fn tick(axis: &mut OnTask, tick: u64, polls: usize) -> driveline::sample::Command<f32> {
    let bus = Wired::new(As5047P::at((turned(tick) >> 18) as u16), None);
    let mut encoder = MagneticEncoder::new(bus, Chip::As5047P);
    let _ = polled(axis.board().angle.fetch(encoder.angle_async()), polls);
    axis.tick(CONFIG, WANTED)
}

#[test]
fn an_angle_that_is_late_is_a_blind_tick() {
    let (mut axis, bus) = governing();
    let from = 2 * CAUGHT;
    for now in from..from + 20 {
        let late = now % 5 == 3;
        let command = tick(&mut axis, now, if late { 3 } else { ALL });
        assert_eq!(command.faults, if late { Faults::ANGLE_MISSING } else { Faults::NONE }, "tick {now}");
        give(&mut axis, &bus, ALL);
    }
    // nobody asked for one
    assert_eq!(axis.tick(CONFIG, WANTED).faults, Faults::ANGLE_MISSING);
}

#[test]
fn a_torque_that_did_not_arrive_trips_in_the_next_tick_and_none_is_given_until_it_arrives() {
    for polls in 1..3 {
        let (mut axis, bus) = governing();
        let from = 2 * CAUGHT;
        assert_ne!(tick(&mut axis, from, ALL).torque, 0.0);
        give(&mut axis, &bus, polls);
        let command = tick(&mut axis, from + 1, ALL);
        assert_eq!((command.torque, command.faults), (0.0, Faults::TORQUE_OUTPUT | Faults::TRIPPED));
        assert!(!axis.board().enable.enabled);
        // and the zero does not arrive either, for some ticks
        for _ in 0..3 {
            give(&mut axis, &bus, 1);
        }
        assert_ne!(bus.chip.borrow().taken[..2], [0x80, 0]);
        give(&mut axis, &bus, ALL);
        assert_eq!(bus.chip.borrow().taken[..2], [0x80, 0], "{polls}");
        // from then on it can be started again
        tick(&mut axis, from + 2, ALL);
        give(&mut axis, &bus, ALL);
        assert_eq!(tick(&mut axis, from + 3, ALL).faults, Faults::TRIPPED);
        axis.start(CONFIG).unwrap();
        assert_eq!(tick(&mut axis, from + 4, ALL).faults, Faults::NONE);
    }
}

#[test]
fn a_torque_that_nobody_hands_over_trips() {
    let (mut axis, _) = governing();
    let from = 2 * CAUGHT;
    assert_eq!(tick(&mut axis, from, ALL).faults, Faults::NONE);
    assert_eq!(tick(&mut axis, from + 1, ALL).faults, Faults::TORQUE_OUTPUT | Faults::TRIPPED);
}

#[test]
fn a_lost_torque_is_not_handed_over_late() {
    let mut torque = AwaitedTorque::<f32>::new();
    torque.set_torque(5.0, 0).unwrap();
    awaited(torque.give(async |torque| if torque == 5.0 { Err(Faults::TORQUE_OUTPUT) } else { panic!("{torque}") }));
    // none instead, and the next tick is told all the same
    let mut given = Vec::new();
    awaited(torque.give(async |torque| {
        given.push(torque);
        Ok(())
    }));
    assert_eq!(given, [0.0]);
    assert_eq!(torque.set_torque(6.0, 0), Err(Faults::TORQUE_OUTPUT));
    awaited(torque.give(async |_| Ok(())));
    assert_eq!(torque.set_torque(7.0, 0), Ok(()));
}
