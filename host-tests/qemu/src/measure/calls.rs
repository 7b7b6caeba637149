//! The worst of many calls of single functions: the bench's image with a larger number of calls.

use std::error::Error;
use std::fs;
use std::time::Duration;

use driveline_firmware::board::Facts;
use object::{Object, ObjectSection, ObjectSymbol};

use crate::image::{Image, Program, build};

use super::Loops;
use super::bound::MachineCode;

/// A function of the bench, its longest path and the worst of its calls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Called {
    /// As the bench names it.
    pub name: String,
    /// On the longest path; none where the analysis refuses it.
    pub longest: Option<u64>,
    /// The most instructions of a call.
    pub most: u64,
}

/// A bench takes a second; this is for a QEMU that hangs.
pub(super) const BENCH_LIMIT: Duration = Duration::from_secs(60);

/// The bench's image for a board.
pub(super) fn bench(board: Facts) -> Result<Image, Box<dyn Error>> {
    let number = if board.target.ends_with("hf") { "f32" } else { "fixed" };
    Ok(build(&format!("hoist/{number}/reduced/10000"), board, Program::Bench, |_| {})?)
}

/// Calls each function of the bench so often, those for the tick alone: the long ones are called a few times only.
pub fn worst_called(board: Facts, calls: u32) -> Result<Vec<Called>, Box<dyn Error>> {
    let image = bench(board)?;
    let code = MachineCode::read(&image.path, Loops::default())?;
    let image = with_calls(image, calls)?;
    // a thousand calls of each take less than a second
    let limit = BENCH_LIMIT + Duration::from_secs(2) * (calls / 1000);
    let lines = crate::link::run(&image, limit)?.lines;
    let called = lines.iter().filter(|line| line["calls"] == calls).filter_map(|line| {
        let function = u32::try_from(line["function"].as_u64()?).ok()?;
        let longest = code.bound(function).ok().map(|bound| bound.instructions);
        Some(Called { name: line["bench"].as_str()?.into(), longest, most: line["max"].as_u64()? })
    });
    let called: Vec<Called> = called.collect();
    if called.is_empty() {
        return Err(format!("the bench on {} called no function {calls} times", board.name).into());
    }
    Ok(called)
}

/// Where the bench's image has the number of its calls.
const CALLS: &str = "DRIVELINE_CALLS";

/// A copy of the bench's image, the same machine code, with another number of calls.
fn with_calls(image: Image, calls: u32) -> Result<Image, Box<dyn Error>> {
    let mut bytes = fs::read(&image.path)?;
    let place = place(&bytes)?;
    bytes.get_mut(place..place + 4).ok_or("the file ends before its sections")?.copy_from_slice(&calls.to_le_bytes());
    let path = image.path.with_extension("calls.elf");
    fs::write(&path, bytes)?;
    Ok(Image { path, ..image })
}

/// The place in the file of an image's number of calls.
fn place(bytes: &[u8]) -> Result<usize, Box<dyn Error>> {
    let file = object::File::parse(bytes)?;
    let symbol = file.symbols().find(|symbol| symbol.name() == Ok(CALLS)).ok_or("the image has no number of calls")?;
    let section = file.section_by_index(symbol.section_index().ok_or("the number of calls is in no section")?)?;
    let (start, _) = section.file_range().ok_or("the number of calls is not in the file")?;
    Ok(usize::try_from(start + symbol.address() - section.address())?)
}
