//! Memory of in-run balancing over power cuts.

use core::convert::Infallible;

use super::in_run::BalancingRecord;

/// A place that keeps a [`BalancingRecord`] without power.
pub trait BalancingMemory<const ROWS: usize, const PLANES: usize> {
    /// Failure of the memory.
    type Error;

    /// The record that was kept last, if one can be read.
    ///
    /// # Errors
    /// The memory's own.
    fn load(&mut self) -> Result<Option<BalancingRecord<ROWS, PLANES>>, Self::Error>;

    /// Keeps a record; until it returns, the last one is kept.
    ///
    /// # Errors
    /// The memory's own.
    fn save(&mut self, record: &BalancingRecord<ROWS, PLANES>) -> Result<(), Self::Error>;
}

/// Memory that keeps its content by itself: buffered RAM, or a host's.
impl<const ROWS: usize, const PLANES: usize> BalancingMemory<ROWS, PLANES> for Option<BalancingRecord<ROWS, PLANES>> {
    type Error = Infallible;

    fn load(&mut self) -> Result<Option<BalancingRecord<ROWS, PLANES>>, Infallible> {
        Ok(*self)
    }

    fn save(&mut self, record: &BalancingRecord<ROWS, PLANES>) -> Result<(), Infallible> {
        *self = Some(*record);
        Ok(())
    }
}

impl<K: BalancingMemory<ROWS, PLANES>, const ROWS: usize, const PLANES: usize> BalancingMemory<ROWS, PLANES>
    for &mut K
{
    type Error = K::Error;

    fn load(&mut self) -> Result<Option<BalancingRecord<ROWS, PLANES>>, K::Error> {
        (**self).load()
    }

    fn save(&mut self, record: &BalancingRecord<ROWS, PLANES>) -> Result<(), K::Error> {
        (**self).save(record)
    }
}

/// Flash, for records of up to 58 numbers.
#[cfg(feature = "parameters")]
impl<F: embedded_storage::nor_flash::NorFlash, const ROWS: usize, const PLANES: usize> BalancingMemory<ROWS, PLANES>
    for crate::parameters::Store<F>
{
    type Error = crate::parameters::Error<F::Error>;

    fn load(&mut self) -> Result<Option<BalancingRecord<ROWS, PLANES>>, Self::Error> {
        Ok(crate::parameters::Store::load(self, &mut [0; 256])?.parameters)
    }

    fn save(&mut self, record: &BalancingRecord<ROWS, PLANES>) -> Result<(), Self::Error> {
        crate::parameters::Store::save(self, record, &mut [0; 256])
    }
}
