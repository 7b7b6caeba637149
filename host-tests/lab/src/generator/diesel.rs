//! A six-cylinder, four-stroke, turbocharged diesel engine, cylinder by cylinder.
//!
//! Every cylinder takes the rack's torque at its own injection and keeps it for its cycle, so the dead time is no
//! assumption but comes of the firing. Its torque is gas pressure times lever `dV/dphi` \[derived\]: compression
//! and expansion by the polytrope 1.36, and a pressure of combustion by Wiebe's function [Heywood 1988, Internal
//! Combustion Engine Fundamentals, §9.2.2], scaled so that its mean over the cycle is the torque that the rack stands
//! for. The reciprocating masses have their own torque, `-J'(phi) omega^2/2 - (J(phi) - J_mean) omega'` at each throw
//! \[derived\]: its orders at a steady speed are those of `CrankSlider::mass_torque`.
//!
//! The charge pressure follows the load with a lag, and the fuel is held to what the air burns: a turbocharged engine
//! takes no full load at once.

use core::array;
use core::f64::consts::TAU;

use driveline::machine::{CrankSlider, Cylinder, Inertia, Length, Mass};

pub const CYLINDERS: usize = 6;
/// A third of a turn.
const THIRD: f64 = TAU / 3.0;
/// Six in line, 150 mm apart, in the firing order 1-5-3-6-2-4.
pub const ENGINE: [Cylinder; CYLINDERS] = Cylinder::fired(
    Cylinder::in_line([0.0, 2.0 * THIRD, THIRD, THIRD, 2.0 * THIRD, 0.0], Length(0.15)),
    [1, 5, 3, 6, 2, 4],
);
/// Bore, stroke (m), compression ratio, crank radius over rod length: an engine of 12.4 l.
const BORE: f64 = 0.126;
const STROKE: f64 = 0.166;
const COMPRESSION: f64 = 17.0;
const LAMBDA: f64 = 0.32;
/// Piston, pin and the connecting rod's share of a cylinder of 2 l: 4 kg, of the usual size.
pub const CRANK: CrankSlider =
    CrankSlider::massless_rod(Length(0.5 * STROKE), Length(0.5 * STROKE / LAMBDA), Inertia(0.0), Mass(4.0));
/// Mean inertia of a cylinder's reciprocating mass, which the throw's inertia has in it (kg m2).
const MEAN_INERTIA: f64 = CRANK.mean_inertia().0;
/// Combustion begins 5 degrees before the dead centre and takes 60.
const IGNITION: f64 = -5.0 / 360.0 * TAU;
const BURNING: f64 = 60.0 / 360.0 * TAU;
/// Fuel deviations of the cylinders, of zero sum.
const UNEVEN: [f64; CYLINDERS] = [0.02, -0.01, 0.015, -0.02, 0.01, -0.015];
/// True torque of a rack position: the rack's calibration is 3 % off.
const CALIBRATION: f64 = 0.97;
/// Share of the rated torque that burns without charge pressure, what full charge adds, and the charger's lag (s).
const NATURAL: f64 = 0.75;
const CHARGED: f64 = 0.45;
const CHARGER_LAG: f64 = 0.8;
/// Ambient pressure (Pa), and what full charge adds to it.
const AMBIENT: f64 = 1.0e5;
const CHARGE: f64 = 1.8e5;

/// A running engine.
#[derive(Clone, Debug)]
pub struct Diesel {
    rated_torque: f64,
    lag: f64,
    /// Torque of combustion over the cycle per unit of its mean, from the top dead centre of its firing.
    burning: Vec<f64>,
    /// Torque of compression and expansion per pascal of charge pressure (N m/Pa).
    motored: Vec<f64>,
    rack: f64,
    charge: f64,
    /// Torque that each cylinder burns for.
    fuel: [f64; CYLINDERS],
    /// Cycle angle of each at the last step.
    angle: [f64; CYLINDERS],
    /// Speed of each throw at the beginning of the last step; none before the first.
    speeds: Option<[f64; CYLINDERS]>,
    /// Share of its fuel that each cylinder burns, in the order of the crank's throws; 1 of a sound one.
    pub burns: [f64; CYLINDERS],
    /// The rack no longer moves.
    seized: bool,
}

/// Points of the tables over a cycle of two turns: a quarter of a degree.
const POINTS: usize = 2880;

fn volume_and_lever(angle: f64) -> (f64, f64) {
    let area = core::f64::consts::PI * BORE * BORE / 4.0;
    let travel = CRANK.travel(angle);
    let clearance = area * STROKE / (COMPRESSION - 1.0);
    (clearance + area * travel.travel, area * travel.first)
}

impl Diesel {
    /// An engine at rest of a rated torque (N m), whose rack has a lag (s).
    pub fn new(rated_torque: f64, lag: f64) -> Self {
        let (least, _) = volume_and_lever(0.0);
        let (most, _) = volume_and_lever(0.5 * TAU);
        let mut burning = Vec::with_capacity(POINTS);
        let mut motored = Vec::with_capacity(POINTS);
        for point in 0..POINTS {
            // From the dead centre of firing, -360 to 360 degrees.
            let angle = (point as f64 / POINTS as f64).mul_add(2.0 * TAU, 0.0);
            let angle = if angle > TAU { angle - 2.0 * TAU } else { angle };
            let (volume, lever) = volume_and_lever(angle);
            let closed = angle.abs() <= 0.5 * TAU;
            motored.push(if closed { ((most / volume).powf(1.36) - 1.0) * lever } else { 0.0 });
            let burnt = ((angle - IGNITION) / BURNING).max(0.0);
            let wiebe = 1.0 - (-6.9 * burnt.powi(2)).exp();
            burning.push(if closed { wiebe * (least / volume).powf(1.3) * lever } else { 0.0 });
        }
        // The valve opens at the lower dead centre, where the lever is nothing.
        let mean = burning.iter().sum::<f64>() / POINTS as f64;
        burning.iter_mut().for_each(|torque| *torque /= mean);
        let angle = ENGINE.map(|cylinder| Self::cycle_angle(0.0, cylinder.firing));
        Diesel {
            rated_torque,
            lag,
            burning,
            motored,
            rack: 0.0,
            charge: 0.0,
            fuel: [0.0; CYLINDERS],
            angle,
            speeds: None,
            burns: [1.0; CYLINDERS],
            seized: false,
        }
    }

    /// Angle of a cylinder in its cycle, from the dead centre of its firing, 0 to 2 turns.
    fn cycle_angle(crank: f64, firing: f64) -> f64 {
        (crank - firing).rem_euclid(2.0 * TAU)
    }

    fn table(table: &[f64], angle: f64) -> f64 {
        let place = angle / (2.0 * TAU) * POINTS as f64;
        let (low, share) = (place.floor() as usize, place.fract());
        let at = |index: usize| table[index % POINTS];
        at(low) + share * (at(low + 1) - at(low))
    }

    /// The rack stays where it is from now on.
    pub fn seize(&mut self) {
        self.seized = true;
    }

    /// The torque that the rack's position stands for (N m).
    pub fn rack(&self) -> f64 {
        self.rack
    }

    /// Torque of each cylinder's reciprocating mass over a step of `dt` (s), the crank at `angle` (rad) in its middle,
    /// the throws at `speeds` (rad/s) at its beginning. The acceleration is that of the step before.
    pub fn mass_torques(&mut self, angle: f64, speeds: [f64; CYLINDERS], dt: f64) -> [f64; CYLINDERS] {
        let before = self.speeds.replace(speeds).unwrap_or(speeds);
        array::from_fn(|k| {
            let law = CRANK.inertia(angle - ENGINE[k].firing);
            let gained = speeds[k] - before[k];
            let middle = speeds[k] + 0.5 * gained;
            -0.5 * law.derivative * middle * middle - (law.inertia - MEAN_INERTIA) * gained / dt
        })
    }

    /// Runs on by `dt` with the rack commanded to a torque, the crank at `angle` (rad) in the middle of the step: the
    /// torque of each cylinder's gas.
    pub fn advance(&mut self, command: f64, angle: f64, dt: f64) -> [f64; CYLINDERS] {
        if !self.seized {
            let stop = 1.25 * self.rated_torque;
            self.rack = command.clamp(0.0, stop) + (self.rack - command.clamp(0.0, stop)) * (-dt / self.lag).exp();
        }
        let mut torques = [0.0; CYLINDERS];
        let burns = (NATURAL + CHARGED * self.charge) * self.rated_torque;
        for k in 0..CYLINDERS {
            let now = Self::cycle_angle(angle, ENGINE[k].firing);
            // The injection's angle is passed: the fuel of the next cycle.
            let injection = IGNITION.rem_euclid(2.0 * TAU);
            if self.angle[k] < injection && now >= injection {
                self.fuel[k] = CALIBRATION * self.burns[k] * (1.0 + UNEVEN[k]) * self.rack.min(burns);
            }
            self.angle[k] = now;
            let pressure = AMBIENT + CHARGE * self.charge;
            torques[k] = self.fuel[k] / CYLINDERS as f64 * Self::table(&self.burning, now)
                + pressure * Self::table(&self.motored, now);
        }
        let load = self.fuel.iter().sum::<f64>() / CYLINDERS as f64 / self.rated_torque;
        self.charge += (load - self.charge) * dt / CHARGER_LAG;
        torques
    }
}
