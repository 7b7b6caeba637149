//! Speed loops: the library's, and controllers of other crates with the same gains, limit and ramp.
//!
//! The others, and the library's loop beside them, get the motor's speed by difference and a low-pass. `driveline rigid
//! observer and loop` gets it from the scene's observer of one mass.

use driveline::governor::{Governor, SpeedLoop, SpeedLoopConfig};
use driveline::number::Number;
use driveline::observer::Observer;
use driveline::sample::Estimate;
use driveline::settings::{Bases, SpeedLoopSettings};
use driveline_firmware::scene::{Input, Output};
use dsp_process::SplitProcess;
use idsp::Build;
use idsp::iir::{BiquadClamp, DirectForm1, pid as idsp_pid};
use pid::Pid;
use pid_ctrl::{PidCtrl, PidIn};

use crate::model::Replayed;
use crate::scene::Scene;

/// Corner of the low-pass, over the loop's bandwidth: five times as far away as the phase that a damped loop can spare.
const CORNER: f32 = 20.0;

/// A controller with its setpoint already ramped.
pub trait Controller {
    /// Torque for a setpoint and a speed (rad/s).
    fn command(&mut self, setpoint: f32, speed: f32) -> f32;
}

/// A controller behind the low-pass.
#[derive(Clone, Copy, Debug)]
pub struct OnLowPass<C> {
    controller: C,
    /// Rate, share of a tick of the low-pass, change of the setpoint in a tick.
    constants: [f32; 3],
    angle: u32,
    speed: f32,
    ramped: f32,
}

impl<C> OnLowPass<C> {
    /// At a standstill.
    pub fn new(scene: &Scene, controller: C) -> Self {
        let share = CORNER * (scene.speed_loop.bandwidth * scene.period()) as f32;
        let constants = [scene.rate_hz as f32, share / (1.0 + share), (scene.ramp * scene.period()) as f32];
        OnLowPass { controller, constants, angle: 0, speed: 0.0, ramped: 0.0 }
    }
}

impl<C: Controller> Replayed for OnLowPass<C> {
    fn start(&mut self, input: &Input) {
        (self.angle, self.speed, self.ramped) = (input.angle, 0.0, 0.0);
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input, output: &mut Output) {
        const TURN: f32 = core::f32::consts::TAU / 4_294_967_296.0;
        let [rate, share, ramp] = self.constants;
        let turn = input.angle.wrapping_sub(self.angle) as i32 as f32 * TURN;
        self.angle = input.angle;
        self.speed += share * (turn * rate - self.speed);
        let rise = f32::from_bits(input.setpoint) - self.ramped;
        self.ramped += if rise > ramp {
            ramp
        } else if rise < -ramp {
            -ramp
        } else {
            rise
        };
        output.torque = self.controller.command(self.ramped, self.speed).to_bits();
    }
}

/// Proportional gain, integral gain (1/s) and torque limit of a scene.
fn gains(scene: &Scene) -> [f32; 3] {
    [scene.speed_loop.proportional, scene.speed_loop.integral, scene.torque_limit].map(|value| value as f32)
}

/// The library's loop alone; the ramp of its own has nothing left to do.
#[derive(Clone, Copy, Debug)]
pub struct LibraryLoop(SpeedLoop, SpeedLoopConfig<f32>);

impl LibraryLoop {
    /// With the scene's gains; none that `f32` does not hold.
    pub fn new(scene: &Scene) -> Option<Self> {
        let config = SpeedLoopConfig::<f32>::try_new(&scene.speed_loop, settings(scene), Bases::SI).ok()?;
        Some(LibraryLoop(SpeedLoop::default(), config))
    }
}

impl Controller for LibraryLoop {
    #[inline(always)]
    fn command(&mut self, setpoint: f32, speed: f32) -> f32 {
        self.0.set_setpoint(setpoint);
        let estimate = Estimate { motor_speed: speed, load_speed: speed, ..Estimate::default() };
        self.0.command(&self.1, &estimate)
    }
}

/// Limit and ramp of a scene's loop.
pub fn settings(scene: &Scene) -> SpeedLoopSettings {
    SpeedLoopSettings { torque_limit: scene.torque_limit, ramp: scene.ramp }
}

/// `pid`.
#[derive(Clone, Copy, Debug)]
pub struct ByPid(Pid<f32>);

impl ByPid {
    /// With the scene's gains.
    pub fn new(scene: &Scene) -> Self {
        let [proportional, integral, limit] = gains(scene);
        let mut pid = Pid::new(0.0, limit);
        pid.p(proportional, f32::MAX).i(integral * scene.period() as f32, limit);
        ByPid(pid)
    }
}

impl Controller for ByPid {
    #[inline(always)]
    fn command(&mut self, setpoint: f32, speed: f32) -> f32 {
        self.0.setpoint = setpoint;
        self.0.next_control_output(speed).output
    }
}

/// `pid-ctrl`.
#[derive(Clone, Copy, Debug)]
pub struct ByPidCtrl(PidCtrl<f32>, f32);

impl ByPidCtrl {
    /// With the scene's gains.
    pub fn new(scene: &Scene) -> Self {
        let [proportional, integral, limit] = gains(scene);
        let mut pid = PidCtrl::new_with_pid(proportional, integral, 0.0);
        pid.ki.limits.set_limit(limit);
        pid.limits.set_limit(limit);
        ByPidCtrl(pid, scene.period() as f32)
    }
}

impl Controller for ByPidCtrl {
    #[inline(always)]
    fn command(&mut self, setpoint: f32, speed: f32) -> f32 {
        self.0.setpoint = setpoint;
        self.0.step(PidIn::new(speed, self.1)).out
    }
}

/// `idsp`'s clamped second-order section with the coefficients of its PID builder.
#[derive(Clone, Debug)]
pub struct ByIdsp(BiquadClamp<f32>, DirectForm1<f32>);

impl ByIdsp {
    /// With the scene's gains.
    pub fn new(scene: &Scene) -> Self {
        let [proportional, integral, limit] = gains(scene);
        let coefficients: [f32; 5] =
            idsp_pid::Builder::default().kp(proportional).ki(integral).build(&(scene.period() as f32));
        let mut section = BiquadClamp::from(coefficients);
        (section.min, section.max) = (-limit, limit);
        ByIdsp(section, DirectForm1::default())
    }
}

impl Controller for ByIdsp {
    #[inline(always)]
    fn command(&mut self, setpoint: f32, speed: f32) -> f32 {
        self.0.process(&mut self.1, setpoint - speed)
    }
}

/// An observer of the library and its loop.
#[derive(Clone, Copy, Debug)]
pub struct Observed<N: Number, O: Observer<N>> {
    config: O::Config,
    observer: O,
    loop_config: SpeedLoopConfig<N>,
    governor: SpeedLoop<(), N>,
}

impl<N: Number, O: Observer<N>> Observed<N, O> {
    /// At rest at angle zero.
    pub fn new(config: O::Config, loop_config: SpeedLoopConfig<N>) -> Self {
        Observed { observer: O::at_rest(&config, 0, N::ZERO), config, loop_config, governor: SpeedLoop::default() }
    }
}

impl<N: Number, O: Observer<N>> Replayed for Observed<N, O> {
    fn start(&mut self, input: &Input) {
        self.observer = O::at_rest(&self.config, input.angle, N::from_word(input.setpoint));
    }

    #[inline(always)]
    fn tick(&mut self, input: &Input, output: &mut Output) {
        self.observer.step(&self.config, input.angle, N::from_word(input.torque));
        let estimate = self.observer.estimate(&self.config);
        self.governor.set_setpoint(N::from_word(input.setpoint));
        output.torque = self.governor.command(&self.loop_config, &estimate).to_word();
    }
}
