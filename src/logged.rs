//! Every public type can be logged: this does not compile where one cannot.

use crate::{constants, design, drive, fault, governor, machine, number, observer, sample};

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
            governor::SpeedLoop<$number>,
            governor::SpeedLoopConfig<$number>,
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
        constants::Bases,
        constants::Error,
        constants::Gear,
        constants::Screening,
        constants::SpeedLoopSettings,
        design::ApproximateStep,
        design::Disturbance,
        design::Doubling<5>,
        design::Encoder,
        design::Error,
        design::ExactStep,
        design::Fidelity,
        design::Kalman<5, 1>,
        design::Margins,
        design::Matrix<5, 5>,
        design::Rate,
        design::RigidDesign,
        design::SemiImplicitStep,
        design::SpeedLoopDesign,
        design::SpeedLoopTuning,
        design::StandardDeviation,
        design::StepChoice,
        design::TwoMassDesign,
        fault::Faults,
        machine::Chain,
        machine::Damping,
        machine::Diameter,
        machine::Efficiency,
        machine::Element,
        machine::Error,
        machine::Falls,
        machine::Flow,
        machine::Gap,
        machine::Inertia,
        machine::Length,
        machine::LinearDamping,
        machine::Mass,
        machine::Match,
        machine::Mode,
        machine::Modes,
        machine::Part,
        machine::Planetary,
        machine::Ratio,
        machine::ReductionError,
        machine::Rigid,
        machine::Shaft,
        machine::Side,
        machine::Speed,
        machine::Stiffness,
        machine::Torque,
        machine::TwoMass,
        machine::Worth,
        number::Coefficient,
        number::Fixed,
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
