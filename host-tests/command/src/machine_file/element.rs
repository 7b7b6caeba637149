//! The elements of a machine as a file names them, and the keys of each.

use std::f64::consts::PI;

use driveline::machine::{
    Belt, Chain, CrankSlider, Damping, Diameter, Efficiency, Error, Falls, Gap, Inertia, Length, LinearDamping, Mass,
    Member, Planetary, PlanetaryGear, Ratio, Section, ShearModulus, Stiffness, try_stepped,
};

use super::diagnostic::Diagnostic;
use super::quantity::Quantity;
use super::table::Table;
use super::train::mean_inertia;

/// The kinds of elements, as a message lists them.
pub const KINDS: &str = "\"motor\", \"shaft\", \"section\", \"rotor\", \"crank\", \"mechanism\", \"gear\", \"worm\", \
                         \"planetary\", \"belt\", \"drum\", \"screw\", \"rope\", \"lifted\", \"driven\", \"swinging\", \
                         \"slack\" or \"backlash\"";

/// The numbers that a ratio may be.
const SIGNED_RATIO: &str = "a number, 1e-6 to 1e6, negative where the two turn against each other";

/// One element of a machine, in SI units, each on its own shaft or along the travel of the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Element {
    /// The motor's own rotor. Every machine begins with it.
    Motor {
        /// Inertia (kg m2).
        inertia: f64,
        /// Viscous damping against the ground (N m s/rad); 0 where the file is silent. A chain does not know it.
        viscous: f64,
    },
    /// A rotor on the present shaft: a brake drum, a gear wheel, a coupling, a roll.
    Rotor {
        /// Inertia (kg m2).
        inertia: f64,
        /// As that of the motor (N m s/rad).
        viscous: f64,
    },
    /// An elastic shaft to the next mass.
    Shaft {
        /// Stiffness (N m/rad).
        stiffness: f64,
        /// Damping (N m s/rad); 0 where the file is silent.
        damping: f64,
        /// Its own inertia (kg m2), half of it at either end; 0 where the file is silent.
        inertia: f64,
    },
    /// A piece of a shaft from its dimensions; pieces in a row are a stepped shaft.
    Section {
        /// Length (m).
        length: f64,
        /// Outer diameter, where it begins (m).
        diameter: f64,
        /// Outer diameter where it ends (m); the same where the file is silent.
        end: f64,
        /// Diameter of the bore (m); 0 where the file is silent.
        bore: f64,
        /// Shear modulus (Pa); steel's where the file is silent.
        modulus: f64,
        /// Damping (N m s/rad); 0 where the file is silent.
        damping: f64,
        /// Density (kg/m3); 0, without an inertia of its own, where the file is silent.
        density: f64,
    },
    /// A crank drive on the present shaft, as the mean of its inertia.
    Crank(CrankSlider),
    /// A four-bar, toggle, cam or table of inertias on the present shaft, as the mean of its inertia.
    Mechanism {
        /// Inertia of its crank, and the mean of what that moves (kg m2).
        inertia: f64,
    },
    /// A gear; what follows turns `ratio` times slower.
    Gear {
        /// Speed of the motor's side over speed of the load's side.
        ratio: f64,
        /// Efficiency; 1 where the file is silent.
        efficiency: f64,
        /// Efficiency while the load drives; the same where the file is silent. At zero or below the gear locks itself.
        back_efficiency: f64,
    },
    /// A gear that loses more while the load drives it.
    Worm {
        /// Speed of the motor's side over speed of the load's side.
        ratio: f64,
        /// Efficiency while the motor drives.
        efficiency: f64,
        /// Efficiency while the load drives; at zero or below the worm locks itself.
        back_efficiency: f64,
    },
    /// A planetary set: one member on the present shaft, one held, what follows turns with the third.
    Planetary {
        gear: PlanetaryGear,
        /// As that of a gear.
        back_efficiency: f64,
    },
    /// A belt to the next mass.
    Belt(Belt),
    /// A drum or a pinion: turning becomes travel.
    Drum {
        /// Diameter (m).
        diameter: f64,
    },
    /// A screw: turning becomes travel.
    Screw {
        /// Travel a turn (m).
        lead: f64,
    },
    /// A rope from the drum to the load.
    Rope {
        /// Falls that carry the load.
        falls: u32,
        /// Stiffness at the load (N/m).
        stiffness: f64,
        /// Damping at the load (N s/m); 0 where the file is silent.
        damping: f64,
    },
    /// A mass that hangs: inertia and weight.
    Lifted {
        /// Mass (kg).
        mass: f64,
    },
    /// A mass that moves on the level: inertia only.
    Driven {
        /// Mass (kg).
        mass: f64,
    },
    /// A mass that swings under what travels.
    Swinging {
        /// Mass (kg).
        mass: f64,
        /// Length of the pendulum (m).
        length: f64,
    },
    /// Free travel along the load's path.
    Slack {
        /// Travel (m).
        travel: f64,
    },
    /// A backlash in series with the shaft beside it.
    Backlash {
        /// Whole free angle between the flanks (rad).
        gap: f64,
    },
}

impl Element {
    /// Reads an `[[element]]` table. The kind says which keys belong to it.
    ///
    /// # Errors
    /// A missing, unknown or wrong key, or a kind that does not exist.
    pub fn read(mut table: Table<'_>) -> Result<Self, Diagnostic> {
        let kind = table.text("kind", KINDS)?;
        let element = match kind {
            "motor" => Self::Motor {
                inertia: table.number("inertia", Quantity::INERTIA)?,
                viscous: table.number_or("viscous", Quantity::DAMPING, 0.0)?,
            },
            "rotor" => Self::Rotor {
                inertia: table.number("inertia", Quantity::INERTIA)?,
                viscous: table.number_or("viscous", Quantity::DAMPING, 0.0)?,
            },
            "shaft" => Self::Shaft {
                stiffness: table.number("stiffness", Quantity::STIFFNESS)?,
                damping: table.number_or("damping", Quantity::DAMPING, 0.0)?,
                inertia: table.number_or("inertia", Quantity::PART_INERTIA, 0.0)?,
            },
            "gear" => {
                // everything is referred to the motor, in the sense in which it turns with it
                let ratio = signed_ratio(&mut table)?.abs();
                let [efficiency, back_efficiency] = efficiencies(&mut table)?;
                Self::Gear { ratio, efficiency, back_efficiency }
            }
            "section" => {
                let diameter = table.number("diameter", Quantity::DIAMETER)?;
                Self::Section {
                    length: table.number("length", Quantity::LENGTH)?,
                    diameter,
                    end: table.number_or("end", Quantity::DIAMETER, diameter)?,
                    bore: table.number_or("bore", Quantity::BORE, 0.0)?,
                    modulus: table.number_or("modulus", Quantity::MODULUS, ShearModulus::STEEL.0)?,
                    damping: table.number_or("damping", Quantity::DAMPING, 0.0)?,
                    density: table.number_or("density", Quantity { zero: true, ..Quantity::DENSITY }, 0.0)?,
                }
            }
            "crank" => Self::Crank(CrankSlider {
                crank: Inertia(table.number("inertia", Quantity::INERTIA)?),
                radius: Length(table.number("radius", Quantity::LENGTH)?),
                rod: Length(table.number("rod", Quantity::LENGTH)?),
                rod_mass: Mass(table.number_or("rod_mass", Quantity::PART_MASS, 0.0)?),
                rod_centre: Length(table.number_or("rod_centre", Quantity::BORE, 0.0)?),
                rod_inertia: Inertia(table.number_or("rod_inertia", Quantity::PART_INERTIA, 0.0)?),
                slider: Mass(table.number("slider", Quantity::PART_MASS)?),
            }),
            "mechanism" => Self::Mechanism {
                inertia: table.number_or("inertia", Quantity::PART_INERTIA, 0.0)? + mean_inertia(&mut table)?,
            },
            "worm" => Self::Worm {
                ratio: table.number("ratio", Quantity::RATIO)?,
                efficiency: table.number("efficiency", Quantity::EFFICIENCY)?,
                back_efficiency: table.number("back_efficiency", Quantity::BACK_EFFICIENCY)?,
            },
            "planetary" => {
                let [efficiency, back_efficiency] = efficiencies(&mut table)?;
                let ring = Inertia(table.number_or("ring", Quantity::PART_INERTIA, 0.0)?);
                let (input, held) = (member(&mut table, "input", Member::Sun)?, other_member(&mut table)?);
                let set = Planetary {
                    // `TEETH` allows whole numbers up to 10000 only.
                    sun_teeth: table.number("sun_teeth", Quantity::TEETH)? as u32,
                    ring_teeth: table.number("ring_teeth", Quantity::TEETH)? as u32,
                    module: table.number("module", Quantity::DIAMETER)?,
                    planets: table.number("planets", Quantity::TEETH)? as u32,
                    sun: Inertia(table.number("sun", Quantity::PART_INERTIA)?),
                    planet: Inertia(table.number("planet", Quantity::PART_INERTIA)?),
                    planet_mass: Mass(table.number("planet_mass", Quantity::PART_MASS)?),
                    carrier: Inertia(table.number("carrier", Quantity::PART_INERTIA)?),
                    efficiency: Efficiency(efficiency),
                };
                Self::Planetary { gear: PlanetaryGear { set, ring, input, held }, back_efficiency }
            }
            "belt" => Self::Belt(Belt {
                driving: Diameter(table.number("driving", Quantity::DIAMETER)?),
                driven: Diameter(table.number("driven", Quantity::DIAMETER)?),
                strand: Stiffness(table.number("stiffness", Quantity::ROPE_STIFFNESS)?),
                damping: LinearDamping(table.number_or("damping", Quantity::ROPE_DAMPING, 0.0)?),
                efficiency: Efficiency(table.number_or("efficiency", Quantity::EFFICIENCY, 1.0)?),
            }),
            "screw" => Self::Screw { lead: table.number("lead", Quantity::LENGTH)? },
            "swinging" => Self::Swinging {
                mass: table.number("mass", Quantity::MASS)?,
                length: table.number("length", Quantity::LENGTH)?,
            },
            "slack" => Self::Slack { travel: table.number("travel", Quantity::BORE)? },
            "drum" => Self::Drum { diameter: table.number("diameter", Quantity::DIAMETER)? },
            "rope" => Self::Rope {
                // `FALLS` allows whole numbers up to 64 only.
                falls: table.number("falls", Quantity::FALLS)? as u32,
                stiffness: table.number("stiffness", Quantity::ROPE_STIFFNESS)?,
                damping: table.number_or("damping", Quantity::ROPE_DAMPING, 0.0)?,
            },
            "lifted" => Self::Lifted { mass: table.number("mass", Quantity::MASS)? },
            "driven" => Self::Driven { mass: table.number("mass", Quantity::MASS)? },
            "backlash" => Self::Backlash { gap: table.number("gap", Quantity::GAP)? },
            _ => return Err(table.wrong("kind", KINDS)),
        };
        table.finish()?;
        Ok(element)
    }

    /// The name of its kind, as in the file.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Motor { .. } => "motor",
            Self::Rotor { .. } => "rotor",
            Self::Shaft { .. } => "shaft",
            Self::Section { .. } => "section",
            Self::Crank(_) => "crank",
            Self::Mechanism { .. } => "mechanism",
            Self::Worm { .. } => "worm",
            Self::Planetary { .. } => "planetary",
            Self::Belt(_) => "belt",
            Self::Screw { .. } => "screw",
            Self::Swinging { .. } => "swinging",
            Self::Slack { .. } => "slack",
            Self::Gear { .. } => "gear",
            Self::Drum { .. } => "drum",
            Self::Rope { .. } => "rope",
            Self::Lifted { .. } => "lifted",
            Self::Driven { .. } => "driven",
            Self::Backlash { .. } => "backlash",
        }
    }

    /// A shaft's own inertia at its beginning and its end (kg m2), so that total and centre are kept; nothing of what
    /// has none.
    pub fn end_inertias(&self) -> [f64; 2] {
        match *self {
            Self::Shaft { inertia, .. } => [0.5 * inertia; 2],
            Self::Section { length, diameter, end, bore, density, .. } => {
                // the integral of x d^4 over a straight taper from 0 to 1, d from `near` to `far`
                let moment = |near: f64, far: f64| {
                    (0..5).map(|k| f64::from(k + 1) * near.powi(4 - k) * far.powi(k)).sum::<f64>() / 30.0
                };
                [(end, diameter), (diameter, end)]
                    .map(|(near, far)| density * length * PI / 32.0 * (moment(near, far) - 0.5 * bore.powi(4)))
            }
            _ => [0.0; 2],
        }
    }

    /// A shaft with its own inertia at its ends.
    fn heavy(&self, chain: Chain, shaft: impl FnOnce(Chain) -> Chain) -> Chain {
        match self.end_inertias() {
            [0.0, 0.0] => shaft(chain),
            [beginning, end] => shaft(chain.rotor(Inertia(beginning))).rotor(Inertia(end)),
        }
    }

    fn heavy_rust(&self, shaft: &str) -> String {
        match self.end_inertias() {
            [0.0, 0.0] => shaft.to_owned(),
            [beginning, end] => format!(".rotor(Inertia({beginning:?})){shaft}.rotor(Inertia({end:?}))"),
        }
    }

    /// Puts the element at the end of a chain; a motor begins a new one.
    pub fn follow(self, chain: Chain) -> Result<Chain, Error> {
        let chain = self.append(chain)?;
        chain.error().map_or(Ok(chain), Err)
    }

    /// The same; a chain that cannot take it carries the error.
    pub(super) fn append(self, chain: Chain) -> Result<Chain, Error> {
        Ok(match self {
            Self::Motor { inertia, .. } => Chain::motor(Inertia(inertia)),
            Self::Rotor { inertia, .. } | Self::Mechanism { inertia } => chain.rotor(Inertia(inertia)),
            Self::Shaft { stiffness, damping, .. } => {
                self.heavy(chain, |chain| chain.shaft(Stiffness(stiffness), Damping(damping)))
            }
            Self::Gear { ratio, efficiency, back_efficiency } | Self::Worm { ratio, efficiency, back_efficiency } => {
                chain.worm(Ratio(ratio), Efficiency(efficiency), Efficiency(back_efficiency))
            }
            Self::Section { length, diameter, end, bore, modulus, damping, .. } => {
                let section = Section {
                    length: Length(length),
                    diameter: [Diameter(diameter), Diameter(end)],
                    bore: Diameter(bore),
                };
                let stiffness = try_stepped(&[section], ShearModulus(modulus))?;
                self.heavy(chain, |chain| chain.shaft(stiffness, Damping(damping)))
            }
            Self::Crank(crank) => {
                crank.check()?;
                chain.rotor(crank.mean_inertia())
            }
            Self::Planetary { gear, back_efficiency } => {
                let (gear, worm) = losing_alike(gear, back_efficiency);
                let chain = match (gear.input, gear.held) {
                    (Member::Sun, Member::Ring) => chain.planetary(gear.set),
                    _ => chain.planetary_gear(gear),
                };
                match worm {
                    Some([ahead, back]) => chain.worm(Ratio(1.0), ahead, back),
                    None => chain,
                }
            }
            Self::Belt(belt) => chain.belt(belt),
            Self::Screw { lead } => chain.screw(Length(lead)),
            Self::Swinging { mass, length } => chain.swinging(Mass(mass), Length(length)),
            Self::Slack { travel } => chain.slack(Length(travel)),
            Self::Drum { diameter } => chain.drum(Diameter(diameter)),
            Self::Rope { falls, stiffness, damping } => {
                chain.damped_rope(Falls(falls), Stiffness(stiffness), LinearDamping(damping))
            }
            Self::Lifted { mass } => chain.lifted(Mass(mass)),
            Self::Driven { mass } => chain.driven(Mass(mass)),
            Self::Backlash { gap } => chain.backlash(Gap(gap)),
        })
    }

    /// The element in the words of the library's builder, as `.rotor(Inertia(0.08))`. The `Debug` of its structures is
    /// how they are written.
    pub fn rust(self) -> String {
        match self {
            Self::Motor { inertia, .. } => format!("Chain::motor(Inertia({inertia:?}))"),
            Self::Rotor { inertia, .. } | Self::Mechanism { inertia } => format!(".rotor(Inertia({inertia:?}))"),
            Self::Shaft { stiffness, damping, .. } => {
                self.heavy_rust(&format!(".shaft(Stiffness({stiffness:?}), Damping({damping:?}))"))
            }
            Self::Gear { ratio, efficiency, back_efficiency } if efficiency == back_efficiency => {
                format!(".gear(Ratio({ratio:?}), Efficiency({efficiency:?}))")
            }
            Self::Section { length, diameter, end, bore, modulus, damping, .. } => self.heavy_rust(&format!(
                ".shaft(Section::tapered(Length({length:?}), Diameter({diameter:?}), \
                    Diameter({end:?})).bored(Diameter({bore:?})).stiffness(ShearModulus({modulus:?})), \
                    Damping({damping:?}))"
            )),
            Self::Crank(crank) => format!(".rotor({crank:?}.mean_inertia())"),
            Self::Gear { ratio, efficiency, back_efficiency } | Self::Worm { ratio, efficiency, back_efficiency } => {
                format!(".worm(Ratio({ratio:?}), Efficiency({efficiency:?}), Efficiency({back_efficiency:?}))")
            }
            Self::Planetary { gear, back_efficiency } => {
                let (PlanetaryGear { set, ring, input, held }, worm) = losing_alike(gear, back_efficiency);
                let behind =
                    worm.map_or_else(String::new, |[ahead, back]| format!(".worm(Ratio(1.0), {ahead:?}, {back:?})"));
                match (input, held) {
                    (Member::Sun, Member::Ring) => format!(".planetary({set:?}){behind}"),
                    _ => format!(
                        ".planetary_gear(PlanetaryGear {{ set: {set:?}, ring: {ring:?}, input: Member::{input:?}, \
                         held: Member::{held:?} }}){behind}"
                    ),
                }
            }
            Self::Belt(belt) => format!(".belt({belt:?})"),
            Self::Screw { lead } => format!(".screw(Length({lead:?}))"),
            Self::Swinging { mass, length } => format!(".swinging(Mass({mass:?}), Length({length:?}))"),
            Self::Slack { travel } => format!(".slack(Length({travel:?}))"),
            Self::Drum { diameter } => format!(".drum(Diameter({diameter:?}))"),
            Self::Rope { falls, stiffness, damping: 0.0 } => format!(".rope(Falls({falls}), Stiffness({stiffness:?}))"),
            Self::Rope { falls, stiffness, damping } => {
                format!(".damped_rope(Falls({falls}), Stiffness({stiffness:?}), LinearDamping({damping:?}))")
            }
            Self::Lifted { mass } => format!(".lifted(Mass({mass:?}))"),
            Self::Driven { mass } => format!(".driven(Mass({mass:?}))"),
            Self::Backlash { gap } => format!(".backlash(Gap({gap:?}))"),
        }
    }
}

/// A planetary set that loses alike both ways, and the losses of a worm behind it where the load's way loses more.
fn losing_alike(gear: PlanetaryGear, back_efficiency: f64) -> (PlanetaryGear, Option<[Efficiency; 2]>) {
    let ahead = gear.set.efficiency;
    if ahead.0 == back_efficiency {
        return (gear, None);
    }
    let set = Planetary { efficiency: Efficiency(1.0), ..gear.set };
    (PlanetaryGear { set, ..gear }, Some([ahead, Efficiency(back_efficiency)]))
}

/// A ratio, negative where an external gear turns the sense round.
pub(super) fn signed_ratio(table: &mut Table<'_>) -> Result<f64, Diagnostic> {
    let ratio = table.number("ratio", Quantity::ANY)?;
    if Quantity::RATIO.allows(ratio.abs()) { Ok(ratio) } else { Err(table.wrong("ratio", SIGNED_RATIO)) }
}

/// The members of a planetary set by their names in a file.
const MEMBERS: [(&str, Member); 3] = [("sun", Member::Sun), ("ring", Member::Ring), ("carrier", Member::Carrier)];

fn member(table: &mut Table<'_>, key: &'static str, default: Member) -> Result<Member, Diagnostic> {
    const MEMBER: &str = "\"sun\", \"ring\" or \"carrier\"";
    let Some(text) = table.text_if(key, MEMBER)? else { return Ok(default) };
    let found = MEMBERS.iter().find(|(name, _)| *name == text);
    found.map(|(_, member)| *member).ok_or_else(|| table.wrong(key, MEMBER))
}

/// The member that is held, which is not the input.
fn other_member(table: &mut Table<'_>) -> Result<Member, Diagnostic> {
    let input = member(table, "input", Member::Sun)?;
    let held = member(table, "held", Member::Ring)?;
    if held == input {
        return Err(table.wrong("held", "another member than the input"));
    }
    Ok(held)
}

/// Efficiencies while the motor drives and while the load does; without losses where the file is silent.
fn efficiencies(table: &mut Table<'_>) -> Result<[f64; 2], Diagnostic> {
    let efficiency = table.number_or("efficiency", Quantity::EFFICIENCY, 1.0)?;
    Ok([efficiency, table.number_or("back_efficiency", Quantity::BACK_EFFICIENCY, efficiency)?])
}
