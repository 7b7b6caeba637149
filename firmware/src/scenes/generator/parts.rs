//! The constants of the diesel's parts one by one, for the bench.

macro_rules! parts {
    ($module:ident, $number:ident, $bases:expr) => {
        /// The parts with this number.
        pub mod $module {
            use super::super::*;
            use crate::scenes::hoist::Hoist;
            use driveline::design::{Averaging, GovernorDesign};
            use driveline::governor::{
                ActiveDampingConfig, BarredConfig, CurveConfig, DroopConfig, FeedForwardConfig, Gains,
                MovingAverageConfig, SequencerConfig, SlewConfig, SymmetricLimitConfig, TorqueRangeConfig,
            };
            use driveline::settings::{SequencerSettings, SpeedLoopSettings};

            const GOVERNOR: GovernorDesign = DIESEL.governor(false).behind(Averaging::Ticks(FIRING as u32));
            /// Gains and ramp.
            pub const GAINS: Gains<$number> = Gains::<$number>::new(
                &GOVERNOR,
                SpeedLoopSettings { torque_limit: DIESEL_TORQUE, ramp: DIESEL.ramp },
                $bases,
            );
            /// Droop.
            pub const DROOP: DroopConfig<$number> = {
                let integral = GOVERNOR.integral * GOVERNOR.period;
                DroopConfig::<$number>::new(super::super::DROOP, RATED_SPEED, DIESEL_TORQUE, integral, $bases)
            };
            /// Barred speeds.
            pub const BARRED: BarredConfig<$number, 1> =
                BarredConfig::<$number, 1>::new(&DIESEL.barred, 4.0 * DIESEL.ramp, PERIOD, $bases);
            /// Feed-forward.
            pub const FORWARD: FeedForwardConfig<$number> = FeedForwardConfig::<$number>::new(DIESEL.share, $bases);
            /// Active damping, the hoist's.
            pub const DAMPING: ActiveDampingConfig<$number> =
                ActiveDampingConfig::<$number>::new(&Hoist::<10_000>::SPEED_LOOP, $bases);
            /// A limit either way.
            pub const SYMMETRIC: SymmetricLimitConfig<$number> =
                SymmetricLimitConfig::<$number>::new(DIESEL_TORQUE, $bases);
            /// A limit from zero on.
            pub const BETWEEN: TorqueRangeConfig<$number> =
                TorqueRangeConfig::<$number>::new(0.0, DIESEL_TORQUE, $bases);
            /// The curve.
            pub const CURVE: CurveConfig<$number, 4> = CurveConfig::<$number, 4>::new(&DIESEL.curve, 0.0, $bases);
            /// The mean over a firing interval.
            pub const MEAN: MovingAverageConfig<$number, FIRING> = MovingAverageConfig::<$number, FIRING>::of_ticks();
            /// Slew, from nothing to the rated torque in 50 ms.
            pub const SLEW: SlewConfig<$number, SymmetricLimitConfig<$number>> =
                SlewConfig::<$number, _>::new(20.0 * DIESEL_TORQUE, SYMMETRIC, PERIOD, $bases);
            /// Modes that the bench's wandering inputs do not trip.
            pub const WIDE: SequencerConfig<$number> = SequencerConfig::<$number>::new(
                &SequencerSettings {
                    overspeed: 1.9 * RATED_SPEED,
                    underspeed: -1.0,
                    reverse: 1.9 * RATED_SPEED,
                    shaft_torque: 3.0 * DIESEL_TORQUE,
                    ..SequencerSettings::of(&DIESEL.rating())
                },
                PERIOD,
                $bases,
            );
        }
    };
}

parts!(single, f32, Bases::SI);
parts!(fixed, Fixed, DIESEL.bases());
