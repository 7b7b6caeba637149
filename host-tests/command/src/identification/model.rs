//! Two masses with friction, as their motor feels them at a frequency.

use nalgebra::Complex;

/// Two masses on a shaft, the viscous friction of each, and the dead time of the torque.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Model {
    /// Inertia on the motor's side (kg m2).
    pub motor: f64,
    /// Inertia on the load's side (kg m2).
    pub load: f64,
    /// Stiffness of the shaft (N m/rad).
    pub stiffness: f64,
    /// Damping of the shaft (N m s/rad).
    pub damping: f64,
    /// Viscous friction of motor and load (N m s/rad).
    pub friction: [f64; 2],
    /// Time by which the torque acts after its sample (s).
    pub delay: f64,
    /// A third mass behind the load.
    pub third: Option<Third>,
}

/// A mass on a shaft behind the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Third {
    /// Inertia (kg m2).
    pub inertia: f64,
    /// Stiffness of its shaft (N m/rad).
    pub stiffness: f64,
    /// Damping of its shaft (N m s/rad).
    pub damping: f64,
}

/// The motion that was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Angle: in a recording the mean speed since the sample before.
    Angle,
    Speed,
    Acceleration,
}

impl std::fmt::Display for Motion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Angle => "angle",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
        })
    }
}

/// The torque between two samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Torque {
    /// At one frequency: the table of a response.
    Sine,
    /// As smooth as its samples allow: a measured current.
    Smooth,
    /// Constant from each sample to the next: a command.
    Held,
}

/// The images of a held torque, about multiples of the sample rate either way, that feel the shaft.
const IMAGES: i32 = 2;

impl Model {
    /// The moment of inertia that the shaft twists against (kg m2).
    #[must_use]
    pub fn reduced(&self) -> f64 {
        self.motor * self.load / (self.motor + self.load)
    }

    /// Resonance, without damping (rad/s).
    #[must_use]
    pub fn resonance(&self) -> f64 {
        (self.stiffness / self.reduced()).sqrt()
    }

    /// Antiresonance, without damping (rad/s).
    #[must_use]
    pub fn antiresonance(&self) -> f64 {
        (self.stiffness / self.load).sqrt()
    }

    /// The damping of a shaft that would take as much from the swing as this one and the friction together
    /// (N m s/rad).
    #[must_use]
    pub fn swing_damping(&self) -> f64 {
        let share = self.load / (self.motor + self.load);
        self.damping + self.friction[0] * share * share + self.friction[1] * (1.0 - share) * (1.0 - share)
    }

    /// Damping ratio of the resonance.
    #[must_use]
    pub fn damping_ratio(&self) -> f64 {
        0.5 * self.swing_damping() / (self.reduced() * self.resonance())
    }

    /// The motor's speed per torque (rad/s per N m) at `s`, as numerator and denominator.
    fn speed(&self, s: Complex<f64>) -> [Complex<f64>; 2] {
        let load = s * self.load + self.friction[1];
        // the torque on the load per its speed
        let [over, under] = match self.third {
            None => [load, Complex::new(1.0, 0.0)],
            Some(Third { inertia, stiffness, damping }) => {
                let shaft = s * damping + stiffness;
                let free = shaft + s * s * inertia;
                [load * free + shaft * s * inertia, free]
            }
        };
        let shaft = s * self.damping + self.stiffness;
        let twisted = shaft * under + s * over;
        [twisted, (s * self.motor + self.friction[0]) * twisted + shaft * over]
    }

    /// The motor's speed (rad/s) per radian by which the shaft's halves shift against each other, at `s`.
    #[must_use]
    pub fn speed_by_shift(&self, s: Complex<f64>) -> Complex<f64> {
        let load = s * self.load + self.friction[1];
        s * load * (s * self.damping + self.stiffness) / self.speed(s)[1]
    }

    /// The motion per sample of the torque at a frequency (rad/s); samples are `period` (s) apart.
    #[must_use]
    pub fn response(&self, frequency: f64, motion: Motion, torque: Torque, period: f64) -> Complex<f64> {
        let one = Complex::new(1.0, 0.0);
        let at = |image: i32| {
            let s = Complex::new(0.0, frequency + f64::from(image) * std::f64::consts::TAU / period);
            // a value held from one sample to the next, and the mean from one to the next
            let held = || (one - (-s * period).exp()) / (s * period);
            let motion = match (motion, torque) {
                (Motion::Angle, Torque::Sine) => s.inv(),
                (Motion::Angle, _) => held(),
                (Motion::Speed, _) => one,
                (Motion::Acceleration, _) => s,
            };
            let hold = if torque == Torque::Held { held() } else { one };
            let [over, under] = self.speed(s);
            over / under * motion * hold * (-s * self.delay).exp()
        };
        match torque {
            Torque::Held => {
                (-IMAGES..=IMAGES).map(at).sum::<Complex<f64>>() + self.far_images(frequency, motion, period)
            }
            _ => at(0),
        }
    }

    /// The sum of the other images of a held torque in the speed: at such frequencies there is but the motor's inertia.
    /// All of them together are `sum 1/(w + m w_s)^2 = (T/2)^2/sin^2(w T/2)`; in an angle they cancel.
    fn far_images(&self, frequency: f64, motion: Motion, period: f64) -> Complex<f64> {
        if motion != Motion::Speed {
            return Complex::new(0.0, 0.0);
        }
        let half = 0.5 * period;
        let all = (half / (half * frequency).sin()).powi(2);
        let near = |image: i32| (frequency + f64::from(image) * std::f64::consts::TAU / period).powi(-2);
        let far = all - (-IMAGES..=IMAGES).map(near).sum::<f64>();
        let s = Complex::new(0.0, frequency);
        ((-s * period).exp() - 1.0) * (-s * self.delay).exp() * (far / (period * self.motor))
    }

    /// What is left of the state before and after a recording: `s^j` over the characteristic polynomial, of size one
    /// about the resonance.
    #[must_use]
    pub fn transient(&self, frequency: f64) -> Vec<Complex<f64>> {
        let (s, unit) = (Complex::new(0.0, frequency), self.resonance());
        let mass = self.third.map_or(1.0, |third| third.inertia * unit * unit);
        let first = self.speed(s)[1].inv() * (self.motor * self.load * mass * unit * unit * unit);
        let power = |power: &Complex<f64>| Some(power * s / unit);
        std::iter::successors(Some(first), power).take(self.transients()).collect()
    }

    /// Coefficients of a transient: the states, and two for the sampling.
    #[must_use]
    pub const fn transients(&self) -> usize {
        if self.third.is_some() { 7 } else { 5 }
    }

    /// Resonances of three masses without damping (rad/s), the lower one first: the roots of
    /// `w^4 - (a + b) w^2 + c`, with a and b the squares of both shafts' own.
    #[must_use]
    pub fn resonances(&self) -> Option<[f64; 2]> {
        let third = self.third?;
        let sum = self.stiffness * (1.0 / self.motor + 1.0 / self.load)
            + third.stiffness * (1.0 / self.load + 1.0 / third.inertia);
        let all = self.motor + self.load + third.inertia;
        let product = self.stiffness * third.stiffness * all / (self.motor * self.load * third.inertia);
        let half = (0.25 * sum * sum - product).max(0.0).sqrt();
        Some([-half, half].map(|half| (0.5 * sum + half).sqrt()))
    }
}
