//! A flash of any bytes: the parameters in it are refused, or a procedure goes on from them.
#![no_main]

use core::convert::Infallible;

use driveline::balancing::{Plan, Procedure, Record};
use driveline::parameters::Store;
use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};

const SIZE: usize = 1024;
type Field = Procedure<f32, 2, 2>;
type Kept = Record<{ Field::words(2, 2) }>;

struct Flash([u8; SIZE]);

impl ErrorType for Flash {
    type Error = Infallible;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;
    fn read(&mut self, at: u32, bytes: &mut [u8]) -> Result<(), Infallible> {
        bytes.copy_from_slice(&self.0[at as usize..][..bytes.len()]);
        Ok(())
    }
    fn capacity(&self) -> usize {
        SIZE
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SIZE / 2;
    fn erase(&mut self, from: u32, to: u32) -> Result<(), Infallible> {
        self.0[from as usize..to as usize].fill(0xff);
        Ok(())
    }
    fn write(&mut self, at: u32, bytes: &[u8]) -> Result<(), Infallible> {
        self.0[at as usize..][..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }
}

libfuzzer_sys::fuzz_target!(|words: Vec<u32>| {
    let plan = Plan::usual(2, 2, 1e-4);
    // the words behind a check sum that no mutation finds
    if let Ok(field) = Field::resume(plan, &words) {
        let mut store = Store::new(Flash([0xff; SIZE]), 0..SIZE as u32).expect("two pages");
        let kept = Kept::of(&field, &[]).expect("what was read has its size");
        store.save(&kept, &mut [0; 512]).expect("a flash without faults");
        let read = store.load::<Kept>(&mut [0; 512]).expect("a flash without faults").parameters;
        assert_eq!(read, Some(kept));
    }
    let mut bytes = [0xff; SIZE];
    for (byte, given) in bytes.iter_mut().zip(words.iter().flat_map(|word| word.to_le_bytes())) {
        *byte = given;
    }
    let mut store = Store::new(Flash(bytes), 0..SIZE as u32).expect("two pages");
    if let Ok(Some(kept)) = store.load::<Kept>(&mut [0; 512]).map(|loaded| loaded.parameters) {
        let _ = kept.resume::<f32, 2, 2, 2>(plan, &mut []);
    }
});
