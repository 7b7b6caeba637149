//! A set's plant: prime mover, crank, coupling and generator in the full solver, a load of constant power, an encoder
//! on the flywheel.
//!
//! The solver's chain is exact for torques held over a step. The prime mover's are those of the step's middle, the
//! load's that of its beginning, for eight steps a tick, 52 us. `tests/governor` makes the steps finer and has the
//! chain proven.

use core::array;

use driveline_firmware::scenes::generator::{
    CHEST_LAG, DIESEL, DIESEL_FRICTION, RACK_LAG, RATED_SPEED, Set as Constants, TURBINE, TURBINE_FRICTION,
    TURBINE_INERTIA, VALVE_LAG,
};

use super::diesel::{CYLINDERS, Diesel};
use super::turbine::Turbine;
use driveline_solver::plant::{Chain, Plant, PlantError, Shaft, Start};

/// Steps of the plant in a tick.
pub const STEPS: u32 = 8;

/// Prime mover of a genset.
#[derive(Clone, Debug)]
enum Mover {
    Diesel(Box<Diesel>),
    Turbine(Turbine),
}

/// Which set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The diesel engine.
    Diesel,
    /// The steam turbine.
    Turbine,
}

impl Kind {
    /// Its name in the variants' names.
    pub const fn name(self) -> &'static str {
        match self {
            Kind::Diesel => "diesel",
            Kind::Turbine => "turbine",
        }
    }

    pub const fn constants(self) -> &'static Constants {
        const SETS: [&Constants; 2] = [&DIESEL, &TURBINE];
        SETS[self as usize]
    }
}

/// A running set.
#[derive(Clone, Debug)]
pub struct Set {
    mover: Mover,
    plant: Plant,
    /// The node with the encoder: the flywheel.
    flywheel: usize,
    power: f64,
    rated_power: f64,
    /// Torques of the last step, for a proof: on each node that is driven, and the load.
    pub held: Vec<(usize, f64)>,
}

impl Set {
    /// A set that turns at `speed` (rad/s), without load.
    pub fn new(kind: Kind, speed: f64) -> Result<Self, PlantError> {
        let rated_torque = kind.constants().rated_torque;
        let (mover, chain, flywheel) = match kind {
            Kind::Diesel => {
                // The ring of the vibration damper, tuned to the crank's first vibration (240 Hz) by Den Hartog's rule;
                // hub with the first of six throws; flywheel. 2 % of critical between the throws.
                let throw = Shaft::elastic(4.0e6).damping(20.0);
                let friction = DIESEL_FRICTION * rated_torque / (RATED_SPEED * CYLINDERS as f64);
                let mut chain = Chain::motor(0.2);
                chain = chain.shaft(Shaft::elastic(2.33e5).damping(141.0), 0.05 + 0.12).viscous(friction);
                for _ in 1..CYLINDERS {
                    chain = chain.shaft(throw, 0.12).viscous(friction);
                }
                let chain = chain.shaft(throw, 3.43).shaft(Shaft::elastic(5.0e4).damping(66.0), 8.0);
                (Mover::Diesel(Box::new(Diesel::new(rated_torque, RACK_LAG))), chain, CYLINDERS + 1)
            }
            Kind::Turbine => {
                let shaft = Shaft::elastic(6.0e6).damping(600.0);
                let friction = TURBINE_FRICTION * rated_torque / RATED_SPEED;
                let chain = Chain::motor(0.4 * TURBINE_INERTIA).viscous(friction).shaft(shaft, 0.6 * TURBINE_INERTIA);
                (Mover::Turbine(Turbine::new(rated_torque, RATED_SPEED, [VALVE_LAG, CHEST_LAG])), chain, 0)
            }
        };
        let nodes = chain.nodes();
        let start = Start::Given { twists: vec![0.0; nodes - 1], speeds: vec![speed; nodes] };
        let plant = chain.start(start).build()?;
        Ok(Set { mover, plant, flywheel, power: 0.0, rated_power: rated_torque * RATED_SPEED, held: Vec::new() })
    }

    /// Sets the load, of rated power.
    pub fn set_load(&mut self, share: f64) {
        self.power = share * self.rated_power;
    }

    /// The share of its fuel that each of the diesel's cylinders burns from its next injection on.
    pub fn set_burns(&mut self, burns: [f64; CYLINDERS]) {
        if let Mover::Diesel(diesel) = &mut self.mover {
            diesel.burns = burns;
        }
    }

    /// The rack or valve stays where it is from now on.
    pub fn seize(&mut self) {
        match &mut self.mover {
            Mover::Diesel(diesel) => diesel.seize(),
            Mover::Turbine(turbine) => turbine.seize(),
        }
    }

    /// Angle of the flywheel (rad).
    pub fn flywheel_angle(&self) -> f64 {
        self.plant.motor_angle() - (0..self.flywheel).map(|shaft| self.plant.twist(shaft)).sum::<f64>()
    }

    /// Angle of the generator (rad).
    pub fn generator_angle(&self) -> f64 {
        self.flywheel_angle() - self.plant.twist(self.flywheel)
    }

    /// Speed of the generator (rad/s).
    pub fn generator_speed(&self) -> f64 {
        self.plant.speed(self.flywheel + 1)
    }

    /// Torque reported to the drive (N m): the rack's position, or the chest's pressure.
    pub fn told(&self) -> f64 {
        match &self.mover {
            Mover::Diesel(diesel) => diesel.rack(),
            Mover::Turbine(turbine) => turbine.chest(),
        }
    }

    /// Torque of the load now (N m): constant power, and the torque of a tenth of rated speed below that.
    pub fn load_torque(&self) -> f64 {
        self.power / self.generator_speed().max(0.1 * RATED_SPEED)
    }

    /// The plant, for a proof.
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// Runs on by a step of `dt` with a commanded torque.
    pub fn step(&mut self, command: f64, dt: f64) {
        self.held.clear();
        match &mut self.mover {
            Mover::Diesel(diesel) => {
                let middle = self.plant.motor_angle() - self.plant.twist(0) + 0.5 * dt * self.plant.speed(1);
                let speeds = array::from_fn(|throw| self.plant.speed(throw + 1));
                let (gas, masses) = (diesel.advance(command, middle, dt), diesel.mass_torques(middle, speeds, dt));
                self.held
                    .extend(gas.iter().zip(masses).enumerate().map(|(throw, (gas, mass))| (throw + 1, gas + mass)));
            }
            Mover::Turbine(turbine) => {
                let torque = turbine.advance(command, self.plant.speed(0), dt);
                self.held.push((0, torque));
            }
        }
        // The load changes by less than 1e-4 of itself in a step.
        self.held.push((self.flywheel + 1, -self.load_torque()));
        for &(node, torque) in self.held.iter().filter(|(node, _)| *node > 0) {
            self.plant.set_load_torque(node, -torque);
        }
        let first = self.held.iter().find(|(node, _)| *node == 0).map_or(0.0, |(_, torque)| *torque);
        self.plant.advance(first, dt);
    }
}
