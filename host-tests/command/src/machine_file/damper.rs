//! Dampers on masses of the machine.

use std::f64::consts::TAU;

use driveline::machine::{CentrifugalPendulum, Damper, FrictionDamper, Inertia, Length, Mass, Resonance};

use super::diagnostic::Diagnostic;
use super::engine::Turning;
use super::quantity::Quantity;
use super::table::Table;

/// A ring or a pendulum on one of the machine's masses.
#[derive(Clone, Debug, PartialEq)]
pub struct DamperRing {
    /// Label of the mass.
    pub at: String,
    /// Index of the mass.
    pub mass: usize,
    /// The motor's speed over that of the mass.
    pub ratio: f64,
    /// How it is held.
    pub kind: DamperKind,
    /// Inertia on its own shaft (kg m2).
    pub inertia: f64,
}

/// How a damper is held, on its own shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DamperKind {
    /// By a spring and a damper: stiffness (N m/rad) and damping (N m s/rad) where the file has them.
    Tuned {
        /// Mode that it damps, from 0.
        mode: usize,
        /// N m/rad.
        stiffness: Option<f64>,
        /// N m s/rad.
        damping: Option<f64>,
    },
    /// By a damper alone.
    Viscous {
        /// Mode that it damps, from 0.
        mode: usize,
        /// N m s/rad, where the file has it.
        damping: Option<f64>,
    },
    /// By dry friction.
    Friction {
        /// Mode that it damps, from 0.
        mode: usize,
        /// Amplitude of the torque that excites the mode (N m).
        excitation: f64,
        /// Friction torque (N m), where the file has it.
        torque: Option<f64>,
    },
    /// By a spring, tuned to an excitation.
    Absorber {
        /// Frequency of the excitation (Hz).
        frequency: f64,
    },
    /// A pendulum in the centrifugal field.
    Pendulum {
        pendulum: CentrifugalPendulum,
        /// Order that it absorbs.
        order: f64,
        /// Speed of its shaft (rad/s).
        speed: f64,
    },
}

impl DamperKind {
    /// Its name in a file.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Tuned { .. } => "tuned",
            Self::Viscous { .. } => "viscous",
            Self::Friction { .. } => "friction",
            Self::Absorber { .. } => "absorber",
            Self::Pendulum { .. } => "pendulum",
        }
    }

    /// The mode that it damps, from 0; none of what is tuned to an excitation.
    pub const fn mode(&self) -> Option<usize> {
        match *self {
            Self::Tuned { mode, .. } | Self::Viscous { mode, .. } | Self::Friction { mode, .. } => Some(mode),
            Self::Absorber { .. } | Self::Pendulum { .. } => None,
        }
    }

    /// The frequency that an absorber is tuned to (rad/s).
    pub fn absorbs(&self) -> Option<f64> {
        match *self {
            Self::Absorber { frequency } => Some(TAU * frequency),
            Self::Pendulum { order, speed, .. } => Some(order * speed),
            _ => None,
        }
    }
}

impl DamperRing {
    /// Reads `[[damper]]` tables; `masses` are those that they can stand on, `modes` the number of modes.
    pub(super) fn read_all(root: &mut Table<'_>, masses: &[Turning], modes: usize) -> Result<Vec<Self>, Diagnostic> {
        root.tables_if("damper", "damper")?.into_iter().map(|(_, table)| Self::read(table, masses, modes)).collect()
    }

    fn read(mut table: Table<'_>, masses: &[Turning], modes: usize) -> Result<Self, Diagnostic> {
        const KINDS: &str = "\"tuned\", \"viscous\", \"friction\", \"absorber\" or \"pendulum\"";
        let kind = table.text("kind", KINDS)?;
        let known = masses.iter().map(|(label, ..)| format!("\"{label}\"")).collect::<Vec<_>>().join(", ");
        let expected = format!("the label of one mass that turns: {known}");
        let at = table.text("at", &expected)?.to_owned();
        let mut labelled = masses.iter().filter(|(label, ..)| *label == at);
        let (Some(&(_, mass, ratio)), None) = (labelled.next(), labelled.next()) else {
            return Err(table.wrong("at", expected));
        };
        let mode = |table: &mut Table<'_>| {
            // `COUNT` allows whole numbers up to 360 only
            let mode = table.number_or("mode", Quantity::COUNT, 1.0)? as usize;
            if mode > modes {
                Err(table.wrong("mode", format!("a mode of the machine, 1 to {modes}")))
            } else {
                Ok(mode - 1)
            }
        };
        let kind = match kind {
            "tuned" => DamperKind::Tuned {
                mode: mode(&mut table)?,
                stiffness: table.number_if("stiffness", Quantity::STIFFNESS)?,
                damping: table.number_if("damping", Quantity::DAMPING)?,
            },
            "viscous" => {
                // the damper alone holds the ring
                let damping = Quantity { zero: false, ..Quantity::DAMPING };
                DamperKind::Viscous { mode: mode(&mut table)?, damping: table.number_if("damping", damping)? }
            }
            "friction" => DamperKind::Friction {
                mode: mode(&mut table)?,
                excitation: table.number("excitation", Quantity::TORQUE)?,
                torque: table.number_if("torque", Quantity::TORQUE)?,
            },
            "absorber" => DamperKind::Absorber { frequency: table.number("frequency", Quantity::FREQUENCY)? },
            "pendulum" => {
                let order = table.number("order", Quantity::ORDER)?;
                let (mass, radius) = (table.number("mass", Quantity::MASS)?, table.number("radius", Quantity::LENGTH)?);
                let best = CentrifugalPendulum::for_order(Mass(mass), Length(radius), order);
                let length = table.number_or("length", Quantity::LENGTH, best.length)?;
                let speed = table.number("speed", Quantity::SPEED)?;
                DamperKind::Pendulum { pendulum: CentrifugalPendulum { length, ..best }, order, speed }
            }
            _ => return Err(table.wrong("kind", KINDS)),
        };
        let inertia = match kind {
            DamperKind::Pendulum { pendulum, .. } => pendulum.mass * (pendulum.radius + pendulum.length).powi(2),
            _ => table.number("inertia", Quantity::INERTIA)?,
        };
        table.finish()?;
        Ok(Self { at, mass, ratio, kind, inertia })
    }

    /// The ring at the motor.
    fn ring(&self) -> Inertia {
        Inertia(self.inertia / (self.ratio * self.ratio))
    }

    /// The friction damper at the motor, for the resonance of its mode: the best one, or with the file's torque; none
    /// of another kind.
    pub fn friction(&self, main: &Resonance) -> Option<FrictionDamper> {
        let DamperKind::Friction { excitation, torque, .. } = self.kind else { return None };
        let best = main.friction_damper(self.ring(), excitation / self.ratio);
        Some(FrictionDamper { torque: torque.map_or(best.torque, |torque| torque / self.ratio), ..best })
    }

    /// The damper at the motor, for the resonance of its mode: the best one, with the file's sizes in its place. A
    /// friction damper has neither stiffness nor damping.
    pub fn sized(&self, main: Option<&Resonance>) -> Damper {
        let square = self.ratio * self.ratio;
        let ring = self.ring();
        let none = Damper { inertia: ring.0, stiffness: 0.0, damping: 0.0 };
        match (self.kind, main) {
            (DamperKind::Tuned { stiffness, damping, .. }, Some(main)) => {
                let best = main.tuned_damper(ring);
                Damper {
                    stiffness: stiffness.map_or(best.stiffness, |stiffness| stiffness / square),
                    damping: damping.map_or(best.damping, |damping| damping / square),
                    ..best
                }
            }
            (DamperKind::Viscous { damping, .. }, Some(main)) => {
                let best = main.viscous_damper(ring);
                Damper { damping: damping.map_or(best.damping, |damping| damping / square), ..best }
            }
            (DamperKind::Absorber { frequency }, _) => Damper::absorber(ring, TAU * frequency),
            // in small angles a ring on a spring that grows with the square of the speed
            (DamperKind::Pendulum { pendulum, speed, .. }, _) => Damper::absorber(ring, pendulum.order() * speed),
            _ => none,
        }
    }
}
