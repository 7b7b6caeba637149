//! The life of a shaft on a panel and in the telemetry: damage by the rainflow count of its torque, kept in flash.
//!
//! Once a second the panel takes the closed cycles into the record. [`SAVE`] closes the count and keeps the record:
//! before the controller is switched off. With power on again, [`Key::Resume`] adds the kept record to what has been
//! counted since; a [`SAVE`] before that adds it, too. The numbers are the bits of `f32`.

use core::marker::PhantomData;

use driveline::balancing::Balancer;
use driveline::configure::HasLife;
use driveline::drive::{ConfigOf, Drive};
use driveline::fatigue::{Classed, LifeRecord, Rainflow};
use driveline::governor::Governor;
use driveline::number::Part;
use driveline::observer::Observer;
use driveline::parameters::Store;
use driveline::telemetry::{Channel, Kind};

use super::flash_model::{self, Pages};
use crate::scene::composed::Beside;
use crate::scene::panel_keys::{DONE, Key, refused};

/// Key: damage, failure at 1.
pub const DAMAGE: u32 = 96;
/// Key: share of the life that is left.
pub const REMAINING: u32 = 97;
/// Key: the torque amplification factor, largest torque over rated torque.
pub const AMPLIFICATION: u32 = 98;
/// Key: time beyond the torque limit (s).
pub const TIME_ABOVE: u32 = 99;
/// Key: closes the count and keeps the record.
pub const SAVE: u32 = 100;

/// Channels of the telemetry, in the order of the keys.
const CHANNELS: [Channel<'static>; 4] = [
    Channel { name: "damage", unit: "", kind: Kind::Single },
    Channel { name: "remaining life", unit: "", kind: Kind::Single },
    Channel { name: "torque amplification", unit: "", kind: Kind::Single },
    Channel { name: "time above limit", unit: "s", kind: Kind::Single },
];

/// Answers: the record was not kept, none was kept.
const NOT_KEPT: u32 = refused(0);
const NOTHING_KEPT: u32 = refused(1);

/// The whole flash; a record and some bytes more.
const RANGE: core::ops::Range<u32> = 0..4 * flash_model::WORDS as u32;
const BYTES: usize = 64;

/// The record of the machine `M`, and the flash that keeps it.
pub struct LifePanel<M> {
    life: LifeRecord,
    /// Whether the kept record is in it: it is added once.
    resumed: bool,
    ticks: u32,
    flash: Pages,
    /// Where the next word is put.
    place: u32,
    machine: PhantomData<M>,
}

impl<M: HasLife> LifePanel<M> {
    #[inline(never)]
    fn save(&mut self) -> u32 {
        self.resume();
        let life = &self.life;
        match Store::new(&mut self.flash, RANGE).and_then(|mut store| store.save(life, &mut [0; BYTES])) {
            Ok(()) => {
                self.resumed = true;
                DONE
            }
            Err(_) => NOT_KEPT,
        }
    }

    #[inline(never)]
    fn resume(&mut self) -> u32 {
        if self.resumed {
            return DONE;
        }
        let loaded = Store::new(&mut self.flash, RANGE).and_then(|mut store| store.load(&mut [0; BYTES]));
        let Some(LifeRecord { damage, time_above, largest }) = loaded.ok().and_then(|loaded| loaded.parameters) else {
            return NOTHING_KEPT;
        };
        self.life.damage += damage;
        self.life.time_above += time_above;
        self.life.largest = self.life.largest.max(largest);
        self.resumed = true;
        DONE
    }

    fn number(&self, key: u32) -> u32 {
        let number = match key {
            DAMAGE => self.life.damage,
            REMAINING => self.life.remaining(),
            AMPLIFICATION => self.life.largest / M::RATING.torque.0,
            TIME_ABOVE => self.life.time_above,
            _ => 0.0,
        };
        (number as f32).to_bits()
    }
}

impl<M, N, O, G, B, const CLASSES: usize> Beside<Drive<N, O, G, Rainflow<CLASSES>, B>> for LifePanel<M>
where
    M: HasLife,
    N: Classed,
    O: Part<N, State: Observer<N>>,
    G: Part<N, State: Governor<N>>,
    B: Part<N, State: Balancer<N>>,
{
    const CHANNELS: &'static [Channel<'static>] = &CHANNELS;

    fn start(_: &mut Drive<N, O, G, Rainflow<CLASSES>, B>, _: &ConfigOf<Drive<N, O, G, Rainflow<CLASSES>, B>>) -> Self {
        LifePanel {
            life: LifeRecord::default(),
            resumed: false,
            ticks: 0,
            flash: Pages::new(),
            place: 0,
            machine: PhantomData,
        }
    }

    fn panel(
        &mut self,
        drive: &mut Drive<N, O, G, Rainflow<CLASSES>, B>,
        config: &mut &'static ConfigOf<Drive<N, O, G, Rainflow<CLASSES>, B>>,
        [key, value]: [u32; 2],
    ) -> u32 {
        let (count, classes) = (drive.fluctuation_mut(), &config.fluctuation);
        self.ticks = self.ticks.wrapping_add(1);
        if self.ticks.is_multiple_of(M::RATE_HZ) {
            self.life.take(count, classes, &M::SHAFT, M::OVERLOAD);
        }
        match (key, Key::of(key)) {
            (SAVE, _) => {
                self.life.close(count, classes, &M::SHAFT, M::OVERLOAD);
                self.save()
            }
            (_, Some(Key::Resume)) => self.resume(),
            (_, Some(Key::FlashWord)) => self.flash.word(value),
            (_, Some(Key::PutPlace)) => {
                self.place = value;
                DONE
            }
            (_, Some(Key::PutWord)) => {
                let put = self.flash.put(self.place, value);
                self.place = self.place.saturating_add(1);
                if put { DONE } else { NOT_KEPT }
            }
            _ => self.number(key),
        }
    }

    fn channel(&self, index: usize) -> u32 {
        self.number(DAMAGE + index as u32)
    }
}
