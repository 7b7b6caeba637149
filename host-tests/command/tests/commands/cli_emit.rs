//! What `design --emit rust` prints compiles, and the compiler designs to the same bits as the program that printed it.
//!
//! The printed files stand in `cli_emit/` as modules of this test, so that building it compiles them. After a change of
//! what is printed, `DRIVELINE_EMIT=1 cargo test -p cargo-driveline --test commands cli_emit` writes them anew.

use cargo_driveline::cli::{Plan, rust};
use cargo_driveline::machine_file::{MachineFile, read};
use driveline::machine::Chain;

#[rustfmt::skip]
#[path = "cli_emit/mill.rs"]
mod mill;

#[rustfmt::skip]
#[path = "cli_emit/ship.rs"]
mod ship;

/// Reads a machine and holds what is printed for it against the file that was compiled.
fn printed(name: &str, compiled: &str) -> (MachineFile, Plan) {
    let root = env!("CARGO_MANIFEST_DIR");
    let machine = read(format!("{root}/machines/{name}.toml").as_ref()).unwrap();
    let text = rust(&machine).unwrap();
    if std::env::var_os("DRIVELINE_EMIT").is_some() {
        std::fs::write(format!("{root}/tests/commands/cli_emit/{name}.rs"), &text).unwrap();
    } else {
        assert_eq!(text, compiled, "tests/commands/cli_emit/{name}.rs is not what is printed");
    }
    let plan = Plan::of(&machine).unwrap();
    (machine, plan)
}

/// The bits of what the compiler designed against those of the program.
#[track_caller]
fn same_bits(compiled: &[f64], plan: &[f64]) {
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(compiled), bits(plan));
}

fn same_chain(compiled: &Chain, machine: &MachineFile) {
    same_bits(compiled.masses(), machine.chain.masses());
    assert_eq!(compiled.shafts(), machine.chain.shafts());
}

#[test]
fn the_mill_compiles_to_the_same_bits() {
    let (machine, plan) = printed("mill", include_str!("cli_emit/mill.rs"));
    same_chain(&mill::ROLLING_MILL, &machine);
    let (gains, governor) = (plan.states.iter().map(|state| state.gain).collect::<Vec<_>>(), plan.speed_loop.unwrap());
    same_bits(&mill::ROLLING_MILL_OBSERVER.gains, &gains);
    let compiled = mill::ROLLING_MILL_SPEED_LOOP;
    same_bits(
        &[compiled.proportional, compiled.integral, compiled.damping],
        &[governor.proportional, governor.integral, governor.damping],
    );
    same_bits(&[mill::ROLLING_MILL_TORQUE, mill::ROLLING_MILL_SPEED], &[machine.limits.torque, machine.limits.speed]);
}

#[test]
fn the_ship_with_its_branches_compiles_to_the_same_bits() {
    let (machine, plan) = printed("ship", include_str!("cli_emit/ship.rs"));
    assert_eq!(machine.train, Some(ship::TWIN_SCREW_SHIP));
    let gains = plan.states.iter().map(|state| state.gain).collect::<Vec<_>>();
    same_bits(&ship::TWIN_SCREW_SHIP_OBSERVER.gains, &gains);
    let (compiled, governor) = (ship::TWIN_SCREW_SHIP_SPEED_LOOP, plan.speed_loop.unwrap());
    same_bits(&[compiled.proportional, compiled.damping], &[governor.proportional, governor.damping]);
    same_bits(
        &[ship::TWIN_SCREW_SHIP_TORQUE, ship::TWIN_SCREW_SHIP_SPEED],
        &[machine.limits.torque, machine.limits.speed],
    );
}
