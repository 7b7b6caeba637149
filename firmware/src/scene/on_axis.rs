//! An axis as a scene: the drive and its reaction to a board's faults, over an image of the board's inputs and outputs.
//!
//! Inputs and outputs are passed as values; no register is accessed in between. So the tick is the
//! same machine code on a board with a motor, where [`Turn`](crate::control_loop::step::Turn) reads and does, and in
//! QEMU, where the host does.
//!
//! Into [`Input::flags`] go [`Input::RELEASED`] and the board's faults as bits of [`Faults`]: of this reading (angle,
//! torque, vibration) and of the outputs after the last tick (torque output, enable). [`Output::faults`] has
//! [`Faults::TRIPPED`] while the power stage is to be off.

use core::marker::PhantomData;

use driveline::axis::{Axis, Board, TRIPPING};
use driveline::configure::{HasVibration, VibrationNumber};
use driveline::drive::ConfigOf;
use driveline::fault::Faults;
use driveline::fluctuation::Fluctuation;
use driveline::governor::Governor;
use driveline::number::{Number, Part};
use driveline::observer::Observer;

use crate::scene::balanced::{BalancedDrive, state};
use crate::scene::composed::output;
use crate::scene::panel_keys::{DONE, Key, refused};
use crate::scene::{FromConfig, Input, Output, Scene};

/// Faults of a board in the flags of an input.
const OF_THE_BOARD: Faults = Faults::ANGLE_MISSING
    .with(Faults::VIBRATION_MISSING)
    .with(Faults::TORQUE_OUTPUT)
    .with(Faults::ENABLE)
    .with(Faults::TORQUE);

/// Readings of a board, in place of the board.
struct Image<N> {
    angle: u32,
    torque: N,
    faults: Faults,
}

impl<N: Number> Image<N> {
    #[inline(always)]
    fn unless(&self, fault: Faults) -> Result<(), Faults> {
        if self.faults.intersects(fault) { Err(fault) } else { Ok(()) }
    }
}

impl<N: Number> Board<N> for Image<N> {
    #[inline(always)]
    fn angle(&mut self) -> Result<u32, Faults> {
        self.unless(Faults::ANGLE_MISSING).map(|()| self.angle)
    }

    #[inline(always)]
    fn torque(&mut self, _: N) -> Result<N, Faults> {
        self.unless(Faults::TORQUE).map(|()| self.torque)
    }

    #[inline(always)]
    fn set_torque(&mut self, _: N, _: u32) -> Result<(), Faults> {
        self.unless(Faults::TORQUE_OUTPUT)
    }

    #[inline(always)]
    fn set_enabled(&mut self, _: bool) -> Result<(), Faults> {
        self.unless(Faults::ENABLE)
    }
}

/// An axis with its constants. Its panel is beside it, as [`AxisPanel`](crate::panel::axis_panel::AxisPanel): here it
/// only begins readings.
pub struct OnAxis<M, N, O, G, F>
where
    N: VibrationNumber + 'static,
    O: Part<N, State: Observer<N, Config: 'static>>,
    G: Part<N, State: Governor<N, Config: 'static>>,
    F: Part<N, State: Fluctuation<N, Config: 'static>>,
{
    // By reference: folded into the code, the constants cost more instructions than loaded from a table.
    config: &'static ConfigOf<BalancedDrive<N, O, G, F>>,
    axis: Axis<Image<N>, BalancedDrive<N, O, G, F>>,
    released: bool,
    machine: PhantomData<M>,
}

impl<M, N, O, G, F> OnAxis<M, N, O, G, F>
where
    N: VibrationNumber + 'static,
    O: Part<N, State: Observer<N, Config: 'static>>,
    G: Part<N, State: Governor<N, Config: 'static>>,
    F: Part<N, State: Fluctuation<N, Config: 'static>>,
{
    /// The drive, to look at.
    pub fn drive(&self) -> &BalancedDrive<N, O, G, F> {
        self.axis.drive()
    }

    /// The drive, for actions between two ticks.
    pub fn drive_mut(&mut self) -> &mut BalancedDrive<N, O, G, F> {
        self.axis.drive_mut()
    }
}

impl<M, N, O, G, F> FromConfig for OnAxis<M, N, O, G, F>
where
    M: HasVibration,
    N: VibrationNumber + 'static,
    O: Part<N, State: Observer<N, Config: 'static>>,
    G: Part<N, State: Governor<N, Config: 'static>>,
    F: Part<N, State: Fluctuation<N, Config: 'static>>,
{
    type Drive = BalancedDrive<N, O, G, F>;

    fn from_config(config: &'static ConfigOf<Self::Drive>) -> Self {
        // An incremental encoder counts from where it was switched on.
        let board = Image { angle: 0, torque: N::ZERO, faults: Faults::NONE };
        OnAxis { config, axis: Axis::new(board, config, TRIPPING), released: false, machine: PhantomData }
    }
}

impl<M, N, O, G, F> Scene for OnAxis<M, N, O, G, F>
where
    M: HasVibration,
    N: VibrationNumber + 'static,
    O: Part<N, State: Observer<N, Config: 'static>>,
    G: Part<N, State: Governor<N, Config: 'static>>,
    F: Part<N, State: Fluctuation<N, Config: 'static>>,
{
    #[inline(always)]
    fn tick(&mut self, input: &Input) -> Output {
        let word = <N as Number>::from_word;
        let config = self.config;
        let faults = Faults::from_bits(input.flags) & OF_THE_BOARD;
        *self.axis.board() = Image { angle: input.angle, torque: word(input.torque), faults };
        let released = input.flags & Input::RELEASED != 0;
        if released != self.released {
            self.released = released;
            if released {
                // the tick reports the cause, and it stays off until the next release
                let _ = self.axis.start(config);
            } else {
                self.axis.trip();
            }
        }
        let mut command = self.axis.tick(config, word(input.setpoint));
        let vibration = self.axis.board().unless(Faults::VIBRATION_MISSING).map(|()| Some(input.vibration.map(word)));
        command.faults |= self.axis.vibration(config, vibration);
        output(&command, &self.axis.drive().estimate(config))
    }

    fn panel(&mut self, [key, _]: [u32; 2]) -> u32 {
        match Key::of(key) {
            None => 0,
            Some(Key::Begin) => {
                self.drive_mut().balancer_mut().begin();
                DONE
            }
            Some(Key::State) => state::<M, N>(&self.config.balancer, self.drive().balancer()),
            Some(_) => refused(3),
        }
    }
}
