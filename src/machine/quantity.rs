//! Quantities with their units. The number inside is public and in SI units.

macro_rules! quantity {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        #[cfg_attr(feature = "defmt", derive(defmt::Format))]
        pub struct $name(pub f64);
    )*};
}

quantity! {
    /// Moment of inertia (kg m2) on its own shaft.
    ///
    /// ```
    /// use driveline::machine::{Chain, Inertia};
    /// // a steel disc of 100 kg and 0.4 m diameter: m r^2/2, keyed to the shaft of a motor
    /// const DISC: Inertia = Inertia(100.0 * 0.2 * 0.2 / 2.0);
    /// assert_eq!(Chain::motor(Inertia(0.6)).rotor(DISC).total_inertia(), 2.6);
    /// ```
    Inertia,
    /// Stiffness: (N m/rad) of a shaft on its own speed, (N/m) of a rope at the load.
    ///
    /// ```
    /// use driveline::machine::{Chain, Damping, Inertia, Stiffness};
    /// // a coupling that twists by 0.01 rad under 200 N m joins two rotors of 1 kg m2: sqrt(2 k/J)
    /// const COUPLING: Stiffness = Stiffness(200.0 / 0.01);
    /// const PAIR: Chain = Chain::motor(Inertia(1.0)).shaft(COUPLING, Damping(0.0)).rotor(Inertia(1.0));
    /// assert!((PAIR.modes().resonances()[0].frequency - 200.0).abs() < 1e-9); // rad/s
    /// ```
    Stiffness,
    /// Viscous damping of a shaft (N m s/rad) on its own speed.
    ///
    /// ```
    /// use driveline::machine::{Damping, Inertia, Stiffness, TwoMass};
    /// // of a shaft with a damping ratio of 2 %: d = 2 zeta sqrt(k J), J = 0.25 kg m2 the reduced inertia
    /// const SHAFT: Damping = Damping(2.0 * 0.02 * 50.0);
    /// let machine = TwoMass::new(Inertia(0.5), Inertia(0.5), Stiffness(1.0e4), SHAFT);
    /// assert!((machine.damping_ratio() - 0.02).abs() < 1e-12);
    /// ```
    Damping,
    /// Viscous damping of a rope (N s/m) along the travel of the load.
    ///
    /// ```
    /// use driveline::machine::{Chain, Diameter, Efficiency, Falls, Inertia, LinearDamping, Mass, Ratio, Stiffness};
    /// // a rope of 2e5 N/m and 500 N s/m; one radian of the motor lifts by 0.4 m/20 = 0.02 m
    /// const HOIST: Chain = Chain::motor(Inertia(0.6))
    ///     .gear(Ratio(20.0), Efficiency(0.95)).drum(Diameter(0.8))
    ///     .damped_rope(Falls(1), Stiffness(2.0e5), LinearDamping(500.0)).lifted(Mass(5000.0));
    /// assert!((HOIST.shafts()[0].damping - 500.0 * 0.02 * 0.02).abs() < 1e-12); // N m s/rad at the motor
    /// ```
    LinearDamping,
    /// Ratio of a gear: speed of the motor's side over speed of the load's side, above 0.
    ///
    /// ```
    /// use driveline::machine::{Chain, Efficiency, Inertia, Ratio};
    /// // behind a gear of 5 an inertia of 12.5 kg m2 is 12.5/5^2 = 0.5 kg m2 at the motor
    /// const ROLL: Chain = Chain::motor(Inertia(0.5)).gear(Ratio(5.0), Efficiency(1.0)).rotor(Inertia(12.5));
    /// assert_eq!(ROLL.total_inertia(), 1.0);
    /// ```
    Ratio,
    /// Efficiency, above 0 and at most 1.
    ///
    /// ```
    /// use driveline::machine::{Chain, Efficiency, Inertia, Ratio};
    /// // two stages of 97 %
    /// const STAGE: Efficiency = Efficiency(0.97);
    /// const GEAR: Chain =
    ///     Chain::motor(Inertia(0.5)).gear(Ratio(4.0), STAGE).gear(Ratio(3.0), STAGE).rotor(Inertia(9.0));
    /// assert!((GEAR.efficiency() - 0.9409).abs() < 1e-12 && GEAR.ratio() == 12.0);
    /// ```
    Efficiency,
    /// Diameter of a drum, pinion, wheel or shaft (m).
    ///
    /// ```
    /// use driveline::machine::{Chain, Diameter, Efficiency, Inertia, Ratio};
    /// // one radian of the motor winds up half the diameter over the ratio
    /// const DRUM: Chain = Chain::motor(Inertia(0.6)).gear(Ratio(20.0), Efficiency(0.95)).drum(Diameter(0.8));
    /// assert!((DRUM.travel_per_angle() - 0.02).abs() < 1e-15); // m/rad
    /// ```
    Diameter,
    /// Mass (kg).
    ///
    /// ```
    /// use driveline::machine::{Chain, Diameter, Efficiency, Falls, Inertia, Mass, Ratio, Stiffness};
    /// const HOIST: Chain = Chain::motor(Inertia(0.6)).gear(Ratio(20.0), Efficiency(1.0)).drum(Diameter(0.8))
    ///     .rope(Falls(1), Stiffness(2.0e5)).lifted(Mass(5000.0));
    /// // 5 t on 0.02 m a radian: an inertia of m r^2, a torque of m g r
    /// assert!((HOIST.total_inertia() - (0.6 + 5000.0 * 0.02 * 0.02)).abs() < 1e-12);
    /// assert!((HOIST.gravity_torque() - 5000.0 * 9.80665 * 0.02).abs() < 1e-9);
    /// ```
    Mass,
    /// Free travel of a backlash (rad) on its own shaft: the whole gap, not half of it.
    ///
    /// ```
    /// use driveline::machine::{Chain, Damping, Efficiency, Gap, Inertia, Ratio, Stiffness};
    /// // 2 mrad between the teeth of the slow shaft are 10 mrad at the motor
    /// const MILL: Chain = Chain::motor(Inertia(0.5)).gear(Ratio(5.0), Efficiency(1.0))
    ///     .backlash(Gap(0.002)).shaft(Stiffness(9.0e4), Damping(10.0)).rotor(Inertia(12.0));
    /// assert!((MILL.total_gap() - 0.010).abs() < 1e-15);
    /// ```
    #[doc(alias("backlash", "play"))]
    Gap,
    /// Travel along a straight line, or length of a shaft, connecting rod or pendulum (m).
    ///
    /// ```
    /// use core::f64::consts::PI;
    /// use driveline::machine::{CrankSlider, Inertia, Length, Mass};
    /// // from one dead centre to the other the slider travels twice the radius
    /// const SLIDER: CrankSlider = CrankSlider::massless_rod(Length(0.1), Length(0.4), Inertia(1.0), Mass(5.0));
    /// assert!((SLIDER.travel(PI).travel - 0.2).abs() < 1e-12);
    /// ```
    Length,
    /// Torque (N m).
    ///
    /// ```
    /// use driveline::machine::{Speed, Torque};
    /// // from the name plate: 75 kW at 1480 r/min
    /// const SPEED: Speed = Speed::rpm(1480.0);
    /// const RATED: Torque = Torque(75_000.0 / SPEED.0);
    /// assert!((RATED.0 - 9550.0 * 75.0 / 1480.0).abs() < 0.1);
    /// ```
    Torque,
    /// Angular speed (rad/s).
    ///
    /// ```
    /// use driveline::machine::Speed;
    /// // 3000 r/min are 50 turns a second, 2 pi rad each
    /// assert!((Speed::rpm(3000.0).0 - 314.16).abs() < 0.01);
    /// ```
    Speed,
    /// Shear modulus of a material (Pa).
    ///
    /// ```
    /// use core::f64::consts::PI;
    /// use driveline::machine::{Diameter, Length, Section, ShearModulus};
    /// // 1 m of solid steel shaft, 80 mm: G pi D^4/(32 l)
    /// const STEEL: ShearModulus = ShearModulus(81.0e9);
    /// const SHAFT: Section = Section::solid(Length(1.0), Diameter(0.08));
    /// assert!((SHAFT.stiffness(STEEL).0 / (81.0e9 * PI * 0.08_f64.powi(4) / 32.0) - 1.0).abs() < 1e-12);
    /// ```
    ShearModulus,
    /// Density of a material (kg/m3).
    Density,
}

impl Speed {
    /// From r/min.
    #[doc(alias = "r/min")]
    #[must_use]
    pub const fn rpm(speed: f64) -> Speed {
        Speed(speed * (core::f64::consts::TAU / 60.0))
    }
}

/// Falls of a rope: how many parts carry the load, at least 1. The load travels `1/falls` of the rope wound by the
/// drum.
///
/// ```
/// use driveline::machine::{Chain, Diameter, Efficiency, Falls, Inertia, Mass, Ratio, Stiffness};
/// // four falls: a quarter of the travel, and so a quarter of the weight at the motor
/// const HOIST: Chain = Chain::motor(Inertia(0.6)).gear(Ratio(20.0), Efficiency(1.0)).drum(Diameter(0.8))
///     .rope(Falls(4), Stiffness(8.0e5)).lifted(Mass(20_000.0));
/// assert!((HOIST.gravity_torque() - 20_000.0 * 9.80665 * 0.005).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Falls(pub u32);
