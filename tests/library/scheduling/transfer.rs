//! Bumpless transfer: estimate and torque are the same before and after a change of the constants.

use driveline::configure::{Configure, Family, Machine, Rating, ScheduleOf, Scheduled};
use driveline::design::{StepChoice, TwoMassDesign};
use driveline::drive::{ConfigOf, Drive};
use driveline::governor::SpeedLoop;
use driveline::machine::{Match, Speed, Torque, TwoMass};
use driveline::number::{Fixed, Number};
use driveline::observer::{BacklashConfig, BacklashObserver, Observer, SemiImplicitObserver, TwoMassObserver};
use driveline::prelude::{Chain, Damping, Encoder, Inertia, Stiffness};
use driveline::sample::{Estimate, Sample};
use driveline::settings::Bases;

/// Two loads on two shafts, twice as heavy and twice as stiff.
struct Winch;

const fn member(load: f64, shaft: f64) -> TwoMass {
    Chain::motor(Inertia(0.62))
        .shaft(Stiffness(900.0 * shaft), Damping(0.5))
        .rotor(Inertia(0.2 * load))
        .reduce(Match::ResonanceAntiresonance)
}

impl Machine for Winch {
    const CHAIN: Chain = Chain::motor(Inertia(0.62)).shaft(Stiffness(900.0), Damping(0.5)).rotor(Inertia(0.2));
    const RATING: Rating = Rating { torque: Torque(200.0), speed: Speed(150.0), torque_limit: Torque(300.0) };
    const ENCODER: Encoder = Encoder::lines(2048);
    const RATE_HZ: u32 = 4_000;
    /// Both steps are tried.
    const OBSERVER: TwoMassDesign = Self::TWO_MASS
        .observer(Self::RATE, Self::ENCODER, Self::RATING.disturbance())
        .with_step(StepChoice::SemiImplicit);
    const BASES: Bases = Bases::new(&member(1.0, 2.0), 600.0, 200.0);
}

impl Family<2, 2> for Winch {
    const FIRST: [f64; 2] = [1.0, 2.0];
    const SECOND: [f64; 2] = [1.0, 2.0];
    const MEMBERS: [[TwoMass; 2]; 2] = [[member(1.0, 1.0), member(1.0, 2.0)], [member(2.0, 1.0), member(2.0, 2.0)]];
}

fn values<N: Number>(estimate: &Estimate<N>) -> [f64; 4] {
    [estimate.motor_speed, estimate.shaft_torque, estimate.load_speed, estimate.load_torque].map(N::to_real)
}

macro_rules! is_bumpless {
    ($test:ident, $number:ty, $observer:ident, $resolution:expr) => {
        #[test]
        fn $test() {
            type D = Drive<$number, $observer, SpeedLoop>;
            static SCHEDULE: ScheduleOf<D, 2, 2> = D::schedule::<Winch, 2, 2>();
            let mut config: ConfigOf<D> = D::configure::<Winch>();
            let mut drive = D::new(&config, 0);
            let (mut angle, mut torque) = (0_u32, <$number>::ZERO);
            let sample = |angle, torque| Sample { setpoint: Sample::si::<Winch>(0, 0.0, 60.0).setpoint, angle, torque };
            // accelerating, the shaft twisted and swinging: angles of a motor that runs up at 200 rad/s2
            for tick in 0..800_u32 {
                angle = (f64::from(tick * tick) * 100.0 / 16e6 / core::f64::consts::TAU * 4_294_967_296.0) as u32;
                torque = drive.tick(&config, &sample(angle, torque)).torque;
            }
            let before = values(&drive.estimate(&config));
            let mut fixed = drive;
            for (load, shaft) in [(1.7, 1.2), (1.2, 1.9), (2.0, 1.0), (1.0, 2.0)] {
                drive.follow(&mut config, &SCHEDULE, load, shaft);
                let after = values(&drive.estimate(&config));
                for (k, (before, after)) in before.iter().zip(after).enumerate() {
                    let limit = $resolution * before.abs().max(1.0);
                    assert!((before - after).abs() <= limit, "{k}: {before} {after} at {load}, {shaft}");
                }
            }
            // The next command differs by the tick's own increment alone: integral and twist gain act on one tick.
            let unchanged = fixed.tick(&D::configure::<Winch>(), &sample(angle, torque)).torque.to_real();
            let changed = drive.tick(&config, &sample(angle, torque)).torque.to_real();
            assert!((changed - unchanged).abs() < 0.02 * unchanged.abs().max(0.1), "{changed} {unchanged}");
            let gains = D::configure::<Winch>().governor.proportional != config.governor.proportional;
            assert!(gains, "the gains have not changed");
        }
    };
}

// The compliance between two points has the resolution of the weight, 2^-16, of a torque that would have changed by up
// to half in each of four changes: 3e-5. The semi-implicit step has the estimates for states: nothing changes.
is_bumpless!(exact_in_f32, f32, TwoMassObserver, 3e-5);
is_bumpless!(exact_in_fixed_point, Fixed, TwoMassObserver, 3e-5);
is_bumpless!(semi_implicit_in_f32, f32, SemiImplicitObserver, 0.0);
is_bumpless!(semi_implicit_in_fixed_point, Fixed, SemiImplicitObserver, 0.0);

/// In contact the shaft torque stays, in the gap the twist.
#[test]
fn backlash_keeps_its_torque_in_contact_and_its_place_in_the_gap() {
    use driveline::machine::Gap;
    let config = |shaft| {
        let machine = member(1.0, shaft).with_gap(Gap(0.02));
        let tuning = driveline::design::BacklashTuning::USUAL;
        let design = machine.backlash_observer(Winch::RATE, Winch::ENCODER, Winch::DISTURBANCE, tuning);
        BacklashConfig::<f64>::new(&design, Bases::SI)
    };
    let (from, to) = (config(1.0), config(2.0));
    for torque in [100.0, -40.0] {
        let mut observer = BacklashObserver::<f64>::steady(&from, 0, torque, 30.0);
        observer.switch(&from, &to);
        let [speed, shaft, load, _] = values(&observer.estimate(&to));
        // at rest against a flank: rounding of f64
        assert!((shaft - torque).abs() < 1e-9 && (speed - 30.0).abs() < 1e-9 && (load - 30.0).abs() < 1e-9);
    }
    let mut observer = BacklashObserver::<f64>::steady(&from, 0, 0.0, 30.0);
    let twist = observer.twist();
    observer.switch(&from, &to);
    assert_eq!((observer.twist(), observer.is_open(&to)), (twist, true));
}

/// At the points the constants are those of the members.
#[test]
fn cells_are_those_of_the_members() {
    type O = TwoMassObserver;
    let cells = <O as Scheduled<Winch, f64, 2, 2>>::CELLS;
    for (member, cell) in Winch::MEMBERS.iter().flatten().zip(cells.iter().flatten()) {
        // the compliance is the stiffness' inverse
        assert!((cell.compliance * member.stiffness - 1.0).abs() < 1e-12);
    }
    let fixed = <O as Configure<Winch, f64>>::CONFIG;
    assert!((fixed.compliance * Winch::TWO_MASS.stiffness - 1.0).abs() < 1e-12);
}
