use driveline::balancing::{Plan, Procedure};

/// Two sensors at one speed, three planes.
type Field = Procedure<f32, 2, 3>;

fn main() {
    let _ = Field::new(Plan::usual(2, 3, 1e-4));
}
