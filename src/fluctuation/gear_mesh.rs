//! A gear's health: amplitude and phase of the tooth mesh and of its sidebands, from the motor's encoder.
//!
//! Errors of the teeth swing the motor at the order of its teeth; an eccentric wheel, a bent shaft or one bad tooth
//! modulates that swing, which puts sidebands beside it, a turn of their shaft apart. Wear raises the first, a fault
//! the others, over weeks. So one order is measured at a time, by turns, at the cost of one.

use super::Fluctuation;
use crate::angle::{Passed, RotorAngle, RotorAngleConfig, Synchronous};
use crate::balancing::{Phasor, ReadingFault};
use crate::math::single::sqrt;
use crate::number::{Fixed, Number};
use crate::sample::Estimate;

/// A line of the mesh's spectrum: `teeth + order shaft_turns/motor_turns` periods on a turn of the motor.
///
/// ```
/// use driveline::fluctuation::Sideband;
/// // the mesh itself; once a turn of the motor above it; once a turn of the wheel, 23 turns to 71, below it
/// const LINES: [Sideband; 3] = [Sideband::MESH, Sideband::of_motor(1), Sideband::of(-1, 23, 71)];
/// assert!((LINES[2].periods(23) - (23.0 - 23.0 / 71.0)).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sideband {
    /// Which sideband: negative below the mesh, zero the mesh itself.
    pub order: i32,
    /// Turns of the shaft that modulates.
    pub shaft_turns: u32,
    /// Turns of the motor to these, from 1 on: in lowest terms.
    pub motor_turns: u32,
}

impl Sideband {
    /// The mesh itself.
    pub const MESH: Self = Sideband::of_motor(0);

    /// A sideband of the motor's own shaft.
    pub const fn of_motor(order: i32) -> Self {
        Sideband::of(order, 1, 1)
    }

    /// A sideband of a shaft that makes `shaft_turns` to `motor_turns` of the motor: of a wheel of 71 teeth on a pinion
    /// of 23, 23 turns to 71.
    pub const fn of(order: i32, shaft_turns: u32, motor_turns: u32) -> Self {
        Sideband { order, shaft_turns, motor_turns }
    }

    /// Periods on a turn of a motor with `teeth` teeth.
    pub const fn periods(&self, teeth: u32) -> f64 {
        teeth as f64 + self.order as f64 * self.shaft_turns as f64 / self.motor_turns as f64
    }
}

sentences! {
    /// A setting of the mesh that is out of its range.
    GearMeshError:
    Teeth => "a mesh must have 1 to 500 teeth on the motor's shaft",
    Sideband => "a sideband must lie above zero and below 15 times the mesh, its motor turns times the teeth 1 to 2^20",
    Turns => "a block of a gear's mesh must have 1 to 300 turns of the motor, and these whole turns of the shaft",
}

/// The constants of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Line {
    /// From the mesh to the line.
    turning: RotorAngleConfig,
    /// Periods of a block.
    block: u32,
    /// Periods on a turn of the motor.
    periods: f32,
    /// These where they are whole, zero where not.
    whole: u32,
}

/// The constants of a [`GearMesh`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GearMeshConfig<const LINES: usize> {
    teeth: u32,
    lines: [Line; LINES],
}

impl<const LINES: usize> GearMeshConfig<LINES> {
    /// The lines of a mesh of `teeth` on the motor's shaft, in blocks of at least `turns` of the motor.
    ///
    /// # Panics
    /// The sentence of [`GearMeshError`]: a compile error in a constant.
    pub const fn new(teeth: u32, lines: &[Sideband; LINES], turns: u32) -> Self {
        match Self::try_new(teeth, lines, turns) {
            Ok(config) => config,
            Err(error) => panic!("{}", error.message()),
        }
    }

    /// The same at run time.
    ///
    /// # Errors
    /// A parameter out of its range.
    pub const fn try_new(teeth: u32, lines: &[Sideband; LINES], turns: u32) -> Result<Self, GearMeshError> {
        if teeth == 0 || teeth > 500 {
            return Err(GearMeshError::Teeth);
        }
        let Some(turning) = RotorAngleConfig::new(1, 1) else { return Err(GearMeshError::Sideband) };
        let none = Line { turning, block: 1, periods: 1.0, whole: 0 };
        let mut config = GearMeshConfig { teeth, lines: [none; LINES] };
        each!(line, 0..LINES, {
            config.lines[line] = get!(Line::of(teeth, &lines[line], turns));
        });
        Ok(config)
    }
}

impl Line {
    const fn of(teeth: u32, sideband: &Sideband, turns: u32) -> Result<Self, GearMeshError> {
        let motor_turns = sideband.motor_turns as i64;
        let (mesh, beside) = (teeth as i64 * motor_turns, sideband.order as i64 * sideband.shaft_turns as i64);
        let periods = mesh + beside;
        if mesh == 0 || mesh > 1 << 20 || periods <= 0 || periods > 15 * mesh {
            return Err(GearMeshError::Sideband);
        }
        // whole turns of both shafts, so that no line of theirs is seen in another
        let cycle = if beside == 0 { 1 } else { motor_turns };
        let cycles = (turns as i64 + cycle - 1) / cycle;
        if turns == 0 || cycle * cycles > 300 {
            return Err(GearMeshError::Turns);
        }
        let Some(turning) = RotorAngleConfig::new(periods as i32, mesh as u32) else {
            return Err(GearMeshError::Sideband);
        };
        Ok(Line {
            turning,
            block: (periods * cycle * cycles / motor_turns) as u32,
            periods: (periods as f64 / motor_turns as f64) as f32,
            whole: if periods % motor_turns == 0 { (periods / motor_turns) as u32 } else { 0 },
        })
    }
}

/// Binary places that a tick's cosine and sine lose in the sums. What a shift cuts off is half a unit in the mean.
const LOST: u32 = 10;

/// Most ticks of a block: a swing that does not turn the motor back has sums below half of them.
const MOST_TICKS: u32 = 1 << 18;

/// Where a block ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct Edge {
    /// Sums of cosine and sine before the tick that is past it (2^-14), which wrap around.
    sums: [i32; 2],
    /// Number of that tick.
    tick: u32,
    /// How far the line's angle is past its zero then (units of its turn).
    past: u32,
}

/// Amplitude and phase of `LINES` orders of a gear's mesh in the motor's angle, one after the other; a reading has
/// `EDGES - 1` blocks.
///
/// A tick adds `e^{-i p theta}`, p the periods on a turn, in integers. That samples the time that the motor spends at
/// each angle: over whole turns a sum of n ticks grows to `-i p X n/2`, X the phasor of the motor's angle \[derived\].
/// An encoder's rounding, which stands in it once, averages out; a product of two rounded angles would keep a part of
/// it. Where a block ends between two ticks the sum is corrected to the integral by Euler and Maclaurin's formula.
///
/// The motor turns forwards, a period of the mesh has eight ticks at least, a block 262,144 at most, and ticks and
/// counts have no common period. The amplitude is that of the motor's own swing, which its inertia and the gear's
/// stiffness set: compare it at one speed and load with what it was, as by a record in flash (feature `parameters`).
///
/// ```
/// use driveline::fluctuation::{Fluctuation, GearMesh, GearMeshConfig, Sideband};
/// use driveline::sample::Estimate;
/// // 23 teeth, their mesh and the lower sideband of the motor's shaft, blocks of eight turns
/// const CONFIG: GearMeshConfig<2> = GearMeshConfig::new(23, &[Sideband::MESH, Sideband::of_motor(-1)], 8);
/// let mut mesh = GearMesh::<2, 5>::default();
/// let mut read = [0.0; 2];
/// for tick in 0..50_000 {
///     // 15 turns a second at 10 kHz; the teeth swing the motor by 50 urad, greatest at the zero of the encoder
///     let turn = 15e-4 * f64::from(tick);
///     let swing = 50e-6 * (core::f64::consts::TAU * 23.0 * turn).cos();
///     let angle = ((turn + swing / core::f64::consts::TAU).fract() * 4_294_967_296.0) as u32;
///     mesh.measure(&CONFIG, angle, 0.0, &Estimate::default()); // in a drive: `drive.tick(..)`
///     if let Some((line, Ok(reading))) = mesh.take(&CONFIG) { // between the ticks
///         read[line] = reading.phasor.amplitude();
///     }
/// }
/// assert!((read[0] - 50e-6).abs() < 0.5e-6 && read[1] < 0.5e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("gear mesh frequency", "vibration analysis", "condition monitoring"))]
pub struct GearMesh<const LINES: usize, const EDGES: usize> {
    /// The motor's angle at the last tick (2^-32 turn).
    angle: u32,
    line: usize,
    is_begun: bool,
    turning: RotorAngle,
    sums: [i32; 2],
    tick: u32,
    /// Zeros to pass until the next edge; runs on where the reading is complete.
    left: u32,
    noted: u32,
    /// Ticks without an angle, zeros passed backwards.
    missing: u32,
    back: u32,
    edges: [Edge; EDGES],
}

impl<const LINES: usize, const EDGES: usize> Default for GearMesh<LINES, EDGES> {
    fn default() -> Self {
        GearMesh {
            angle: 0,
            line: 0,
            is_begun: false,
            turning: RotorAngle::default(),
            sums: [0; 2],
            tick: 0,
            left: 1,
            noted: 0,
            missing: 0,
            back: 0,
            edges: [Edge::default(); EDGES],
        }
    }
}

impl<N: Number, const LINES: usize, const EDGES: usize> Fluctuation<N> for GearMesh<LINES, EDGES> {
    type Config = GearMeshConfig<LINES>;

    #[inline(always)]
    fn measure(&mut self, config: &Self::Config, angle: u32, _torque: N, _estimate: &Estimate<N>) {
        let Some(line) = config.lines.get(self.line) else { return };
        let passed = self.turning.advance(&line.turning, angle.wrapping_mul(config.teeth));
        let (tick, sums) = (self.tick.wrapping_add(1), self.sums);
        if passed != Passed::Not {
            self.note(line, passed);
        }
        let [cosine, sine] = <Fixed as Synchronous>::direction(self.turning.direction(&line.turning));
        self.sums = [sums[0].wrapping_add(cosine >> LOST), sums[1].wrapping_add(sine >> LOST)];
        self.tick = tick;
        self.angle = angle;
    }

    fn disturb(&mut self) {
        self.missing = self.missing.saturating_add(1);
    }
}

/// A line of the mesh, measured.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct MeshReading {
    /// The motor's angle (rad) swings by `Re(X e^{i p theta})`, theta the encoder's angle, p the periods on a turn. A
    /// line whose periods are not whole has no phase, since a turn has no mark for it.
    pub phasor: Phasor,
    /// Standard deviation of the phasor by the blocks' differences (rad).
    pub deviation: f32,
    /// Ticks in a period.
    pub ticks: f32,
}

/// Difference of the fastest and slowest block that a reading bears, over the mean: a mesh is read in operation.
const SPEED_SPREAD: f32 = 0.05;

/// Fewest ticks in a period.
const FEWEST_TICKS: f32 = 8.0;

impl<const LINES: usize, const EDGES: usize> GearMesh<LINES, EDGES> {
    #[inline(always)]
    fn note(&mut self, line: &Line, passed: Passed) {
        if passed == Passed::Astray {
            self.back = self.back.saturating_add(1);
        }
        self.left = self.left.wrapping_sub(1);
        if self.left == 0 {
            let (sums, tick, past, noted) = (self.sums, self.tick, self.turning.units(), self.noted);
            // complete: later ticks are in no block
            if let Some(edge) = self.edges.get_mut(noted as usize) {
                *edge = Edge { sums, tick, past };
                (self.left, self.noted) = (line.block, noted + 1);
            }
        }
    }

    /// A finished reading and its line, and begins that of the next; the first call begins the first. Between two
    /// ticks.
    ///
    /// # Errors
    /// [`ReadingFault`]: why this reading cannot be used.
    pub fn take(&mut self, config: &GearMeshConfig<LINES>) -> Option<(usize, Result<MeshReading, ReadingFault>)> {
        let taken = self.line;
        let mut read = None;
        if self.is_begun {
            let is_lost = self.back > 0 || self.missing > 0;
            if self.noted < EDGES as u32 && !is_lost {
                return None;
            }
            read = Some((taken, self.reading(config.lines.get(taken)?)));
            self.line = if taken + 1 < LINES { taken + 1 } else { 0 };
        }
        let line = config.lines.get(self.line)?;
        let (mesh, angle) = (self.angle.wrapping_mul(config.teeth), self.angle.wrapping_mul(line.whole));
        *self = GearMesh { angle: self.angle, line: self.line, is_begun: true, ..GearMesh::default() };
        self.turning.set_at(&line.turning, mesh, angle);
        read
    }

    fn reading(&self, line: &Line) -> Result<MeshReading, ReadingFault> {
        if self.back > 0 {
            return Err(ReadingFault::Backwards { times: self.back });
        }
        if self.missing > 0 {
            return Err(ReadingFault::Missing { samples: self.missing });
        }
        let (Some(first), Some(last)) = (self.edges.first(), self.edges.last()) else {
            return Err(ReadingFault::Incomplete { turns: 0, of: line.block });
        };
        let (blocks, periods) = (self.edges.len().saturating_sub(1) as f32, line.block as f32);
        let turns = |edge: &Edge| edge.past as f32 / line.turning.turn as f32;
        let about = last.tick.wrapping_sub(first.tick) as f32 / (blocks * periods);
        // ticks from an edge to the first one past it
        let past = |edge: &Edge| {
            let ticks = turns(edge) * about;
            if ticks < 1.0 { ticks } else { 1.0 }
        };
        let at = |edge: &Edge| edge.tick.wrapping_sub(first.tick) as f32 - past(edge);
        let ticks = (at(last) - at(first)) / (blocks * periods);
        if !(ticks >= FEWEST_TICKS) {
            return Err(ReadingFault::TooFast);
        }
        let turn = core::f32::consts::TAU / ticks;
        // Bernoulli's polynomials over their factorials, times the derivatives of e^{-i turn t} at zero
        let end = |edge: &Edge| {
            let a = past(edge);
            let (first, second, third) = (a - 0.5, a * (a - 1.0) + 1.0 / 6.0, a * (a - 0.5) * (a - 1.0));
            Phasor { re: first - turn * turn * third / 6.0, im: -0.5 * turn * second }
        };
        let integral = |from: &Edge, to: &Edge| {
            let cut = 0.5 * to.tick.wrapping_sub(from.tick) as f32;
            let sum = |of: usize| {
                let [to, from] = [to, from].map(|edge| edge.sums.get(of).copied().unwrap_or_default());
                (to.wrapping_sub(from) as f32 + cut) / (1 << (24 - LOST)) as f32
            };
            Phasor { re: sum(0), im: -sum(1) }.plus(end(from)).less(end(to))
        };
        // X = 2 i/p of the mean
        let phasor = |integral: Phasor, ticks: f32| {
            Phasor { re: -integral.im, im: integral.re }.scaled(2.0 / (line.periods * ticks))
        };
        let pairs = || self.edges.windows(2).filter_map(|pair| <&[Edge; 2]>::try_from(pair).ok());
        let sum = pairs().fold(Phasor::default(), |sum, [from, to]| sum.plus(integral(from, to)));
        let whole = phasor(sum, at(last) - at(first));
        let (mut squares, mut shortest, mut longest) = (0.0, f32::INFINITY, 0.0);
        for [from, to] in pairs() {
            let lasted = at(to) - at(from);
            squares += phasor(integral(from, to), lasted).less(whole).square();
            shortest = if lasted < shortest { lasted } else { shortest };
            longest = if lasted > longest { lasted } else { longest };
        }
        if longest > MOST_TICKS as f32 {
            return Err(ReadingFault::TooSlow);
        }
        let spread = (longest - shortest) / (ticks * periods);
        if !(spread <= SPEED_SPREAD) {
            return Err(ReadingFault::SpeedMoved { spread });
        }
        let deviation = if blocks > 1.0 { sqrt(squares / (blocks * (blocks - 1.0))) } else { f32::INFINITY };
        Ok(MeshReading { phasor: whole, deviation, ticks })
    }
}
