//! The two-mass steps: from rest under a torque of the motor that changes its sign, by the library's own observers with
//! gains of zero, against the closed form.

use driveline::design::{ExactStep, Matrix, SemiImplicitStep, StandardDeviation, StepChoice, TwoMassDesign};
use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
use driveline::number::{Fixed, Number};
use driveline::observer::{Observer, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver};
use driveline::settings::Bases;

use super::{Cases, Found};

/// Tick (s). Only omega T enters the step; it sets the scale of the speeds.
const PERIOD: f64 = 1e-4;
/// Torque of the motor (N m), and most ticks of a run.
const TORQUE: f64 = 0.5;
const LONGEST: u64 = 20_000;

/// A machine at a rate, and its motion.
#[derive(Clone, Copy, Debug)]
struct Place {
    omega_t: f64,
    inertia_ratio: f64,
    damping: f64,
}

/// omega T from 1e-6 to 1e3, inertia ratio from 1e-6 to 1e6, damping from none to 100 times the critical.
pub(super) fn add(all: &mut Cases) {
    all.subject("two-mass step", "largest error over its limit, five inertia ratios", "closed form of the pair");
    for damping in [0.0, 1.0, 100.0] {
        for decade in -6..4 {
            all.case(format!("omega T = 1e{decade}, damping ratio {damping}"), || {
                let places = [1e-6, 1e-3, 1.0, 1e3, 1e6];
                let each = places.map(|inertia_ratio| {
                    let place = Place { omega_t: 10_f64.powi(decade), inertia_ratio, damping };
                    exact(&place).max(semi_implicit(&place))
                });
                Ok(Found { error: each.into_iter().fold(0.0, f64::max), limit: 1.0 })
            });
        }
    }
}

impl Place {
    fn machine(&self) -> TwoMass {
        let omega = self.omega_t / PERIOD;
        let stiffness = 200.0 * (self.omega_t * self.omega_t).max(1.0);
        let reduced = stiffness / (omega * omega);
        TwoMass::new(
            Inertia(reduced * (1.0 + 1.0 / self.inertia_ratio)),
            Inertia(reduced * (1.0 + self.inertia_ratio)),
            Stiffness(stiffness),
            Damping(2.0 * self.damping * omega * reduced),
        )
    }

    /// Motion of the slower of the pair in a tick: the angle turned (rad), or the share that decays.
    fn slowest(&self) -> f64 {
        let zeta = self.damping;
        if zeta <= 1.0 { self.omega_t } else { self.omega_t / (zeta + (zeta * zeta - 1.0).sqrt()) }
    }

    /// Four periods, from 2000 ticks on.
    fn ticks(&self) -> u64 {
        ((4.0 * core::f64::consts::TAU / self.omega_t).ceil() as u64).clamp(2000, LONGEST)
    }

    /// Ticks after which the torque changes its sign.
    fn hold(&self) -> u64 {
        self.ticks() / 4
    }

    /// Motor speed, shaft torque, load speed after so many ticks.
    fn truth(&self, machine: &TwoMass, tick: u64) -> [f64; 3] {
        let hold = self.hold();
        (0..=tick / hold).fold([0.0; 3], |sum, change| {
            let steps = if change == 0 { 1.0 } else { 2.0 * f64::from(1 - 2 * (change % 2) as i32) };
            let more = self.response(machine, tick - change * hold);
            core::array::from_fn(|k| sum[k] + steps * more[k])
        })
    }

    /// The same under a torque that stays: the twist follows `theta'' + 2 zeta omega theta' +
    /// omega^2 theta = T/J_m`, the speeds its rate and the impulse \[derived\].
    fn response(&self, machine: &TwoMass, tick: u64) -> [f64; 3] {
        let (omega, zeta, t) = (self.omega_t / PERIOD, self.damping, tick as f64 * PERIOD);
        let (angle, total) = (self.omega_t * tick as f64, machine.total_inertia());
        // twist over its end value, and its rate over omega
        let (twist, rate) = if zeta == 0.0 {
            (2.0 * (0.5 * angle).sin().powi(2), angle.sin())
        } else if zeta == 1.0 {
            (-(-angle).exp_m1() - angle * (-angle).exp(), angle * (-angle).exp())
        } else {
            let slow = 1.0 / (zeta + (zeta * zeta - 1.0).sqrt());
            let fast = 1.0 / slow;
            let [less, more] = [slow, fast].map(|decay| -(-decay * angle).exp_m1());
            ((fast * less - slow * more) / (fast - slow), (more - less) / (fast - slow))
        };
        let swing = TORQUE / machine.motor_inertia / omega;
        let (slip, mean) = (swing * rate, TORQUE * t / total);
        let shaft_torque = machine.stiffness * swing / omega * twist + machine.damping * slip;
        [mean + slip * machine.load_inertia / total, shaft_torque, mean - slip * machine.motor_inertia / total]
    }

    /// The steps without correction. By hand, because the design refuses what it cannot observe, such as a resonance
    /// above half the rate, and the step must hold there too.
    fn design(&self, machine: &TwoMass) -> TwoMassDesign {
        let semi_implicit = SemiImplicitStep::new(machine, PERIOD);
        TwoMassDesign {
            period: PERIOD,
            machine: *machine,
            step: ExactStep::new(machine, PERIOD),
            semi_implicit,
            chosen: StepChoice::choose(&semi_implicit, StepChoice::THRESHOLD),
            transition: Matrix::IDENTITY,
            input: [0.0; 5],
            gains: [0.0; 5],
            poles: [(1.0, 0.0); 5],
            spectral_radius: 1.0,
            semi_implicit_radius: 0.0,
            standard_deviation: StandardDeviation {
                motor_angle: f64::INFINITY,
                motor_speed: f64::INFINITY,
                twist: f64::INFINITY,
                shaft_torque: f64::INFINITY,
                load_speed: f64::INFINITY,
                load_torque: f64::INFINITY,
            },
            innovation: f64::INFINITY,
            posterior: Matrix::ZERO,
        }
    }

    /// Bases that the run fits in; fixed point holds no coefficient above 1/2.
    fn bases(&self, machine: &TwoMass) -> Bases {
        let most = |k: usize| (0..self.ticks()).map(|tick| self.truth(machine, tick)[k].abs()).fold(0.0, f64::max);
        let torque = (1.1 * most(1).max(TORQUE)).log2().ceil().exp2();
        let swing = (machine.resonance() / machine.stiffness).min(1.0 / machine.damping);
        let least = (2.1 * PERIOD * torque / machine.total_inertia()).max(0.95 * swing * torque);
        Bases::new(machine, torque, (1.1 * most(0).max(most(2))).max(least))
    }

    /// Largest speeds, in the energy norm, and shaft torque over so many ticks.
    fn largest(&self, machine: &TwoMass, ticks: u64) -> [f64; 2] {
        let truth = (1..=ticks).map(|tick| self.truth(machine, tick));
        truth.fold([0.0; 2], |[speeds, torque], truth| [norm(machine, truth).max(speeds), truth[1].abs().max(torque)])
    }

    /// Largest error over so many ticks, over the run's largest: of the speeds in the energy norm, or of the shaft torque.
    fn error<N: Number, O: Observer<N>>(&self, ticks: u64, config: &O::Config, bases: &Bases, of: fn(f64) -> N) -> f64 {
        let machine = self.machine();
        let torque = [TORQUE, -TORQUE].map(|torque| of(torque / bases.torque));
        let largest = self.largest(&machine, ticks);
        let mut observer = O::at_rest(config, 0, N::ZERO);
        let mut worst = 0.0_f64;
        for tick in 1..=ticks {
            observer.step(config, 0, torque[((tick - 1) / self.hold() % 2) as usize]);
            let seen = observer.estimate(config);
            let truth = self.truth(&machine, tick);
            let seen = [seen.motor_speed, seen.shaft_torque, seen.load_speed].map(|value| value.to_real());
            let seen = [seen[0] * bases.speed, seen[1] * bases.torque, seen[2] * bases.speed];
            let miss: [f64; 3] = core::array::from_fn(|k| seen[k] - truth[k]);
            let off = (norm(&machine, miss) / largest[0]).max(miss[1].abs() / largest[1]);
            worst = worst.max(if off.is_finite() { off } else { f64::INFINITY });
        }
        worst
    }
}

/// The energy norm of the speeds in motor speed, shaft torque, load speed.
fn norm(machine: &TwoMass, [motor, _, load]: [f64; 3]) -> f64 {
    (machine.motor_inertia * motor * motor + machine.load_inertia * load * load).sqrt()
}

/// A steady torque adds the same to the states in every tick, so that a tick's few roundings repeat; the closed form's
/// angle, and the step's, are off by a rounding for each tick.
fn rounding(place: &Place, ticks: u64) -> f64 {
    let angle = place.omega_t.min(1.0) * 4.0 + place.omega_t * (1.0 + 2.0 * place.damping);
    0.5 * f64::EPSILON * ticks as f64 * (4.0 + angle)
}

/// The exact step: in `f64` it is right to its rounding; in `f32` nothing is off by more than 20,000 roundings of 6e-8
/// that repeat, 1.2e-3. In fixed point each tick adds half of 2^-28 of the bases at most, where it moves 1e-4 of a
/// swing at least and the inertias are within a factor of a thousand.
fn exact(place: &Place) -> f64 {
    let (machine, ticks) = (place.machine(), place.ticks());
    let design = place.design(&machine);
    let double = TwoMassConfig::<f64>::new(&design, Bases::SI);
    let double = place.error::<f64, TwoMassObserver<f64>>(ticks, &double, &Bases::SI, |torque| torque);
    let single = TwoMassConfig::<f32>::new(&design, Bases::SI);
    let single = place.error::<f32, TwoMassObserver<f32>>(ticks, &single, &Bases::SI, |torque| torque as f32);
    let mut worst = (double / rounding(place, ticks)).max(single / 1.2e-3);
    if (1e-3..=1e3).contains(&place.inertia_ratio) && place.slowest() > 0.9e-4 {
        let bases = place.bases(&machine);
        let fixed = TwoMassConfig::<Fixed>::new(&design.with_step(StepChoice::Exact), bases);
        let error = place.error::<Fixed, TwoMassObserver<Fixed>>(ticks, &fixed, &bases, Fixed::from_f64);
        let [speeds, shaft_torque] = place.largest(&machine, ticks);
        let coarse = (bases.torque / shaft_torque).max(norm(&machine, [bases.speed, 0.0, bases.speed]) / speeds);
        worst = worst.max(error / (0.5 * 2.0_f64.powi(-28) * ticks as f64 * coarse));
    }
    worst
}

/// Where the design chooses the semi-implicit step, its error over a period is within the 1 % that it is chosen by.
fn semi_implicit(place: &Place) -> f64 {
    let machine = place.machine();
    let design = place.design(&machine);
    if design.chosen == StepChoice::Exact {
        return 0.0;
    }
    let ticks = u64::from(design.semi_implicit.fidelity.horizon).min(place.ticks());
    let design = design.with_step(StepChoice::SemiImplicit);
    let double = SemiImplicitConfig::<f64>::new(&design, Bases::SI);
    let single = SemiImplicitConfig::<f32>::new(&design, Bases::SI);
    let double = place.error::<f64, SemiImplicitObserver<f64>>(ticks, &double, &Bases::SI, |torque| torque);
    let single = place.error::<f32, SemiImplicitObserver<f32>>(ticks, &single, &Bases::SI, |torque| torque as f32);
    double.max(single) / StepChoice::THRESHOLD
}
