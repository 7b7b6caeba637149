//! How far fixed point was from real numbers in a run, to lay beside the bound.

use driveline::number::{Fixed, Number};
use driveline::observer::{
    Observer, RigidConfig, RigidObserver, SemiImplicitConfig, SemiImplicitObserver, TwoMassConfig, TwoMassObserver,
};
use driveline::sample::Estimate;
use driveline::settings::Bases;
use nalgebra::Matrix4;

use super::rounding::{Kind, Linear, linear};
use super::subject::Subject;

/// Largest difference of motor speed, shaft torque, load speed and load torque (SI units) in so many ticks of both
/// observers on the same samples; `None` where the constants do not fit.
///
/// Half of the ticks are a random run: speeds within the rating, each held for a while, under torques and innovations
/// of several kinds. In the others each angle is the one of sixteen, all within some counts, whose roundings add most
/// to the error at the end.
pub fn measured(subject: &Subject, kind: Kind, ticks: u64) -> Option<[f64; 4]> {
    let bases = subject.bases;
    let linear = linear(subject, kind)?;
    match kind {
        Kind::Rigid => {
            let fixed = RigidConfig::<Fixed>::try_new(&subject.rigid, subject.load_share, bases).ok()?;
            let real = RigidConfig::<f64>::try_new(&subject.rigid, subject.load_share, Bases::SI).ok()?;
            Some(Pair::<RigidObserver<Fixed>, RigidObserver<f64>>::new(subject, &fixed, &real).most(&linear, ticks))
        }
        Kind::SemiImplicit => {
            let design = subject.two_mass.as_ref()?;
            let fixed = SemiImplicitConfig::<Fixed>::try_new(design, bases).ok()?;
            let real = SemiImplicitConfig::<f64>::try_new(design, Bases::SI).ok()?;
            let pair = Pair::<SemiImplicitObserver<Fixed>, SemiImplicitObserver<f64>>::new(subject, &fixed, &real);
            Some(pair.most(&linear, ticks))
        }
        Kind::Exact => {
            let design = subject.two_mass.as_ref()?;
            let fixed = TwoMassConfig::<Fixed>::try_new(design, bases).ok()?;
            let real = TwoMassConfig::<f64>::try_new(design, Bases::SI).ok()?;
            Some(Pair::<TwoMassObserver<Fixed>, TwoMassObserver<f64>>::new(subject, &fixed, &real).most(&linear, ticks))
        }
    }
}

/// The observer in both numbers.
struct Pair<'a, F: Observer<Fixed>, R: Observer<f64>> {
    subject: &'a Subject,
    fixed: &'a F::Config,
    real: &'a R::Config,
    observers: (F, R),
}

impl<'a, F: Observer<Fixed> + Copy, R: Observer<f64> + Copy> Pair<'a, F, R> {
    fn new(subject: &'a Subject, fixed: &'a F::Config, real: &'a R::Config) -> Self {
        Self { subject, fixed, real, observers: (F::at_rest(fixed, 0, Fixed::ZERO), R::at_rest(real, 0, 0.0)) }
    }

    fn restart(&mut self) {
        let angle = self.observers.1.angle();
        self.observers = (F::at_rest(self.fixed, angle, Fixed::ZERO), R::at_rest(self.real, angle, 0.0));
    }

    /// The torque that keeps a speed, `shake` of it added, in fixed point and in N m.
    fn torque(&self, speed: f64, shake: f64) -> (Fixed, f64) {
        let bases = self.subject.bases;
        let limit = 0.45 * bases.torque;
        let Estimate { motor_speed, load_torque, .. } = self.observers.1.estimate(self.real);
        let gain = 0.02 * self.subject.rigid.machine.inertia / self.subject.rigid.period;
        let wanted = load_torque + gain * (speed - motor_speed) + shake * limit;
        let torque = Fixed::from_f64(wanted.clamp(-limit, limit) / bases.torque);
        (torque, torque.to_f64() * bases.torque)
    }

    /// The angle that has this innovation (2^-32 turn) in real numbers.
    fn angle(&self, torque: f64, innovation: f64) -> u32 {
        let (_, real) = &self.observers;
        let still = real.predict(self.real, real.angle(), torque).innovation();
        real.angle().wrapping_add((innovation - still).round() as i64 as u32)
    }

    fn step(&mut self, angle: u32, (fixed, real): (Fixed, f64)) {
        self.observers.0.step(self.fixed, angle, fixed);
        self.observers.1.step(self.real, angle, real);
    }

    /// Fixed less real: motor speed, shaft torque, load speed, load torque (SI units).
    fn error(&self) -> [f64; 4] {
        let Bases { torque, speed, .. } = self.subject.bases;
        let (f, r) = (self.observers.0.estimate(self.fixed), self.observers.1.estimate(self.real));
        [
            f.motor_speed.to_f64() * speed - r.motor_speed,
            f.shaft_torque.to_f64() * torque - r.shaft_torque,
            f.load_speed.to_f64() * speed - r.load_speed,
            f.load_torque.to_f64() * torque - r.load_torque,
        ]
    }

    /// Innovation in fixed point less that in real numbers.
    fn innovation(&self, (fixed, real): (Fixed, f64)) -> f64 {
        let (f, r) = &self.observers;
        let angle = r.angle();
        let in_fixed = f.predict(self.fixed, angle, fixed).innovation().to_bits();
        f64::from(in_fixed) - r.predict(self.real, angle, real).innovation()
    }

    fn most(mut self, linear: &Linear, ticks: u64) -> [f64; 4] {
        let mut most = self.drawn(ticks / 2);
        for (output, most) in most.iter_mut().enumerate() {
            self.restart();
            *most = most.max(self.sought(linear, output, (ticks / 64) as usize));
        }
        most
    }

    fn drawn(&mut self, ticks: u64) -> [f64; 4] {
        let base = self.subject.bases.speed;
        let mut random = random();
        let mut most = [0.0_f64; 4];
        let (mut speed, mut noise, mut shake, mut left) = (0.0, 0.0, 0.0, 0_u64);
        for tick in 0..ticks {
            if left == 0 {
                left = 1 + (8_000.0 * random().abs()) as u64;
                speed = 0.74 * base * random() * if tick % 3 == 0 { 0.01 } else { 1.0 };
                noise = 2e4 * random().abs().powi(4);
                shake = random().abs().powi(3);
            }
            left -= 1;
            let torque = self.torque(speed, shake * random());
            let angle = self.angle(torque.1, noise * random());
            self.step(angle, torque);
            if self.observers.0.beyond_base() != 0 {
                self.restart();
                left = 0;
            }
            most.iter_mut().zip(self.error()).for_each(|(most, error)| *most = most.max(error.abs()));
        }
        most
    }

    /// The error of an output after at most so many ticks, each angle chosen for it.
    fn sought(&mut self, linear: &Linear, output: usize, ticks: usize) -> f64 {
        let Linear { step, outputs, units } = linear;
        let n = step.len();
        let last = n - 1;
        // what the error of a state now makes of the output later, while it is a millionth of the most
        let mut later = vec![outputs[output].clone()];
        let mut most = vec![0.0_f64; n];
        while later.len() < ticks {
            let row = &later[later.len() - 1];
            most.iter_mut().zip(row).for_each(|(most, x)| *most = most.max(x.abs()));
            if row.iter().zip(&most).all(|(x, most)| x.abs() <= 1e-6 * most) {
                break;
            }
            let next: Vec<f64> = (0..n).map(|j| row.iter().zip(step).map(|(x, of)| x * of[j]).sum()).collect();
            later.push(next);
        }
        let states = (n == 5).then(|| Matrix4::from_fn(|i, j| outputs[i][j]).try_inverse()).flatten();
        let mut random = random();
        let speed = 0.6 * self.subject.bases.speed;
        let mut torque = self.torque(speed, 0.0);
        for row in later.iter().rev() {
            let start = self.observers;
            let mut best: Option<(f64, (F, R), (Fixed, f64))> = None;
            for _ in 0..16 {
                self.observers = start;
                let angle = self.angle(torque.1, 2e3 * random());
                self.step(angle, torque);
                let next = self.torque(speed, 0.0);
                let error: [f64; 4] = std::array::from_fn(|k| self.error()[k] / units[k]);
                let state = match states {
                    Some(inverse) => (inverse * nalgebra::Vector4::from(error)).as_slice().to_vec(),
                    None => vec![error[0], error[3], 0.0],
                };
                // the turn of the next tick is rounded already: it counts as residual
                let told = state.iter().zip(&step[last]).map(|(x, c)| x * c / step[last][last]).sum::<f64>();
                let value =
                    state.iter().zip(row).map(|(x, c)| x * c).sum::<f64>() + row[last] * (self.innovation(next) - told);
                if best.is_none_or(|(most, ..)| value > most) {
                    best = Some((value, self.observers, next));
                }
            }
            if let Some((_, observers, next)) = best {
                (self.observers, torque) = (observers, next);
            }
        }
        if self.observers.0.beyond_base() != 0 { 0.0 } else { self.error()[output].abs() }
    }
}

/// Numbers from -1 to 1, the same in each run.
fn random() -> impl FnMut() -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}
