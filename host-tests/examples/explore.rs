use driveline_firmware::{Visitor, Words, scene::Scene, selected};
use host_tests::run::{closed_loop::*, hoist, units::Units};
struct V;
impl Visitor for V {
    type Outcome = ();
    fn visit<S: Scene>(self) {
        let m = hoist::machine().unwrap();
        let u = Units::new(Words::of::<S>(), m.bases);
        print!("{:28}", S::NAME);
        for sc in &m.scenarios {
            let t = run(&m, sc, &u, S::RATE_HZ, &mut OnHost(S::new()), |_| {}).unwrap();
            let peak: Vec<f64> =
                (0..3).map(|i| t.moments.iter().map(|m| m.truth[i].abs()).fold(0.0, f64::max)).collect();
            let den = [peak[0], m.rated_speed, peak[2]];
            for i in 0..3 {
                let e: Vec<f64> = t.moments.iter().map(|m| m.truth[i] - m.estimate[i]).collect();
                let rms = (e.iter().map(|x| x * x).sum::<f64>() / e.len() as f64).sqrt();
                let mx = e.iter().fold(0.0f64, |a, b| a.max(b.abs()));
                print!(" {:.3}%/{:.2}%", 100. * rms / den[i], 100. * mx / den[i]);
            }
            let f = t.moments.iter().fold(0, |a, m| a | m.faults);
            print!(" pk{:.0} f{f:x} n{} |", peak[0], t.moments.iter().filter(|m| m.faults != 0).count());
            if std::env::args().nth(2).is_some() {
                for m in t.moments.iter().step_by(2000) {
                    println!(
                        "{:.2} tq {:.0} wm {:.1} true {:.1?} est {:.1?} {:x}",
                        m.time, m.torque, m.motor_speed, m.truth, m.estimate, m.faults
                    );
                }
            }
        }
        println!();
    }
}
fn main() {
    let f = std::env::args().nth(1).unwrap_or_default();
    for v in selected::VARIANTS {
        if v.starts_with("hoist") && v.contains(&f) {
            selected::visit(v, V);
        }
    }
}
