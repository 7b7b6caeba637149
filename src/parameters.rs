//! Parameters: a versioned record in flash that survives power loss.
//!
//! A record is what [`Parameters`] serialises to, after a head with its identity and version, and before a CRC-32.
//! [`Store`] keeps two records, each in pages of its own, and erases and writes the one that is not the newest good
//! one. So whatever happens to a write, the other record is untouched; and one that is damaged, or that another
//! firmware has left, is refused with the reason and the other one taken.
//!
//! Every second save erases the same page: a flash of 10,000 cycles lasts for 20,000 saves. A map in flash (crate
//! `sequential-storage` 8.0.2) would level the wear; in the test's model of a flash a cut in the tenth save left
//! neither record to be found. Whether the crate or the model is at fault was not traced, so that it is left out here.
//!
//! | bytes of a record | what |
//! |---|---|
//! | 4 | `DLP1` |
//! | 4 | whose parameters they are, [`Parameters::IDENTITY`] |
//! | 2 | [`Parameters::VERSION`] |
//! | 4 | count of the saves |
//! | 4 | bytes of the parameters |
//! | | the parameters, by `postcard` |
//! | 4 | CRC-32 of all before it (polynomial 0x04c11db7, reflected) |
//!
//! All words are least significant byte first. Nothing here belongs into the tick: erasing a page takes milliseconds.

mod record;
mod store;

pub use record::{Parameters, RecordError};
pub use store::{Error, Loaded, Store};
