//! Ticks of any bits in any variant: no panic, and no torque that is not a number.
#![no_main]

use driveline_firmware::Words;
use driveline_firmware::scene::Input;
use driveline_firmware::scenes::{VARIANTS, find};

libfuzzer_sys::fuzz_target!(|course: (u16, Vec<[u32; 8]>)| {
    let (which, ticks) = course;
    let row = find(VARIANTS[usize::from(which) % VARIANTS.len()]).expect("a name of the list");
    let mut scene = row.start();
    for [angle, torque, setpoint, flags, one, two, key, value] in ticks {
        let vibration = [one, two];
        let output = scene.exchange(&Input { angle, torque, setpoint, flags, vibration, asked: [key, value] });
        assert!(row.words() == Words::Fixed || f32::from_bits(output.torque).is_finite(), "{}", row.name);
    }
});
