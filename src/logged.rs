//! Every public type can be logged: this does not compile where one cannot.

use crate::balance;
use crate::constants;
use crate::design;
use crate::drive;
use crate::fault;
use crate::fluctuation;
use crate::governor;
use crate::machine;
use crate::number;
use crate::observer;
use crate::sample;

const fn is_logged<T: defmt::Format>() {}

macro_rules! all {
    ($($type:ty),+ $(,)?) => { $(is_logged::<$type>();)+ };
}

macro_rules! all_of_number {
    ($($number:ty),+) => {$(
        all!(
            drive::Limits<$number>,
            drive::Config<$number, observer::TwoMassConfig<$number>, (), governor::SpeedLoopConfig<$number>, ()>,
            drive::Drive<$number, observer::TwoMass<$number>, (), governor::SpeedLoop<$number>, ()>,
            governor::ActuatorWatch<$number, 2>,
            governor::ActuatorWatchConfig<$number, 2>,
            governor::BarredConfig<$number, 2>,
            governor::BetweenConfig<$number>,
            governor::CurveConfig<$number, 4>,
            governor::CurvePiece<$number>,
            governor::AccelerationFeedback,
            governor::AccelerationFeedbackConfig<$number>,
            governor::ActiveDamping,
            governor::ActiveDampingConfig<$number>,
            governor::DroopConfig<$number>,
            governor::FeedForwardConfig<$number>,
            governor::Gains<$number>,
            governor::ModesConfig<$number>,
            governor::Rack<$number, 64>,
            governor::Slew<$number, governor::Symmetric>,
            governor::SlewConfig<$number, governor::SymmetricConfig<$number>>,
            governor::SpeedGovernor<
                $number,
                (governor::Droop, governor::Barred<2>),
                (governor::FeedForward, governor::ActiveDamping),
                governor::Curve<4>,
                governor::Modes,
            >,
            fluctuation::CycleMean<$number, 64>,
            fluctuation::CycleMeanConfig<$number>,
            fluctuation::Extremes<$number>,
            fluctuation::Waveform<$number, 64>,
            fluctuation::Window<$number, 64>,
            governor::Mean<$number, 32>,
            governor::MeanConfig<$number, 32>,
            governor::OverCycle<$number>,
            governor::SpeedGovernorConfig<$number, (), (), governor::BetweenConfig<$number>, (), ()>,
            governor::Slack<$number, governor::Symmetric>,
            governor::SlackConfig<$number, governor::SymmetricConfig<$number>>,
            governor::SpeedLoop<$number>,
            governor::SpeedLoopConfig<$number>,
            balance::Phasors<$number, 2, 9>,
            balance::PhasorsConfig<$number, 2>,
            governor::Symmetric,
            governor::SymmetricConfig<$number>,
            governor::Window<$number>,
            observer::Backlash<$number>,
            observer::BacklashConfig<$number>,
            observer::Cranked<$number>,
            observer::CrankedConfig<$number>,
            observer::CrankedPrediction<$number, observer::RigidPrediction<$number>>,
            observer::Place<$number>,
            observer::Contact<$number>,
            observer::Correction<$number>,
            observer::FreeFlight<$number>,
            observer::BacklashPrediction<$number>,
            observer::Geared<observer::Rigid<$number>>,
            observer::GearedConfig<$number, observer::RigidConfig<$number>>,
            observer::GearedPrediction<observer::RigidPrediction<$number>>,
            observer::Rigid<$number>,
            observer::RigidConfig<$number>,
            observer::RigidPrediction<$number>,
            observer::SemiImplicit<$number>,
            observer::SemiImplicitConfig<$number>,
            observer::SemiImplicitPrediction<$number>,
            observer::TwoMass<$number>,
            observer::TwoMassConfig<$number>,
            observer::TwoMassPrediction<$number>,
            sample::Command<$number>,
            sample::Estimate<$number>,
            sample::Sample<$number>,
        );
    )+};
}

const _: () = {
    all_of_number!(f32, f64, number::Fixed);
    all!(
        balance::Doubt,
        balance::Motion,
        balance::Phasor,
        balance::Reading,
        balance::Sensor,
        balance::SensorError,
        balance::Steadiness,
        balance::Turning,
        balance::TurningConfig,
        constants::Bases,
        constants::Cycle,
        constants::Error,
        constants::Gear,
        constants::Measured,
        constants::MeasuredError,
        constants::ActuatorWatchSettings,
        constants::ModesSettings,
        constants::Screening,
        constants::SpeedLoopSettings,
        design::Actuator,
        constants::Wheel,
        design::ApproximateStep,
        design::BarredSpeeds<2>,
        design::BacklashDesign,
        design::CrankedDesign,
        design::BacklashTuning,
        design::Aim,
        design::ApproximateStep,
        design::Cost,
        design::Disturbance,
        design::Doubling<5>,
        design::Duty,
        design::Encoder,
        design::Error,
        design::ExactStep,
        design::Fidelity,
        design::GovernorDesign,
        design::Kalman<5, 1>,
        design::LoadFeedForward,
        design::VirtualInertia,
        design::Margins,
        design::Matrix<5, 5>,
        design::Need,
        design::ObserverChoice,
        design::Rate,
        design::RigidDesign,
        design::SemiImplicitStep,
        design::SlackDesign,
        design::SlackTuning,
        design::SpeedLoopDesign,
        design::SpeedLoopTuning,
        design::StandardDeviation,
        design::StepChoice,
        design::TorqueCurve<4>,
        design::TwoMassDesign,
        fault::Faults,
        governor::Between,
        governor::Duty,
        governor::Mode,
        governor::Modes,
        governor::RackConfig<64>,
        governor::Request,
        governor::Trip,
        fluctuation::Balance,
        fluctuation::Behind,
        fluctuation::Bin<f32>,
        fluctuation::CycleConfig,
        fluctuation::Drivetrain,
        fluctuation::Edge<f32>,
        fluctuation::Extreme,
        fluctuation::Fluctuations,
        fluctuation::Flywheel,
        fluctuation::MachineClass,
        fluctuation::Order,
        fluctuation::Reading,
        fluctuation::Remedy,
        fluctuation::Ripple,
        fluctuation::Series,
        fluctuation::ToothErrors<60>,
        fluctuation::ToothWindow<60>,
        fluctuation::ToothedWheel<60>,
        fluctuation::ToothedWheelConfig,
        fluctuation::WaveformConfig,
        machine::Belt,
        machine::Chain,
        machine::Combustion,
        machine::CrankSlider,
        machine::Cranked,
        machine::Damping,
        machine::Density,
        machine::Diameter,
        machine::Efficiency,
        machine::Element,
        machine::Error,
        machine::Falls,
        machine::Flow,
        machine::Gap,
        machine::Induction,
        machine::Inertia,
        machine::Joint,
        machine::Length,
        machine::Line,
        machine::LinearDamping,
        machine::Mass,
        machine::Match,
        machine::Member,
        machine::Mixture,
        machine::Mode,
        machine::Modes,
        machine::Parabola,
        machine::Part,
        machine::Planetary,
        machine::PlanetaryGear,
        machine::Ratio,
        machine::ReductionError,
        machine::Rigid,
        machine::Section,
        machine::Shaft,
        machine::Series,
        machine::Shaft,
        machine::ShearModulus,
        machine::Shunt,
        machine::Side,
        machine::Speed,
        machine::StartCondition,
        machine::StartingLaw,
        machine::Stiffness,
        machine::Torque,
        machine::Train,
        machine::Travel,
        machine::TwoMass,
        machine::VariableInertia,
        machine::Worth,
        number::Coefficient,
        number::Fixed,
    );
};

const _: () = {
    use crate::commissioning;

    all!(
        commissioning::Commissioning<24>,
        commissioning::Eccentricity,
        commissioning::Figure,
        commissioning::Findings<24>,
        commissioning::Friction,
        commissioning::Identified,
        commissioning::Job<24>,
        commissioning::Reason,
        commissioning::Response,
        commissioning::Stage,
        commissioning::TestConfig,
        commissioning::TestSettings,
    );
};

#[cfg(feature = "balancing")]
const _: () = {
    all!(
        balance::Entry,
        balance::Halt,
        balance::InRunConfig<f32, 1>,
        balance::Mode,
        balance::Objective,
        balance::Refusal,
        balance::Step,
        balance::Tolerance<f32>,
        balance::Verdict<f32>,
    );
};

#[cfg(feature = "hal")]
const _: () = {
    use crate::hal;

    all!(hal::Along, hal::Chip, hal::Dac, hal::Range, hal::ToothedWheel, hal::Wheel);
    all!(hal::AdcVibration<f32>, hal::FullScale<f32>, hal::PerCount<f32>, hal::PhaseConfig<f32>);
    all!(hal::MagneticEncoder<()>, hal::Quadrature<()>, hal::Adxl355<(), f32>);
    all!(hal::PwmTorque<(), f32>, hal::SpiDac<(), f32>, hal::ThreePhase<(), (), (), f32>, hal::Tmc4671<(), f32>);
};

#[cfg(feature = "hal-async")]
const _: () = {
    use crate::hal;

    all!(hal::AwaitedAngle, hal::AwaitedTorque<f32>);
};

#[cfg(feature = "telemetry")]
const _: () = {
    use crate::telemetry;

    all!(telemetry::Channel<'static>, telemetry::Kind, telemetry::Record<8>);
};

#[cfg(feature = "parameters")]
const _: () = {
    use crate::parameters;

    all!(parameters::Loaded<u32>);
};
