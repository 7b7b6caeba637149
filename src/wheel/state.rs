//! The state of a wheel, and what is known of its place.

use super::check::Check;
use super::cycle::{CycleTimes, ToothCycle, ToothRecord};
use super::phase::Phase;
use super::place::Search;
use super::track::Track;

/// How far the wheel is synchronized with its teeth: how much is known of the place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Synchronization {
    /// Not known.
    #[default]
    Searching,
    /// One place is left, and is being checked.
    Checking,
    /// Known.
    Known,
}

/// What has to be seen again before the angle of a known place is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) enum Open {
    /// Nothing.
    Nothing,
    /// One tooth, or two in a row, a quarter of a pitch at most from where and after how long they were expected: until
    /// then a tooth without an edge may have been a slower speed.
    Tooth,
    Teeth,
    /// The place, from intervals that exclude all others: the machine may have turned back, or the teeth contradict it.
    Place,
}

/// A toothed wheel. Its angle is that of [`crate::settings::Teeth`]. `R` is what it records: nothing, or
/// [`CycleTimes`].
///
/// ```
/// use driveline::settings::{Teeth, ToothClock};
/// use driveline::wheel::{Synchronization, ToothedWheel, ToothedWheelConfig};
/// const CONFIG: ToothedWheelConfig<58> =
///     ToothedWheelConfig::new(&Teeth::gap(60, 2), ToothClock { turns: 1, clock: 6e6, lowest_speed: 10.0 });
/// let mut wheel = ToothedWheel::<()>::default();
/// // three turns at 100 turns a second, 1000 counts from tooth to tooth; then half a tooth behind the tenth
/// for place in (0..60 * 3 + 11_u32).filter(|place| place % 60 < 58) {
///     wheel.tooth(&CONFIG, 1000 * place);
/// }
/// assert_eq!(wheel.synchronization(), Synchronization::Known);
/// let turn = wheel.at(&CONFIG, 1000 * (60 * 3 + 10) + 500)?.angle as f64 / 4_294_967_296.0;
/// assert!((turn - 10.5 / 60.0).abs() < 1.0 / 60_000.0); // a count of the clock
/// # Ok::<(), driveline::fault::Faults>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[doc(alias("tachometer", "crankshaft sensor", "60-2"))]
pub struct ToothedWheel<R = ()> {
    /// The last edge that was taken, and the time from the one before; 0 where there is none.
    pub(super) last: u32,
    pub(super) interval: u32,
    pub(super) search: Search,
    pub(super) synchronization: Synchronization,
    pub(super) trust: u32,
    pub(super) open: Open,
    /// The last tooth, and its number in the cycle. While the place is not known, one more with each edge.
    pub(super) place: u32,
    pub(super) in_cycle: u32,
    pub(super) track: Track,
    /// Edges too many and teeth without an edge.
    pub(super) doubts: u32,
    /// An edge too many has come since the last tooth.
    pub(super) extra: bool,
    /// The last edge is a tooth, with no edge too many before it.
    pub(super) firm: bool,
    pub(super) good: u32,
    pub(super) check: Check,
    /// Span of the last tooth that was checked.
    pub(super) span: u32,
    pub(super) cam: Phase,
    pub(super) record: R,
}

impl<R: ToothRecord + Default> Default for ToothedWheel<R> {
    fn default() -> Self {
        ToothedWheel {
            last: 0,
            interval: 0,
            search: Search::NEW,
            synchronization: Synchronization::Searching,
            trust: 0,
            open: Open::Nothing,
            place: 0,
            in_cycle: 0,
            track: Track::NEW,
            doubts: 0,
            extra: false,
            firm: false,
            good: 0,
            check: Check::NEW,
            span: 0,
            cam: Phase::NEW,
            record: R::default(),
        }
    }
}

impl<R: ToothRecord> ToothedWheel<R> {
    /// The wheel stands, the capture has timed out, edges were missed: the place is looked for anew.
    pub fn lose(&mut self) {
        self.synchronization = Synchronization::Searching;
        self.search = Search::NEW;
        self.interval = 0;
        self.record.lost();
    }

    /// Whether the place is known.
    pub fn synchronization(&self) -> Synchronization {
        if self.synchronization == Synchronization::Known && self.open == Open::Place {
            Synchronization::Checking
        } else {
            self.synchronization
        }
    }
}

impl<const TEETH: usize> ToothedWheel<CycleTimes<TEETH>> {
    /// Takes the last finished cycle, once. Call it with the capture's interrupt off, once a cycle at least:
    /// [`ToothCycle::number`] shows cycles that were missed.
    pub fn take(&mut self) -> Option<ToothCycle<TEETH>> {
        self.record.take()
    }
}
