//! The drive called from Rust, in the place of the C interface: what that is measured against.

use driveline::number::Number as _;
use driveline::sample::Sample;

use crate::{CONFIG, Number, TheDrive};

#[repr(C)]
pub struct CSample {
    angle: u32,
    torque: u32,
    setpoint: u32,
}

#[unsafe(no_mangle)]
pub extern "C" fn rust_new(drive: &mut core::mem::MaybeUninit<TheDrive>) {
    drive.write(TheDrive::new(&CONFIG, 0));
}

#[unsafe(no_mangle)]
pub extern "C" fn rust_hold(drive: &mut TheDrive, angle: u32, torque: &u32) {
    drive.hold(&CONFIG, angle, Number::from_word(*torque));
}

#[unsafe(no_mangle)]
pub extern "C" fn rust_tick(drive: &mut TheDrive, sample: &CSample, torque: &mut u32) -> u32 {
    let (applied, setpoint) = (Number::from_word(sample.torque), Number::from_word(sample.setpoint));
    let command = drive.tick(&CONFIG, &Sample { angle: sample.angle, torque: applied, setpoint });
    *torque = command.torque.to_word();
    command.faults.bits()
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
