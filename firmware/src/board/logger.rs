//! Output of `defmt` logs: the host's file `log`, through semihosting.
//!
//! No interrupt is enabled in these images, so that a frame is never begun within another: no critical section, and no
//! panic that could be reached.

use core::cell::UnsafeCell;

use super::semihosting::Sink;

#[defmt::global_logger]
struct Logger;

struct State {
    encoder: defmt::Encoder,
    sink: Option<Sink>,
}

struct Unshared(UnsafeCell<State>);

// SAFETY: one core and no interrupt: there is never a second one that uses it.
unsafe impl Sync for Unshared {}

static STATE: Unshared = Unshared(UnsafeCell::new(State { encoder: defmt::Encoder::new(), sink: None }));

/// Does something with the encoder and the way out.
fn with(action: impl FnOnce(&mut defmt::Encoder, &mut dyn FnMut(&[u8]))) {
    // SAFETY: `defmt` does not log while it logs, and nothing interrupts it.
    let State { encoder, sink } = unsafe { &mut *STATE.0.get() };
    if sink.is_none() {
        *sink = Sink::open(c"log");
    }
    action(encoder, &mut |bytes| {
        if let Some(sink) = sink {
            // bytes that the host does not take are lost
            let _ = sink.write(bytes);
        }
    });
}

// SAFETY: as `defmt::Logger` asks: frames begin and end in turn, and nothing runs at the same time.
unsafe impl defmt::Logger for Logger {
    fn acquire() {
        with(|encoder, out| encoder.start_frame(out));
    }

    unsafe fn flush() {
        // a write of semihosting has arrived when it returns
    }

    unsafe fn release() {
        with(|encoder, out| encoder.end_frame(out));
    }

    unsafe fn write(bytes: &[u8]) {
        with(|encoder, out| encoder.write(bytes, out));
    }
}
