use driveline::{
    constants::*,
    design::*,
    drive::*,
    governor::*,
    machine::*,
    number::Number,
    observer::{Geared, GearedConfig, TwoMass as Exact, TwoMassConfig},
    sample::Sample,
};
use driveline_firmware::{
    Words,
    scene::{Input, Output},
    scenes::hoist as h,
};
use host_tests::run::{closed_loop::*, hoist, units::Units};
struct D {
    c: ConfigOf<f32, Geared<Exact<f32>>, (), SpeedLoop<f32>>,
    d: Drive<f32, Geared<Exact<f32>>, (), SpeedLoop<f32>>,
}
impl Ticks for D {
    fn tick(&mut self, i: &Input) -> std::io::Result<Output> {
        let w = f32::from_word;
        let r = w(i.reference);
        let c = if i.flags & 1 != 0 {
            self.d.tick(&self.c, &Sample { angle: i.angle, torque: w(i.torque), reference: r })
        } else {
            self.d.hold(&self.c, i.angle, r)
        };
        let e = c.estimate;
        Ok(Output {
            torque: c.torque.to_word(),
            motor_speed: e.motor_speed.to_word(),
            shaft_torque: e.shaft_torque.to_word(),
            load_speed: e.load_speed.to_word(),
            load_torque: e.load_torque.to_word(),
            faults: c.faults.bits(),
            ..Output::default()
        })
    }
}
fn main() {
    let a: Vec<f64> = std::env::args().skip(1).map(|x| x.parse().unwrap()).collect();
    let m = hoist::machine().unwrap();
    let u = Units::new(Words::Single, m.bases);
    for (name, mac) in [("reduced", h::REDUCED), ("modal", h::CHAIN.reduce(Match::ModalTruncation)), ("cut", h::CUT)] {
        let rate = a[3] as u32;
        let d = mac.observer(
            Rate::hz(rate),
            h::ENCODER,
            Disturbance { torque_accuracy: a[0], load_torque_step: a[1], within: a[2] },
        );
        let g = h::REDUCED
            .speed_loop(Rate::hz(rate), SpeedLoopTuning { bandwidth: a[4], damping: a[5], shaft_damping: a[6] });
        if name == "reduced" {
            println!(
                "sd {:?}\npoles {:?}\nkp {} ki {} slip {} margins {:?} res {} antires {} zeta {}",
                d.standard_deviation,
                d.poles.map(|(r, i)| (r * r + i * i).sqrt().ln() * rate as f64),
                g.proportional,
                g.integral,
                g.slip,
                g.margins,
                mac.resonance(),
                mac.antiresonance(),
                mac.damping_ratio()
            );
        }
        print!("{name:8}");
        for sc in &m.scenarios {
            let c = Config {
                limits: Limits::<f32>::new(&Screening {
                    torque: 2300.,
                    reference: 200.,
                    innovation: 0.049,
                    standstill: 0.0015,
                    missed: 200,
                }),
                observer: GearedConfig::<f32, _>::new(TwoMassConfig::<f32>::new(&d), &h::GEAR, 1.0 / rate as f64),
                fluctuation: (),
                governor: SpeedLoopConfig::<f32>::new(
                    &g,
                    SpeedLoopSettings { torque_limit: h::TORQUE_LIMIT, ramp: 77.5 },
                ),
                balancer: (),
            };
            let mut dd = D { c, d: Drive::new(&c, 0) };
            let t = run(&m, sc, &u, rate, &mut dd, |_| {}).unwrap();
            let peak: Vec<f64> =
                (0..3).map(|i| t.moments.iter().map(|m| m.truth[i].abs()).fold(0.0, f64::max)).collect();
            let den = [peak[0], m.rated_speed, peak[2]];
            for i in 0..3 {
                let e: Vec<f64> = t.moments.iter().map(|m| m.truth[i] - m.estimate[i]).collect();
                let rms = (e.iter().map(|x| x * x).sum::<f64>() / e.len() as f64).sqrt();
                let mx = e.iter().fold(0.0f64, |a, b| a.max(b.abs()));
                print!(" {:.3}%/{:.2}%", 100. * rms / den[i], 100. * mx / den[i]);
            }
            print!(" pk{:.0} f{:x} | ", peak[0], t.moments.iter().fold(0, |a, m| a | m.faults));
            if a.len() > 7 {
                println!();
                for m in t.moments.iter().step_by(a[7] as usize) {
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
