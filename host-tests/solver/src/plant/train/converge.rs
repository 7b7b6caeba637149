//! Proof of a recorded run of a train: it is run again by DOP853 of the crate `differential-equations`, with its own
//! right-hand side and its own finding of events, and by the solver itself with its events located ten times closer.
//! Both must agree to 1e-8 of the peaks of the run; the angle of what turns freely, to 1e-8 of the way that its peak
//! speed goes in the run.
//!
//! ```
//! use driveline_solver::plant::train::{Coordinate, Link, Source, Train};
//! use driveline_solver::plant::train::converge::{Recording, prove};
//! let drive = Train::new()
//!     .coordinate(Coordinate::new(1.2).source(Source::Constant(200.0)))
//!     .coordinate(Coordinate::new(0.35).source(Source::Constant(-120.0)))
//!     .link(Link::shaft(0, 1, 850.0).damping(0.5).gap(0.06))
//!     .build()?;
//! let mut run = Recording::new(drive);
//! for _ in 0..500 {
//!     run.advance(1e-3);
//! }
//! let proof = prove(&run)?;
//! assert!(proof.largest() <= 1e-8);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(in crate::plant) mod chain;
mod growth;
#[cfg(test)]
mod random;
mod textbook;

pub use crate::plant::converge::{BOUND, Deviation, NotProven, Proof, Sensitive};

use super::motion::Motion;
use super::rank::Elimination;
use super::state::{Mode, State};
use crate::plant::converge::pass::{Pass, REACH};
use growth::Growth;
use textbook::{Change, Double};

/// What a step of the second integrator may deviate by, as a share of the peaks. The first tick of a piece may deviate
/// by ten of them, or by as many as it takes at least: rattling gears show 7e-14, stiff ones of 17 steps a tick 1e-12.
/// What that makes of small elongations between fast masses, and of forces behind a gap, is in [`Growth::resolved`].
const FRESH: f64 = 1e-13;

/// Steps whose errors gather within a piece, at least; more where the second integrator takes more.
const GATHERED: f64 = 1000.0;

/// What is done to a motion: a tick, a torque held on a coordinate, its dry friction against the ground, stiffness and
/// damping of a link.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    Advance(f64),
    Torque(usize, f64),
    Friction(usize, f64),
    Link(usize, f64, f64),
}

impl Step {
    fn take(self, motion: &mut Motion) {
        match self {
            Step::Advance(dt) => motion.advance(dt),
            Step::Torque(coordinate, torque) => motion.set_torque(coordinate, torque),
            Step::Friction(coordinate, torque) => motion.set_ground_friction(coordinate, torque),
            Step::Link(link, stiffness, damping) => motion.set_link(link, stiffness, damping),
        }
    }
}

/// Everything that was done to a motion, and what came of every tick.
#[derive(Debug, Clone)]
struct Run {
    start: Motion,
    steps: Vec<Step>,
    samples: Vec<Vec<f64>>,
    times: Vec<f64>,
    /// Guards that fell.
    fired: u64,
}

impl Run {
    /// Of a motion that begins as it is.
    pub fn of(motion: &Motion) -> Self {
        let mut start = motion.clone();
        start.watches.clear();
        Self { start, steps: Vec::new(), samples: Vec::new(), times: Vec::new(), fired: 0 }
    }

    /// Writes down what was done, with the motion as it is then.
    pub fn note(&mut self, step: Step, motion: &Motion) {
        self.steps.push(step);
        if let Step::Advance(_) = step {
            self.samples.push(sample(motion));
            self.times.push(motion.time());
            self.fired = motion.fired - self.start.fired;
        }
    }
}

/// A motion whose run is written down as it goes.
#[derive(Debug, Clone)]
pub struct Recording {
    run: Run,
    motion: Motion,
}

impl Recording {
    /// Begins with the motion as it is, which must not have been advanced yet.
    #[must_use]
    pub fn new(motion: Motion) -> Self {
        Self { run: Run::of(&motion), motion }
    }

    /// [`Motion::advance`], written down.
    pub fn advance(&mut self, dt: f64) {
        let refused = self.motion.refused();
        self.motion.advance(dt);
        if self.motion.refused() == refused {
            self.run.note(Step::Advance(dt), &self.motion);
        }
    }

    /// [`Motion::set_torque`], written down.
    pub fn set_torque(&mut self, coordinate: usize, torque: f64) {
        let refused = self.motion.refused();
        self.motion.set_torque(coordinate, torque);
        if self.motion.refused() == refused {
            self.run.note(Step::Torque(coordinate, torque), &self.motion);
        }
    }

    /// The motion as it stands.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }
}

/// Runs both checks, at the same time.
///
/// # Errors
/// [`NotProven`] if one of them comes out more than [`BOUND`] from the recording, or cannot be done.
pub fn prove(run: &Recording) -> Result<Proof, NotProven> {
    check(&run.run, false, |_| {})
}

/// [`prove`], telling now and then the share of the work that is done, from 0 to 1; of a sensitive run in pieces.
///
/// Where a rounding grows, two runs have nothing in common after some time. A check that comes out more than [`BOUND`]
/// from the recording does that step again from the recording's own state before it, and goes on from there. The proof
/// says how often: see [`Sensitive`]. A run that is wrong is lost as well, and not called sensitive: a piece ends only
/// where the errors of its steps, each right to 1e-13, have grown to the bound, as the solver shows that runs it twice.
/// That is a hundredfold after a thousand steps or fewer. Its first tick agrees to 1e-13 for each step of the second
/// integrator, ten at least, times its own growth.
///
/// # Errors
/// [`NotProven`] if a step comes out more than [`BOUND`] from the recording, or cannot be done.
pub fn prove_in_pieces(run: &Recording, done: impl FnMut(f64)) -> Result<Proof, NotProven> {
    check(&run.run, true, done)
}

fn check(run: &Run, pieces: bool, done: impl FnMut(f64)) -> Result<Proof, NotProven> {
    if run.samples.is_empty() {
        return Err(NotProven::Empty);
    }
    let peaks = peaks(run);
    let sizes = sizes(run, &peaks);
    let tightened = || {
        // without an event nothing was located: the same series would come out
        if run.fired == 0 { Ok(None) } else { follow(run, &sizes, pieces, Tightened::of(run), |_| {}).map(Some) }
    };
    let (integrator, tightened) = std::thread::scope(|scope| {
        let tightened = scope.spawn(tightened);
        let integrator = follow(run, &sizes, pieces, Integrator::of(run, &peaks), done);
        (integrator, tightened.join())
    });
    let (integrator, tightened) = (integrator?, tightened.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?);
    let also = tightened.as_ref().and_then(|tightened| tightened.sensitive);
    let both = |a: Sensitive, b: Sensitive| Sensitive {
        from: a.from.min(b.from),
        restarts: a.restarts.max(b.restarts),
        shortest: a.shortest.min(b.shortest),
    };
    Ok(Proof {
        integrator: integrator.deviation,
        tightened: tightened.map(|tightened| tightened.deviation),
        sensitive: [integrator.sensitive, also].into_iter().flatten().reduce(both),
    })
}

/// The run once more by other means.
trait Again {
    const NAME: &'static str;

    /// Takes the place of the recording, with its sample at a time (s), in the mode that the last step began with.
    fn restart(&mut self, sample: &[f64], time: f64);
    /// Does what is no tick.
    fn change(&mut self, step: Step);
    /// Steps that it has taken, each with an error of its own; those that begin anew after an event included.
    fn steps(&self) -> u64 {
        0
    }
    /// Goes on by `dt` to the time `end`, both in s; the sample there.
    fn advance(&mut self, dt: f64, end: f64) -> Result<Vec<f64>, NotProven>;
}

/// How well a run was followed.
#[derive(Default)]
struct Followed {
    deviation: Deviation,
    sensitive: Option<Sensitive>,
}

fn follow<A: Again>(
    run: &Run,
    sizes: &[f64],
    pieces: bool,
    mut again: A,
    mut done: impl FnMut(f64),
) -> Result<Followed, NotProven> {
    let mut followed = Followed::default();
    let mut growth = Growth::of(run);
    let (mut sample, mut before, mut begun, mut taken) = (0, run.start.now, run.start.now, 0);
    for (index, step) in run.steps.iter().enumerate() {
        done(index as f64 / run.steps.len() as f64);
        let dt = match *step {
            Step::Advance(dt) => dt,
            step => {
                again.change(step);
                continue;
            }
        };
        let time = run.times[sample];
        let mut largest = run.deviation(sample, before, &again.advance(dt, time)?, sizes);
        let refused = |found, expected| NotProven::Deviates { from: A::NAME, found, expected, time };
        // what takes the errors of the steps so far beyond the bound
        let grown = BOUND / (FRESH * ((again.steps() - taken) as f64).max(GATHERED));
        if pieces && largest > BOUND && begun < before && growth.until(run, sizes, index) > grown {
            again.restart(&run.samples[sample - 1], before);
            taken = again.steps();
            let other = again.advance(dt, time)?;
            largest = run.deviation(sample, before, &other, sizes);
            growth.begin(run, index, &run.samples[sample - 1]);
            let fresh = FRESH * ((again.steps() - taken) as f64).max(10.0);
            let found = run.deviation(sample, before, &other, &growth.resolved(sizes, dt));
            if found > fresh && found > fresh * growth.until(run, sizes, index) {
                return Err(refused(found, fresh));
            }
            let sensitive =
                followed.sensitive.get_or_insert(Sensitive { from: before, restarts: 0, shortest: f64::MAX });
            sensitive.restarts += 1;
            sensitive.shortest = sensitive.shortest.min(time - begun);
            begun = before;
        }
        if largest > BOUND {
            return Err(refused(largest, BOUND));
        }
        if largest > followed.deviation.largest {
            followed.deviation = Deviation { largest, time };
        }
        (sample, before) = (sample + 1, time);
    }
    Ok(followed)
}

/// The state that a sample has.
fn state(motion: &Motion, sample: &[f64]) -> State {
    let (n, links) = (motion.coordinates(), motion.links());
    State {
        speed: sample[..n].to_vec(),
        elongation: sample[n..n + links].to_vec(),
        angle: sample[n + 2 * links..].to_vec(),
    }
}

/// The solver with events located ten times closer.
struct Tightened {
    motion: Motion,
    /// Mode and clock at the start of the step.
    mode: Mode,
    clock: (f64, f64),
    /// Guards that fell up to there.
    fired: u64,
}

impl Tightened {
    fn of(run: &Run) -> Self {
        let mut motion = run.start.clone();
        motion.set_event_tolerance(0.1 * motion.event_tolerance);
        Self { mode: motion.mode.clone(), clock: motion.clock, fired: motion.fired, motion }
    }
}

impl Again for Tightened {
    const NAME: &'static str = "the solver with events located ten times closer";

    fn restart(&mut self, sample: &[f64], time: f64) {
        self.motion.state = state(&self.motion, sample);
        (self.motion.mode, self.motion.clock, self.motion.now) = (self.mode.clone(), self.clock, time);
        self.motion.look_again();
    }

    fn change(&mut self, step: Step) {
        step.take(&mut self.motion);
    }

    fn advance(&mut self, dt: f64, _: f64) -> Result<Vec<f64>, NotProven> {
        if self.motion.fired != self.fired {
            (self.mode, self.fired) = (self.motion.mode.clone(), self.motion.fired);
        }
        self.clock = self.motion.clock;
        self.motion.advance(dt);
        Ok(sample(&self.motion))
    }
}

/// Speeds, then elongations, then forces, then angles.
fn sample(motion: &Motion) -> Vec<f64> {
    let forces = (0..motion.links()).map(|link| motion.force(link));
    let state = &motion.state;
    let moved = state.speed.iter().chain(&state.elongation).copied();
    moved.chain(forces).chain(state.angle.iter().copied()).collect()
}

/// The second integrator.
struct Integrator<'a> {
    start: &'a Motion,
    double: Double,
    /// At the start of the step.
    before: Double,
    /// Elongations, speeds, angles.
    y: Vec<f64>,
    pass: Pass<Change>,
    now: f64,
}

impl<'a> Integrator<'a> {
    fn of(run: &'a Run, peaks: &[f64]) -> Self {
        let motion = &run.start;
        let (n, links) = (motion.coordinates(), motion.links());
        let state = &motion.state;
        let y: Vec<f64> = state.elongation.iter().chain(&state.speed).chain(&state.angle).copied().collect();
        let felt: Vec<f64> = (0..links).map(|l| felt(motion, peaks, l)).collect();
        let mut scale: Vec<f64> = felt.iter().chain(&peaks[..n]).copied().collect();
        // masses on a stiff link may turn a million times as fast as they swing
        for (l, link) in motion.train.links.iter().enumerate() {
            let inverse: f64 = link.terms.iter().map(|&(j, factor)| factor * factor / motion.inertia(j)).sum();
            let swing = felt[l] * (link.stiffest() * inverse).sqrt();
            for &(j, _) in link.terms.iter().filter(|_| swing > 0.0) {
                scale[links + j] = scale[links + j].min(swing);
            }
        }
        scale.extend_from_slice(&peaks[n + 2 * links..]);
        scale.iter_mut().filter(|size| **size <= 0.0).for_each(|size| *size = 1.0);
        let pass = Pass::new(&scale, REACH / motion.rate.max(1e-3), 0.1 * motion.event_tolerance);
        let double = Double::new(motion.train.clone(), motion.held.clone(), &motion.mode.arcs, &peaks[..n]);
        Self { start: motion, before: double.clone(), double, y, pass, now: motion.now }
    }

    /// To the time `end`; the equations are the same up to `corner`, which lies beyond it.
    fn smooth(&mut self, end: f64, corner: f64) -> Result<(), NotProven> {
        self.double.middle = 0.5 * (self.now + corner);
        self.pass.between(&mut self.double, &mut self.y, self.now, end)?;
        self.now = end;
        Ok(())
    }
}

impl Again for Integrator<'_> {
    const NAME: &'static str = "the second integrator";

    fn restart(&mut self, sample: &[f64], time: f64) {
        let (n, links) = (self.start.coordinates(), self.start.links());
        let moved = sample[n..n + links].iter().chain(&sample[..n]).chain(&sample[n + 2 * links..]);
        (self.double, self.y, self.now) = (self.before.clone(), moved.copied().collect(), time);
        self.pass.anew();
    }

    fn change(&mut self, step: Step) {
        let rate = self.double.apply(step, self.now, &mut self.y);
        if rate > 0.0 {
            self.pass.longest = self.pass.longest.min(REACH / rate);
        }
        self.pass.anew();
    }

    fn steps(&self) -> u64 {
        self.pass.taken
    }

    /// To the clock of the run, which does not gather the rounding of its ticks: teeth that meet 1e-12 s late show.
    fn advance(&mut self, dt: f64, end: f64) -> Result<Vec<f64>, NotProven> {
        if !self.double.settled {
            self.double.middle = 0.5 * (self.now + self.start.corner_after(self.now).unwrap_or(self.now + dt));
            self.double.settle(self.now, &self.y);
        }
        if std::mem::take(&mut self.double.changed) {
            self.before = self.double.clone();
        }
        let mut corner = self.start.corner_after(self.now);
        while let Some(at) = corner.filter(|&corner| corner <= end) {
            self.smooth(at, at)?;
            self.pass.anew();
            corner = self.start.corner_after(self.now);
        }
        let corner = corner.unwrap_or(end + dt);
        if self.now < end {
            self.smooth(end, corner)?;
        }
        self.double.middle = 0.5 * (end + corner);
        let (links, n, y) = (self.start.links(), self.start.coordinates(), &self.y);
        let forces = (0..links).map(|l| self.double.carried(end, y, l));
        Ok(y[links..links + n]
            .iter()
            .chain(&y[..links])
            .copied()
            .chain(forces)
            .chain(y[links + n..].iter().copied())
            .collect())
    }
}

fn peaks(run: &Run) -> Vec<f64> {
    let mut peaks = vec![0.0_f64; run.samples.first().map_or(0, Vec::len)];
    for sample in &run.samples {
        for (peak, value) in peaks.iter_mut().zip(sample) {
            *peak = peak.max(value.abs());
        }
    }
    peaks
}

/// The elongation, at most, at which a link carries its force: a rope that flies open is as long as its way, and pulls
/// within hundredths of it.
fn felt(motion: &Motion, peaks: &[f64], l: usize) -> f64 {
    let (n, links) = (motion.coordinates(), &motion.train.links);
    peaks[n + l].min(links[l].elongation_at(peaks[n + links.len() + l]))
}

/// What a deviation is a share of: the peak of each quantity; of the angle of what turns freely at least the way that
/// its peak speed would go in the whole run. It may come back to where it was, and gathers the rounding of its speed
/// all the same.
fn sizes(run: &Run, peaks: &[f64]) -> Vec<f64> {
    let (n, time) = (run.start.coordinates(), run.times.last().map_or(0.0, |end| end - run.start.now));
    let angles = peaks.len() - n;
    let links = run.start.train.links.iter().map(|link| link.terms.as_slice());
    let free = Elimination::of(links, n).free_motions(&vec![1.0; n]);
    // a motion is of length one
    let turns = |j: usize| free.iter().any(|motion| motion[j].abs() > 1e-9);
    let size = |(i, &peak): (usize, &f64)| {
        let way = i.checked_sub(angles).filter(|&j| turns(j)).map_or(0.0, |j| peaks[j] * time);
        if peak.max(way) > 0.0 { peak.max(way) } else { 1.0 }
    };
    peaks.iter().enumerate().map(size).collect()
}

impl Run {
    /// Largest deviation of a sample from that of the run.
    fn deviation(&self, sample: usize, before: f64, other: &[f64], sizes: &[f64]) -> f64 {
        self.apart([before, self.times[sample]], &self.samples[sample], other, sizes)
    }

    /// Largest difference of two samples at the end of a step, as a share of the size of each quantity. Where it falls
    /// on a corner of a torque or a switch of stiffness, forces have two values and are left out of it.
    fn apart(&self, [before, time]: [f64; 2], one: &[f64], other: &[f64], sizes: &[f64]) -> f64 {
        let (n, links) = (self.start.coordinates(), self.start.links());
        let close = 1e-9 * (time - before);
        let on_corner = self.start.corner_after(time - close).is_some_and(|corner| corner <= time + close);
        let mut largest = 0.0_f64;
        for (i, ((a, b), size)) in one.iter().zip(other).zip(sizes).enumerate() {
            if on_corner && (n + links..n + 2 * links).contains(&i) {
                continue;
            }
            let share = (a - b).abs() / size;
            // a value that is not a number agrees with nothing
            largest = largest.max(if share.is_nan() { f64::INFINITY } else { share });
        }
        largest
    }
}

#[cfg(test)]
mod tests {
    use crate::plant::LoadProgram;
    use crate::plant::train::converge::*;
    use crate::plant::train::{Coordinate, Harmonic, Link, Source, Train};

    /// A mass swings on a rope by 1e-4 rad and is then pulled away by 1000 rad: what the rope has carried is known by
    /// the elongations at which it did.
    #[test]
    fn a_rope_that_flies_open_is_known_by_what_it_carried() {
        let pull = Source::Program(LoadProgram::steps(&[(0.0, 0.04), (0.2, -3.0)]));
        let mass = Coordinate::new(0.03).source(pull);
        let mut run =
            Recording::new(Train::new().coordinate(mass).link(Link::ground(0, 850.0).rope()).build().unwrap());
        for _ in 0..1500 {
            run.advance(3.4e-3);
        }
        assert!(run.run.samples.iter().any(|sample| sample[2] > 0.05) && run.run.fired > 0);
        let proof = prove(&run).unwrap();
        assert!(proof.largest() < 1e-11, "{proof:?}");
    }

    /// A mass that turns slowly for 20 s and then a hundred thousand times as fast for 10 ms: steps are short only then.
    #[test]
    fn steps_are_as_short_as_what_turns_needs_then() {
        let push = Source::Program(LoadProgram::steps(&[(0.0, 0.0), (20.0, 1e8)]));
        let swing = Source::Orders(vec![Harmonic { order: 2.0, cosine: 0.5, sine: 0.0 }]);
        let mass = Coordinate::new(1.0).speed(10.0).source(push).source(swing);
        let mut run = Recording::new(Train::new().coordinate(mass).build().unwrap());
        for _ in 0..2001 {
            run.advance(1e-2);
        }
        let peaks = peaks(&run.run);
        let mut again = Integrator::of(&run.run, &peaks);
        for &time in &run.run.times {
            again.advance(1e-2, time).unwrap();
        }
        // a radian of order 2 a step; 400 rad slowly and 5000 rad fast, and what begins anew
        assert!(peaks[0] > 9e5 && (10_000..40_000).contains(&again.steps()), "{} {}", peaks[0], again.steps());
        assert!(prove(&run).unwrap().largest() < BOUND);
    }

    /// A ball between two walls a little apart, pushed back and forth: its impacts forget where it came from. Pieces
    /// begin with what was recorded, so that a recording that is wrong in one number by ten times the bound is found.
    #[test]
    fn a_sensitive_run_that_is_wrong_in_one_sample_is_refused() {
        let push = crate::plant::train::Waveform::triangle(30.0, 0.05, 3);
        let ball = Coordinate::new(1.0).speed(0.3).source(Source::Waveform(push));
        let walls = Link::ground(0, 4.0e5).damping(20.0).gap(2e-3);
        let mut run = Recording::new(Train::new().coordinate(ball).link(walls).build().unwrap());
        for _ in 0..4000 {
            run.advance(5e-4);
        }
        assert!(prove(&run).is_err());
        let proof = prove_in_pieces(&run, |_| {}).unwrap();
        assert!(proof.sensitive.is_some_and(|sensitive| sensitive.restarts > 0), "{proof:?}");
        let peak = peaks(&run.run)[0];
        for sample in [1, 1234, 3998] {
            let mut wrong = run.clone();
            wrong.run.samples[sample][0] += 1e-7 * peak;
            assert!(matches!(prove_in_pieces(&wrong, |_| {}), Err(NotProven::Deviates { .. })), "{sample}");
        }
    }

    /// A driven pendulum is chaotic without an event; a rope lets go of it once.
    #[test]
    fn a_rounding_that_grows_without_an_event_begins_a_piece() {
        let swing = |damping: f64| {
            let weight = Source::Orders(vec![Harmonic { order: 1.0, cosine: 0.0, sine: -1.0 }]);
            let push = crate::plant::train::Waveform::triangle(1.85, 9.42, 1);
            let pendulum = Coordinate::new(1.0).viscous(damping).source(weight).source(Source::Waveform(push));
            let rope = Link::shaft(0, 1, 1e4).rope().elongated(1e-3);
            Train::new().coordinate(pendulum).coordinate(Coordinate::new(1.0).speed(10.0)).link(rope)
        };
        let run = passed_off(swing(0.5), swing(0.5), 0.1, 4000);
        assert!(matches!(prove(&run), Err(NotProven::Deviates { .. })));
        let proof = prove_in_pieces(&run, |_| {}).unwrap();
        assert!(proof.sensitive.is_some_and(|sensitive| sensitive.restarts > 0), "{proof:?}");
        let wrong = passed_off(swing(0.5 * (1.0 + 1e-7)), swing(0.5), 0.1, 4000);
        assert!(matches!(prove_in_pieces(&wrong, |_| {}), Err(NotProven::Deviates { .. })));
    }

    /// A run of one train, recorded as that of another.
    pub fn passed_off(wrong: Train, right: Train, dt: f64, ticks: usize) -> Recording {
        let mut run = Recording::new(wrong.build().unwrap());
        for _ in 0..ticks {
            run.advance(dt);
        }
        run.run.start = right.build().unwrap();
        run
    }

    /// The recorded run has a millionth too much damping. That grows beyond the bound within some steps, and so would
    /// a rounding.
    #[test]
    fn a_run_with_a_millionth_too_much_damping_is_refused_and_not_called_sensitive() {
        let rattle = |damping: f64| {
            let push = crate::plant::train::Waveform::triangle(30.0, 0.05, 3);
            let ball = Coordinate::new(1.0).speed(0.3).source(Source::Waveform(push));
            Train::new().coordinate(ball).link(Link::ground(0, 4.0e5).damping(damping).gap(2e-3))
        };
        let run = passed_off(rattle(2.0 * (1.0 + 1e-6)), rattle(2.0), 5e-4, 4000);
        assert!(matches!(prove_in_pieces(&run, |_| {}), Err(NotProven::Deviates { .. })));
        // no event, and one that is over when the run is lost
        let slowed = |damping: f64, at: f64| {
            let stop = Link::ground(0, 900.0).rope().gap(0.1);
            Train::new().coordinate(Coordinate::new(1.0).speed(at).viscous(damping)).link(stop)
        };
        for speed in [-1.0, 1.0] {
            let run = passed_off(slowed(0.5 * (1.0 + 1e-6), speed), slowed(0.5, speed), 1e-3, 2000);
            let proof = prove_in_pieces(&run, |_| {});
            assert!(matches!(proof, Err(NotProven::Deviates { .. })), "{speed}: {proof:?}");
        }
    }
}
