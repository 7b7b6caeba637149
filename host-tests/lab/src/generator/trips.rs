//! Every trip of the diesel, brought about: that it comes, commands no torque, keeps its reason when the cause has
//! gone, and is left by a reset.
//!
//! The cause goes a second after the trip. For another half second the run switch stays on; then it goes off, which
//! resets the trip; but a rack that is still stuck trips again at once.

use driveline::governor::Trip;
use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::generator::{RATED_SPEED, panel};

use super::run::{Broken, Moment, Program, run};
use super::set::Kind;
use driveline_closed_loop::ticks::Ticks;
use driveline_closed_loop::units::Units;

/// A cause, and the trip that it is to bring about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cause {
    /// Action.
    pub what: &'static str,
    pub trip: Trip,
    /// When it is done, and until when the trip has to have come, after it (s).
    at: f64,
    within: f64,
    act: Act,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Act {
    /// The setpoint is this, of rated speed.
    Setpoint(f64),
    /// The set is found turning at this, of rated speed.
    Turning(f64),
    /// The load is this, of rated power.
    Load(f64),
    /// The angle is this word.
    Angle(u32),
    /// The rack seizes, and the load goes after 0.2 s.
    Seizes,
    /// The rack's sensor freezes, and the load goes after 0.2 s.
    Frozen,
    /// The rack's sensor reports no torque.
    Absent,
    /// A request of the panel.
    Panel,
}

/// A cause for every trip.
pub const CAUSES: [Cause; 10] = [
    // A ramp of 25 % a second to 110 %, and 10 ms.
    Cause { what: "setpoint 115 %", trip: Trip::Overspeed, at: 3.0, within: 0.8, act: Act::Setpoint(1.15) },
    // The same to 80 %, and 3 s.
    Cause { what: "setpoint 70 %", trip: Trip::Underspeed, at: 3.0, within: 4.5, act: Act::Setpoint(0.7) },
    Cause { what: "started turning back at 5 %", trip: Trip::Reverse, at: 0.5, within: 0.1, act: Act::Turning(-0.05) },
    // A fault of the generator: the coupling carries its engine's share of the inertia, 0.35, and swings.
    Cause { what: "load 1000 %", trip: Trip::ShaftOverload, at: 3.0, within: 0.1, act: Act::Load(10.0) },
    Cause { what: "angle frozen", trip: Trip::SensorLoss, at: 3.0, within: 0.05, act: Act::Angle(u32::MAX) },
    Cause { what: "rack's position absent", trip: Trip::SensorLoss, at: 3.0, within: 0.15, act: Act::Absent },
    // 30 s.
    Cause {
        what: "setpoint 60 % at the start",
        trip: Trip::NotStarted,
        at: 0.5,
        within: 30.5,
        act: Act::Setpoint(0.6),
    },
    Cause { what: "emergency stop", trip: Trip::Requested, at: 3.0, within: 0.01, act: Act::Panel },
    // The command has moved by a fifth within 0.1 s of the load, and 0.1 s more.
    Cause { what: "rack seized, then load off", trip: Trip::Actuator, at: 3.0, within: 0.5, act: Act::Seizes },
    Cause {
        what: "rack's position frozen, then load off",
        trip: Trip::Actuator,
        at: 3.0,
        within: 0.5,
        act: Act::Frozen,
    },
];

/// Result of a cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Latched {
    /// Actions.
    pub what: &'static str,
    /// The trip that came and how long after the cause (s).
    pub trip: Option<(String, f64)>,
    /// Least and largest torque commanded up to it, of rated.
    pub torque: [f64; 2],
    /// Largest torque commanded after it, of rated.
    pub after: f64,
    /// Whether it stood with its reason, the cause gone, until it was reset.
    pub stands: bool,
    /// Whether the reset left it.
    pub reset: bool,
    /// Whether the cause never goes, so that a reset must not leave it.
    pub lasting: bool,
    /// Whether all that is as documented.
    pub as_documented: bool,
}

/// Brings a trip about on the diesel at half load.
pub fn latched(words: Words, drive: &mut impl Ticks, cause: &Cause) -> Result<Latched, Broken> {
    let units = Units::new(words, Kind::Diesel.constants().bases());
    let (mut speed, mut loads, mut seizes) = (RATED_SPEED, vec![(0.5, 0.5)], None);
    match cause.act {
        Act::Turning(share) => (speed, loads) = (share * RATED_SPEED, Vec::new()),
        Act::Load(share) => loads.push((cause.at, share)),
        Act::Seizes | Act::Frozen => loads.push((cause.at + 0.2, 0.0)),
        // A start, without load.
        Act::Setpoint(_) if cause.trip == Trip::NotStarted => (speed, loads) = (20.0, Vec::new()),
        _ => {}
    }
    if cause.act == Act::Seizes {
        seizes = Some(cause.at);
    }
    let gone = cause.at + cause.within + 1.0;
    let (off, duration) = (gone + 0.5, gone + 0.6);
    let program =
        Program { speed, on: if speed == RATED_SPEED { 0.2 } else { 0.5 }, constants: 0, loads, seizes, duration };
    let mut held = 0;
    let spoil = |time: f64, input: &mut Input| {
        if time >= off {
            input.flags &= !Input::RELEASED;
        }
        if time < cause.at || time >= gone {
            held = input.torque;
            return;
        }
        match cause.act {
            Act::Setpoint(share) => input.setpoint = units.speed_word(share * RATED_SPEED),
            Act::Angle(word) => input.angle = word,
            Act::Frozen => input.torque = held,
            Act::Absent if words == Words::Single => input.torque = f32::NAN.to_bits(),
            Act::Absent => input.torque = 1 << 31,
            Act::Panel => input.asked = [panel::TRIP, 0],
            Act::Turning(_) | Act::Load(_) | Act::Seizes => {}
        }
    };
    Ok(judge(&run(Kind::Diesel, words, &program, drive, spoil)?, cause, off))
}

fn judge(moments: &[Moment], cause: &Cause, off: f64) -> Latched {
    let first = moments.iter().position(|moment| moment.mode >= 16).unwrap_or(moments.len());
    let (before, after) = moments.split_at(first);
    let trip = after.first().map(|moment| {
        let name = Trip::NAMES.iter().find(|(trip, _)| *trip as u32 + 16 == moment.mode).map_or("", |(_, name)| name);
        (name.to_owned(), moment.time - cause.at)
    });
    let commands = || before.iter().map(|moment| moment.command);
    let torque = [commands().fold(0.0, f64::min), commands().fold(0.0, f64::max)];
    // A request of the panel follows the tick.
    let skipped = usize::from(cause.act == Act::Panel);
    let largest = after.iter().skip(skipped).map(|moment| moment.command.abs()).fold(0.0, f64::max);
    let stands = after.iter().filter(|moment| moment.time < off).all(|moment| moment.mode == cause.trip as u32 + 16);
    let reset = moments.last().is_some_and(|moment| moment.mode == 0);
    let lasting = cause.act == Act::Seizes;
    let due = after.first().is_some_and(|moment| {
        let late = moment.time - cause.at;
        moment.mode == cause.trip as u32 + 16 && late >= 0.0 && late <= cause.within
    });
    Latched {
        what: cause.what,
        trip,
        torque,
        after: largest,
        stands,
        reset,
        lasting,
        as_documented: due
            && stands
            && reset != lasting
            && largest == 0.0
            && torque[0] >= 0.0
            && torque[1] <= super::faults::MOST,
    }
}
