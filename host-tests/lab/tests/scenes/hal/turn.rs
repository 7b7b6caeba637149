//! One turn of the control loop on a board: what is done in which order, and what becomes of what the board refuses.

use std::cell::RefCell;

use driveline::axis::Board;
use driveline::configure::Machine as _;
use driveline::fault::Faults;
use driveline_firmware::control_loop::main_loop_watch::{Attended, PATIENCE};
use driveline_firmware::control_loop::step::{Asked, Turn};
use driveline_firmware::scene::{Input, Of, Scene, Variant};
use driveline_firmware::scenes::test_rig::{TestRig, Whole};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Done {
    Torque(f32),
    Enabled(bool),
    Alive,
}

/// A board that notes what is done with it, and refuses what it is told to.
#[derive(Default)]
struct Noting {
    done: RefCell<Vec<Done>>,
    refuses: Faults,
    /// Refuses the torque only while it is on: a break.
    broken: bool,
    on: bool,
    angle: u32,
}

impl Noting {
    fn unless(&self, fault: Faults) -> Result<(), Faults> {
        if self.refuses.intersects(fault) { Err(fault) } else { Ok(()) }
    }
}

impl Board<f32> for Noting {
    fn angle(&mut self) -> Result<u32, Faults> {
        self.unless(Faults::ANGLE_MISSING).map(|()| self.angle)
    }

    fn set_torque(&mut self, torque: f32, _: u32) -> Result<(), Faults> {
        self.done.borrow_mut().push(Done::Torque(torque));
        if self.broken && self.on {
            return Err(Faults::TORQUE_OUTPUT);
        }
        self.unless(Faults::TORQUE_OUTPUT)
    }

    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
        self.done.borrow_mut().push(Done::Enabled(enabled));
        self.on = enabled && !self.refuses.intersects(Faults::ENABLE);
        self.unless(Faults::ENABLE)
    }

    fn alive(&mut self) {
        self.done.borrow_mut().push(Done::Alive);
    }
}

const RELEASED: Asked<f32> = Asked { released: true, speed: 50.0 };
const STILL: Result<[f32; 2], Faults> = Ok([0.0; 2]);

/// A turn whose tick gives this torque, or trips.
fn turn(turn: &mut Turn<Noting, f32>, torque: Option<f32>) -> (Input, Vec<Done>) {
    turn.board().done.take();
    let (input, _) = turn.run(RELEASED, STILL, |_, output| {
        output.torque = torque.unwrap_or(0.0).to_bits();
        output.faults = if torque.is_none() { Faults::TRIPPED.bits() } else { 0 };
    });
    (input, turn.board().done.take())
}

#[test]
fn torque_comes_after_the_enable_chain_and_goes_before_it() {
    use Done::{Alive, Enabled, Torque};
    let mut loop_ = Turn::new(Noting::default());
    assert_eq!(loop_.board().done.take(), [Torque(0.0), Enabled(false)]);
    assert_eq!(turn(&mut loop_, None).1, [Alive]);
    assert_eq!(turn(&mut loop_, Some(1.5)).1, [Torque(0.0), Enabled(true), Torque(1.5), Alive]);
    let (input, done) = turn(&mut loop_, Some(2.0));
    assert_eq!(done, [Torque(2.0), Alive]);
    // what was set in the turn before is what the motor has given
    assert_eq!(f32::from_bits(input.torque), 1.5);
    assert_eq!(turn(&mut loop_, None).1, [Torque(0.0), Enabled(false), Alive]);
    assert_eq!(turn(&mut loop_, None).1, [Alive]);
}

#[test]
fn what_the_board_refuses_is_taken_back_at_once_and_told_to_the_next_tick() {
    use Done::{Alive, Enabled, Torque};
    let mut loop_ = Turn::new(Noting::default());
    turn(&mut loop_, Some(1.0));
    loop_.board().broken = true;
    let (input, done) = turn(&mut loop_, Some(1.25));
    assert_eq!(done, [Torque(1.25), Torque(0.0), Enabled(false), Alive]);
    assert_eq!(input.flags, Input::RELEASED);
    let (input, done) = turn(&mut loop_, None);
    assert_eq!(input.flags, Input::RELEASED | Faults::TORQUE_OUTPUT.bits());
    // everything is asked to be off again, and has obeyed
    assert_eq!(done, [Torque(0.0), Enabled(false), Alive]);
    assert_eq!(turn(&mut loop_, None).1, [Alive]);

    // a line that does not go on: no torque but zero has been set
    let mut loop_ = Turn::new(Noting { refuses: Faults::ENABLE, ..Noting::default() });
    let (_, done) = turn(&mut loop_, Some(1.0));
    assert!(done.iter().all(|done| !matches!(done, Torque(torque) if *torque != 0.0)), "{done:?}");
    assert_eq!(turn(&mut loop_, None).0.flags, Input::RELEASED | Faults::ENABLE.bits());
}

#[test]
fn a_reading_that_is_missing_is_told_and_never_taken_for_new() {
    let mut loop_ = Turn::new(Noting { angle: 7, ..Noting::default() });
    assert_eq!(turn(&mut loop_, None).0.angle, 7);
    loop_.board().refuses = Faults::ANGLE_MISSING;
    loop_.board().angle = 9;
    let (input, _) = loop_.run(RELEASED, Err(Faults::VIBRATION_MISSING), |_, _| {});
    assert_eq!(input.flags, Input::RELEASED | Faults::ANGLE_MISSING.bits() | Faults::VIBRATION_MISSING.bits());
    assert_eq!((input.angle, input.vibration), (7, [0; 2]));
}

/// The test rig's own tick on the board.
struct Rig {
    scene: Whole<f32>,
    turn: Turn<Noting, f32>,
}

impl Rig {
    fn new() -> Self {
        Rig { scene: Of::<TestRig, Whole<f32>>::start(), turn: Turn::new(Noting::default()) }
    }

    fn ticks(&mut self, ticks: u32, asked: Asked<f32>) -> Faults {
        let scene = &mut self.scene;
        let mut faults = 0;
        for _ in 0..ticks {
            faults = self.turn.run(asked, STILL, |input, output| *output = scene.tick(input)).1.faults;
        }
        Faults::from_bits(faults)
    }

    fn is_on(&mut self) -> bool {
        self.turn.board().on
    }
}

#[test]
fn a_break_trips_until_the_drive_is_released_again() {
    let mut rig = Rig::new();
    assert_eq!(rig.ticks(10, Asked { released: false, speed: 0.0 }), Faults::TRIPPED);
    assert!(!rig.is_on());
    assert_eq!(rig.ticks(10, RELEASED), Faults::NONE);
    assert!(rig.is_on());
    rig.turn.board().broken = true;
    rig.ticks(1, RELEASED);
    assert!(!rig.is_on(), "off in the turn of the break");
    assert!(rig.ticks(1, RELEASED).contains(Faults::TORQUE_OUTPUT.with(Faults::TRIPPED)));
    rig.turn.board().broken = false;
    assert_eq!(rig.ticks(100, RELEASED), Faults::TRIPPED);
    assert!(!rig.is_on(), "it has not been released anew");
    rig.ticks(1, Asked { released: false, ..RELEASED });
    assert_eq!(rig.ticks(1, RELEASED), Faults::NONE);
    assert!(rig.is_on());
}

#[test]
fn an_angle_that_stays_away_trips() {
    let mut rig = Rig::new();
    rig.ticks(10, RELEASED);
    rig.turn.board().refuses = Faults::ANGLE_MISSING;
    // the screening's limit, 15 ms, is the last tick that is borne
    let limit = TestRig::RATE_HZ / 67;
    assert_eq!(rig.ticks(limit, RELEASED), Faults::ANGLE_MISSING);
    assert!(rig.is_on());
    assert!(rig.ticks(2, RELEASED).contains(Faults::ANGLE_LOST.with(Faults::TRIPPED)));
    assert!(!rig.is_on());
}

#[test]
fn a_main_loop_that_hangs_is_seen_and_one_that_is_busy_is_not() {
    let mut attended = Attended::default();
    // turns of a hundredth of a second, over the counter's end
    for tick in 0..100_000_u32 {
        assert!(attended.check((u32::MAX - 500).wrapping_add(tick / 100)), "tick {tick}");
    }
    // the last turn began a hundred ticks ago
    let turns = (u32::MAX - 500).wrapping_add(999);
    let hung = (1..).find(|_| !attended.check(turns)).unwrap();
    assert_eq!(hung, PATIENCE - 99);
    assert!(!attended.check(turns));
    assert!(attended.check(turns + 1));
    // one that never begins is seen too
    let mut attended = Attended::default();
    assert_eq!((1..).find(|_| !attended.check(0)), Some(PATIENCE));
}
