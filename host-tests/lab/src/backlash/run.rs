//! Courses: random reversals through the gap, as the full solver has them.

use super::case::{Case, GAP, RATE_HZ};
use driveline_closed_loop::sensors::Encoder;
use driveline_solver::noise::Noise;
use driveline_solver::plant::{Chain, Plant, PlantError, Shaft};

/// Uniform numbers: xorshift64* [Vigna 2016, ACM TOMS 42(4)].
#[derive(Clone, Debug)]
pub struct Drawn(u64);

impl Drawn {
    pub fn new(seed: u64) -> Self {
        Drawn(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// From `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11;
        low + (high - low) * bits as f64 / 9_007_199_254_740_992.0
    }
}

/// Actions on the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A speed loop reverses every half second or so, against a tenth of rated torque of dry friction.
    Reversals,
    /// Random torques up to rated, of either sign, every quarter of a second or so, against a fifth.
    Torques,
    /// Torques of changing sign and random size, every quarter of a second, against a twentieth.
    Rattling,
    /// As the first, against three tenths.
    Dragging,
    /// A mill's passes: a speed loop reverses every two seconds or so against little friction; between two reversals
    /// the rolls bite, within 50 ms, with 0.4 to 1 of rated torque for half a second.
    Bites,
}

impl Kind {
    /// Those of the six machines.
    pub const ALL: [Kind; 4] = [Kind::Reversals, Kind::Torques, Kind::Rattling, Kind::Dragging];

    /// Dry friction of the load as a share of rated torque.
    const fn friction(self) -> f64 {
        match self {
            Kind::Reversals => 0.1,
            Kind::Torques => 0.2,
            Kind::Rattling => 0.05,
            Kind::Dragging => 0.3,
            Kind::Bites => 0.03,
        }
    }
}

/// Speed at which a torque course is turned back (rad/s).
const TURNING: f64 = 60.0;

/// Time in which the rolls bite and let go (s).
const BITE: f64 = 0.05;
/// Speed of a mill's passes at most (rad/s): 50 r/min.
const PASS: f64 = 5.24;

/// A machine on its course, tick by tick.
#[derive(Clone, Debug)]
pub struct Rig {
    kind: Kind,
    rated: f64,
    inertia: f64,
    plant: Plant,
    encoder: Encoder,
    noise: Noise,
    drawn: Drawn,
    time: f64,
    next: f64,
    wanted: f64,
    set_point: f64,
    integral: f64,
    applied: f64,
    /// From when on the rolls bite, until when (s), and their torque (N m).
    bite: [f64; 3],
}

impl Rig {
    /// A case at rest in the middle of its gap.
    pub fn new(case: &Case, kind: Kind, seed: u64) -> Result<Self, PlantError> {
        let machine = &case.machine;
        let shaft = Shaft::elastic(machine.stiffness).damping(machine.damping).gap(GAP);
        let plant = Chain::motor(machine.motor_inertia)
            .shaft(shaft, machine.load_inertia)
            .coulomb(kind.friction() * case.rated)
            .viscous(0.0007 * case.rated)
            .build()?;
        Ok(Rig {
            kind,
            rated: case.rated,
            inertia: machine.total_inertia(),
            plant,
            encoder: Encoder::new(4 * case.lines),
            noise: Noise::new(seed),
            drawn: Drawn::new(seed),
            time: 0.0,
            next: 0.0,
            wanted: 0.0,
            set_point: 0.0,
            integral: 0.0,
            applied: 0.0,
            bite: [0.0; 3],
        })
    }

    /// The machine.
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// The angle now, 2^32 to the turn, and the torque of the tick that has ended as reported to the drive (N m).
    pub fn sensed(&mut self) -> (u32, f64) {
        let torque = self.applied + 0.01 * self.rated * self.noise.normal();
        (self.encoder.read(self.plant.motor_angle()), torque)
    }

    /// Goes on by a tick.
    pub fn advance(&mut self) {
        let period = 1.0 / f64::from(RATE_HZ);
        if self.time >= self.next {
            self.draw();
        }
        self.applied = match self.kind {
            Kind::Reversals | Kind::Dragging => self.speed_loop(period, 0.8),
            Kind::Bites => {
                let [from, to, torque] = self.bite;
                let grip = |since: f64| ((self.time - since) / BITE).clamp(0.0, 1.0);
                self.plant.set_load_torque(1, torque * (grip(from) - grip(to)));
                self.speed_loop(period, 1.6)
            }
            Kind::Torques | Kind::Rattling => self.wanted,
        };
        self.plant.advance(self.applied, period);
        self.plant.clear_events();
        self.time += period;
    }

    fn draw(&mut self) {
        let speed = self.plant.motor_speed();
        match self.kind {
            Kind::Reversals | Kind::Dragging => {
                self.next += self.drawn.between(0.25, 0.75);
                let size = self.drawn.between(20.0, 40.0) * (self.rated / 60.0).min(1.0);
                self.wanted = if self.wanted > 0.0 { -size } else { size };
            }
            Kind::Bites => {
                self.next += self.drawn.between(1.8, 2.6);
                let size = PASS * self.drawn.between(0.3, 1.0);
                self.wanted = if self.wanted > 0.0 { -size } else { size };
                let from = self.time + self.drawn.between(0.7, 1.1);
                let to = from + self.drawn.between(0.3, 0.7);
                self.bite = [from, to, self.wanted.signum() * self.rated * self.drawn.between(0.4, 1.0)];
            }
            Kind::Torques => {
                self.next += self.drawn.between(0.1, 0.4);
                self.wanted = self.drawn.between(-1.0, 1.0) * self.rated;
            }
            Kind::Rattling => {
                self.next += self.drawn.between(0.15, 0.35);
                let size = self.drawn.between(0.3, 1.0) * self.rated;
                self.wanted = if self.wanted > 0.0 { -size } else { size };
            }
        }
        if matches!(self.kind, Kind::Torques | Kind::Rattling) && speed.abs() > TURNING {
            self.wanted = -speed.signum() * self.wanted.abs();
        }
    }

    /// Proportional and integral, 20 rad/s wide, its setpoint on a ramp of this share of rated torque, its torque
    /// within twice rated.
    fn speed_loop(&mut self, period: f64, share: f64) -> f64 {
        let bandwidth = 20.0;
        let ramp = share * self.rated / self.inertia * period;
        self.set_point += (self.wanted - self.set_point).clamp(-ramp, ramp);
        let error = self.set_point - self.plant.motor_speed();
        let unlimited = bandwidth * self.inertia * error + self.integral;
        let torque = unlimited.clamp(-2.0 * self.rated, 2.0 * self.rated);
        if unlimited == torque {
            self.integral += 0.25 * bandwidth * bandwidth * self.inertia * error * period;
        }
        torque
    }
}

/// A recorded run.
#[derive(Clone, Debug)]
pub struct Course {
    /// Angle and torque as reported to the drive.
    pub sensed: Vec<(u32, f64)>,
    /// Shaft torque and its peak (N m).
    pub shaft_torque: Vec<f64>,
    pub peak: f64,
}

impl Course {
    /// Runs a case for so many seconds.
    pub fn record(case: &Case, kind: Kind, seed: u64, seconds: f64) -> Result<Self, PlantError> {
        let mut rig = Rig::new(case, kind, seed)?;
        let ticks = (seconds * f64::from(RATE_HZ)) as usize;
        let (mut sensed, mut shaft_torque) = (Vec::with_capacity(ticks), Vec::with_capacity(ticks));
        for _ in 0..ticks {
            sensed.push(rig.sensed());
            shaft_torque.push(rig.plant.shaft_torque(0));
            rig.advance();
        }
        let peak = shaft_torque.iter().fold(0.0_f64, |peak, torque| peak.max(torque.abs()));
        Ok(Course { sensed, shaft_torque, peak })
    }
}
