//! How a run begins: the start conditions of `[Huang 1987 part 2]`.

use super::chain::Chain;
use super::error::{PlantError, finite};
use super::event::Place;

/// The state at time zero. The motor's angle is zero.
#[derive(Debug, Clone, PartialEq)]
pub enum Start {
    /// No speed and no twist.
    Rest,
    /// No speed, every backlash open to its far flank (twist `-G/2`), ropes without tension at zero twist.
    Slack,
    /// The loads and frictions carried at a steady speed, rad/s, without vibration. At zero speed the constant loads
    /// alone are carried and friction is left out.
    Pretensioned {
        /// Of every node, rad/s.
        speed: f64,
    },
    /// As given.
    Given {
        /// Of every shaft, rad.
        twists: Vec<f64>,
        /// Of every node, rad/s.
        speeds: Vec<f64>,
    },
}

impl Start {
    pub(super) fn validate(&self, chain: &Chain) -> Result<(), PlantError> {
        match self {
            Start::Rest | Start::Slack => Ok(()),
            Start::Pretensioned { speed } => {
                finite("starting speed", Place::Node(0), *speed)?;
                let torques = carried_torques(chain, *speed);
                for (s, (shaft, torque)) in chain.shafts.iter().zip(torques).enumerate() {
                    if shaft.rope && torque < 0.0 {
                        return Err(PlantError::Parameter {
                            name: "torque to be carried",
                            place: Place::Shaft(s),
                            value: torque,
                            expected: "zero or above, since a rope cannot push",
                        });
                    }
                }
                Ok(())
            }
            Start::Given { twists, speeds } => {
                count("starting twists", twists.len(), chain.shafts.len())?;
                count("starting speeds", speeds.len(), chain.nodes.len())?;
                for (s, &twist) in twists.iter().enumerate() {
                    finite("starting twist", Place::Shaft(s), twist)?;
                }
                for (j, &speed) in speeds.iter().enumerate() {
                    finite("starting speed", Place::Node(j), speed)?;
                }
                Ok(())
            }
        }
    }

    /// Twists (rad) and speeds (rad/s) at time zero, of a chain that was found valid.
    pub(super) fn state(&self, chain: &Chain) -> (Vec<f64>, Vec<f64>) {
        let still = vec![0.0; chain.nodes.len()];
        match self {
            Start::Rest => (vec![0.0; chain.shafts.len()], still),
            Start::Slack => {
                let open = |s: &super::Shaft| if s.rope { 0.0 } else { -0.5 * s.gap };
                (chain.shafts.iter().map(open).collect(), still)
            }
            Start::Pretensioned { speed } => {
                let torques = carried_torques(chain, *speed);
                let twists = chain.shafts.iter().zip(torques).map(|(shaft, torque)| {
                    let side = if torque < 0.0 { -1 } else { 1 };
                    torque / shaft.stiffness + shaft.origin(side)
                });
                (twists.collect(), vec![*speed; chain.nodes.len()])
            }
            Start::Given { twists, speeds } => (twists.clone(), speeds.clone()),
        }
    }
}

/// Torque of every shaft at a steady speed, N m: the sum of what lies behind it, gear losses paid by the driving side.
fn carried_torques(chain: &Chain, speed: f64) -> Vec<f64> {
    let direction = if speed == 0.0 { 0.0 } else { speed.signum() };
    let mut torques = vec![0.0; chain.shafts.len()];
    let mut behind = 0.0;
    for s in (0..chain.shafts.len()).rev() {
        let node = &chain.nodes[s + 1];
        let program = node.program.as_ref().map_or(0.0, |program| program.at(0.0).0);
        let through = match direction * behind {
            power if power > 0.0 => behind / node.efficiency,
            power if power < 0.0 => behind * node.efficiency,
            _ => behind,
        };
        behind = through + node.load + program + node.viscous * speed + node.coulomb * direction;
        torques[s] = behind;
    }
    torques
}

fn count(name: &'static str, found: usize, expected: usize) -> Result<(), PlantError> {
    if found == expected { Ok(()) } else { Err(PlantError::Count { name, found, expected }) }
}
