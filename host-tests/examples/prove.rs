use driveline_firmware::{Visitor, Words, scene::Scene, selected};
use host_tests::run::{closed_loop::*, hoist, units::Units};
struct V;
impl Visitor for V {
    type Outcome = ();
    fn visit<S: Scene>(self) {
        let m = hoist::machine().unwrap();
        let u = Units::new(Words::of::<S>(), m.bases);
        for sc in &m.scenarios {
            let t = run(&m, sc, &u, S::RATE_HZ, &mut OnHost(S::new()), |_| {}).unwrap();
            let i = std::time::Instant::now();
            println!("{:?} {:?}", host_tests::plant::converge::prove(&t.recording), i.elapsed());
        }
    }
}
fn main() {
    selected::visit("hoist/f32/reduced/10000", V);
    selected::visit("hoist/f32/reduced/1000", V);
}
