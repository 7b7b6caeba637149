//! The same bits on every core that a board is there for.

use driveline_firmware::board::{FURTHER, RISC_V};
use driveline_qemu::measure::self_test;
use driveline_qemu::setup::has_risc_v;

#[test]
fn further_cores_give_the_hosts_bits() {
    // RISC-V where its QEMU and targets are installed
    for &board in FURTHER.iter().chain(RISC_V.iter().filter(|_| has_risc_v())) {
        let number = if board.has_float_unit() { "f32" } else { "fixed" };
        for observer in ["exact", "reduced"] {
            let variant = format!("hoist/{number}/{observer}/10000");
            let fingerprint = self_test(&variant, board).unwrap_or_else(|error| panic!("{}: {error}", board.core));
            println!("{variant} on {} ({}): {fingerprint}", board.name, board.core);
        }
    }
}
