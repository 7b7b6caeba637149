//! A board whose parts do what a test says, and the hoist's drive on it.

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::rc::Rc;

use driveline::axis::{Axis, Board, TRIPPING};
use driveline::drive::{ConfigOf, Drive};
use driveline::fault::Faults;
use driveline::governor::SpeedLoop;
use driveline::observer::{GearedObserver, SemiImplicitObserver};

use crate::hoist::Hoist;

pub type Observer = GearedObserver<SemiImplicitObserver>;
type HoistDrive = Drive<f32, Observer, SpeedLoop>;
pub const CONFIG: &ConfigOf<HoistDrive> = const { &HoistDrive::configure::<Hoist<10_000>>() };

/// The speed at which the motor turns (rad/s), and what is wanted of it: more, so that there is torque.
pub const SPEED: f64 = 30.0;
pub const WANTED: f32 = 31.0;

/// The motor's angle at a tick, 2^32 to the turn.
pub fn turned(tick: u64) -> u32 {
    (SPEED * tick as f64 * 1e-4 / TAU * 4_294_967_296.0) as u64 as u32
}

type Asked<T> = Box<dyn FnMut(u64) -> Result<T, Faults>>;
type Told<T> = Box<dyn FnMut(T) -> Result<(), Faults>>;

/// A board of closures, and its commands.
pub struct Scripted {
    pub tick: u64,
    /// Ticks that the board has missed before the next one.
    pub missed: u32,
    pub angle: Asked<u32>,
    pub torque: Told<f32>,
    pub enable: Told<bool>,
    pub told: Rc<RefCell<Vec<String>>>,
}

impl Scripted {
    /// A board without a fault.
    pub fn sound() -> Self {
        Scripted {
            tick: 0,
            missed: 0,
            angle: Box::new(|tick| Ok(turned(tick))),
            torque: Box::new(|_| Ok(())),
            enable: Box::new(|_| Ok(())),
            told: Rc::default(),
        }
    }

    /// Whether it was switched on last.
    pub fn is_enabled(&self) -> bool {
        self.told.borrow().iter().rfind(|told| told.starts_with("enabled")).is_some_and(|told| told == "enabled true")
    }
}

impl Board<f32> for Scripted {
    fn missed(&mut self) -> u32 {
        self.missed
    }
    fn angle(&mut self) -> Result<u32, Faults> {
        let tick = self.tick;
        self.tick += 1;
        (self.angle)(tick)
    }
    fn set_torque(&mut self, torque: f32, _angle: u32) -> Result<(), Faults> {
        self.told.borrow_mut().push(format!("torque {torque}"));
        (self.torque)(torque)
    }
    fn set_enabled(&mut self, enabled: bool) -> Result<(), Faults> {
        self.told.borrow_mut().push(format!("enabled {enabled}"));
        (self.enable)(enabled)
    }
}

pub type Whole<P> = Axis<P, HoistDrive>;

/// Ticks after which a drive that was switched on under a turning motor has caught it: the 150 that its limit counts,
/// and the search.
pub const CAUGHT: u64 = 400;

/// An axis that has caught a turning motor and has been governing it for as many ticks again.
pub fn governing(board: Scripted) -> Whole<Scripted> {
    let mut axis = Whole::new(board, CONFIG, TRIPPING);
    for _ in 0..CAUGHT {
        axis.tick(CONFIG, WANTED);
    }
    axis.start(CONFIG).unwrap();
    for _ in 0..CAUGHT {
        assert_eq!(axis.tick(CONFIG, WANTED).faults, Faults::NONE);
    }
    assert!(axis.board().is_enabled());
    axis
}
