//! Errors in the description of a machine.

sentences! {
    /// A parameter of a machine that is out of its range, or elements in an impossible order.
    ///
    /// ```
    /// use driveline::machine::{Chain, Damping, Error, Inertia, Stiffness};
    /// // a chain carries its first error to its end
    /// let chain = Chain::motor(Inertia(0.62)).shaft(Stiffness(-900.0), Damping(0.5)).rotor(Inertia(0.35));
    /// assert_eq!(chain.error(), Some(Error::ShaftStiffness));
    /// assert!(Error::ShaftStiffness.message().starts_with("stiffness of the shaft must be positive"));
    /// ```
    Error:
    MotorInertia => "inertia of the motor must be positive and finite (kg m2)",
    RotorInertia => "inertia of the rotor must be positive and finite (kg m2)",
    LoadInertia => "inertia of the load must be positive and finite (kg m2)",
    ShaftStiffness => "stiffness of the shaft must be positive and finite (N m/rad)",
    ShaftDamping => "damping of the shaft must be zero or positive and finite (N m s/rad)",
    GearRatio => "ratio of the gear must be positive and finite (speed of the motor's side over the load's)",
    GearEfficiency => "efficiency of the gear must be above 0 and at most 1",
    PlanetaryTeeth => "teeth of the planetary set must be above zero, with more on the ring than on the sun",
    PlanetaryInertia => "inertias and masses of the planetary set must be zero or positive and finite, not all of \
        them zero, and its module positive",
    PlanetaryMembers => "the held member of the planetary set must not be its input",
    DrumDiameter => "diameter of the drum must be positive and finite (m)",
    RopeFalls => "falls of the rope must be at least 1",
    RopeStiffness => "stiffness of the rope must be positive and finite (N/m at the load)",
    RopeDamping => "damping of the rope must be zero or positive and finite (N s/m at the load)",
    HoistingRange => "lengths of the rope and loads of the hoist must be positive, finite and rise: the shortest, that \
        of its stiffness, the longest (m); the least, the largest (kg)",
    LoadMass => "mass of the load must be positive and finite (kg)",
    BacklashGap => "gap of the backlash must be zero or positive and finite (rad on its own shaft, m after a drum)",
    DrumMissing => "a rope or a mass needs a drum before it",
    RotaryAfterDrum => "a shaft, rotor, gear, angular backlash or second drum cannot follow a drum",
    TooManyMasses => "a chain holds at most 16 masses",
    OpenEnd => "a chain must end in a rotor or a mass, not in a shaft or a rope",
    BacklashAlone => "a backlash needs a shaft or a rope beside it",
    Rigid => "a chain without a shaft has no two masses: it is a rigid machine",
    CutOutOfRange => "the shaft of the textbook cut must be one of the chain's shafts, counted from 0 at the motor",
    Reduction => "two masses cannot stand for the machine: its inertias or stiffnesses differ by more than the \
        calculation can resolve",
    ShaftStiffnessNegative => "stiffness between the two masses must be zero or positive and finite (N m/rad)",
    GravityTorque => "gravity torque of the load must be finite (N m at the motor)",
    SectionDiameter => "outer diameters of the shaft's section must be positive and finite, its bore smaller than both \
        (m)",
    SectionLength => "length of the shaft's section must be positive and finite (m)",
    ShearModulus => "shear modulus must be positive and finite (Pa)",
    Density => "density must be positive and finite (kg/m3)",
    PulleyDiameter => "diameters of the belt's pulleys must be positive and finite (m)",
    BeltStiffness => "stiffness of the belt's strand must be positive and finite (N/m)",
    BeltDamping => "damping of the belt's strand must be zero or positive and finite (N s/m)",
    ScrewLead => "lead of the screw must be positive and finite (m of travel a turn)",
    PendulumLength => "length of the pendulum must be positive and finite (m)",
    CrankRadius => "radius of the crank must be positive and finite, and smaller than the length of the connecting rod \
        (m)",
    CrankMass => "masses and inertias of the crank drive must be zero or positive and finite, the connecting rod's \
        centre of mass within it",
    LinkageBars => "bars of the linkage must be positive and finite, the crank the shortest of them and with the longest \
        shorter than the other two together; a toggle's link longer than its rocker (m)",
    LinkageMass => "masses and inertias of the linkage must be zero or positive and finite, the coupler's centre of \
        mass within it",
    MechanismTable => "table of a mechanism must have an odd number of finite values at even angles of a turn, 3 or \
        more",
    MechanismInertia => "inertia of a machine with a mechanism must be positive and finite at every angle (kg m2)",
    BranchNode => "the mass that a branch or a closing shaft stands on must be one of the train's masses, counted \
        from 0 at the motor",
    TooManyShafts => "a train holds at most 30 shafts",
    TrainCut => "a train with branches has no textbook cut: match resonance and antiresonance, or keep the first mode",
    Unseen => "no mode of the train is observable at the motor: it is a rigid machine",
    DamperRing => "ring of the damper must have a positive inertia (kg m2), and a spring or a damping, zero or \
        positive (N m/rad, N m s/rad)",
    CharacteristicPoints => "speeds of the prime mover's characteristic must differ, its speeds and torques be finite",
    Overload => "overload capacity of the motor must be above 1 and finite (breakdown torque over rated torque)",
    InductionSpeed => "rated speed of the induction motor must lie between zero and its synchronous speed (rad/s)",
    DirectCurrent => "voltage, armature resistance and flux of the direct-current motor must be positive and finite \
        (V, ohm, V s or H)",
    FiringOrder => "firing order must name every cylinder once, counted from 1, and fit into two turns of the \
        crankshaft",
    Indicator => "compression ratio and polytropic exponent must be above 1, charge pressure positive, and peak \
        pressure finite and above that of the compression (Pa, absolute)",
}

impl Error {
    /// Stops with the sentence: a compile error in a constant.
    pub(crate) const fn stop(self) -> ! {
        panic!("{}", self.message())
    }
}

/// `value` is a number above zero.
pub(crate) const fn positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

/// `value` is a number, zero or above.
pub(crate) const fn not_negative(value: f64) -> bool {
    value >= 0.0 && value.is_finite()
}
