//! The tick path against closed forms of one or a few ticks, with numbers small enough to be checked by hand.
//!
//! Each test notices one deliberate error that the runs over whole machines would hide: a sign, a part left out, a
//! state that is kept or lost. It needs the library alone, so that every mutant of the tick path is judged in seconds.

mod any_design;
#[cfg(feature = "balancing")]
mod balancing;
mod composed_loop;
mod drive;
mod fluctuation;
mod governor;
mod number;
mod observer;
mod settings;
mod switch;
mod wheel;
mod window;

use driveline::observer::RigidConfig;

/// An inertia of one, ticks as unit of time, 2^-32 turn as unit of angle, and no correction: pure prediction.
const UNIT: RigidConfig<f64> = RigidConfig {
    acceleration: 1.0,
    turn: 0.5,
    correction: [0.0, 0.0],
    angle_correction: 0.0,
    speed: 1.0,
    load_share: 0.25,
};

/// Of the values of a setting these are accepted, and these are refused.
#[track_caller]
fn accepts<V: Copy + core::fmt::Debug, T, E>(right: &[V], wrong: &[V], made: impl Fn(V) -> Result<T, E>) {
    for &value in right {
        assert!(made(value).is_ok(), "{value:?}");
    }
    for &value in wrong {
        assert!(made(value).is_err(), "{value:?}");
    }
}
