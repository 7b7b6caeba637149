//! The fuzz targets, each a function of any bytes: `cargo fuzz` drives them by coverage, and the tests of the command
//! (`host-tests/lab/tests/scenes/fuzz.rs`) play the corpus and mutations of it.

use std::cell::OnceCell;
use std::convert::Infallible;
use std::fs;

use cargo_driveline::cli;
use cargo_driveline::machine_file::{balance, is_train, parse, parse_rotor, parse_train, parse_train_for_modes};
use cargo_driveline::recording::{Asked, read_recording};
use cargo_driveline::telemetry::Decoder;
use driveline::balancing::{Plan, Procedure, ProcedureRecord};
use driveline::parameters::Store;
use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::{VARIANTS, find};
use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};
use tempfile::TempPath;

/// A machine file is designed, a train's or a rotor's is read, or each is refused.
pub fn machine_file(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if is_train(text) {
        let _ = parse_train("fuzz.toml", text);
        let _ = parse_train_for_modes("fuzz.toml", text);
    } else if text.contains("[[station]]") || text.contains("[[disc]]") {
        let _ = parse_rotor("fuzz.toml", text);
    } else if let Ok(machine) = parse("fuzz.toml", text) {
        let _ = cli::Plan::of(&machine);
    }
}

/// A file of balancing is read or refused.
pub fn balancing_file(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        let _ = balance::parse("fuzz.toml", text);
    }
}

thread_local! {
    static FILE: OnceCell<TempPath> = const { OnceCell::new() };
}

/// A recording is read or refused: with its own times, at a rate that is told, and with uneven times.
pub fn recording(bytes: &[u8]) {
    FILE.with(|file| {
        let path = file.get_or_init(|| tempfile::NamedTempFile::new().expect("a temporary file").into_temp_path());
        fs::write(path, bytes).expect("a temporary file");
        for (rate, uneven) in [(None, false), (Some(1e3), false), (None, true)] {
            let counts = bytes.windows(6).any(|word| word == b"counts").then_some(4096.0);
            let asked = Asked { rate, torque_constant: None, counts, columns: vec![], window: [None; 2], uneven };
            let _ = read_recording(path, &asked);
        }
    });
}

/// Telemetry in pieces, whose length is the first byte.
pub fn telemetry(bytes: &[u8]) {
    let Some((&length, stream)) = bytes.split_first() else { return };
    let mut decoder = Decoder::default();
    for piece in stream.chunks(usize::from(length).max(1)) {
        decoder.take(piece, |decoder, told| {
            for (index, word) in told.words.iter().enumerate() {
                let _ = decoder.channel(index).value(*word);
            }
        });
    }
}

/// Bytes of the flash.
const SIZE: usize = 1024;
type Field = Procedure<f32, 2, 2>;
type Kept = ProcedureRecord<{ Field::words(2, 2) }>;

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

/// A flash with parameters, or the words of a record: each is refused, or a procedure goes on from it.
pub fn procedure(bytes: &[u8]) {
    let plan = Plan::usual(2, 2, 1e-4);
    // the words, behind the flash's check sum that no mutation finds
    let words: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    if let Ok(field) = Field::resume(plan, &words) {
        let mut store = Store::new(Flash([0xff; SIZE]), 0..SIZE as u32).expect("two pages");
        let kept = Kept::of(&field, &[]).expect("what was read has its size");
        store.save(&kept, &mut [0; 512]).expect("a flash without faults");
        let read = store.load::<Kept>(&mut [0; 512]).expect("a flash without faults").parameters;
        assert_eq!(read, Some(kept));
    }
    let mut flash = [0xff; SIZE];
    let length = bytes.len().min(SIZE);
    flash[..length].copy_from_slice(&bytes[..length]);
    let mut store = Store::new(Flash(flash), 0..SIZE as u32).expect("two pages");
    if let Ok(Some(kept)) = store.load::<Kept>(&mut [0; 512]).map(|loaded| loaded.parameters) {
        let _ = kept.resume::<f32, 2, 2, 2>(plan, &mut []);
    }
}

/// The inputs of any variant, which the first two bytes choose: no panic, and no torque that is not a number.
pub fn tick(bytes: &[u8]) {
    let Some((which, ticks)) = bytes.split_first_chunk() else { return };
    let row = find(VARIANTS[usize::from(u16::from_le_bytes(*which)) % VARIANTS.len()]).expect("a name of the list");
    let mut scene = row.start();
    for tick in ticks.as_chunks::<4>().0.as_chunks::<8>().0 {
        let [angle, torque, setpoint, flags, one, two, key, value] = tick.map(u32::from_le_bytes);
        let vibration = [one, two];
        let output = scene.exchange(&Input { angle, torque, setpoint, flags, vibration, asked: [key, value] });
        assert!(row.words() == Words::Fixed || f32::from_bits(output.torque).is_finite(), "{}", row.name);
    }
}
