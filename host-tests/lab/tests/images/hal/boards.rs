//! The same bits on every core that a board is there for.

use driveline_firmware::board::FURTHER;
use driveline_qemu::measure::self_test;

#[test]
fn further_cores_give_the_hosts_bits() {
    for &board in FURTHER {
        let number = if board.target.ends_with("hf") { "f32" } else { "fixed" };
        for observer in ["exact", "reduced"] {
            let variant = format!("hoist/{number}/{observer}/10000");
            let fingerprint = self_test(&variant, board).unwrap_or_else(|error| panic!("{}: {error}", board.core));
            println!("{variant} on {} ({}): {fingerprint}", board.name, board.core);
        }
    }
}
