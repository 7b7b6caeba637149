use driveline::balancing::{Plan, Procedure, ProcedureStep};

/// Two sensors at one speed, two planes: this one compiles.
type Field = Procedure<f32, 2, 2>;

fn main() {
    assert_eq!(Field::new(Plan::usual(2, 2, 1e-4)).unwrap().next(), ProcedureStep::Baseline);
}
