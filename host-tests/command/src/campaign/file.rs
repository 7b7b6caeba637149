//! A machine file as a scene of campaigns: its plant, a run that its load cycle makes, and its drives.

use driveline::design::ObserverChoice;
use driveline::settings::Bases;
use driveline_firmware::Words;
use driveline_firmware::scene::Scene;
use driveline_solver::plant::train::{Coordinate, Link, RigidGear, Source, Train};
use driveline_solver::plant::{Chain, LoadProgram, PlantError, Shaft, Start};

use super::file_drive::start;
use crate::machine_file::designs::{BRANCHES, Designs, NO_SHAFT};
use crate::machine_file::train::too_stiff;
use crate::machine_file::{MachineFile, slug};
use driveline_closed_loop::departure::Departure;
use driveline_closed_loop::plant::Body;
use driveline_closed_loop::scenario::{Action, Machine, Scenario};
use driveline_closed_loop::sensors::Encoder;

/// A machine of a file with its designs.
#[derive(Clone, Debug)]
pub struct FileCase {
    pub machine: MachineFile,
    /// Its name in names of results.
    pub name: String,
    pub designs: Designs,
    /// Begin of the load's change, its end, the lower speed, the end of the run (s).
    times: [f64; 4],
    /// The softest shaft, whose torque the two masses have.
    shaft: usize,
}

/// When the governor is released (s).
const RELEASE: f64 = 0.1;

/// Least efficiency of a draw, as of a file.
const LEAST_EFFICIENCY: f64 = 1e-3;

/// Longest run (s).
const LONGEST: f64 = 600.0;

impl FileCase {
    /// A machine that a campaign can be run of.
    ///
    /// # Errors
    /// A sentence: it has branches or no shaft, losses that no shaft carries, or cannot be designed.
    pub fn of(machine: MachineFile) -> Result<Self, String> {
        let refused = |error: String| format!("no drive can be made: {error}");
        if !machine.branches.is_empty() {
            return Err(refused(BRANCHES.to_owned()));
        }
        let damped = machine.with_dampers().map_err(refused)?;
        let two = damped.two_masses().ok_or_else(|| refused(NO_SHAFT.to_owned()))?;
        damped.drive_gears(&two, false).map_err(refused)?;
        if let Some(why) = machine.gear_that_stops_at_once() {
            return Err(format!("no plant can be made: {why}"));
        }
        let designs = Designs::of(&damped, &two).map_err(|error| refused(Designs::refusal(&damped, error)))?;
        let cycle = machine.cycle(two.gravity_torque);
        let ramp = machine.limits.speed / designs.ramp;
        // the loop has settled to e^-5
        let settled = RELEASE + ramp + 5.0 / designs.speed_loop.bandwidth;
        let off = settled + cycle.rise + cycle.every;
        let slower = off + cycle.rise + cycle.every;
        let end = slower + 0.5 * ramp + cycle.every.max(5.0 / designs.speed_loop.bandwidth);
        if end > LONGEST {
            let settling = 5.0 / designs.speed_loop.bandwidth;
            let remedies = [
                (ramp, "raise `limits.torque` or `speed_loop.ramp`, or lower `limits.speed`"),
                (settling, "stiffen the softest shaft or raise `speed_loop.bandwidth`"),
                (cycle.every, "shorten `duty.every`"),
            ];
            let (_, remedy) = remedies.into_iter().fold((0.0, ""), |a, b| if b.0 > a.0 { b } else { a });
            return Err(format!(
                "a run of {end:.0} s would be needed, {LONGEST} s are possible (ramp {ramp:.0} s, settling \
                 {settling:.0} s, load cycle {:.0} s): {remedy}",
                cycle.every
            ));
        }
        let ticks = machine.actuator.delay * f64::from(machine.control.rate_hz);
        if ticks > 1.0 {
            return Err(format!(
                "the torque is {ticks:.1} ticks late, a campaign has one at most; `design` counts them all"
            ));
        }
        let shafts = machine.chain.shafts();
        let softest = shafts.iter().enumerate().min_by(|a, b| a.1.stiffness.total_cmp(&b.1.stiffness));
        let shaft = softest.map_or(0, |(shaft, _)| shaft);
        let case = Self { name: slug(&machine.name), machine, designs, times: [settled, off, slower, end], shaft };
        if !case.machine.dampers.is_empty() {
            let nominal = case.plant(&Departure::NONE).map_err(|error| error.to_string())?;
            if let Some((place, found, expected)) = nominal.motion().and_then(|motion| too_stiff(motion, end)) {
                let name = case.machine.name_at(place);
                return Err(format!(
                    "with its dampers the machine is too stiff for a campaign of {end:.1} s: at `{name}`, referred to \
                     the motor, {found}; expected {expected}, or a copy of the file without its dampers"
                ));
            }
        }
        Ok(case)
    }

    /// The plant, which departs from the file, with the change of load of its run.
    fn plant(&self, by: &Departure) -> Result<Body, PlantError> {
        let Self { machine, designs, times: [on, off, ..], .. } = self;
        let cycle = machine.cycle(designs.two.gravity_torque);
        let rise = cycle.rise.max(1e-6);
        let program = [(*on, 0.0), (on + rise, cycle.change), (*off, cycle.change), (off + rise, 0.0)];
        plant(machine, program, by)
    }

    /// From when to when nothing excites the swing at the end of the run (s).
    pub fn free(&self) -> (f64, f64) {
        let [.., slower, end] = self.times;
        (slower + 0.5 * self.machine.limits.speed / self.designs.ramp, end)
    }

    /// The machine as it is: up to its speed, a change of load that comes and goes, half of the speed.
    pub fn departing(&'static self, by: &Departure) -> Result<Machine, PlantError> {
        let Self { machine, designs, times: [.., slower, end], .. } = self;
        let speed = machine.limits.speed;
        let run = Scenario {
            held: designs.two.gravity_torque * by.load,
            actions: vec![
                (RELEASE, Action::Release),
                (RELEASE, Action::Setpoint(speed)),
                (*slower, Action::Setpoint(0.5 * speed)),
            ],
            duration: *end,
            ..Scenario::of("run-up, a load that comes and goes, slower", self.plant(by)?)
        };
        let last = machine.chain.masses().len() - 1;
        Ok(Machine {
            name: &self.name,
            summary: "",
            facts: Vec::new(),
            notes: Vec::new(),
            chosen: (if designs.is_rigid() { "rigid" } else { "two-mass" }, self.rate()),
            scenarios: vec![run],
            encoder: Encoder::new(machine.encoder.lines.saturating_mul(4)),
            torque_noise: machine.disturbance.noise(),
            load: last,
            shaft_torque: SHAFTS[self.shaft.min(SHAFTS.len() - 1)],
            load_torque: LOADS[last.min(LOADS.len() - 1)],
            told_friction: 0.0,
            rated_speed: speed,
            bases: Bases::SI,
        })
    }

    /// Ticks a second.
    pub const fn rate(&self) -> u32 {
        self.machine.control.rate_hz
    }

    /// The drive with an observer in `f32`, at rest.
    pub fn start(&self, observer: ObserverChoice) -> Result<Box<dyn Scene>, String> {
        start(&self.machine, &self.designs, observer, Words::Single).map(|(drive, _)| drive)
    }
}

/// A machine as a plant that departs from the file: it hangs on its shafts, its gears have their losses, its ropes
/// only pull, and a load torque (s, N m) is added at its far end. Its dampers stand on it with their nominal sizes.
fn plant(machine: &MachineFile, load: [(f64, f64); 4], by: &Departure) -> Result<Body, PlantError> {
    let (masses, shafts) = (machine.chain.masses(), machine.chain.shafts());
    let (rope, efficiency) = machine.ropes_and_efficiencies();
    let (weight, last) = (machine.chain.gravity_torque() * by.load, masses.len() - 1);
    let loaded = |node: usize, inertia: f64| if node == last { inertia * by.load_inertia * by.load } else { inertia };
    let viscous = machine.viscous();
    let mut known = Chain::motor(masses[0] * by.motor_inertia).viscous(viscous[0]);
    let mut train = Train::new().coordinate(Coordinate::new(masses[0] * by.motor_inertia).viscous(viscous[0]));
    let mut twists = Vec::new();
    for (s, (shaft, inertia)) in shafts.iter().zip(&masses[1..]).enumerate() {
        let (stiffness, gap) = (shaft.stiffness * by.stiffness, shaft.gap * by.gap);
        let damping = shaft.damping * by.damping;
        let of = if rope[s] { Shaft::rope(stiffness) } else { Shaft::elastic(stiffness) };
        let flank = if weight > 0.0 && !rope[s] { 0.5 * gap } else { 0.0 };
        twists.push(flank + weight / stiffness);
        let inertia = loaded(s + 1, *inertia);
        let mut link = Link::shaft(s, s + 1, stiffness).damping(damping).gap(gap).elongated(twists[s]);
        if efficiency[s] != [1.0; 2] {
            let [ahead, back] = departing(efficiency[s], by);
            known = known.efficiency(ahead).back_efficiency(back);
            link = link.efficiency(ahead).back_efficiency(back);
        }
        known = known.shaft(of.damping(damping).gap(gap), inertia).viscous(viscous[s + 1]);
        train = train.coordinate(Coordinate::new(inertia).viscous(viscous[s + 1]));
        train = train.link(if rope[s] { link.rope() } else { link });
    }
    let rigid = machine.rigid_gears();
    if machine.dampers.is_empty() && rigid.is_empty() {
        let start = Start::Given { twists, speeds: vec![0.0; masses.len()] };
        return Ok(known.load(weight).program(LoadProgram::table(&load)).start(start).build()?.into());
    }
    for (mass, gear) in rigid {
        let [efficiency, back_efficiency] = departing([gear.efficiency, gear.back_efficiency], by);
        train = train.gear(mass, RigidGear { efficiency, back_efficiency, ..gear });
    }
    let against = load.map(|(time, torque)| (time, -torque));
    train = train.source(last, Source::Constant(-weight)).source(last, Source::Program(LoadProgram::table(&against)));
    Ok(Body::train(machine.put_dampers(train, masses.len()).build()?, &[]))
}

/// Efficiencies of a gear while the motor drives and while the load does, which depart from the file.
fn departing([ahead, back]: [f64; 2], by: &Departure) -> [f64; 2] {
    // a gear that locks itself stays one
    let least = if back > 0.0 { LEAST_EFFICIENCY } else { f64::NEG_INFINITY };
    [(ahead + by.efficiency).clamp(LEAST_EFFICIENCY, 1.0), (back + by.efficiency).clamp(least, 1.0)]
}

/// A torque of a plant.
type Torque = fn(&Body) -> f64;

fn behind_gear<const SHAFT: usize>(plant: &Body) -> f64 {
    plant.torque_behind_gear(SHAFT)
}

fn load<const NODE: usize>(plant: &Body) -> f64 {
    plant.load_torque(NODE)
}

macro_rules! each {
    ($torque:ident: $($index:literal)+) => { [$($torque::<$index>),+] };
}

/// The shafts and masses that a chain may have.
const SHAFTS: [Torque; 16] = each!(behind_gear: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
const LOADS: [Torque; 16] = each!(load: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
