//! The static library: of what the compiler bundles, the drive's own object.
//!
//! The compiler puts its run-time library into a `staticlib`, some 500 objects. The drive is one object, compiled as a
//! whole; what it calls beside are functions of the run-time ABI (`__aeabi_dadd`, `memcpy`), which every C compiler
//! brings. So the archive that is handed over has one member, and the index of its symbols.

use object::read::archive::ArchiveFile;
use object::{Object, ObjectSection, ObjectSymbol};

/// The drive's object.
#[derive(Debug)]
pub struct DriveObject {
    bytes: Vec<u8>,
    /// Functions and constants that other objects see.
    pub defined: Vec<String>,
    /// Functions that it takes from other objects.
    pub undefined: Vec<String>,
    /// Bytes and alignment of the state, bits of the bases of torque and speed.
    pub layout: [u32; 4],
}

impl DriveObject {
    /// Finds it in a static library of the compiler's, by the layout that a crate exports.
    ///
    /// # Errors
    /// A sentence: what is not as the compiler has always made it.
    pub fn find(archive: &[u8], krate: &str) -> Result<Self, String> {
        let unread = |error: object::Error| format!("the compiler's library cannot be read: {error}");
        let layout = format!("{krate}_layout");
        for member in ArchiveFile::parse(archive).map_err(unread)?.members() {
            let bytes = member.map_err(unread)?.data(archive).map_err(unread)?;
            // the compiler's own notes are no object
            let Ok(file) = object::File::parse(bytes) else { continue };
            let is_layout = |symbol: &object::Symbol| symbol.name() == Ok(&layout) && symbol.is_definition();
            let Some(symbol) = file.symbols().find(is_layout) else { continue };
            let section = symbol.section_index().and_then(|index| file.section_by_index(index).ok());
            let data = section.and_then(|section| section.data_range(symbol.address(), 16).ok().flatten());
            let words = data.ok_or("the library's layout has no bytes")?.chunks_exact(4);
            let mut words = words.filter_map(|word| word.try_into().ok()).map(u32::from_le_bytes);
            let names = |wanted: fn(&object::Symbol) -> bool| {
                file.symbols().filter(|symbol| wanted(symbol)).filter_map(|s| s.name().ok()).map(String::from).collect()
            };
            return Ok(DriveObject {
                bytes: bytes.to_vec(),
                defined: names(|symbol| symbol.is_definition() && symbol.is_global()),
                undefined: names(|symbol| symbol.is_undefined() && symbol.name().is_ok_and(|name| !name.is_empty())),
                layout: std::array::from_fn(|_| words.next().unwrap_or_default()),
            });
        }
        Err(format!("the compiler's library has no object with `{layout}`"))
    }

    /// An archive of this one object, with the index that linkers ask for (System V, as GNU `ar` writes it).
    pub fn archive(&self) -> Vec<u8> {
        let mut index = (self.defined.len() as u32).to_be_bytes().to_vec();
        let names: usize = self.defined.iter().map(|name| name.len() + 1).sum();
        let length = 4 + 4 * self.defined.len() + names;
        let member = (MAGIC.len() + HEADER + length + length % 2) as u32;
        index.extend(self.defined.iter().flat_map(|_| member.to_be_bytes()));
        index.extend(self.defined.iter().flat_map(|name| name.bytes().chain([0])));
        let mut archive = MAGIC.to_vec();
        for (name, bytes) in [("/", &index), ("drive.o/", &self.bytes)] {
            let header = format!("{name:<16}{:<12}{:<6}{:<6}{:<8}{:<10}`\n", 0, 0, 0, 644, bytes.len());
            archive.extend(header.bytes());
            archive.extend(bytes);
            // members begin at even places
            archive.extend((bytes.len() % 2 == 1).then_some(b'\n'));
        }
        archive
    }
}

const MAGIC: &[u8] = b"!<arch>\n";
/// Bytes of a member's header.
const HEADER: usize = 60;

#[cfg(test)]
mod tests {
    use object::read::archive::ArchiveFile;

    use super::DriveObject;

    /// Read back by a reader of archives that is not this writer.
    #[test]
    fn an_archive_has_one_member_and_its_index() {
        let names = ["roll_init_checked", "roll_tick", "roll_layout"];
        for length in [7, 8] {
            let bytes: Vec<u8> = (0..length).collect();
            let defined = names.map(String::from).to_vec();
            let drive = DriveObject { bytes: bytes.clone(), defined, undefined: Vec::new(), layout: [0; 4] };
            let written = drive.archive();
            let archive = ArchiveFile::parse(&*written).unwrap();
            let members: Vec<_> = archive.members().map(Result::unwrap).collect();
            assert_eq!(members.len(), 1);
            assert_eq!((members[0].name(), members[0].data(&*written).unwrap()), (&b"drive.o"[..], &*bytes));
            let index: Vec<_> = archive.symbols().unwrap().unwrap().map(Result::unwrap).collect();
            assert_eq!(index.len(), names.len());
            for (symbol, name) in index.iter().zip(names) {
                assert_eq!(symbol.name(), name.as_bytes());
                assert_eq!(archive.member(symbol.offset()).unwrap().name(), b"drive.o");
            }
        }
    }
}
