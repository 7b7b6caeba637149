//! The waveform of motions whose slowness is given in closed form: `dt/dphi = r(theta)/sqrt(w^2 + 2 a phi)`, with the
//! mean 1 of r over the cycle.

use core::f64::consts::TAU;

use driveline::fluctuation::{
    CycleConfig, Extremes, Fluctuation, FourierSeries, Ranked, Ripple, Unusable, Waveform, WaveformConfig, Window,
};
use driveline::number::Fixed;
use driveline::sample::Estimate;
use driveline::settings::{Bases, Cycle};

use super::accepts;

const PERIOD: f64 = 1e-4;
const BINS: usize = 64;
/// 2^-32 turns of a radian.
const ANGLE: f64 = 4_294_967_296.0 / TAU;

#[derive(Clone, Copy, Debug)]
struct Motion {
    /// Ticks to a turn.
    ticks: f64,
    acceleration: f64,
    forward: bool,
    /// Order, cosine and sine of the slowness over its mean.
    orders: [[f64; 3]; 3],
    cycle: Cycle,
    cycles: u32,
}

const STEADY: Motion = Motion {
    ticks: 4_000.3,
    acceleration: 0.0,
    forward: true,
    orders: [[1.0, 0.02, -0.01], [2.0, -0.015, 0.02], [5.0, 0.004, 0.003]],
    cycle: Cycle::TURN,
    cycles: 4,
};

impl Motion {
    fn turns(&self) -> f64 {
        f64::from(self.cycle.turns) / f64::from(self.cycle.cycles)
    }

    fn speed(&self) -> f64 {
        TAU / self.ticks / PERIOD
    }

    /// The slowness over its mean, at an angle of the cycle.
    fn slowness(&self, theta: f64) -> f64 {
        1.0 + self.orders.iter().map(|[n, cos, sin]| cos * (n * theta).cos() + sin * (n * theta).sin()).sum::<f64>()
    }

    /// The largest and the least speed over its mean, each with its angle of the cycle. Backwards the speeds are
    /// negative, and the least magnitude is the largest of them.
    fn extremes(&self) -> [(f64, f64); 2] {
        let (mut fast, mut slow) = ((0.0, 0.0), (f64::INFINITY, 0.0));
        for k in 0..20_000 {
            let theta = f64::from(k) / 20_000.0 * TAU;
            let speed = 1.0 / self.slowness(theta);
            fast = if speed > fast.0 { (speed, theta) } else { fast };
            slow = if speed < slow.0 { (speed, theta) } else { slow };
        }
        if self.forward { [fast, slow] } else { [slow, fast] }
    }

    fn config(&self) -> WaveformConfig {
        WaveformConfig::new::<BINS>(CycleConfig::new(self.cycle, PERIOD, Bases::SI), self.cycles)
    }

    /// Hands on angle (rad) and speed of each tick until that is enough.
    fn run(&self, mut tick: impl FnMut(f64, f64) -> bool) {
        let sign = if self.forward { 1.0 } else { -1.0 };
        let mut phi = 0.3 * sign;
        let rate = |phi: f64| {
            let square = self.speed() * self.speed() + 2.0 * self.acceleration * phi * sign;
            sign * square.sqrt() / self.slowness(phi / self.turns())
        };
        for _ in 0..400_000 {
            // Runge and Kutta; a tick is a small part of a turn
            let one = rate(phi);
            let two = rate(phi + 0.5 * PERIOD * one);
            let three = rate(phi + 0.5 * PERIOD * two);
            let four = rate(phi + PERIOD * three);
            phi += PERIOD / 6.0 * (one + 2.0 * two + 2.0 * three + four);
            if tick(phi, rate(phi)) {
                return;
            }
        }
    }

    /// The first window, if there is one.
    fn window(&self, torque: impl Fn(f64) -> f64) -> Option<Window<f64, BINS>> {
        self.window_of(&self.config(), torque)
    }

    fn window_of<const BINS: usize>(
        &self,
        config: &WaveformConfig,
        torque: impl Fn(f64) -> f64,
    ) -> Option<Window<f64, BINS>> {
        let mut waveform = Waveform::<BINS, f64>::default();
        let mut window = None;
        self.run(|phi, motor_speed| {
            let estimate = Estimate { motor_speed, ..Estimate::default() };
            waveform.measure(config, angle(phi), torque(phi / self.turns()), &estimate);
            window = waveform.take();
            window.is_some()
        });
        window
    }

    fn ripple(&self, highest: usize) -> Result<Ripple, Unusable> {
        self.window(|_| 0.0).expect("a window").ripple(&self.config(), highest)
    }

    /// The speed over its mean by time.
    fn expected(&self) -> FourierSeries {
        let table: Vec<f64> = (0..64).map(|k| 1.0 / self.slowness(f64::from(k) / 64.0 * TAU)).collect();
        FourierSeries::from_samples(&table)
    }
}

fn angle(phi: f64) -> u32 {
    ((phi / TAU).rem_euclid(1.0) * 4_294_967_296.0) as u32
}

/// The largest error of an order up to the fifth, over the mean.
fn off(motion: &Motion, ripple: &Ripple) -> f64 {
    let expected = motion.expected();
    let orders = (1..=5).map(|n| {
        let (found, expected) = (ripple.speed.order(n), expected.order(n));
        let (cos, sin) = (found.cos / ripple.mean - expected.cos, found.sin / ripple.mean - expected.sin);
        cos.hypot(sin)
    });
    orders.fold(0.0, f64::max)
}

/// Ticks to a turn, and what may be left of an order over the mean: the parabola of a bin, of the fifth order with 13
/// bins to a period, leaves 1e-5; the ends of a window of few cycles lie between two ticks.
const ACCURACY: [(f64, f64); 3] = [(4_000.3, 3e-5), (400.7, 1e-4), (130.7, 2e-4)];

/// Both directions, cycles of one turn, of two and of three fifths.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn orders_mean_and_extremes_of_a_steady_motion() {
    for (ticks, accuracy) in ACCURACY {
        for cycles in [1, 2, 16] {
            for (cycle, forward) in [
                (Cycle::TURN, true),
                (Cycle::TURN, false),
                (Cycle::FOUR_STROKE, true),
                (Cycle { turns: 3, cycles: 5 }, false),
            ] {
                let motion = Motion { ticks, cycles, cycle, forward, ..STEADY };
                let ripple = motion.ripple(8).unwrap();
                let sign = if forward { 1.0 } else { -1.0 };
                assert!(off(&motion, &ripple) < accuracy, "{ticks} {cycles} {cycle:?} {ripple:?}");
                assert!((sign * ripple.mean / motion.speed() - 1.0).abs() < 0.3 * accuracy, "{ticks} {ripple:?}");
                // the part of an order by which a cycle may seem shorter than the other, over its duration
                let firm = motion.speed() * motion.speed() / (TAU * motion.turns());
                assert!(ripple.acceleration.abs() < accuracy * firm && ripple.quality.trend.abs() < accuracy);
                assert_eq!((ripple.cycles, ripple.quality.missed, ripple.quality.spread), (cycles, 0, 0.0));
                let [max, min] = motion.extremes();
                for (found, (speed, theta)) in [(ripple.motor.max, max), (ripple.motor.min, min)] {
                    assert!((found.speed / ripple.mean - speed).abs() < 4.0 * accuracy, "{found:?} {speed}");
                    // the curvature there is 0.1 of the mean: the root of the speed's error over half of it
                    let beside = (found.angle / motion.turns() - theta).abs();
                    assert!(beside.min(TAU - beside) < (8.0 * accuracy / 0.05).sqrt(), "{found:?} {theta}");
                }
            }
        }
    }
}

/// A whole number of ticks to the turn has them at the same angles in every cycle, a few to a bin. An even motion has a
/// delta below 0.0005: the squares are known to 0.44/256 bin2, which is 5e-4 of the eighth order's cosine. Nearly a
/// whole number may leave 2e-3 of the eighth order, so 0.004 of delta.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_whole_number_of_ticks_to_the_turn_is_no_ripple() {
    const WHOLE: [f64; 11] = [60.0, 64.0, 72.0, 73.0, 80.0, 96.0, 100.0, 120.0, 128.0, 200.0, 512.0];
    for (ticks, most) in WHOLE.map(|ticks| (ticks, 5e-4)).into_iter().chain([(72.01, 4e-3), (72.05, 4e-3)]) {
        for forward in [true, false] {
            let motion = Motion { ticks, cycles: 8, forward, ..STEADY };
            assert!(off(&motion, &motion.ripple(8).unwrap()) < 1e-4, "{ticks} {forward}");
            let even = Motion { orders: [[0.0; 3]; 3], ..motion };
            let ripple = even.ripple(8).unwrap();
            assert!(ripple.motor.delta.abs() < most, "{ticks} {forward} {ripple:?}");
        }
    }
}

/// Sixteen bins have a fourth order of four bins to a period, and eight a second one. The slope of a sine over a bin is
/// 1 - h^2/40 + h^4/4480, of which the last is left out: with h = pi/2 that is 1.4e-3 of the fifth (h^2/12) that the
/// slope has in an order of 0.2, 6e-5.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn the_highest_order_of_few_bins() {
    fn check<const BINS: usize>(highest: u32) {
        let n = f64::from(highest);
        for orders in [[[n, 0.2, 0.0], [0.0; 3], [0.0; 3]], [[n, 0.0, -0.2], [1.0, 0.1, 0.05], [0.0; 3]]] {
            let motion = Motion { ticks: 40_000.3, cycles: 2, orders, ..STEADY };
            let config = WaveformConfig::new::<BINS>(CycleConfig::new(motion.cycle, PERIOD, Bases::SI), motion.cycles);
            let ripple = motion.window_of::<BINS>(&config, |_| 0.0).unwrap().ripple(&config, 8).unwrap();
            let (found, expected) = (ripple.speed.order(highest as usize), motion.expected().order(highest as usize));
            let off = (found.cos / ripple.mean - expected.cos).hypot(found.sin / ripple.mean - expected.sin);
            assert!(off < 1e-4, "{BINS} {orders:?} {off:e}");
        }
    }
    check::<16>(4);
    check::<8>(2);
}

/// The trend is taken off: the same orders, and the acceleration; a cycle's duration rises by `-a angle/w^2`.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_steady_acceleration_is_taken_off() {
    for (ticks, accuracy) in ACCURACY {
        for cycles in [2, 4, 16] {
            for (cycle, forward, share) in [
                (Cycle::TURN, true, 0.002),
                (Cycle::TURN, false, 0.002),
                (Cycle::FOUR_STROKE, true, -0.004),
                (Cycle::TURN, true, 0.02),
            ] {
                let mut motion = Motion { ticks, cycles, cycle, forward, ..STEADY };
                let angle = TAU * motion.turns();
                motion.acceleration = share * motion.speed() * motion.speed() / angle;
                let ripple = motion.ripple(8).unwrap();
                assert!(off(&motion, &ripple) < accuracy, "{ticks} {cycles} {share} {ripple:?}");
                let sign = if forward { 1.0 } else { -1.0 };
                // what an end may be off, over the change of a cycle's duration
                let part = 0.01 * accuracy / 2e-5 / f64::from(cycles) + 1e-3;
                assert!((sign * ripple.acceleration / motion.acceleration - 1.0).abs() < part, "{ticks} {ripple:?}");
                let rise = -motion.acceleration * angle / ripple.mean / ripple.mean;
                // the square of the window's change of speed beside its mean
                let bent = (share * f64::from(cycles)).powi(2) + part;
                assert!((ripple.quality.trend / rise - 1.0).abs() < bent, "{ticks} {cycles} {ripple:?} {rise}");
            }
        }
    }
}

/// An order beyond the highest is the residue: its slowness c in the n-th order is a lateness of c/n.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn the_residue_is_the_lateness_of_the_other_orders() {
    for (cycle, turns) in [(Cycle::TURN, 1.0), (Cycle::FOUR_STROKE, 2.0)] {
        let orders = [[1.0, 0.02, -0.01], [0.0, 0.0, 0.0], [5.0, 0.03, 0.04]];
        let motion = Motion { cycle, cycles: 16, orders, ..STEADY };
        let residue = 0.05 / 5.0 / 2.0_f64.sqrt() * turns;
        let found = motion.ripple(4).unwrap().quality.residue;
        // the ends of bins, between two ticks of 4,000 in 16 cycles
        assert!((found / residue - 1.0).abs() < 0.01, "{found} {residue}");
        assert!(motion.ripple(5).unwrap().quality.residue < 0.05 * residue);
        // orders up to the highest alone
        assert_eq!(motion.ripple(4).unwrap().speed.order(5), Default::default());
        assert!(motion.ripple(99).unwrap().speed.order(16).amplitude() < 1e-4 * motion.speed());
    }
}

/// 72 ticks to a turn in fewer than eight cycles or where a cycle is not a turn, and twelve to a segment of another
/// cycle. A window's ends are noticed up to 24 ticks late, which many cycles hide.
#[test]
fn too_few_ticks() {
    for (cycle, cycles, least) in
        [(Cycle::TURN, 7, 72.0), (Cycle::FOUR_STROKE, 200, 72.0), (Cycle { turns: 3, cycles: 5 }, 200, 80.0)]
    {
        for (ticks, is_right) in [(least + 0.7, true), (least - 0.7, false)] {
            let motion = Motion { ticks, cycle, cycles, orders: [[0.0; 3]; 3], ..STEADY };
            // with too few the ends of cycles may be missed altogether
            let found = motion.window(|_| 0.0).map(|window| window.ripple(&motion.config(), 4));
            assert_eq!(found.is_some_and(|ripple| ripple.is_ok()), is_right, "{ticks} {cycle:?} {cycles}");
        }
    }
}

/// A cycle that takes a tenth longer than the one before, or shorter, is too much.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn too_much_of_a_trend() {
    // two cycles from the end of the first on: in their middle the square of the speed is 1 + 4 shares
    for (share, is_right) in [(0.15, true), (0.2, false), (-0.06, true), (-0.08, false)] {
        let mut motion = Motion { cycles: 2, orders: [[0.0; 3]; 3], ..STEADY };
        motion.acceleration = share * motion.speed() * motion.speed() / TAU;
        let ripple = motion.ripple(4);
        assert_eq!(ripple.is_ok(), is_right, "{share} {ripple:?}");
        assert!(is_right || ripple == Err(Unusable::Trend));
    }
}

/// The extremes of motor and load, each of its own slowness. The parabola through three samples four ticks apart, a
/// thousandth of a turn, leaves the fourth power of that.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn extremes_cycle_by_cycle() {
    for (cycle, forward) in [
        (Cycle::TURN, true),
        (Cycle::TURN, false),
        (Cycle::FOUR_STROKE, true),
        (Cycle::FOUR_STROKE, false),
        (Cycle { turns: 3, cycles: 5 }, true),
        (Cycle { turns: 16, cycles: 1 }, false),
    ] {
        extremes_of(Motion { cycle, forward, ..STEADY }, Bases::SI, 1e-6, |speed| speed);
    }
    for (ticks, forward) in [(4_000.3, true), (400.7, true), (400.7, false)] {
        let motion = Motion { ticks, cycle: Cycle::FOUR_STROKE, forward, ..STEADY };
        extremes_of(motion, Bases::SI, 2e-6, |speed| speed as f32);
        let bases = Bases { speed: 250.0, ..Bases::SI };
        extremes_of(motion, bases, 2e-6, |speed| Fixed::from_f64(speed / 250.0));
    }
}

/// The readings of six turns' cycles, all within the accuracy (over the speed).
fn extremes_of<N: Ranked>(motion: Motion, bases: Bases, accuracy: f64, number: impl Fn(f64) -> N) {
    let load = Motion { orders: [[1.0, -0.01, 0.02], [3.0, 0.006, 0.0], [2.0, 0.0, 0.01]], ..motion };
    let sign = if motion.forward { 1.0 } else { -1.0 };
    let config = CycleConfig::new(motion.cycle, PERIOD, bases);
    let (mut extremes, mut turned, mut seen) = (Extremes::<N>::default(), 0.0, 0);
    let mut first = None;
    motion.run(|phi, motor_speed| {
        let load_speed = number(sign * load.speed() / load.slowness(phi / load.turns()));
        let estimate = Estimate { motor_speed: number(motor_speed), load_speed, ..Estimate::default() };
        extremes.measure(&config, angle(phi), N::ZERO, &estimate);
        turned = phi.abs() / motion.turns() / TAU;
        if extremes.cycles() != seen {
            seen = extremes.cycles();
            let reading = extremes.reading(&config).unwrap();
            first.get_or_insert(reading);
            let [mean, duration]: [f64; 2] = [reading.mean.into(), reading.duration.into()];
            assert!((sign * mean / motion.speed() - 1.0).abs() < accuracy, "{motion:?} {reading:?}");
            let expected = motion.ticks * motion.turns() * PERIOD;
            assert!((duration / expected - 1.0).abs() < accuracy, "{reading:?}");
            for (found, of) in [(reading.motor, &motion), (reading.load, &load)] {
                let [max, min] = of.extremes().map(|(speed, theta)| (of.speed() * speed, theta));
                for (found, (speed, theta)) in [(found.max, max), (found.min, min)] {
                    assert!((found.speed.into() - sign * speed).abs() < accuracy * of.speed(), "{found:?} {speed}");
                    let beside = (found.angle.into() / motion.turns() - theta).abs();
                    // the closed form is on a grid of 3e-4, and four ticks are between two samples
                    assert!(beside.min(TAU - beside) < 5e-4 + 2.0 / motion.ticks, "{motion:?} {found:?} {theta}");
                    assert!((0.0..config.angle).contains(&found.angle.into()));
                }
                let swing = (max.0 - min.0).abs();
                assert!((found.arithmetic_mean.into() - 0.5 * sign * (max.0 + min.0)).abs() < accuracy * of.speed());
                assert!((found.delta.into() - swing / of.speed()).abs() < accuracy);
                assert!((found.delta_arithmetic.into() - 2.0 * swing / (max.0 + min.0)).abs() < accuracy);
            }
        }
        turned > 6.0
    });
    // the first end of a cycle is found with the first segments, the last one is just passed
    assert!((4..=5).contains(&seen), "{motion:?} {seen}");
    assert_eq!(first.unwrap().change, None);
    let change: f64 = extremes.reading(&config).unwrap().change.unwrap().into();
    assert!(change.abs() < 10.0 * accuracy * motion.speed());
}

/// On a ramp a cycle's mean changes by the ramp's over the cycle, whose length changes by a hundredth.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_trend_is_told_from_the_ripple() {
    let mut motion = STEADY;
    motion.acceleration = 0.01 * motion.speed() * motion.speed() / TAU;
    let config = CycleConfig::new(motion.cycle, PERIOD, Bases::SI);
    let mut extremes = Extremes::<f64>::default();
    motion.run(|phi, motor_speed| {
        let estimate = Estimate { motor_speed, load_speed: motor_speed, ..Estimate::default() };
        extremes.measure(&config, angle(phi), 0.0, &estimate);
        extremes.cycles() == 10
    });
    let reading = extremes.reading(&config).unwrap();
    assert!((reading.change.unwrap() / (motion.acceleration * reading.duration) - 1.0).abs() < 0.01, "{reading:?}");
}

/// The torque over the angle at a steady speed: of some 250 ticks in a bin one may be missing at an end, 1/250 of what
/// the torque changes by in it, 0.5.
#[test]
fn the_motors_torque() {
    let orders = [[0.0; 3]; 3];
    for forward in [true, false] {
        let motion = Motion { forward, orders, ..STEADY };
        let torque = |theta: f64| 100.0 + 7.0 * theta.cos() - 3.0 * (5.0 * theta).sin();
        let found = motion.window(torque).unwrap().motor_torque(&motion.config(), 8);
        for k in 0..100 {
            let theta = f64::from(k) / 100.0 * TAU;
            assert!((found.at(theta) - torque(theta)).abs() < 0.01, "{theta} {} {}", found.at(theta), torque(theta));
        }
    }
}

/// The cycle's constants by hand: two turns in eight segments, three fifths of a turn in four, 2 of 2^-32 turn left of
/// ten times 429,496,729.
#[test]
fn the_constants_of_a_cycle() {
    let of = |turns, cycles| CycleConfig::try_new(Cycle { turns, cycles }, PERIOD, Bases::SI);
    let two = of(2, 1).unwrap();
    assert_eq!((two.length, two.last_segment, two.whole, two.part, two.divisor), (1 << 30, 7, 0, 0, 1));
    assert_eq!((two.angle, two.period, two.speed, two.torque), (2.0 * TAU, PERIOD, 1.0, 1.0));
    // 2^32 of 3/5 in four parts: 644,245,094.4 each
    let three = of(3, 5).unwrap();
    assert_eq!((three.length, three.last_segment, three.divisor), (644_245_094, 3, 5));
    // 3 2^32 = 20 * 644,245,094 + 8: one whole and three fifths
    assert_eq!((three.whole, three.part), (1, 3));
    assert_eq!(three.angle, 0.6 * TAU);
    let wrong = [[17, 1], [0, 1], [1, 0], [65_536, 65_535], [65_535, 65_536]];
    accepts(&[[16, 1], [65_535, 65_535], [1, 65_535]], &wrong, |[turns, cycles]| of(turns, cycles));
    accepts(&[], &[0.0, -1.0, f64::NAN, f64::INFINITY], |period| CycleConfig::try_new(Cycle::TURN, period, Bases::SI));
    let waveform = WaveformConfig::try_new::<64>(two, 5).unwrap();
    // eight bins to a segment of 2^30, in 2^-50
    assert_eq!((waveform.cycles, waveform.per_segment, waveform.scale), (5, 8, 1 << 23));
    accepts(&[1, 65_535], &[0, 65_536], |cycles| WaveformConfig::try_new::<64>(two, cycles));
    assert!(WaveformConfig::try_new::<8>(two, 1).is_ok() && WaveformConfig::try_new::<4>(two, 1).is_err());
    assert!(WaveformConfig::try_new::<1024>(two, 1).is_ok() && WaveformConfig::try_new::<2048>(two, 1).is_err());
    assert!(WaveformConfig::try_new::<48>(two, 1).is_err());
    let short = of(1, 16).unwrap();
    assert!(WaveformConfig::try_new::<4>(short, 1).is_ok() && WaveformConfig::try_new::<2>(short, 1).is_err());
    // 8192 bins to a turn: 512 of a sixteenth
    assert!(WaveformConfig::try_new::<256>(short, 1).is_ok() && WaveformConfig::try_new::<512>(short, 1).is_err());
}

/// A disturbance with a jump of the angle, or a turn back by more than a segment, at every third tick of two cycles: no
/// window is handed on that holds it, and the next one is right. The window is asked for after each tick, or after
/// every seventh one alone.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn no_window_holds_a_disturbance() {
    const TICKS: f64 = 400.7;
    for (first, (forward, asked, back)) in (700..).zip([
        (true, 1, false),
        (false, 1, false),
        (true, 7, false),
        (false, 7, false),
        (true, 1, true),
        (false, 1, true),
    ]) {
        let motion = Motion { ticks: TICKS, forward, cycles: 2, ..STEADY };
        let mut path = Vec::new();
        motion.run(|phi, speed| {
            path.push((angle(phi), speed));
            path.len() > 4_000
        });
        let config = motion.config();
        for disturbed in (first..1_520).step_by(3) {
            let mut waveform = Waveform::<BINS, f64>::default();
            let (mut at, mut windows) = (0, 0);
            for tick in 0..3_600 {
                if tick == disturbed && !back {
                    // a fifth of a turn, unseen
                    at += 80;
                    waveform.disturb();
                }
                let (angle, speed) = path[at];
                let is_back = back && (disturbed..disturbed + 120).contains(&tick);
                at = if is_back { at - 1 } else { at + 1 };
                let motor_speed = if is_back { -speed } else { speed };
                waveform.measure(&config, angle, 0.0, &Estimate { motor_speed, ..Estimate::default() });
                if tick % asked == 0
                    && let Some(window) = waveform.take()
                {
                    match window.ripple(&config, 8) {
                        Ok(ripple) => {
                            assert!(off(&motion, &ripple) < 1e-4, "{forward} {back} {disturbed} {tick} {ripple:?}");
                            // one that ended before the disturbance is taken after seven ticks at the latest
                            windows += u32::from(tick > disturbed + 7);
                        }
                        // turned back while the end was dealt with, of which the window says the speed
                        Err(fault) => assert!(back && fault == Unusable::Trend, "{forward} {disturbed} {tick}"),
                    }
                }
            }
            // behind the disturbance one begins within two turns and is two long
            assert!(windows >= 1, "{forward} {asked} {back} {disturbed}");
        }
    }
}

/// Half of 2^22 ticks are enough for a window, whatever the cycles that are wanted; one of more than 2^22 is given up.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_window_has_at_most_four_million_ticks() {
    // steady, in 2^-32 turn a tick
    let run = |step: f64, cycles: u32, ticks: u32, asked: u32| {
        let config = WaveformConfig::new::<BINS>(CycleConfig::new(Cycle::TURN, PERIOD, Bases::SI), cycles);
        let mut waveform = Waveform::<BINS, f64>::default();
        let motor_speed = step / ANGLE / PERIOD;
        let mut found = Vec::new();
        for tick in 0..ticks {
            let angle = (f64::from(tick) * step) as u64 as u32;
            waveform.measure(&config, angle, 0.0, &Estimate { motor_speed, ..Estimate::default() });
            if tick % asked == 0
                && let Some(window) = waveform.take()
            {
                let ripple = window.ripple(&config, 4).unwrap();
                assert!((ripple.mean / motor_speed - 1.0).abs() < 1e-6, "{ripple:?}");
                found.push(ripple.cycles);
            }
        }
        found
    };
    const TURN: f64 = 4_294_967_296.0;
    // 2^21 ticks are 524.2 turns of 4,001
    assert_eq!(run(TURN / 4_001.0, 1_000, 2_200_000, 1), [525]);
    assert_eq!(run(TURN / 4_001.0, 524, 2_200_000, 1), [524]);
    // one turn of a little less and of a little more than 2^22; asked for after every tick, now and then, or at the end
    for asked in [1, 1_000, 8_599_999] {
        assert_eq!(run(TURN / 4.15e6, 1, 8_600_000, asked), [1], "{asked}");
        assert!(run(TURN / 4.25e6, 1, 8_600_000, asked).is_empty(), "{asked}");
    }
}

/// Of a cycle in which the load's speed changes its sign, and of one with an infinite estimate, there is no reading.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn a_cycle_without_a_sign_has_no_reading() {
    let config = CycleConfig::new(Cycle::TURN, 1e-4, Bases::SI);
    for (swing, is_right) in [(24.9, true), (25.1, false), (f64::INFINITY, false)] {
        let mut extremes = Extremes::<f64>::default();
        let step = 1.0 / 1_000.3;
        for tick in 0..4_200 {
            let turns = f64::from(tick) * step;
            let load_speed = 25.0 + swing * (TAU * turns).cos();
            let estimate = Estimate { motor_speed: 62.8, load_speed, ..Estimate::default() };
            extremes.measure(&config, (turns.fract() * 4_294_967_296.0) as u32, 0.0, &estimate);
        }
        assert!(extremes.mean(&config).is_some());
        assert_eq!(extremes.reading(&config).is_some(), is_right, "{swing}");
    }
}
