//! The figures of a run.

use driveline_closed_loop::lockstep::Moment;

/// Lists the figures with their names and units.
macro_rules! figures {
    ($($(#[$text:meta])* $figure:ident = $name:literal, $unit:literal;)+) => {
        /// A figure of a run.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Figure {
            $($(#[$text])* $figure,)+
        }

        impl Figure {
            /// All, in the order of an outcome.
            pub const ALL: &[Self] = &[$(Self::$figure),+];

            pub const fn name(self) -> &'static str {
                match self { $(Self::$figure => $name),+ }
            }

            /// Unit; empty for a fraction.
            pub const fn unit(self) -> &'static str {
                match self { $(Self::$figure => $unit),+ }
            }
        }
    };
}

figures! {
    /// Error of the shaft torque, rms, of rated torque.
    ShaftTorque = "shaft torque, rms error", "";
    /// Error of the load speed, rms, of rated speed.
    LoadSpeed = "load speed, rms error", "";
    /// Error of the load torque, rms, of rated torque.
    LoadTorque = "load torque, rms error", "";
    /// Largest error of the shaft torque, of rated torque.
    ShaftTorqueMax = "shaft torque, largest error", "";
    /// Largest error of the load speed, of rated speed.
    LoadSpeedMax = "load speed, largest error", "";
    /// Largest error of the load torque, of rated torque.
    LoadTorqueMax = "load torque, largest error", "";
    /// Error of the shaft torque, rms, of its peak in the run.
    ShaftTorqueOfPeak = "shaft torque, rms error of its peak", "";
    /// Peak of the shaft torque, of rated torque.
    Peak = "peak of the shaft torque", "";
    /// What the peak exceeds the torque by that load and ramp require, of rated torque.
    DynamicPeak = "dynamic part of the peak", "";
    /// Decay of the slowest swing after a blow on the load; infinite where nothing swings.
    RingDown = "decay of the slowest swing", "1/s";
    /// Decay of the motion that is left at the end of the run.
    Decay = "decay of the motion at the end", "1/s";
    /// Swing of the shaft torque that is left at the end of the run, rms, of rated torque.
    Residual = "swing left at the end", "";
    /// The same where it is sustained without noise and errors of the encoder; 0 where it decays.
    Sustained = "swing sustained by the loop", "";
    /// Share of the ticks with a fault flag.
    Flagged = "ticks with a flag", "";
}

impl Figure {
    /// Whether more of it is better.
    pub const fn is_decay(self) -> bool {
        matches!(self, Self::Decay | Self::RingDown)
    }

    /// A number that grows as the figure gets worse: of the decay its negative.
    pub const fn badness(self, value: f64) -> f64 {
        if self.is_decay() { -value } else { value }
    }
}

/// How many figures there are.
pub const FIGURES: usize = Figure::ALL.len();

/// The figures of a run, in the order of [`Figure::ALL`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome(pub [f64; FIGURES]);

impl Outcome {
    pub const fn of(&self, figure: Figure) -> f64 {
        self.0[figure as usize]
    }

    /// A figure, where there is one: where nothing swings there is no decay.
    pub fn found(&self, figure: Figure) -> Option<f64> {
        let value = self.of(figure);
        (figure != Figure::RingDown || value != f64::INFINITY).then_some(value)
    }

    /// Whether all figures are the same to the bit.
    pub fn is_same(&self, other: &Self) -> bool {
        self.0.map(f64::to_bits) == other.0.map(f64::to_bits)
    }

    /// Whether the loop did not hold: a figure that is not finite, or a swing that the loop sustains.
    pub fn is_unstable(&self) -> bool {
        let mut found = Figure::ALL.iter().filter_map(|&figure| self.found(figure));
        found.any(|value| !value.is_finite()) || self.of(Figure::Sustained) > 0.0
    }

    /// Whether a swing of more than 5 % of rated torque is left at the end, for whatever reason.
    pub fn swings(&self) -> bool {
        !(self.of(Figure::Residual) <= 0.05)
    }

    /// With the decay of the slowest swing (1/s); none where nothing swings.
    #[must_use]
    pub fn with_ring_down(mut self, decay: Option<f64>) -> Self {
        self.0[Figure::RingDown as usize] = decay.unwrap_or(f64::INFINITY);
        self
    }

    /// With the swing that is left in a run without noise and errors of the encoder: sustained where its amplitude
    /// falls by less than `exp(-1/2)` in the `free` time (s).
    #[must_use]
    pub fn with_sustained(mut self, quiet: &Self, free: f64) -> Self {
        let decays = quiet.of(Figure::Decay) * free >= 0.5;
        if quiet.swings() && !decays {
            self.0[Figure::Sustained as usize] = quiet.of(Figure::Residual);
        }
        self
    }
}

/// What the figures of a run are taken against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Rated torque (N m).
    pub torque: f64,
    /// Rated speed (rad/s).
    pub speed: f64,
    /// Inertia behind the shaft (kg m2).
    pub load_inertia: f64,
    /// From when to when nothing excites the swing at the end of the run (s).
    pub free: (f64, f64),
}

/// Gathers the figures of a run, tick by tick.
#[derive(Clone, Debug)]
pub struct Gathering {
    scale: Scale,
    ticks: u64,
    squares: [f64; 3],
    largest: [f64; 3],
    peak: f64,
    required: f64,
    flagged: u64,
    /// In the free part: energy of the swing, and its moment about the part's beginning.
    energy: (f64, f64),
    /// In the second half of the free part: count, sum and sum of squares of the shaft torque.
    last: (f64, f64, f64),
}

impl Gathering {
    /// Of a run that begins.
    pub const fn new(scale: Scale) -> Self {
        Self {
            scale,
            ticks: 0,
            squares: [0.0; 3],
            largest: [0.0; 3],
            peak: 0.0,
            required: 0.0,
            flagged: 0,
            energy: (0.0, 0.0),
            last: (0.0, 0.0, 0.0),
        }
    }

    /// Adds a tick. `ramp` is the acceleration of the ramped setpoint now (rad/s2).
    pub fn add(&mut self, moment: &Moment, ramp: f64) {
        self.ticks += 1;
        for (k, error) in moment.error().into_iter().enumerate() {
            self.squares[k] += error * error;
            // `max` would drop a NaN
            if error.abs() > self.largest[k] || error.is_nan() {
                self.largest[k] = error.abs();
            }
        }
        let [torque, speed, load] = moment.truth;
        self.peak = self.peak.max(torque.abs());
        self.required = self.required.max((load + self.scale.load_inertia * ramp).abs());
        self.flagged += u64::from(moment.faults != 0);
        let (from, to) = self.scale.free;
        if moment.time >= from && moment.time <= to {
            let energy = (moment.motor_speed - speed).powi(2);
            self.energy.0 += energy;
            self.energy.1 += energy * (moment.time - from);
            if moment.time >= 0.5 * (from + to) {
                self.last = (self.last.0 + 1.0, self.last.1 + torque, self.last.2 + torque * torque);
            }
        }
    }

    /// Mean of the shaft torque in the second half of the free part (N m).
    pub fn carried(&self) -> f64 {
        self.last.1 / self.last.0
    }

    /// The figures.
    pub fn outcome(&self) -> Outcome {
        let Scale { torque, speed, free, .. } = self.scale;
        let ticks = self.ticks.max(1) as f64;
        let rated = [torque, speed, torque];
        let rms = |k: usize| (self.squares[k] / ticks).sqrt();
        let (count, sum, squares) = self.last;
        let mean = sum / count;
        Outcome([
            rms(0) / rated[0],
            rms(1) / rated[1],
            rms(2) / rated[2],
            self.largest[0] / rated[0],
            self.largest[1] / rated[1],
            self.largest[2] / rated[2],
            rms(0) / self.peak,
            self.peak / torque,
            (self.peak - self.required) / torque,
            0.0,
            decay(self.energy.1 / self.energy.0, free.1 - free.0),
            (squares / count - mean * mean).max(0.0).sqrt() / torque,
            0.0,
            self.flagged as f64 / ticks,
        ])
    }
}

/// The rate (1/s) at which an amplitude `exp(-rate t)` falls whose energy over `length` (s) has this centroid (s):
/// negative where it grows.
///
/// The centroid of `exp(-x t/length)` is `1/x - 1/(exp(x) - 1)` of the length. It falls with `x`, and is solved by
/// bisection.
pub fn decay(centroid: f64, length: f64) -> f64 {
    let share = centroid / length;
    if !share.is_finite() {
        return f64::NAN;
    }
    // near zero by its series
    let at = |x: f64| if x.abs() < 1e-3 { 0.5 - x / 12.0 } else { 1.0 / x - 1.0 / x.exp_m1() };
    let (mut low, mut high) = (-500.0, 500.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at(middle) > share { low = middle } else { high = middle }
    }
    0.25 * (low + high) / length
}
