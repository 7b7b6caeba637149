//! The motion over a stretch as its Taylor series, order by order, with what rounding may have done to it.

use super::Train;
use super::series::{Series, TERMS, ZERO, product, value};
use super::sized::Sized;
use super::source::Work as SourceWork;
use super::state::{Mode, State};
use super::varying::Varying;
use super::{coupling, series};

/// Negligible share of the largest coefficient.
const LEFT_OUT: f64 = 1e-17;
/// All quantities of a train over `length` seconds.
pub(super) struct Stretch {
    pub length: f64,
    pub elongation: Vec<Sized>,
    /// Of every link, the elongation less the tooth error.
    pub approach: Vec<Sized>,
    pub speed: Vec<Sized>,
    pub angle: Vec<Sized>,
    /// Of every link, the force as if it were in contact on its present side.
    pub strain: Vec<Sized>,
    /// Of every friction, the force along its terms, while it sticks or slides.
    pub friction: Vec<Sized>,
    /// Of every gear with no shaft behind it, the torque behind it; the dry friction there added while it slides.
    pub gear: Vec<Sized>,
    /// Of every crank with friction in its pins, the force in its rod along the slider's way.
    pub rod: Vec<Sized>,
}

/// Lengths that are tried before terms that are no numbers are left as they are, and each over the one before: down to
/// 2^-80.
const ATTEMPTS: usize = 5;
const SHORTER: f64 = 1.0 / 1_048_576.0;

/// Course of a link's stiffness and error over a stretch.
enum Law {
    Fixed(f64),
    Varying(Box<[Series; 2]>),
}

impl Stretch {
    /// From a state at the time `t`, at most `length` long: shorter where its series would not converge to rounding.
    pub fn new(train: &Train, mode: &Mode, state: &State, held: &[f64], t: f64, length: f64) -> Self {
        let mut length = length;
        for _ in 0..ATTEMPTS {
            let mut stretch = Self::of(train, state, length);
            stretch.solve(train, mode, held, t, TERMS - 1);
            if stretch.is_finite() {
                stretch.shorten();
                return stretch;
            }
            length *= SHORTER;
        }
        let mut stretch = Self::of(train, state, length / SHORTER);
        stretch.solve(train, mode, held, t, TERMS - 1);
        stretch
    }

    /// Whether its terms are numbers. They are not where a torque changes within a tiny part of the length: at the
    /// start of a series motor almost without resistance.
    fn is_finite(&self) -> bool {
        self.speed.iter().chain(&self.elongation).all(|terms| terms.value.iter().sum::<f64>().is_finite())
    }

    /// The lowest terms alone: what is there now, and its rates.
    pub fn now(train: &Train, mode: &Mode, state: &State, held: &[f64], t: f64, length: f64) -> Self {
        let mut stretch = Self::of(train, state, length);
        stretch.solve(train, mode, held, t, 1);
        stretch
    }

    fn of(train: &Train, state: &State, length: f64) -> Self {
        let new = |values: &[f64]| values.iter().map(|&v| Sized::new(v)).collect::<Vec<_>>();
        let empty = |count: usize| (0..count).map(|_| Sized::new(0.0)).collect::<Vec<_>>();
        Self {
            length,
            elongation: new(&state.elongation),
            approach: Vec::new(),
            speed: new(&state.speed),
            angle: new(&state.angle),
            strain: empty(train.links.len()),
            friction: empty(train.frictions.len()),
            gear: empty(train.coordinates.iter().filter(|coordinate| coordinate.gear.is_some()).count()),
            rod: empty(train.coordinates.iter().filter(|coordinate| coordinate.pins.is_some()).count()),
        }
    }

    fn solve(&mut self, train: &Train, mode: &Mode, held: &[f64], t: f64, orders: usize) {
        let h = self.length;
        let n = train.coordinates.len();
        let laws: Vec<Law> = train
            .links
            .iter()
            .enumerate()
            .map(|(l, link)| match &link.variation {
                None => Law::Fixed(link.stiffness),
                Some(variation) => {
                    let (k, e) = variation.over(link.stiffness, t, h, mode.edge(l));
                    Law::Varying(Box::new([k, e]))
                }
            })
            .collect();
        let mut applied = vec![ZERO; n];
        let mut works: Vec<Vec<SourceWork>> = Vec::with_capacity(n);
        let mut cranks: Vec<Option<(Varying, Sized)>> = Vec::with_capacity(n);
        for (j, coordinate) in train.coordinates.iter().enumerate() {
            applied[j][0] = held[j];
            for (s, source) in coordinate.sources.iter().enumerate() {
                source.add_over(&mut applied[j], t, h, mode.on_arc(j, s));
            }
            let sources = coordinate.sources.iter().enumerate();
            works.push(sources.map(|(s, source)| source.work(mode.passed(j, s))).collect());
            let pins = coordinate.pins.as_ref().zip(mode.pinning(j));
            cranks.push(Varying::of(coordinate.crank, pins, coordinate.law.as_ref()).map(|mut work| {
                work.extend(&self.angle[j].value, 0);
                let momentum = (coordinate.inertia + work.inertia[0]) * self.speed[j].value[0];
                (work, Sized::new(momentum))
            }));
        }
        let mut unbalances = coupling::Work::of(train, &self.angle, &self.speed);
        let inertia: Vec<f64> = (0..n).map(|j| mode.inertia(train, j)).collect();
        let mut net = vec![0.0; n];
        let mut size = vec![0.0; n];
        for k in 0..orders {
            let step = h / (k + 1) as f64;
            for (j, coordinate) in train.coordinates.iter().enumerate() {
                let (angle, speed) = (&self.angle[j].value, &self.speed[j].value);
                let mut sum = applied[j][k];
                size[j] = sum.abs();
                for (source, work) in coordinate.sources.iter().zip(&mut works[j]) {
                    let torque = source.follow(work, angle, speed, k);
                    sum += torque;
                    size[j] += torque.abs();
                }
                if let Some((work, _)) = &cranks[j] {
                    sum += work.torque(k);
                    size[j] += work.torque(k).abs();
                }
                net[j] = sum - coordinate.viscous * speed[k];
                size[j] += coordinate.viscous * self.speed[j].size[k];
                let (v, v_size) = (speed[k], self.speed[j].size[k]);
                self.angle[j].put(k + 1, step * v, step * v_size);
            }
            self.links(train, mode, &laws, k, step, &mut net, &mut size);
            self.frictions(train, mode, k, &mut net, &mut size);
            if let Some(work) = &mut unbalances {
                work.push(train, &self.speed, k, &mut net, &mut size);
                work.extend(train, k, step, &net, &size, [&mut self.angle, &mut self.speed]);
            }
            for (j, coordinate) in train.coordinates.iter().enumerate() {
                match &mut cranks[j] {
                    Some((work, momentum)) => {
                        // (J w)' = net + J' w^2 / 2 without pins
                        let speed = &mut self.speed[j];
                        let mut square = ZERO;
                        for (i, s) in square.iter_mut().enumerate().take(k + 1) {
                            *s = product(&speed.value, &speed.value, i);
                        }
                        let push = net[j] + product(&work.push, &square, k);
                        momentum.put(k + 1, step * push, step * size[j]);
                        work.extend(&self.angle[j].value, k + 1);
                        let mut inertia = work.inertia;
                        inertia[0] += coordinate.inertia;
                        let next = series::quotient(&momentum.value, &inertia, &speed.value, k + 1);
                        speed.put(k + 1, next, next.abs().max(momentum.size[k + 1] / inertia[0]));
                        if let Some((force, size)) = work.rod(&speed.value, k, step)
                            && let Some(row) = mode.pins.iter().position(|pinning| pinning.at == j)
                        {
                            self.rod[row].put(k, force, size);
                        }
                    }
                    None if unbalances.is_some() => {}
                    None => {
                        let rate = step / inertia[j];
                        self.speed[j].put(k + 1, rate * net[j], rate * size[j]);
                    }
                }
            }
        }
        self.approach.clone_from(&self.elongation);
        for (approach, law) in self.approach.iter_mut().zip(&laws) {
            if let Law::Varying(over) = law {
                for (k, error) in over[1].iter().enumerate() {
                    approach.value[k] -= error;
                    approach.size[k] += error.abs();
                }
            }
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn links(
        &mut self,
        train: &Train,
        mode: &Mode,
        laws: &[Law],
        k: usize,
        step: f64,
        net: &mut [f64],
        size: &mut [f64],
    ) {
        for (l, link) in train.links.iter().enumerate() {
            let (mut rate, mut rate_size) = (0.0, 0.0);
            for &(at, share) in &link.terms {
                rate += share * self.speed[at].value[k];
                rate_size += share.abs() * self.speed[at].size[k];
            }
            let elongation = &mut self.elongation[l];
            elongation.put(k + 1, step * rate, step * rate_size);
            let mut opening = (0.0, 0.0);
            let origin = link.origin(mode.contact[l]);
            let (force, force_size) = match &laws[l] {
                Law::Fixed(stiffness) => {
                    let at = if k == 0 { origin } else { 0.0 };
                    (stiffness * (elongation.value[k] - at), stiffness * (elongation.size[k] + at.abs()))
                }
                Law::Varying(over) => {
                    let [stiffness, error] = &**over;
                    let (mut sum, mut sizes) = (0.0, 0.0);
                    for i in 0..=k {
                        let at = if i == 0 { origin } else { 0.0 };
                        sum += stiffness[k - i] * (elongation.value[i] - at - error[i]);
                        sizes += stiffness[k - i].abs() * (elongation.size[i] + at.abs() + error[i].abs());
                    }
                    opening = (error[k + 1] / step, error[k + 1].abs() / step);
                    (sum, sizes)
                }
            };
            // the damper feels the flanks, which the error parts
            let force = force + link.damping * (rate - opening.0);
            let force_size = force_size + link.damping * (rate_size + opening.1);
            self.strain[l].put(k, force, force_size);
            if mode.carries(train, l) {
                for (i, &(at, share)) in link.terms.iter().enumerate() {
                    let factor = if i == 0 { share * mode.loss(train, l) } else { share };
                    net[at] -= factor * force;
                    size[at] += factor.abs() * force_size;
                }
            }
        }
    }

    fn frictions(&mut self, train: &Train, mode: &Mode, k: usize, net: &mut [f64], size: &mut [f64]) {
        for (s, friction) in train.frictions.iter().enumerate().filter(|&(s, _)| mode.slip[s] != 0) {
            let force = if k == 0 { -f64::from(mode.slip[s]) * friction.kinetic } else { 0.0 };
            self.friction[s].put(k, force, force.abs());
            for &(at, share) in &friction.terms {
                net[at] += share * force;
                size[at] += share.abs() * force.abs();
            }
        }
        self.gears(train, mode, k, net, size);
        // sticking: the forces that keep its speed
        let wanted: Vec<(f64, f64)> = mode
            .stuck
            .iter()
            .map(|&s| {
                let terms = train.frictions[s].terms.iter();
                terms.fold((0.0, 0.0), |(sum, sizes), &(at, share)| {
                    let inertia = train.coordinates[at].inertia;
                    (sum - share * net[at] / inertia, sizes + share.abs() * size[at] / inertia)
                })
            })
            .collect();
        for (row, &s) in mode.stuck.iter().enumerate() {
            let (mut force, mut force_size) = (0.0, 0.0);
            for (column, &(sum, sizes)) in wanted.iter().enumerate() {
                force += mode.holding[(row, column)] * sum;
                force_size += mode.holding[(row, column)].abs() * sizes;
            }
            self.friction[s].put(k, force, force_size);
        }
        for &s in &mode.stuck {
            let terms = &train.frictions[s].terms;
            for &(at, share) in terms {
                net[at] += share * self.friction[s].value[k];
                size[at] += share.abs() * self.friction[s].size[k];
            }
        }
        for &s in &mode.stuck {
            // a coordinate that the ground holds stays as it is to the last digit
            if let [(at, _)] = train.frictions[s].terms[..] {
                (net[at], size[at]) = (0.0, 0.0);
            }
        }
    }

    /// Halves the length until the last coefficients lie below rounding.
    fn shorten(&mut self) {
        let whole = |s: &Sized| {
            let most = s.value.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            let last = s.value[TERMS - 1].abs().max(s.value[TERMS - 2].abs());
            last > LEFT_OUT * most && last > 0.0 && most > f64::MIN_POSITIVE
        };
        for _ in 0..60 {
            let bad = self.speed.iter().chain(&self.elongation).any(whole);
            if !bad {
                return;
            }
            self.length *= 0.5;
            let moved = [&mut self.speed, &mut self.angle, &mut self.elongation];
            let forces = [&mut self.approach, &mut self.strain, &mut self.friction, &mut self.gear, &mut self.rod];
            for sized in moved.into_iter().chain(forces).flatten() {
                let mut scale = 1.0;
                for k in 0..TERMS {
                    sized.value[k] *= scale;
                    sized.size[k] *= scale;
                    scale *= 0.5;
                }
            }
        }
    }

    /// The state at `s`.
    pub fn at(&self, s: f64) -> State {
        let all = |list: &[Sized]| list.iter().map(|sized| value(&sized.value, s)).collect();
        State { elongation: all(&self.elongation), speed: all(&self.speed), angle: all(&self.angle) }
    }
}
