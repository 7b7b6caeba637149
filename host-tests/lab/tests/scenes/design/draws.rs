//! Machines drawn from the tolerances of each scene: the loop with its observer in it stays stable, with 6 dB to spare.
//!
//! By the closed forms alone: the chain with all its vibrations, sampled, and a speed loop designed for the machine as
//! described. `closed_loop.rs` tests them against the full plant.

use driveline::configure::{Configure, GainSource, LoopPart, Machine};
use driveline::design::{
    Actuator, ClosedLoop, Disturbance, Encoder, LoopObserver, Plant, Rate, Robustness, SpeedLoopDesign,
    SpeedLoopTuning, Spread, Tolerance,
};
use driveline::machine::{Chain, Damping, Inertia, Stiffness, TwoMass};
use driveline::number::{Number, Part};
use driveline_firmware::scene::FromConfig;
use driveline_firmware::scenes::{
    balanced_fan, blooming_mill, crane_travel, hoist, spindle, strip_mill, surface_grinder, test_rig,
};

/// xorshift64* [Marsaglia 2003, J. Stat. Softw. 8(14)].
struct Draws(u64);

impl Draws {
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Equal ratios are equally likely.
    fn between(&mut self, min: f64, max: f64) -> f64 {
        min * (max / min).powf(self.unit())
    }

    fn of(&mut self, spread: Spread) -> f64 {
        self.between(spread.min, spread.max)
    }
}

/// The chain with other inertias at its ends, another stiffness of its softest shaft and other damping.
fn varied(chain: &Chain, [motor, load, stiffness, damping]: [f64; 4]) -> Chain {
    let (masses, shafts) = (chain.masses(), chain.shafts());
    let softest = shafts.iter().map(|shaft| shaft.stiffness).fold(f64::INFINITY, f64::min);
    let mut varied = Chain::motor(Inertia(masses[0] * motor));
    for (at, (shaft, mass)) in shafts.iter().zip(&masses[1..]).enumerate() {
        let k = shaft.stiffness * if shaft.stiffness == softest { stiffness } else { 1.0 };
        let inertia = mass * if at + 1 == shafts.len() { load } else { 1.0 };
        varied = varied.shaft(Stiffness(k), Damping(shaft.damping * damping)).rotor(Inertia(inertia));
    }
    varied
}

/// The loop of a configured drive as the library tests it: closed with its torque so late.
struct Scene<'a> {
    name: &'a str,
    chain: Chain,
    tolerance: Tolerance,
    observer: LoopPart,
    speed_loop: SpeedLoopDesign,
}

impl Scene<'_> {
    fn close(&self, late: f64, lag: f64) -> ClosedLoop {
        let actuator = Actuator { delay: late * self.speed_loop.period, lag };
        match &self.observer {
            LoopPart { two_mass: Some(design), .. } => ClosedLoop::of(design, &self.speed_loop, actuator),
            LoopPart { rigid: Some(design), .. } => ClosedLoop::of_rigid(design, &self.speed_loop, actuator),
            part => panic!("{}: {part:?} is no observer", self.name),
        }
        .unwrap()
    }

    /// Unstable ones of 1,000, and those that have less than 6 dB: the first 32 are corners.
    fn drawn(&self) -> (u32, u32) {
        let Tolerance { motor_inertia, load_inertia, stiffness, torque, late, lag, .. } = self.tolerance;
        let mut draws = Draws(0x9E37_79B9_7F4A_7C15);
        let ends = [self.close(0.0, 0.0), self.close(f64::from(late), lag)];
        let (mut unstable, mut fragile) = (0, 0);
        for draw in 0..1000 {
            let corner = |spread: Spread, bit: u32| if draw >> bit & 1 == 0 { spread.min } else { spread.max };
            let (factors, closed) = if draw < 32 {
                let factors =
                    [corner(motor_inertia, 0), corner(load_inertia, 1), corner(stiffness, 2), corner(torque, 3)];
                (factors, ends[draw >> 4])
            } else {
                let factors = [motor_inertia, load_inertia, stiffness, torque].map(|spread| draws.of(spread));
                let ticks = (draws.unit() * f64::from(late + 1)).floor();
                (factors, self.close(ticks, lag * draws.unit()))
            };
            let [motor, load, stiffness, torque] = factors;
            // the corners with the least, at which the library tests; 6 dB at what is described
            let of = |chain: Chain| Plant::of_modes(chain.total_inertia(), &chain.modes());
            let least = of(varied(&self.chain, [motor, load, stiffness, self.tolerance.damping.min]));
            unstable += u32::from(!closed.is_stable(&least, torque));
            let plant = of(varied(&self.chain, [motor, load, stiffness, 1.0]));
            unstable += u32::from(!closed.is_stable(&plant, torque));
            // In steps of 5 %: an island of instability narrower than that is passed over.
            let steps = (0..=14).map(|step| torque * 2.0_f64.powf(f64::from(step) / 14.0));
            fragile += u32::from(!steps.into_iter().all(|gain| closed.is_stable(&plant, gain)));
        }
        (unstable, fragile)
    }
}

/// The loop of the drive `S` on the machine `M`, where the library tests one.
fn scene<'a, M, S>(name: &'a str) -> Scene<'a>
where
    M: Machine,
    S: FromConfig,
    S::Drive: Looped<M>,
{
    let (observer, governor) = <S::Drive as Looped<M>>::LOOP;
    let Some(GainSource::SpeedLoop(design)) = governor.gains else { panic!("{name}: {governor:?} is no speed loop") };
    let speed_loop = SpeedLoopDesign { damping: design.damping + governor.damping, ..design };
    Scene { name, chain: M::CHAIN, tolerance: M::TOLERANCE, observer, speed_loop }
}

/// Observer and governor of a drive as parts of its loop.
trait Looped<M> {
    const LOOP: (LoopPart, LoopPart);
}

impl<M, N, O, G, F, B> Looped<M> for driveline::drive::Drive<N, O, G, F, B>
where
    M: Machine,
    N: Number,
    O: Configure<M, N> + Part<N>,
    G: Configure<M, N> + Part<N>,
    F: Part<N>,
    B: Part<N>,
{
    const LOOP: (LoopPart, LoopPart) = (O::LOOP, G::LOOP);
}

/// The target: none unstable, the smallest gain margin above 2.
#[test]
fn a_thousand_machines_within_each_scene_s_tolerances_are_stable_with_6_db_to_spare() {
    macro_rules! scenes {
        ($($scene:ident $drive:ident $machine:ty;)+) => {
            [$(scene::<$machine, $scene::$drive<f32>>(concat!(stringify!($scene), " ", stringify!($drive)))),+]
        };
    }
    let scenes = scenes! {
        hoist Reduced hoist::Hoist<1_000>;
        hoist Reduced hoist::Hoist<4_000>;
        hoist Reduced hoist::Hoist<10_000>;
        hoist Rigid hoist::Hoist<1_000>;
        hoist Rigid hoist::Hoist<10_000>;
        hoist Exact hoist::CutAtRope<10_000>;
        spindle Exact spindle::Spindle;
        strip_mill SemiImplicit strip_mill::StripMill;
        strip_mill Rigid strip_mill::StripMill;
        crane_travel SemiImplicit crane_travel::CraneTravel;
        crane_travel Rigid crane_travel::CraneTravel;
        blooming_mill Backlash blooming_mill::BloomingMill;
        blooming_mill Slack blooming_mill::BloomingMill;
        balanced_fan TwoMass balanced_fan::BalancedFan;
        surface_grinder Tick surface_grinder::SurfaceGrinder;
        test_rig Whole test_rig::TestRig;
    };
    for scene in scenes {
        let (unstable, fragile) = scene.drawn();
        assert_eq!((unstable, fragile), (0, 0), "{}: unstable, below 6 dB", scene.name);
    }
}

/// One mass is there for comparison: it takes the shaft's swing for the load's doing, and has not everywhere 6 dB.
#[test]
fn the_rigid_observer_for_comparison_is_stable_within_its_tolerances() {
    let (unstable, fragile) = scene::<spindle::Spindle, spindle::Rigid<f32>>("spindle").drawn();
    println!("{fragile} of 1,000 below 6 dB");
    assert_eq!(unstable, 0);
}

/// Between the points that are tested lie no machines that are unstable: random loops of 6 dB, usual tolerances and
/// those of a hoist. By the ends of each range alone 730 of 1,500 hoists of 6 dB pass; 74 of these are unstable in
/// between.
#[test]
fn loops_that_are_accepted_are_stable_between_the_points_that_are_tested() {
    let hoist = Tolerance {
        load_inertia: Spread::between(0.04, 1.1),
        stiffness: Spread::between(0.4, 2.4),
        ..Tolerance::USUAL
    };
    // A loop of 30 degrees more rarely has anything in between.
    let robustness = Robustness { phase: 0.0, ..Robustness::USUAL };
    let mut draws = Draws(1);
    for tolerance in [Tolerance::USUAL, hoist] {
        let (mut accepted, mut refused, mut unstable) = (0, 0, 0);
        while accepted < 200 {
            let resonance = draws.between(10.0, 5_000.0);
            let load = draws.between(0.1, 20.0);
            let stiffness = resonance * resonance * load / (1.0 + load);
            let damping = 2.0 * draws.between(0.002, 0.03) * stiffness / resonance;
            let two = TwoMass::new(Inertia(1.0), Inertia(load), Stiffness(stiffness), Damping(damping));
            let disturbance =
                Disturbance { torque_accuracy: 1.0, load_torque_step: 50.0, within: draws.between(0.01, 100.0) };
            let encoder = Encoder::counts(draws.between(4e3, 1e6) as u32);
            let tuning = SpeedLoopTuning {
                bandwidth: draws.between(0.03, 0.7),
                damping: 1.0,
                shaft_damping: draws.between(0.02, 1.0),
            };
            let tolerance = Tolerance { lag: tolerance.lag * draws.between(0.02, 1.0), ..tolerance };
            let rate = Rate::hz(10_000);
            let designs = (two.try_observer(rate, encoder, disturbance), two.try_speed_loop(rate, tuning));
            let (Ok(observer), Ok(speed_loop)) = designs else { continue };
            let eye = LoopObserver::TwoMass(&observer);
            if two.try_robust(eye, &speed_loop, Actuator::DIRECT, &tolerance, &robustness).is_err() {
                refused += 1;
                continue;
            }
            accepted += 1;
            let close = |late, lag| {
                ClosedLoop::of(&observer, &speed_loop, Actuator { delay: 1e-4 * late, lag: lag * tolerance.lag })
                    .unwrap()
            };
            let loops = [close(0.0, 0.0), close(0.0, 0.5), close(0.0, 1.0), close(1.0, 0.0), close(1.0, 1.0)];
            let stable = |draws: &mut Draws| {
                let mut machine = two;
                machine.motor_inertia *= draws.of(tolerance.motor_inertia);
                machine.load_inertia *= draws.of(tolerance.load_inertia);
                machine.stiffness *= draws.of(tolerance.stiffness);
                let torque = draws.of(tolerance.torque);
                loops.iter().all(|closed| closed.is_stable(&Plant::of(&machine), torque))
            };
            unstable += u32::from((0..100).any(|_| !stable(&mut draws)));
        }
        println!("{accepted} accepted, {refused} refused, {unstable} unstable in between");
        assert!(refused > 50, "{refused}");
        // Points are no proof: 1 in 100 is what 1,500 loops of either kind stay far below (1 of 1,139, 2 of 642).
        assert!(100 * unstable <= accepted, "{unstable} of {accepted}");
    }
}

#[test]
fn a_tolerance_out_of_its_range_is_refused() {
    use driveline::design::Error;
    let (two, observer, speed_loop) =
        (hoist::Hoist::<1_000>::TWO_MASS, hoist::Hoist::<1_000>::OBSERVER, hoist::Hoist::<1_000>::SPEED_LOOP);
    let tested = |tolerance: Tolerance| {
        let eye = LoopObserver::TwoMass(&observer);
        two.try_robust(eye, &speed_loop, Actuator::DIRECT, &tolerance, &Robustness::USUAL)
    };
    assert_eq!(tested(Tolerance::USUAL), Ok(()));
    assert_eq!(tested(Tolerance { lag: -1e-4, ..Tolerance::USUAL }), Err(Error::Tolerance));
    assert_eq!(tested(Tolerance { lag: f64::NAN, ..Tolerance::USUAL }), Err(Error::Tolerance));
    assert_eq!(tested(Tolerance { stiffness: Spread::within(1.0), ..Tolerance::USUAL }), Err(Error::Tolerance));
    assert_eq!(tested(Tolerance { torque: Spread::between(1.1, 1.2), ..Tolerance::USUAL }), Err(Error::Tolerance));
}
