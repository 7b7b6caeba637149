//! The governor's law in all its numbers, the limits, and changes of its constants.

use driveline::design::{Actuator, GovernorDesign, LoadFeedForward, Rate, TorqueCurve};
use driveline::governor::{
    ActiveDamping, ActiveDampingConfig, Curve, CurveConfig, Droop, DroopConfig, FeedForward, FeedForwardConfig, Gains,
    Governor, Limit, Slew, SlewConfig, SpeedGovernor, SymmetricLimit, SymmetricLimitConfig, TorqueRange,
    TorqueRangeConfig,
};
use driveline::number::{Fixed, Number, StateOf};
use driveline::sample::Estimate;
use driveline::settings::{Bases, SpeedLoopSettings};
use proptest::prelude::*;

use super::{SET, plain};

const TORQUE: f64 = 2500.0;
const SPEED: f64 = 157.0;
const BASES: Bases = Bases::new(&SET, 2.5 * TORQUE, 1.34 * SPEED);
const PERIOD: f64 = 5e-4;
const DESIGN: GovernorDesign =
    SET.governor(Rate::every(PERIOD), Actuator { delay: 0.02, lag: 0.02 }, 2.5, LoadFeedForward::NONE);
const RAMP: f64 = 40.0;
const SETTINGS: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE, ramp: RAMP };
/// With a ramp of one tick.
const STEP: SpeedLoopSettings = SpeedLoopSettings { torque_limit: TORQUE, ramp: 1e9 };

/// Droop, feed-forward, a curve: a governor of every kind of part.
type Whole<N> = StateOf<SpeedGovernor<Droop, FeedForward, Curve<3>>, N>;

const CURVE: TorqueCurve<3> = TorqueCurve::through([[0.0, 1500.0], [80.0, TORQUE], [170.0, 2000.0]]);

/// The law once more, by the formulas, in `f64`.
#[derive(Default)]
struct Law {
    integral: f64,
    set_point: f64,
}

impl Law {
    fn command(&mut self, setpoint: f64, speed: f64, load: f64) -> f64 {
        self.set_point += (setpoint - self.set_point).clamp(-RAMP * PERIOD, RAMP * PERIOD);
        let target = self.set_point - 0.04 * SPEED / TORQUE * (self.integral + 0.9 * load);
        let error = target - speed;
        let (gain, reset) = (DESIGN.proportional + DESIGN.integral * PERIOD, DESIGN.integral * PERIOD);
        let wanted = self.integral + gain * error + 0.9 * load;
        let most = match speed.abs() {
            w if w < 80.0 => 1500.0 + 1000.0 * w / 80.0,
            w if w < 170.0 => 2500.0 - 500.0 * (w - 80.0) / 90.0,
            _ => 2000.0,
        };
        let torque = wanted.clamp(-100.0, most);
        self.integral += reset / gain * (torque - 0.9 * load - self.integral);
        torque
    }
}

macro_rules! constants {
    ($number:ident, $bases:expr) => {
        plain(
            Gains::<$number>::new(&DESIGN, SETTINGS, $bases),
            DroopConfig::<$number>::new(0.04, SPEED, TORQUE, DESIGN.integral * PERIOD, $bases),
            FeedForwardConfig::<$number>::new(0.9, $bases),
            CurveConfig::<$number, 3>::new(&CURVE, -100.0, $bases),
        )
    };
}

proptest! {
    /// Any speed in the machine's range and any load: the torque is the law's, to what `f32` and fixed point resolve,
    /// and within the curve.
    #[test]
    fn the_torque_is_the_laws(
        samples in prop::collection::vec((-20.0..180.0_f64, -2500.0..2500.0_f64, 0.0..160.0_f64), 1..200)
    ) {
        let mut law = Law::default();
        let (mut by_single, mut by_fixed) = (Whole::<f32>::default(), Whole::<Fixed>::default());
        let (single, fixed) = (constants!(f32, Bases::SI), constants!(Fixed, BASES));
        for (speed, load, setpoint) in samples {
            let wanted = law.command(setpoint, speed, load);
            by_single.set_setpoint(setpoint as f32);
            let now = Estimate { motor_speed: speed as f32, load_torque: load as f32, ..Estimate::default() };
            let torque = f64::from(by_single.command(&single, &now));
            // 24 bits of 200 rad/s, 0.00001, times a gain of 130, and of 5000 N m, over 200 ticks at worst.
            prop_assert!((torque - wanted).abs() < 0.1, "{torque} {wanted}");
            by_fixed.set_setpoint(Fixed::from_f64(setpoint / BASES.speed));
            let now = Estimate {
                motor_speed: Fixed::from_f64(speed / BASES.speed),
                load_torque: Fixed::from_f64(load / BASES.torque),
                ..Estimate::default()
            };
            let torque = by_fixed.command(&fixed, &now).to_f64() * BASES.torque;
            // 2^-28 of 210 rad/s and of 6250 N m, times a gain of 4.5 per unit, over 200 ticks at worst.
            prop_assert!((torque - wanted).abs() < 0.02, "{torque} {wanted}");
        }
    }

    /// In fixed point, whatever the bits of the estimates: within the limits, no wrap.
    #[test]
    fn no_bits_leave_the_limits(words in prop::collection::vec(any::<[i32; 4]>(), 1..100)) {
        let config = constants!(Fixed, BASES);
        let mut governor = Whole::<Fixed>::default();
        let least = Fixed::from_f64(-100.0 / BASES.torque);
        let most = Fixed::from_f64(TORQUE / BASES.torque);
        for [motor, load, setpoint, torque] in words {
            let state = |word: i32| Fixed::from_bits(word).saturated();
            governor.set_setpoint(state(setpoint));
            let now = Estimate {
                motor_speed: state(motor),
                shaft_torque: Fixed::ZERO,
                load_speed: state(load),
                load_torque: state(torque),
            };
            let torque = governor.command(&config, &now);
            prop_assert!(torque >= least && torque <= most, "{torque:?}");
        }
    }
}

/// Ten seconds against a limit with an error of 157 rad/s would wind the integral up by 890 kN m. By automatic reset
/// it ends where the limit is, so that the torque leaves the limit in the first tick of an error of the other sign.
#[test]
fn the_integral_does_not_wind_up_behind_any_limit() {
    fn leaves<L: Limit<f64>>(limit: L::Config) -> f64 {
        let config = plain(Gains::<f64>::new(&DESIGN, STEP, Bases::SI), (), (), limit);
        let mut governor = SpeedGovernor::<(), (), L, (), (), f64>::default();
        governor.set_setpoint(SPEED);
        for _ in 0..20_000 {
            governor.command(&config, &Estimate::default());
        }
        // 10 s are 64 of its time constants.
        assert!((governor.integral() - TORQUE).abs() < 1e-6 * TORQUE, "{}", governor.integral());
        let now = Estimate { motor_speed: SPEED + 5.0, ..Estimate::default() };
        TORQUE - governor.command(&config, &now)
    }
    // 5 rad/s at k_p, and within 45 N m the integral's tick.
    let prompt = 5.0 * DESIGN.proportional;
    let flat = TorqueCurve::through([[0.0, TORQUE], [1.0, TORQUE], [2.0, TORQUE]]);
    for fall in [
        leaves::<SymmetricLimit>(SymmetricLimitConfig::<f64>::new(TORQUE, Bases::SI)),
        leaves::<TorqueRange>(TorqueRangeConfig::<f64>::new(0.0, TORQUE, Bases::SI)),
        leaves::<Curve<3>>(CurveConfig::<f64, 3>::new(&flat, 0.0, Bases::SI)),
    ] {
        assert!((fall - prompt).abs() < 45.0, "{fall} {prompt}");
    }
    // At 100 kN m/s a tick is 50 N m.
    let slew = SlewConfig::<f64, _>::new(1e5, SymmetricLimitConfig::<f64>::new(TORQUE, Bases::SI), PERIOD, Bases::SI);
    assert!((leaves::<Slew<SymmetricLimit, f64>>(slew) - 50.0).abs() < 1e-9);
}

#[test]
fn slew_and_limit_hold_in_every_tick() {
    let slew = SlewConfig::<f64, _>::new(1e5, TorqueRangeConfig::<f64>::new(0.0, TORQUE, Bases::SI), PERIOD, Bases::SI);
    let config = plain(Gains::<f64>::new(&DESIGN, STEP, Bases::SI), (), (), slew);
    let mut governor = <StateOf<SpeedGovernor<(), (), Slew<TorqueRange>>, f64>>::default();
    let mut last = 0.0;
    for tick in 0..5000 {
        governor.set_setpoint(if tick / 500 % 2 == 0 { SPEED } else { -SPEED });
        let torque = governor.command(&config, &Estimate::default());
        // 50 N m a tick, and the rounding of a difference of 2500 N m.
        assert!((torque - last).abs() <= 50.0 + 1e-9 && (0.0..=TORQUE).contains(&torque), "{last} {torque}");
        last = torque;
    }
}

/// The damping alone, with the gains of a speed loop, is the speed loop: on a run-up, while the machine is held for half
/// a second and the torque is at its limit, and behind that.
#[test]
fn with_damping_and_nothing_else_it_is_the_speed_loop() {
    use driveline::design::SpeedLoopTuning;
    use driveline::governor::{SpeedLoop, SpeedLoopConfig};
    let design = SET.speed_loop(Rate::hz(2000), SpeedLoopTuning::USUAL);
    let config = plain(
        Gains::<f32>::of_speed_loop(&design, SETTINGS, Bases::SI),
        (),
        ActiveDampingConfig::<f32>::new(&design, Bases::SI),
        SymmetricLimitConfig::<f32>::new(TORQUE, Bases::SI),
    );
    let loop_config = SpeedLoopConfig::<f32>::new(&design, SETTINGS, Bases::SI);
    let mut governor = <StateOf<SpeedGovernor<(), ActiveDamping>, f32>>::default();
    let mut speed_loop = SpeedLoop::<(), _>::default();
    let mut limited = 0;
    for tick in 0..4000 {
        let swing = (f64::from(tick) * 0.05).sin() as f32;
        let load_speed = if (1000..2000).contains(&tick) { 0.0 } else { 0.02 * tick as f32 };
        let now = Estimate { motor_speed: load_speed + swing, load_speed, ..Estimate::default() };
        governor.set_setpoint(SPEED as f32);
        speed_loop.set_setpoint(SPEED as f32);
        let (a, b) = (governor.command(&config, &now), speed_loop.command(&loop_config, &now));
        limited += u32::from(a == TORQUE as f32);
        // The sums are taken in another order: a few roundings of 2500 N m.
        assert!((a - b).abs() < 0.01, "{tick}: {a} {b}");
    }
    assert!((900..3000).contains(&limited), "{limited}");
}

/// With a power limit the curve gives no more than the power at its points, and the stated excess between.
#[test]
fn a_power_limit_is_kept() {
    let power = 300e3;
    let points =
        [[0.0, 2500.0], [110.0, 2500.0], [121.0, 2500.0], [133.1, 2500.0], [146.41, 2500.0], [161.051, 2500.0]];
    let config = CurveConfig::<f64, 6>::new(&TorqueCurve::through(points).with_power_limit(power), 0.0, Bases::SI);
    for step in 0..=1610 {
        let speed = 0.1 * f64::from(step);
        let most = config.max_torque(speed);
        assert!(most <= 2500.0);
        // From the first point that is limited (133.1 rad/s) on: a chord over a ratio of 1.1 lies 0.23 % above the
        // hyperbola at most.
        if speed >= 133.1 {
            assert!(most * speed <= power * 1.0023, "{speed} {most}");
        }
    }
}

type Switched = StateOf<SpeedGovernor<Droop, FeedForward>, f64>;

fn config(span: f64, droop: f64, share: f64) -> <Switched as Governor<f64>>::Config {
    let actuator = Actuator { delay: 0.02, lag: 0.02 };
    let design = SET.governor(Rate::hz(2000), actuator, span, LoadFeedForward::NONE);
    plain(
        Gains::<f64>::new(&design, SpeedLoopSettings { torque_limit: 3000.0, ramp: 40.0 }, Bases::SI),
        DroopConfig::<f64>::new(droop, 157.0, 2500.0, design.integral * design.period, Bases::SI),
        FeedForwardConfig::<f64>::new(share, Bases::SI),
        SymmetricLimitConfig::<f64>::new(3000.0, Bases::SI),
    )
}

proptest! {
    /// Whatever the state and whichever of gains, droop and feed-forward change, the next torque is what it would have
    /// been, but for what one tick's ramp and integral make of it.
    #[test]
    fn the_constants_change_without_a_jolt(
        (span, droop, share) in (2.0..5.0_f64, 0.0..0.08_f64, 0.0..1.0_f64),
        (to_span, to_droop, to_share) in (2.0..5.0_f64, 0.0..0.08_f64, 0.0..1.0_f64),
        load in 0.0..2000.0_f64,
        error in -2.0..2.0_f64,
        ticks in 1..2000_usize,
    ) {
        let (from, to) = (config(span, droop, share), config(to_span, to_droop, to_share));
        let mut governor = Switched::default();
        let now = Estimate { motor_speed: 150.0, load_torque: load, ..Estimate::default() };
        governor.start(&from, &now, load);
        let now = Estimate { motor_speed: 150.0 + error, ..now };
        let mut last = 0.0;
        for _ in 0..ticks {
            governor.set_setpoint(150.0);
            last = governor.command(&from, &now);
        }
        let mut other = governor;
        governor.set_setpoint(150.0);
        let stayed = governor.command(&from, &now);
        other.switch(&from, &to, &now);
        other.set_setpoint(150.0);
        let switched = other.command(&to, &now);
        // A tick's ramp is 0.02 rad/s, of which the integral's tick and the droop's make less than another: 2 * 0.04
        // rad/s by the largest k_p, 150, and at the limit the torque must not move at all.
        prop_assert!((switched - stayed).abs() < 2.0 * 0.04 * 150.0, "{last} {stayed} {switched}");
    }
}
