//! Windows of steady speed, and pairs of them in opposite directions.

/// Change of the speed within a window, as a fraction.
const STEADY_SPEED: f32 = 0.01;
/// Difference of the speeds of a pair, as a fraction.
const SAME_SPEED: f32 = 0.2;

/// Stops a constant whose interval of updates (s) or rating is out of range.
pub(super) const fn check(torque: f64, speed: f64, every: f64) {
    assert!(every > 0.0 && every <= 0.05, "a learner needs an update every 50 ms or more often");
    assert!(torque > 0.0 && speed > 0.0, "the rated torque and speed must be above zero");
}

/// Frictions per torque of a gear, (1/eta - eta)/(1/eta + eta), at the ends of a range of its efficiency.
pub(super) const fn frictions([least, most]: [f64; 2]) -> [f32; 2] {
    assert!(
        least > 0.0 && most > least && most <= 1.0,
        "the gear's efficiency must lie between two rising values above 0 and at most 1"
    );
    [((1.0 - most * most) / (1.0 + most * most)) as f32, ((1.0 - least * least) / (1.0 + least * least)) as f32]
}

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
    /// Updates so far, and those of the first half.
    counts: [f32; 2],
    /// That the others are compared with.
    speed: f32,
    /// At the beginning.
    first: f32,
    sums: [f32; 2],
}

impl Window {
    /// Takes a torque (N m) and a speed (rad/s), both finite, which stand for so many updates; the window that they
    /// complete. One that stands for a tenth of a window or more is no sample of it.
    pub fn update(&mut self, length: u32, least_speed: f32, elapsed: f32, torque: f32, speed: f32) -> Option<Steady> {
        let changed = (speed - self.speed).abs() > STEADY_SPEED * self.speed.abs();
        if changed || speed.abs() < least_speed || !(10.0 * elapsed <= length as f32) {
            *self = Window { speed, ..Window::default() };
            return None;
        }
        let [count, first_half] = self.counts;
        if count == 0.0 {
            self.first = speed;
        }
        let half = (length / 2) as f32;
        let [first, second] = &mut self.sums;
        let now = count + elapsed;
        if count < half {
            *first += torque * elapsed;
            self.counts = [now, now];
        } else {
            *second += torque * elapsed;
            self.counts = [now, first_half];
        }
        if now < 2.0 * half {
            return None;
        }
        let [first, second] = self.sums;
        let (first, second) = (first / first_half, second / (now - first_half));
        (self.counts, self.sums) = ([0.0; 2], [0.0; 2]);
        Some(Steady {
            speed: self.speed,
            end: speed,
            change: speed - self.first,
            torque: 0.5 * (first + second),
            drift: (first - second).abs(),
        })
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) struct Pairs {
    last: Option<Steady>,
    /// Updates since.
    age: f32,
}

impl Pairs {
    /// So many updates have passed: a window older than the pause has no partner.
    pub fn age(&mut self, pause: u32, elapsed: f32) {
        self.age += elapsed;
        if self.age > pause as f32 {
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
                (self.last, self.age) = (Some(now), 0.0);
                None
            }
        }
    }
}
