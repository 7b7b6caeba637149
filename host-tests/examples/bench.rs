use host_tests::{
    image::{self, Program},
    link,
};
fn main() {
    for (v, b) in
        [("hoist/f32/reduced/10000", "m4f"), ("hoist/fixed/reduced/10000", "m3"), ("hoist/fixed/reduced/10000", "m4f")]
    {
        let i = image::build(v, image::board(b).unwrap(), Program::Bench, |_| {}).unwrap();
        for l in link::run(&i, std::time::Duration::from_secs(60)).unwrap().lines {
            println!("{b} {l}");
        }
    }
}
