//! Windows of steady speed, and pairs of them in opposite directions.

/// Change of the speed within a window, as a fraction.
const STEADY_SPEED: f32 = 0.01;
/// Difference of the speeds of a pair, as a fraction.
const SAME_SPEED: f32 = 0.2;

/// A window that has passed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Steady {
    /// That it is steady about (rad/s).
    pub speed: f32,
    /// At its end (rad/s).
    pub end: f32,
    /// Change of the speed over it (rad/s).
    pub change: f32,
    /// Mean (N m).
    pub torque: f32,
    /// Difference of the means of its two halves (N m).
    pub drift: f32,
}

/// A window that is being filled.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Window {
    count: u32,
    /// That the others are compared with.
    speed: f32,
    /// At the beginning.
    first: f32,
    /// Of the two halves.
    sums: [f32; 2],
}

impl Window {
    /// Takes a torque (N m) and a speed (rad/s), both finite; the window that they complete.
    pub fn update(&mut self, length: u32, least_speed: f32, torque: f32, speed: f32) -> Option<Steady> {
        let changed = (speed - self.speed).abs() > STEADY_SPEED * self.speed.abs();
        if changed || speed.abs() < least_speed {
            *self = Window { speed, ..Window::default() };
            return None;
        }
        if self.count == 0 {
            self.first = speed;
        }
        let half = length / 2;
        let [first, second] = &mut self.sums;
        *(if self.count < half { first } else { second }) += torque;
        self.count += 1;
        if self.count < 2 * half {
            return None;
        }
        let [first, second] = self.sums.map(|sum| sum / half as f32);
        (self.count, self.sums) = (0, [0.0; 2]);
        Some(Steady {
            speed: self.speed,
            end: speed,
            change: speed - self.first,
            torque: 0.5 * (first + second),
            drift: (first - second).abs(),
        })
    }
}

/// Pairs of windows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Pairs {
    last: Option<Steady>,
    /// Updates since.
    age: u32,
}

impl Pairs {
    /// An update has passed: a window older than the pause has no partner.
    pub fn age(&mut self, pause: u32) {
        self.age = self.age.saturating_add(1);
        if self.age > pause {
            self.last = None;
        }
    }

    /// The window with the one before, where they are of opposite directions and nearly one speed.
    ///
    /// A window has one partner: a wrong one would bias two findings alike, and they would confirm each other.
    pub fn of(&mut self, now: Steady) -> Option<[Steady; 2]> {
        match self.last.take() {
            Some(last) if last.speed * now.speed < 0.0 => {
                ((last.speed + now.speed).abs() <= SAME_SPEED * last.speed.abs()).then_some([last, now])
            }
            _ => {
                (self.last, self.age) = (Some(now), 0);
                None
            }
        }
    }
}
