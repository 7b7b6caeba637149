//! No image may hold a reachable panic.
//!
//! The handler calls a symbol that nothing defines. Where the optimiser proves that no panic can be reached, the
//! handler is dropped with the reference; where it cannot, the linker refuses the image and names the symbol.

use core::panic::PanicInfo;

unsafe extern "C" {
    /// Defined nowhere.
    fn panic_is_reachable() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    // SAFETY: never runs: an image in which this call is left does not link.
    unsafe { panic_is_reachable() }
}
