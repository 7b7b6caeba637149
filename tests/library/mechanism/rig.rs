//! Drawn mechanisms of all five laws, with the truth from the full solver's ways: Fourier series of positions, where the
//! library differentiates closed forms.

use std::f64::consts::TAU;

use driveline::machine::{CrankSlider, FourBar, Inertia, Length, Mass, Mechanism, Toggle};
use driveline_solver::noise::Noise;
use driveline_solver::plant::train::{FourBar as Bars, Harmonic, Orders, Toggle as Knee};

use crate::runge_kutta;

pub const LAWS: [&str; 5] = ["slider-crank", "four-bar", "toggle", "cam", "table"];

/// A drawn mechanism and its truth.
pub struct Drawn {
    pub mechanism: Mechanism,
    /// Inertia (kg m2) and the tool's way (m) over the angle.
    pub inertia: Orders,
    pub way: Orders,
}

/// A uniform number between two.
pub fn between(noise: &mut Noise, low: f64, high: f64) -> f64 {
    low + 0.5 * (high - low) * (1.0 + noise.uniform())
}

/// A series of so many orders whose coefficients fall off with the square of the order.
fn series(noise: &mut Noise, mean: f64, swing: f64, orders: u32) -> Orders {
    let mut one = |order: u32| {
        let size = swing / f64::from(order.max(1)).powi(2);
        let [cosine, sine] = [0, 1].map(|_| if order == 0 { 0.0 } else { between(noise, -size, size) });
        Harmonic { order: f64::from(order), cosine: if order == 0 { mean } else { cosine }, sine }
    };
    Orders((0..=orders).map(&mut one).collect())
}

fn values<const K: usize>(of: &Orders) -> [f64; K] {
    std::array::from_fn(|k| of.at(TAU * k as f64 / K as f64))
}

/// Bars whose crank turns round with a margin of a tenth.
fn bars(noise: &mut Noise) -> Bars {
    loop {
        let [coupler, rocker, ground] = [0, 1, 2].map(|_| between(noise, 0.2, 0.5));
        let bars = Bars { crank: between(noise, 0.04, 0.15), coupler, rocker, ground };
        let longest = coupler.max(rocker).max(ground);
        let others = coupler + rocker + ground - longest;
        if bars.is_crank_rocker() && bars.crank + longest < 0.85 * others {
            return bars;
        }
    }
}

/// A mechanism of a law, drawn.
pub fn draw(law: &str, noise: &mut Noise) -> Drawn {
    match law {
        "slider-crank" => {
            let r = between(noise, 0.05, 0.2);
            let l = r * between(noise, 2.5, 8.0);
            let [slider, rod] = [between(noise, 50.0, 500.0), between(noise, 1.0, 50.0)];
            let centre = l * between(noise, 0.2, 0.6);
            let about = between(noise, 0.02, 0.1) * rod * l * l;
            let crank = CrankSlider {
                radius: Length(r),
                rod: Length(l),
                crank: Inertia(0.0),
                rod_mass: Mass(rod),
                rod_centre: Length(centre),
                rod_inertia: Inertia(about),
                slider: Mass(slider),
            };
            let reach = |phi: f64| (l * l - (r * phi.sin()).powi(2)).sqrt();
            let way = Orders::sampled(|phi| r + l - r * phi.cos() - reach(phi));
            let x = Orders::sampled(|phi| r * phi.cos() + centre / l * reach(phi));
            let y = Orders::sampled(|phi| (1.0 - centre / l) * r * phi.sin());
            let lean = Orders::sampled(|phi| (r / l * phi.sin()).asin());
            let inertia = Orders::inertia(&[(slider, &way), (rod, &x), (rod, &y), (about, &lean)]);
            Drawn { mechanism: Mechanism::slider_crank(&crank), inertia, way }
        }
        "four-bar" | "toggle" => {
            let bars = bars(noise);
            let centre = bars.coupler * between(noise, 0.2, 0.8);
            let [mass, about, rocker] =
                [between(noise, 1.0, 20.0), between(noise, 0.01, 0.3), between(noise, 1.0, 10.0)];
            let linkage = FourBar {
                coupler_mass: Mass(mass),
                coupler_centre: Length(centre),
                coupler_inertia: Inertia(about),
                ..FourBar::massless(
                    Length(bars.crank),
                    Length(bars.coupler),
                    Length(bars.rocker),
                    Length(bars.ground),
                    Inertia(rocker),
                )
            };
            let [theta, psi] = [0, 1].map(|bar| Orders::sampled(|phi| bars.angles(phi)[bar]));
            let x = Orders::sampled(|phi| bars.crank * phi.cos() + centre * bars.angles(phi)[0].cos());
            let y = Orders::sampled(|phi| bars.crank * phi.sin() + centre * bars.angles(phi)[0].sin());
            let mut parts = vec![(mass, &x), (mass, &y), (about, &theta), (rocker, &psi)];
            if law == "four-bar" {
                let inertia = Orders::inertia(&parts);
                return Drawn { mechanism: Mechanism::four_bar(&linkage), inertia, way: psi };
            }
            let (link, direction) = (bars.rocker * between(noise, 1.2, 2.5), between(noise, 0.0, TAU));
            let knee = Knee { bars, link, direction };
            let way = Orders::sampled(|phi| knee.way(phi));
            let slider = between(noise, 10.0, 200.0);
            parts.push((slider, &way));
            let inertia = Orders::inertia(&parts);
            let toggle = Toggle { bars: linkage, link: Length(link), direction, slider: Mass(slider) };
            Drawn { mechanism: Mechanism::toggle(&toggle), inertia, way }
        }
        "cam" => {
            let (way, mass) = (series(noise, 0.1, 0.05, 6), between(noise, 20.0, 200.0));
            let mechanism = Mechanism::cam(&values::<33>(&way), Mass(mass));
            Drawn { mechanism, inertia: Orders::inertia(&[(mass, &way)]), way }
        }
        _ => {
            let (inertia, way) = (series(noise, 5.0, 1.5, 8), series(noise, 0.0, 0.1, 8));
            let mechanism = Mechanism::table(&values::<65>(&inertia), &values::<65>(&way));
            Drawn { mechanism, inertia, way }
        }
    }
}

/// A rigid machine with a drawn mechanism behind a gear of 10, weight and viscous friction: own Runge-Kutta integration
/// of order four, four steps a tick.
pub struct Machine {
    /// Inertia and its derivative, torque of the weight: at even angles of a turn, 4096 of them.
    table: Vec<[f64; 3]>,
    /// Inertia at the motor that does not change.
    pub constant: f64,
    /// Viscous friction at the motor (N m s/rad).
    pub viscous: f64,
    /// Load at the motor (N m).
    pub load: f64,
    pub angle: f64,
    pub speed: f64,
}

pub const RATIO: f64 = 10.0;

impl Machine {
    /// With as much inertia at the motor as the mechanism has in the mean, times `flywheel`, and a weight.
    pub fn new(drawn: &Drawn, flywheel: f64, weight: f64) -> Self {
        const PLACES: usize = 4096;
        let (slope, leverage) = (drawn.inertia.slope(), drawn.way.slope());
        let at = |k: usize| TAU * k as f64 / PLACES as f64;
        let row = |k: usize| {
            let phi = at(k);
            [drawn.inertia.at(phi) / 100.0, slope.at(phi) / 1000.0, weight * leverage.at(phi) / RATIO]
        };
        let table: Vec<_> = (0..PLACES).map(row).collect();
        let mean = table.iter().map(|row| row[0]).sum::<f64>() / PLACES as f64;
        Machine { table, constant: flywheel * mean, viscous: 0.0, load: 0.0, angle: 0.0, speed: 0.0 }
    }

    /// Inertia at the motor, its derivative, torque of the weight. Straight between 4096 angles: 3e-7 of an amplitude
    /// for each square of its order.
    pub fn at(&self, angle: f64) -> [f64; 3] {
        let place = (angle / RATIO / TAU).rem_euclid(1.0) * self.table.len() as f64;
        let (index, part) = (place as usize % self.table.len(), place.fract());
        let (from, to) = (self.table[index], self.table[(index + 1) % self.table.len()]);
        let [inertia, slope, weight] = [0, 1, 2].map(|k| from[k] + part * (to[k] - from[k]));
        [self.constant + inertia, slope, weight]
    }

    /// Largest torque of inertia and weight at a speed of the motor.
    pub fn most_taken(&self, speed: f64) -> f64 {
        self.table.iter().map(|row| (0.5 * row[1] * speed * speed + row[2]).abs()).fold(0.0, f64::max)
    }

    pub fn tick(&mut self, torque: f64, period: f64) {
        let h = period / 4.0;
        let rates = |[angle, speed]: [f64; 2]| {
            let [inertia, slope, weight] = self.at(angle);
            let taken = 0.5 * slope * speed * speed + weight + self.load + self.viscous * speed;
            [speed, (torque - taken) / inertia]
        };
        let state = (0..4).fold([self.angle, self.speed], |state, _| runge_kutta::step(state, h, rates));
        [self.angle, self.speed] = state;
    }

    /// What an encoder of 2^17 counts shows (2^-32 turn).
    pub fn seen(&self) -> u32 {
        (((self.angle / TAU * 131_072.0).round() as i64) << 15) as u32
    }
}
