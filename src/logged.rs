//! Every public type can be logged: this does not compile where one cannot.

use crate::angle;
use crate::balancing;
use crate::design;
use crate::drive;
use crate::fault;
use crate::fluctuation;
use crate::governor;
use crate::machine;
use crate::number;
use crate::observer;
use crate::sample;
use crate::settings;

const fn is_logged<T: defmt::Format>() {}

macro_rules! all {
    ($($type:ty),+ $(,)?) => { $(is_logged::<$type>();)+ };
}

macro_rules! all_of_number {
    ($($number:ty),+) => {$(
        all!(
            drive::Limits<$number>,
            drive::Config<$number, observer::TwoMassConfig<$number>, (), governor::SpeedLoopConfig<$number>, ()>,
            drive::Drive<$number, observer::TwoMassObserver<$number>, (), governor::SpeedLoop<$number>, ()>,
            governor::ActuatorMonitor<$number, 2>,
            governor::ActuatorMonitorConfig<$number, 2>,
            governor::BarredConfig<$number, 2>,
            governor::TorqueRangeConfig<$number>,
            governor::CurveConfig<$number, 4>,
            governor::CurvePiece<$number>,
            governor::AccelerationFeedback,
            governor::AccelerationFeedbackConfig<$number>,
            governor::ActiveDamping,
            governor::ActiveDampingConfig<$number>,
            governor::DroopConfig<$number>,
            governor::FeedForwardConfig<$number>,
            governor::Gains<$number>,
            governor::SequencerConfig<$number>,
            governor::TransportDelay<$number, 64>,
            governor::Slew<$number, governor::SymmetricLimit>,
            governor::SlewConfig<$number, governor::SymmetricLimitConfig<$number>>,
            governor::SpeedGovernor<
                $number,
                (governor::Droop, governor::Barred<2>),
                (governor::FeedForward, governor::ActiveDamping),
                governor::Curve<4>,
                governor::Sequencer,
            >,
            fluctuation::CycleMean<$number, 64>,
            fluctuation::CycleMeanConfig<$number>,
            fluctuation::Extremes<$number>,
            fluctuation::Waveform<$number, 64>,
            fluctuation::Window<$number, 64>,
            governor::MovingAverage<$number, 32>,
            governor::MovingAverageConfig<$number, 32>,
            governor::CycleAverage<$number>,
            governor::SpeedGovernorConfig<$number, (), (), governor::TorqueRangeConfig<$number>, (), ()>,
            governor::BacklashTakeUp<$number, governor::SymmetricLimit>,
            governor::BacklashTakeUpConfig<$number, governor::SymmetricLimitConfig<$number>>,
            governor::SpeedLoop<$number>,
            governor::SpeedLoopConfig<$number>,
            balancing::Phasors<$number, 2, 9>,
            balancing::PhasorsConfig<$number, 2>,
            governor::SymmetricLimit,
            governor::SymmetricLimitConfig<$number>,
            governor::SpeedRange<$number>,
            observer::BacklashObserver<$number>,
            observer::BacklashConfig<$number>,
            observer::CrankObserver<$number>,
            observer::CrankConfig<$number>,
            observer::TablePoint<$number>,
            observer::Contact<$number>,
            observer::Correction<$number>,
            observer::FreeFlight<$number>,
            observer::GearedObserver<observer::RigidObserver<$number>>,
            observer::GearedConfig<$number, observer::RigidConfig<$number>>,
            observer::AngleTracker<$number>,
            observer::RigidObserver<$number>,
            observer::RigidConfig<$number>,
            observer::SemiImplicitObserver<$number>,
            observer::SemiImplicitConfig<$number>,
            observer::TwoMassObserver<$number>,
            observer::TwoMassConfig<$number>,
            sample::Command<$number>,
            sample::Estimate<$number>,
            sample::Sample<$number>,
        );
    )+};
}

const _: () = {
    all_of_number!(f32, f64, number::Fixed);
    all!(
        balancing::ReadingFault,
        balancing::Motion,
        balancing::Phasor,
        balancing::Reading,
        balancing::Sensor,
        balancing::SensorError,
        balancing::Steadiness,
        angle::RotorAngle,
        angle::RotorAngleConfig,
        settings::Bases,
        settings::Cycle,
        settings::Error,
        settings::Gear,
        settings::PhasorSettings,
        settings::PhasorError,
        settings::ActuatorMonitorSettings,
        settings::SequencerSettings,
        settings::Screening,
        settings::SpeedLoopSettings,
        design::Actuator,
        settings::Wheel,
        design::ApproximateStep,
        design::BarredSpeeds<2>,
        design::BacklashDesign,
        design::CrankedDesign,
        design::BacklashTuning,
        design::Requirement,
        design::ApproximateStep,
        design::Penalty,
        design::Disturbance,
        design::Doubling<5>,
        design::LoadCycle,
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
        design::ObserverSelection,
        design::ObserverChoice,
        design::Rate,
        design::RigidDesign,
        design::SemiImplicitStep,
        design::BacklashTakeUpDesign,
        design::BacklashTakeUpTuning,
        design::SpeedLoopDesign,
        design::SpeedLoopTuning,
        design::StandardDeviation,
        design::StepChoice,
        design::TorqueCurve<4>,
        design::TwoMassDesign,
        fault::Faults,
        governor::TorqueRange,
        governor::RunAction,
        governor::RunState,
        governor::Sequencer,
        governor::TransportDelayConfig<64>,
        governor::RunRequest,
        governor::Trip,
        fluctuation::Balance,
        fluctuation::LoadSide,
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
        machine::CombustionType,
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
        machine::Sensitivity,
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
        commissioning::CommissioningResult,
        commissioning::Job<24>,
        commissioning::Error,
        commissioning::Response,
        commissioning::Stage,
        commissioning::TestConfig,
        commissioning::TestSettings,
    );
};

#[cfg(feature = "balancing")]
const _: () = {
    all!(
        balancing::Entry,
        balancing::AbortReason,
        balancing::InRunConfig<f32, 1>,
        balancing::CorrectionMethod,
        balancing::Objective,
        balancing::Error,
        balancing::ProcedureStep,
        balancing::Tolerance<f32>,
        balancing::Verdict<f32>,
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
