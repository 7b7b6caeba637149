//! Least squares of balancing: accuracy on the host, cost in QEMU.

use std::error::Error;

use driveline_firmware::scene::Input;
use driveline_report::Table;
use serde::Serialize;

use super::count::{CORES, Cost, Images, cost_cells, cost_headings};
use super::replay::Replay;

/// A way to solve for the weights.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Solver {
    pub name: String,
    /// Largest error of the weights, over the largest weight.
    pub error: f64,
    /// Rms of the residual vibration.
    pub residual: f64,
    /// Cost by core.
    pub costs: Vec<Cost>,
}

/// Number of the first solver among the observers, as the crate has it.
const FIRST: usize = 200;
/// Times that each solves: it takes the same path each time.
const TIMES: usize = 5;

/// All.
pub fn solvers(replay: &Replay, images: &Images, says: &dyn Fn(&str)) -> Result<Vec<Solver>, Box<dyn Error>> {
    let mut inputs = vec![Input::default()];
    inputs.extend([Input { flags: Input::RELEASED, ..Input::default() }; TIMES]);
    let mut solvers = Vec::new();
    for (number, (name, [error, residual])) in replay.solvers()?.into_iter().enumerate() {
        says(&format!("least squares: {name}"));
        let mut costs = Vec::new();
        for core in CORES {
            costs.extend(images.net_cost(core, [0, FIRST + number], 0.0, &inputs)?);
        }
        solvers.push(Solver { name, error, residual, costs });
    }
    Ok(solvers)
}

/// A row a solver.
pub fn solvers_table(solvers: &[Solver]) -> Table {
    let headings = ["solver", "error of the weights", "residual"].map(str::to_owned);
    let mut table = Table::new(headings.into_iter().chain(cost_headings()));
    for solver in solvers {
        let mut row = vec![solver.name.clone(), format!("{:.1e}", solver.error), format!("{:.6}", solver.residual)];
        row.extend(cost_cells(&solver.costs));
        table.row(row);
    }
    table
}
