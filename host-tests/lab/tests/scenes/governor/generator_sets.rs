//! The generator sets' designs.

use driveline::design::{GovernorDesign, NaturalDamping};
use driveline_firmware::scenes::generator::{DIESEL, RATED_SPEED, TURBINE};

/// The sets' slopes at 1500 r/min by hand: the diesel's friction of 8 % of 2546 N m, half the torque and 2 % of
/// friction of the turbine's 12,732 N m, and for both a load of constant power. The limit is of a parabola's chords.
#[test]
fn the_sets_have_the_slopes_of_their_movers_and_of_a_load_of_constant_power() {
    for (set, torque, falls) in [(&DIESEL, 4.0e5 / RATED_SPEED, 0.08), (&TURBINE, 2.0e6 / RATED_SPEED, 0.52)] {
        let unit = torque / RATED_SPEED;
        // no-load speeds of up to 13 times the rated one: some roundings
        assert!((set.natural.motor - falls * unit).abs() < 1e-12 * unit, "{:?}", set.natural);
        assert!((set.natural.load + unit).abs() < 1e-12 * unit, "{:?}", set.natural);
        for forward in [true, false] {
            let design = set.governor(forward);
            let free = GovernorDesign { natural: NaturalDamping::NONE, ..design };
            let (with, without) = (design.margins(&set.machine), free.margins(&set.machine));
            // a torque that rises off the rated point takes phase, and asks for a least gain
            assert!(with.phase < without.phase && with.gain_down > without.gain_down, "{with:?} {without:?}");
        }
    }
    // through 75, 105 and 120 % at 40, 70 and 105 % of the speed: 10.4 % at rest, 111.5 % at 80 % by Lagrange's weights
    let rated = 4.0e5 / RATED_SPEED;
    for ([speed, torque], (share, of)) in
        DIESEL.curve.points().iter().zip([(0.0, 0.103_846), (0.4, 0.75), (0.8, 1.114_835), (1.05, 1.2)])
    {
        assert!((speed / RATED_SPEED - share).abs() < 1e-14 && (torque / rated - of).abs() < 1e-6, "{speed} {torque}");
    }
}
