//! A fault on every wire of the diesel, and a cause for every trip: it rides through, or trips for its reason, and then
//! commands no torque, keeps the reason when the cause has gone, and is left by a reset.

use driveline::governor::Trip;
use driveline_closed_loop::units::Units;
use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::generator::{RATED_SPEED, panel};
use driveline_lab::generator::run::{Moment, Program, run};
use driveline_lab::generator::set::Kind;
use driveline_solver::noise::Noise;

use super::sets::{MOST, on_host};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Wire {
    Angle,
    Rack,
    Setpoint,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// Zero.
    Dropped,
    Frozen,
    /// A degree of the angle, half the rated torque, 5 % of rated speed (standard deviations).
    Noisy,
    Negated,
    /// Not a number; every bit of an angle, the most negative number of fixed point.
    NotANumber,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Act {
    /// The setpoint is this, of rated speed; the second is at the start.
    Setpoint(f64),
    Start(f64),
    /// The set is found turning at this, of rated speed.
    Turning(f64),
    /// The load is this, of rated power.
    Load(f64),
    On(Wire, Fault),
    /// The rack seizes, or its sensor freezes, and the load goes after 0.2 s.
    Seizes,
    FrozenOff,
    Requested,
}

const WIRES: [Wire; 3] = [Wire::Angle, Wire::Rack, Wire::Setpoint];
const FAULTS: [Fault; 5] = [Fault::Dropped, Fault::Frozen, Fault::Noisy, Fault::Negated, Fault::NotANumber];

/// When it is done (s): to a set that turns steadily, or to one that starts.
fn at(act: Act) -> f64 {
    if matches!(act, Act::Start(_) | Act::Turning(_)) { 0.5 } else { STEADY }
}

const STEADY: f64 = 3.0;

/// What trips it, for which of these reasons, and within what time (s).
const TRIPS: [(Act, &[Trip], f64); 19] = [
    // A ramp of 25 % a second to 110 %, and 10 ms; the same to 80 %, and 3 s.
    (Act::Setpoint(1.15), &[Trip::Overspeed], 0.8),
    (Act::Setpoint(0.7), &[Trip::Underspeed], 4.5),
    (Act::Start(0.6), &[Trip::NotStarted], 30.5),
    (Act::Turning(-0.05), &[Trip::Reverse], 0.1),
    // A fault of the generator: the coupling carries its engine's share of the inertia, 0.35, and swings.
    (Act::Load(10.0), &[Trip::ShaftOverload], 0.1),
    (Act::Requested, &[Trip::Requested], 0.01),
    // The command has moved by a fifth within 0.1 s of the load, and 0.1 s more.
    (Act::Seizes, &[Trip::Actuator], 0.5),
    (Act::FrozenOff, &[Trip::Actuator], 0.5),
    // The angle is lost after 15 ms; with noise, plausible angles come between.
    (Act::On(Wire::Angle, Fault::Dropped), &[Trip::SensorLoss], 0.1),
    (Act::On(Wire::Angle, Fault::Frozen), &[Trip::SensorLoss], 0.1),
    (Act::On(Wire::Angle, Fault::Noisy), &[Trip::SensorLoss], 0.1),
    (Act::On(Wire::Angle, Fault::Negated), &[Trip::SensorLoss], 0.1),
    (Act::On(Wire::Angle, Fault::NotANumber), &[Trip::SensorLoss], 0.1),
    // 0.1 s.
    (Act::On(Wire::Rack, Fault::NotANumber), &[Trip::SensorLoss], 0.11),
    (Act::On(Wire::Rack, Fault::Dropped), &[Trip::Actuator], 0.11),
    (Act::On(Wire::Rack, Fault::Negated), &[Trip::Actuator], 0.11),
    // Half the rated torque of noise is beyond a fifth of it in two ticks of three: these less the others take three
    // times as long. Some are beyond what a rack can stand for.
    (Act::On(Wire::Rack, Fault::Noisy), &[Trip::Actuator, Trip::SensorLoss], 0.4),
    // A setpoint of zero or below is one: the set slows down by its ramp, to 80 % in a second, and 3 s of underspeed
    // trip it, unless its load of constant power overloads the coupling before.
    (Act::On(Wire::Setpoint, Fault::Dropped), &[Trip::ShaftOverload, Trip::Underspeed], 4.5),
    (Act::On(Wire::Setpoint, Fault::Negated), &[Trip::ShaftOverload, Trip::Underspeed], 4.5),
];

/// The diesel at half load through something that lasts until a time; the run switch goes off half a second later.
fn moments(words: Words, act: Act, until: f64, duration: f64) -> Vec<Moment> {
    let units = Units::new(words, Kind::Diesel.constants().bases());
    let at = at(act);
    let (mut speed, mut on, mut loads) = (RATED_SPEED, 0.2, vec![(0.5, 0.5)]);
    match act {
        Act::Turning(share) => (speed, on, loads) = (share * RATED_SPEED, at, Vec::new()),
        Act::Start(_) => (speed, on, loads) = (20.0, at, Vec::new()),
        Act::Load(share) => loads.push((at, share)),
        Act::Seizes | Act::FrozenOff => loads.push((at + 0.2, 0.0)),
        _ => {}
    }
    let seizes = (act == Act::Seizes).then_some(at);
    let program = Program { speed, on, constants: 0, loads, seizes, duration };
    let (mut held, mut noise) = (Input::default(), Noise::new(2));
    let spoil = |time: f64, input: &mut Input| {
        if time >= until + 0.5 {
            input.flags &= !Input::RELEASED;
        }
        if time < at || time >= until {
            held = *input;
            return;
        }
        let (wire, fault) = match act {
            Act::Setpoint(share) | Act::Start(share) => return input.setpoint = units.speed_word(share * RATED_SPEED),
            Act::Requested => return input.asked = [panel::TRIP, 0],
            Act::FrozenOff => (Wire::Rack, Fault::Frozen),
            Act::On(wire, fault) => (wire, fault),
            Act::Turning(_) | Act::Load(_) | Act::Seizes => return,
        };
        let rated = Kind::Diesel.constants().rated_torque;
        let (value, held) = match wire {
            Wire::Angle => (&mut input.angle, held.angle),
            Wire::Rack => (&mut input.torque, held.torque),
            Wire::Setpoint => (&mut input.setpoint, held.setpoint),
        };
        *value = match (fault, wire) {
            (Fault::Dropped, _) => 0,
            (Fault::Frozen, _) => held,
            (Fault::Noisy, Wire::Angle) => value.wrapping_add((noise.normal() * 4_294_967_296.0 / 360.0) as i64 as u32),
            (Fault::Noisy, Wire::Rack) => units.torque_word(units.torque(*value) + 0.5 * rated * noise.normal()),
            (Fault::Noisy, _) => units.speed_word(units.speed(*value) + 0.05 * RATED_SPEED * noise.normal()),
            (Fault::Negated, Wire::Angle) => value.wrapping_neg(),
            (Fault::Negated, Wire::Rack) => units.torque_word(-units.torque(*value)),
            (Fault::Negated, Wire::Setpoint) => units.speed_word(-units.speed(*value)),
            (Fault::NotANumber, Wire::Angle) => u32::MAX,
            (Fault::NotANumber, _) if words == Words::Single => f32::NAN.to_bits(),
            (Fault::NotANumber, _) => 1 << 31,
        };
    };
    run(Kind::Diesel, words, &program, &mut on_host(Kind::Diesel, words), spoil).unwrap()
}

#[test]
fn every_trip_latches_with_its_reason() {
    for (trip, name) in Trip::NAMES {
        assert!(TRIPS.iter().any(|(_, reasons, _)| reasons.contains(&trip)), "{name}");
    }
    for (act, reasons, within) in TRIPS {
        for words in [Words::Single, Words::Fixed] {
            let gone = at(act) + within + 1.0;
            let moments = moments(words, act, gone, gone + 0.6);
            let first = moments.iter().position(|moment| moment.mode >= 16);
            let (before, after) = moments.split_at(first.unwrap_or_else(|| panic!("{act:?} {words:?}: no trip")));
            let (mode, late) = (after[0].mode, after[0].time - at(act));
            let is_due = reasons.iter().any(|trip| *trip as u32 + 16 == mode) && (0.0..=within).contains(&late);
            assert!(is_due, "{act:?} {words:?}: mode {mode} after {late} s");
            assert!(before.iter().all(|moment| (0.0..=MOST).contains(&moment.command)), "{act:?} {words:?}");
            // a request of the panel follows the tick
            let mut after = after.iter().skip(usize::from(act == Act::Requested));
            assert!(after.all(|moment| moment.command == 0.0), "{act:?} {words:?}: torque after the trip");
            let mut armed = moments[before.len()..].iter().filter(|moment| moment.time < gone + 0.5);
            assert!(armed.all(|moment| moment.mode == mode), "{act:?} {words:?}: another reason");
            // a rack that is stuck trips again at once
            assert_eq!(moments.last().unwrap().mode == 0, act != Act::Seizes, "{act:?} {words:?}: reset");
        }
    }
}

/// What it rides through: 5 ms of any fault, by coasting or by another torque than the true one; a reading that is still
/// as expected; a last good setpoint; 5 % of noise, of which the ramp lets 0.01 % through in a tick.
#[test]
fn what_is_no_reason_to_trip_is_ridden_through() {
    let all = WIRES.into_iter().flat_map(|wire| FAULTS.map(|fault| (wire, fault, 0.005, 0.01)));
    let lasting = [
        (Wire::Rack, Fault::Frozen, 6.0, 0.01),
        (Wire::Setpoint, Fault::Frozen, 6.0, 0.01),
        (Wire::Setpoint, Fault::NotANumber, 6.0, 0.01),
        (Wire::Setpoint, Fault::Noisy, 6.0, 0.02),
    ];
    for (wire, fault, lasts, off) in all.chain(lasting) {
        for words in [Words::Single, Words::Fixed] {
            let until = STEADY + lasts;
            for moment in moments(words, Act::On(wire, fault), until, until + 0.4) {
                let rides = moment.mode < 16 && (0.0..=MOST).contains(&moment.command);
                let holds = moment.time < STEADY || (moment.frequency - 1.0).abs() <= off;
                assert!(rides && holds, "{wire:?} {fault:?} {words:?} for {lasts} s: {moment:?}");
            }
        }
    }
}
