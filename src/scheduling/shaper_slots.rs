//! Slots of an input shaper over the length of the rope.

use super::grid::Breakpoints;
use crate::design::InputShaperDesign;
use crate::machine::Length;
use crate::number::Interpolate;

/// Ticks of an [`InputShaper`](crate::governor::InputShaper)'s slot over the length of the rope, for
/// [`InputShaperConfig::slot`](crate::governor::InputShaperConfig::slot).
///
/// To be taken while the setpoint has stood for the shaper's delay, as before a travel: then all parts are alike, and
/// another slot changes nothing of them.
///
/// ```
/// use driveline::design::InputShaperDesign;
/// use driveline::machine::Length;
/// use driveline::scheduling::ShaperSlots;
/// // 16 slots between two parts at 1 kHz: half a period of a rope of 10 m is 3.172 s
/// const SHAPER: InputShaperDesign = InputShaperDesign::pendulum(Length(10.0));
/// const SLOTS: ShaperSlots<3> = ShaperSlots::new(&SHAPER, Length(10.0), [8.0, 10.0, 12.0], 16, 1e-3);
/// assert_eq!([8.0, 10.0].map(|rope| SLOTS.at(rope)), [177, 198]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ShaperSlots<const K: usize> {
    ropes: Breakpoints<K>,
    slots: [u32; K],
}

impl<const K: usize> ShaperSlots<K> {
    /// A `design` for a `rope` at other lengths of it (m, rising), with so many `slots` between two parts and ticks of
    /// `period` (s).
    ///
    /// # Panics
    /// At compile time in a constant, with the sentence that [`try_new`](Self::try_new) returns.
    #[must_use]
    pub const fn new(design: &InputShaperDesign, rope: Length, ropes: [f64; K], slots: u32, period: f64) -> Self {
        match Self::try_new(design, rope, ropes, slots, period) {
            Ok(table) => table,
            Err(sentence) => panic!("{}", sentence),
        }
    }

    /// [`new`](Self::new), with the sentence instead of a panic.
    ///
    /// # Errors
    /// For lengths that [`Breakpoints`] refuses or that are not positive, and slots that are not near a whole number of
    /// ticks.
    pub const fn try_new(
        design: &InputShaperDesign,
        rope: Length,
        ropes: [f64; K],
        slots: u32,
        period: f64,
    ) -> Result<Self, &'static str> {
        let axis = get!(Breakpoints::try_new(ropes));
        let mut found = [0; K];
        each!(k, 0..K, {
            let design = match design.try_at_rope(rope, Length(ropes[k])) {
                Ok(design) => design,
                Err(error) => return Err(error.message()),
            };
            found[k] = match design.slot(slots, period) {
                Some(slot) => slot,
                None => {
                    return Err("the slots of an input shaper must be nearly whole ticks at every length of the rope");
                }
            };
        });
        Ok(Self { ropes: axis, slots: found })
    }

    /// The slot (ticks) at a length of the rope (m), by straight lines, to the nearest tick; at the end for a length
    /// beyond it. Between two lengths with the ratio q the line lies below the root by at most
    /// `(q^(1/4) - 1)^2/(1 + q^(1/2))` of it, 0.16 % at q = 1.25.
    #[must_use]
    pub fn at(&self, rope: f32) -> u32 {
        let (below, weight) = self.ropes.place(rope);
        match (self.slots.get(below), self.slots.get(below + 1)) {
            // twice the slot, so that half a tick can be added
            (Some(low), Some(high)) => (2 * low).between(&(2 * high), weight).div_ceil(2),
            _ => self.slots.first().copied().unwrap_or(1),
        }
    }
}
