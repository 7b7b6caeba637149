//! Commissioning: a test sequence that identifies the machine from the motor's angle and the commanded torque alone.
//!
//! [`Commissioning`] runs in the tick and gives the torque: bounded, as is the travel. Its stages, the motor in
//! each, and the quantities identified:
//!
//! - **[`Stage::Holding`]**: the motor stands while the load settles.
//! - **[`Stage::Friction`]**: two speeds and the ramps between, both ways; total inertia, Coulomb and viscous friction,
//!   weight.
//! - **[`Stage::Encoder`]**: 8 to 40 turns at the test's speed; eccentricity of the encoder, which is then taken off.
//! - **[`Stage::Backlash`]**: the motor creeps in both directions against a load held by friction; gap.
//! - **[`Stage::Resonance`]**: the motor turns slowly under a multisine, first small, then as large as the shaft may
//!   carry, both ways; inertias, stiffness, damping.
//!
//! A stage ends with a [`Job`]: a copy of its sums, solved in `f64` outside the tick ([`Job::solve`]) while the tick
//! holds the motor, and handed back ([`Commissioning::accept`]). The last one gives [`CommissioningResult`]: the
//! two-mass machine, with standard deviations, for the same [`try_observer`](crate::machine::TwoMass::try_observer) and
//! [`try_speed_loop`](crate::machine::TwoMass::try_speed_loop) that the compiler uses; or an [`Error`] that says
//! why the data do not suffice.
//!
//! # How it is found
//! The response is correlated with the commanded torque, so that noise in the motor's torque and the encoder's counts
//! average out. While the motor turns at a speed with a slow ramp in it, counts of the encoder fall at all phases, and
//! dry friction is but a constant. The speed is held by a servo whose torque is correlated too, so that it does not
//! bias the answer. Each line of the multisine gives the response of the acceleration `H = s^2 Theta/T`, through a Hann
//! window, corrected for the hold of the torque and the mean of the angle over a block; to them
//! `H = 1/J + (1/J_m - 1/J) s^2/(s^2 + 2 zeta w_r s + w_r^2) + R s^2` is fitted, the two-mass machine
//! [derived; headings: Huang 1987 ch. 3 to 7] and the compliance R of all higher modes, with weights of noise in torque
//! and angle. Deviations follow from the fit's curvature and its own residuals.
//!
//! The gap is the angle from flank to flank at creep speed while friction holds the load. Each flank is measured under
//! two torques and extrapolated to none, which removes the twist of the shafts.
//!
//! A gear that loses a share of its torque makes the machine look heavier when it drives and lighter when it is driven
//! [Huang 1987 tables 1-2 to 1-4]: the mean of both ways is taken.
//!
//! # Bounds
//! Torque and travel stay within the [`TestSettings`], and so does the shaft, with the exceptions under Limits.
//! Before the multisine, while it is not known whether the load is free, the torque takes half of the shaft's room at
//! most, and the first run-up is gentle.
//! A motor that lags too far ([`Error::NotFollowed`]), a shaft that swings, a torque that goes from bound to bound
//! ([`Error::Unsteady`]), an angle jump or an exceeded travel ends the test without torque: the brake must hold the
//! load. Where data do not support an answer the test ends holding the load, with its [`Error`].
//!
//! # Limits
//! - The arithmetic in the tick is in `f32`: for cores with an FPU. A record's solving, in `f64`, takes 163 million
//!   instructions on a Cortex-M4F, while the tick goes on.
//! - The first guess of the total inertia must be right within a factor of two; the motor's, where no more is known.
//! - Only the lowest resonance is identified, and it must lie within the band; higher modes count as a compliance.
//! - Friction is taken as weight, Coulomb and viscous friction over the two speeds of its test.
//! - The servo takes damping from the swing: with its frequency w, a sixth of the band's lower end, and the resonance
//!   w_r a damping ratio of about `45 (w/w_r)^3 J_l/J_m`: with equal masses 1.3 % for a band that begins at 0.4 w_r,
//!   and 0.2 % for one that begins at 0.2 w_r. A shaft that has less is driven into a swing that grows. The test ends
//!   when the motor shows it ([`Error::Unsteady`]). The shaft then carries about twice `shaft_torque` if the resonance
//!   lies at two fifths of the band's upper end. It carries more if the first guess of the inertia is below the
//!   motor's. Begin the band low: at 0.2 of the resonance.
//! - All gaps are identified as one, no wider than a tenth of a turn of the motor.
//! - The gap is identified only where friction holds the load and no weight closes the gap; otherwise
//!   [`Error::LoadNotHeld`] or [`Error::Preloaded`].
//! - With a gap the multisine stays below the friction: low friction means long records.
//! - The inertia before the gap is taken to turn freely under half of the friction.
//! - Eccentricity cannot be distinguished from the torque of an unbalance: at the test's speed the rotor's own swing
//!   must be small beside it.

mod complex;
mod eccentricity;
mod error;
mod excitation;
mod figure;
mod fit;
mod friction;
mod gap;
mod harmonic;
mod job;
mod multisine;
mod reference;
mod response;
mod result;
mod sequence;
mod servo;
mod settings;
mod stage;
mod swing;

pub use eccentricity::Eccentricity;
pub use error::Error;
pub use figure::Figure;
pub use fit::{Derived, Fit, fit};
pub use friction::Friction;
pub use job::{Findings, Job};
pub use response::Response;
pub use result::CommissioningResult;
pub use sequence::Commissioning;
pub use settings::{TestConfig, TestSettings};
pub use stage::Stage;
