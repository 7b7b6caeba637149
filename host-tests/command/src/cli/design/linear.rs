//! The speed loop in state space: machine, observer, governor and actuator, tick by tick.
//!
//! It is what [`ClosedLoop`](driveline::design::ClosedLoop) has as polynomials: linear, gaps closed, gears without
//! losses, no limit and no ramp. Its poles and its steps are on the page. A tick is written once; the matrix of the
//! whole loop follows from it, a column for each state.

use driveline::design::{
    Actuator, Error, LoopObserver, Matrix, RigidDesign, SpeedLoopDesign, TwoMassDesign, discretise,
};
use driveline::machine::{Modes, TwoMass};
use nalgebra::{Complex, DMatrix, DVector};

/// A vibration as it is excited: square of the frequency (1/s2), damping (1/s), shapes at motor and load
/// (1/sqrt(kg m2)).
#[derive(Clone, Copy, Debug)]
pub struct Vibration {
    square: f64,
    damping: f64,
    shapes: [f64; 2],
}

/// A machine between its motor and its load.
#[derive(Clone, Debug)]
pub struct Body {
    inertia: f64,
    vibrations: Vec<Vibration>,
}

impl Body {
    /// Two masses.
    pub fn of(two: &TwoMass) -> Self {
        let (motor, load, total) = (two.motor_inertia, two.load_inertia, two.total_inertia());
        let reduced = two.reduced_inertia();
        let shapes = [(load / (total * motor)).sqrt(), -(motor / (total * load)).sqrt()];
        let vibration = Vibration { square: two.stiffness / reduced, damping: two.damping / reduced, shapes };
        Self { inertia: total, vibrations: vec![vibration] }
    }

    /// A machine with all vibrations that its motor feels, its load on a mass.
    pub fn of_modes(inertia: f64, modes: &Modes, load: usize) -> Self {
        // as the library leaves them out of a loop: a node at the motor
        let is_felt = |residue: f64| residue * inertia > 1e-9;
        let vibrations = modes.resonances().iter().filter(|mode| is_felt(mode.residue)).map(|mode| Vibration {
            square: mode.frequency * mode.frequency,
            damping: mode.damping,
            shapes: [mode.shape[0], mode.shape[load]],
        });
        Self { inertia, vibrations: vibrations.collect() }
    }

    /// Speed of the motor per torque of it (rad/s per N m) at a frequency (rad/s).
    pub fn mobility(&self, frequency: f64) -> Complex<f64> {
        let s = Complex::new(0.0, frequency);
        let vibrating =
            self.vibrations.iter().map(|one| one.shapes[0].powi(2) * s / (s * (s + one.damping) + one.square));
        1.0 / (s * self.inertia) + vibrating.sum::<Complex<f64>>()
    }

    /// Frequencies (rad/s) and damping (1/s) of its vibrations.
    pub fn resonances(&self) -> impl Iterator<Item = [f64; 2]> {
        self.vibrations.iter().map(|one| [one.square.sqrt(), one.damping])
    }
}

/// The observer: `x = A x + B torque + K (angle - x[0])`, and the rows of its estimates.
#[derive(Clone, Debug)]
pub struct Observer {
    transition: DMatrix<f64>,
    input: DVector<f64>,
    gains: DVector<f64>,
    /// Estimated load speed and shaft torque, and the latter's part of the states a tick ago.
    load_speed: DVector<f64>,
    shaft_torque: DVector<f64>,
    earlier: DVector<f64>,
}

impl Observer {
    /// Of a design with its speed loop.
    pub fn of(observer: &LoopObserver<'_>, two: &TwoMass) -> Option<Self> {
        match observer {
            LoopObserver::TwoMass(TwoMassDesign { machine, transition, input, gains, .. }) => Some(Self::new(
                transition,
                input,
                gains,
                [0.0, 0.0, 0.0, 1.0, 0.0],
                [0.0, machine.damping, machine.stiffness, -machine.damping, 0.0],
                [0.0; 5],
            )),
            // without a torque of the motor: the load torque, less the load's share of what decelerated
            LoopObserver::Rigid(RigidDesign { transition, input, gains, .. }) => {
                let share = two.load_inertia / two.total_inertia();
                Some(Self::new(transition, input, gains, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -share]))
            }
            LoopObserver::Placed(_) => None,
        }
    }

    fn new<const N: usize>(
        transition: &Matrix<N, N>,
        input: &[f64; N],
        gains: &[f64; N],
        load_speed: [f64; N],
        shaft_torque: [f64; N],
        earlier: [f64; N],
    ) -> Self {
        let vector = |values: &[f64; N]| DVector::from_row_slice(values);
        Self {
            transition: DMatrix::from_row_slice(N, N, transition.0.as_flattened()),
            input: vector(input),
            gains: vector(gains),
            load_speed: vector(&load_speed),
            shaft_torque: vector(&shaft_torque),
            earlier: vector(&earlier),
        }
    }

    /// Estimated load speed, and estimated shaft torque, per speed of the motor as it is measured, without a torque of
    /// the motor, at a frequency (rad/s).
    pub fn response(&self, frequency: f64, period: f64) -> Option<[Complex<f64>; 2]> {
        let z = Complex::new(0.0, frequency * period).exp();
        let n = self.gains.len();
        let seen = DMatrix::from_fn(n, n, |i, j| if j == 0 { self.gains[i] } else { 0.0 });
        let follows = (DMatrix::identity(n, n) - seen) * &self.transition;
        let system = DMatrix::from_fn(n, n, |i, j| z * f64::from(u8::from(i == j)) - follows[(i, j)]);
        let states = system.lu().solve(&self.gains.map(|gain| z * gain))?;
        let speed = Complex::new(0.0, frequency);
        let row = |row: &DVector<f64>| states.iter().zip(row.iter()).map(|(state, share)| state * *share).sum();
        let [load_speed, now, earlier]: [Complex<f64>; 3] =
            [&self.load_speed, &self.shaft_torque, &self.earlier].map(row);
        Some([load_speed / speed, (now + earlier / z) / speed])
    }
}

/// States of an observer at most.
const MOST_STATES: usize = 5;

/// What enters a tick from outside.
#[derive(Clone, Copy, Debug, Default)]
pub struct Entry {
    /// Setpoint (rad/s).
    pub setpoint: f64,
    /// Load torque (N m).
    pub load: f64,
}

/// What a tick shows: speeds of motor and load (rad/s), torque of the motor (N m).
pub type Shown = [f64; 3];

/// The closed loop.
#[derive(Clone, Debug)]
pub struct Linear {
    period: f64,
    body: Body,
    /// Transition and inputs (motor's torque, load torque) of each vibration over a tick.
    swings: Vec<(Matrix<2, 2>, Matrix<2, 2>)>,
    observer: Observer,
    /// Gains on error, integral and twist rate.
    gains: [f64; 3],
    ticks: usize,
    /// Share that the lag settles in a tick, and the lag's share of the tick's mean.
    settled: f64,
    within: f64,
    /// Torque of the machine over the reported one.
    torque: f64,
}

impl Linear {
    /// The loop on a body whose torque is so many times the reported one.
    ///
    /// # Errors
    /// A vibration that no exact step follows.
    pub fn new(
        body: Body,
        observer: Observer,
        speed_loop: &SpeedLoopDesign,
        actuator: Actuator,
        torque: f64,
    ) -> Result<Self, Error> {
        let period = speed_loop.period;
        let swing = |one: &Vibration| {
            let rates = Matrix([[0.0, 1.0], [-one.square, -one.damping]]);
            let forced = Matrix([[0.0, 0.0], [one.shapes[0], -one.shapes[1]]]);
            discretise::<2, 2, 4>(&rates, &forced, period).ok_or(Error::SampleRate)
        };
        let swings = body.vibrations.iter().map(swing).collect::<Result<_, _>>()?;
        let settled = if actuator.lag > 0.0 { -(-period / actuator.lag).exp_m1() } else { 1.0 };
        Ok(Self {
            period,
            body,
            swings,
            observer,
            gains: [speed_loop.proportional, speed_loop.integral, speed_loop.damping],
            ticks: (actuator.delay / period - 1e-6).ceil().max(0.0) as usize,
            settled,
            within: if actuator.lag > 0.0 { settled * actuator.lag / period } else { 0.0 },
            torque,
        })
    }

    /// Number of states.
    fn states(&self) -> usize {
        2 + 2 * self.swings.len() + self.observer.gains.len() + 3 + self.ticks
    }

    /// A tick: measure, observe, govern, act.
    fn tick(&self, state: &mut [f64], entry: Entry) -> Shown {
        let (turning, rest) = state.split_at_mut(2);
        let (swinging, rest) = rest.split_at_mut(2 * self.swings.len());
        let (observed, rest) = rest.split_at_mut(self.observer.gains.len());
        let ([integral, lagging, acted], line) = rest.split_at_mut(3) else { return [f64::NAN; 3] };
        let moved = |which: usize, at: usize, turning: &[f64], swinging: &[f64]| {
            let shares = self.body.vibrations.iter().zip(swinging.chunks_exact(2));
            turning[at] + shares.map(|(one, swing)| one.shapes[which] * swing[at]).sum::<f64>()
        };
        let angle = moved(0, 0, turning, swinging);
        let speeds = [0, 1].map(|which| moved(which, 1, turning, swinging));

        let Observer { transition, input, gains, load_speed, .. } = &self.observer;
        let mut corrected = [0.0; MOST_STATES];
        for (row, next) in corrected.iter_mut().take(gains.len()).enumerate() {
            *next = observed.iter().enumerate().map(|(at, state)| transition[(row, at)] * state).sum();
            *next += input[row] * *acted;
        }
        let innovation = angle - corrected[0];
        corrected.iter_mut().zip(gains.iter()).for_each(|(next, gain)| *next += gain * innovation);
        observed.copy_from_slice(&corrected[..gains.len()]);

        let [proportional, reset, damping] = self.gains;
        let error = entry.setpoint - corrected[1];
        *integral += reset * self.period * error;
        let seen: f64 = load_speed.iter().zip(&corrected).map(|(share, state)| share * state).sum();
        let command = proportional * error + *integral - damping * (corrected[1] - seen);

        let mut late = command;
        if let [first, ..] = line {
            late = *first;
            line.rotate_left(1);
            line[self.ticks - 1] = command;
        }
        let mean = late + self.within * (*lagging - late);
        *lagging += self.settled * (late - *lagging);
        *acted = mean;

        let given = self.torque * mean;
        let push = (given - entry.load) / self.body.inertia;
        turning[0] += self.period * (turning[1] + 0.5 * self.period * push);
        turning[1] += self.period * push;
        for ((f, g), swing) in self.swings.iter().zip(swinging.chunks_exact_mut(2)) {
            let next = [0, 1].map(|row| {
                let free = f.0[row][0] * swing[0] + f.0[row][1] * swing[1];
                free + g.0[row][0] * given + g.0[row][1] * entry.load
            });
            swing.copy_from_slice(&next);
        }
        [speeds[0], speeds[1], mean]
    }

    /// Poles in the plane of z, without the freely turning angle's, which is not fed back; none where they are not
    /// found.
    pub fn poles(&self) -> Option<Vec<Complex<f64>>> {
        let n = self.states();
        let column = |at: usize| {
            let mut state = vec![0.0; n];
            state[at] = 1.0;
            self.tick(&mut state, Entry::default());
            state
        };
        let columns: Vec<f64> = (0..n).flat_map(column).collect();
        let schur = DMatrix::from_vec(n, n, columns).try_schur(1e-15, 10_000)?;
        Some(schur.complex_eigenvalues().iter().copied().collect())
    }

    /// What every `stride`-th of so many ticks shows under a constant entry.
    pub fn step(&self, entry: Entry, ticks: usize, stride: usize) -> Vec<Shown> {
        let mut state = vec![0.0; self.states()];
        let shown = |tick: usize| Some(self.tick(&mut state, entry)).filter(|_| tick.is_multiple_of(stride));
        (0..ticks).filter_map(shown).collect()
    }
}
