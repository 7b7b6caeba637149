//! Piston engines: free forces, moments and torques against closed forms.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

use driveline::machine::{
    CrankSlider, Cylinder, Diameter, Error, Harmonic, Indicator, Inertia, Length, Mass, WorkingCycle, free_forces,
    free_moments, phasor_sum,
};

/// A third of a turn.
const THIRD: f64 = TAU / 3.0;
/// Distance of two throws (m).
const PITCH: f64 = 0.13;

/// Two banks at an angle (rad), cylinders 1, 3, 5 ... of the first: a pair for each throw.
fn vee<const N: usize>(throws: [f64; N], angle: f64, pitch: Length) -> [Cylinder; N] {
    let bank = |j: usize| if j.is_multiple_of(2) { -0.5 * angle } else { 0.5 * angle };
    std::array::from_fn(|j| Cylinder::new(throws[j], bank(j), Length(pitch.0 * (j / 2) as f64)))
}

/// Opposed cylinders, each on a throw of its own.
fn boxer<const N: usize>(throws: [f64; N], pitch: Length) -> [Cylinder; N] {
    let bank = |j: usize| if j.is_multiple_of(2) { 0.0 } else { PI };
    std::array::from_fn(|j| Cylinder::new(throws[j], bank(j), Length(pitch.0 * j as f64)))
}

/// A star: all cylinders on one throw, evenly spread.
fn star<const N: usize>() -> [Cylinder; N] {
    std::array::from_fn(|j| Cylinder::new(0.0, TAU * j as f64 / N as f64, Length(0.0)))
}

/// Position of the pin of a slider over the crank's axis.
fn position(radius: f64, rod: f64, angle: f64) -> f64 {
    radius * angle.cos() + (rod * rod - (radius * angle.sin()).powi(2)).sqrt()
}

/// Forces and moments of sixteen arrangements against the Fourier series of the sampled positions of their sliders,
/// whose term of order k accelerates with k^2: orders 1 to 6, and balance shafts that leave nothing of one.
#[test]
fn the_orders_are_those_of_the_sampled_sliders() {
    let (pitch, mass, samples) = (Length(PITCH), 0.8, 4096);
    let [turned, quarter, fifth] = [PI, FRAC_PI_2, TAU / 5.0];
    let arrangements: [&[Cylinder]; 16] = [
        &Cylinder::in_line([0.0], pitch),
        &Cylinder::in_line([0.0, turned], pitch),
        &Cylinder::in_line([0.0; 2], pitch),
        &Cylinder::in_line([0.0, THIRD, 2.0 * THIRD], pitch),
        &Cylinder::in_line([0.0, turned, turned, 0.0], pitch),
        &Cylinder::in_line([0.0, 3.0 * fifth, 2.0 * fifth, fifth, 4.0 * fifth], pitch),
        &vee([0.0; 2], FRAC_PI_3, pitch),
        &vee([0.3, 0.3, 1.9, 1.9], 1.1, pitch),
        &vee([0.0, 0.0, quarter, quarter, -quarter, -quarter, turned, turned], quarter, pitch),
        &boxer([0.0, turned], pitch),
        &star::<5>(),
        &Cylinder::in_line([0.0, 0.7, 3.1], pitch),
        &Cylinder::in_line([0.0, 2.0 * THIRD, THIRD, THIRD, 2.0 * THIRD, 0.0], pitch),
        &vee([0.0; 2], quarter, pitch),
        &boxer([0.0, turned, turned, 0.0], pitch),
        &star::<3>(),
    ];
    for (number, cylinders) in arrangements.into_iter().enumerate() {
        let lambda = 0.1 + 0.35 * number as f64 / 15.0;
        let (radius, rod, speed) = (0.05, 0.05 / lambda, 150.0);
        let crank = CrankSlider::massless_rod(Length(radius), Length(rod), Inertia(0.1), Mass(mass));
        let units = crank.force_orders::<7>(speed);
        let middle = cylinders.iter().map(|cylinder| cylinder.position).sum::<f64>() / cylinders.len() as f64;
        for order in 1..=6_u32 {
            for (about, found) in
                [(None, free_forces(cylinders, order)), (Some(middle), free_moments(cylinders, order, middle))]
            {
                // x and y of the sum, each with its cosine and sine
                let mut sum = [[0.0; 2]; 2];
                for step in 0..samples {
                    let phi = TAU * f64::from(step) / f64::from(samples);
                    let (sine, cosine) = (f64::from(order) * phi).sin_cos();
                    for cylinder in cylinders {
                        let arm = about.map_or(1.0, |about| cylinder.position - about);
                        let along = arm * position(radius, rod, phi + cylinder.throw - cylinder.bank);
                        for (axis, part) in [cylinder.bank.cos(), cylinder.bank.sin()].into_iter().enumerate() {
                            sum[axis][0] += along * part * cosine;
                            sum[axis][1] += along * part * sine;
                        }
                    }
                }
                // the frame feels the slider's inertia, which accelerates against its position
                let force = mass * (f64::from(order) * speed).powi(2) * 2.0 / f64::from(samples);
                let [[xc, xs], [yc, ys]] = sum.map(|axis| axis.map(|part| force * part));
                let forward = [0.5 * (xc + ys), 0.5 * (yc - xs)];
                let backward = [0.5 * (xc - ys), 0.5 * (yc + xs)];
                let unit = units[order as usize];
                let [with, against] = [forward, backward].map(|part| f64::hypot(part[0], part[1]));
                for (found, expected) in [(found.largest(), with + against), (found.smallest(), (with - against).abs())]
                {
                    // the sines, each rounded
                    let off = (unit.abs() * found - expected).abs();
                    assert!(off < 1e-12 * units[1], "{number}, order {order}: {found}");
                }
                for (part, expected) in [(found.forward, forward), (found.backward, backward)] {
                    let off = f64::hypot(unit * part[0] - expected[0], unit * part[1] - expected[1]);
                    // the roundings of sums of 4096 positions, 36 times as large in the sixth order
                    assert!(off < 1e-10 * units[1], "{number}, order {order}: {part:?} {expected:?}");
                }
                let [with, against] = found.balance_shafts(&crank, order).unwrap();
                let square = (f64::from(order) * speed).powi(2);
                for (shaft, expected) in [(with, forward), (against, backward)] {
                    let left = f64::hypot(shaft[0] * square + expected[0], shaft[1] * square + expected[1]);
                    assert!(left < 1e-10 * units[1], "{number}, order {order}: {shaft:?}");
                }
            }
        }
    }
}

#[test]
fn counterweights_and_balance_shafts_take_their_share() {
    let [one, pair] = [Cylinder::in_line([0.0], Length(0.1)), [Cylinder::new(0.0, 0.0, Length(0.0)); 1]];
    let single = free_forces(&one, 1);
    // half of the reciprocating mass leaves half of the force, turning against the crank; all of it turns it across
    let half = single.counterweighted(0.5);
    assert_eq!((half.largest(), half.smallest()), (0.5, 0.5));
    let whole = single.counterweighted(1.0);
    assert_eq!((whole.largest(), whole.forward), (1.0, [-0.5, 0.0]));
    assert_eq!(half.with_balance_shafts(0.0, 1.0).largest(), 0.0);
    assert_eq!(free_forces(&pair, 1), single);
    // a 90 degree V2 by its counterweight alone
    let vee = free_forces(&vee([0.4; 2], FRAC_PI_2, Length(0.0)), 1);
    // sums of two sines
    assert!(vee.counterweighted(0.5).largest() < 1e-15, "{vee:?}");
    // a four in line by two shafts at twice the speed
    let four = free_forces(&Cylinder::in_line([0.0, PI, PI, 0.0], Length(0.1)), 2);
    assert_eq!(four.with_balance_shafts(1.0, 1.0).largest(), 0.0);
}

const CRANK: CrankSlider = CrankSlider::massless_rod(Length(0.04), Length(0.14), Inertia(0.1), Mass(0.7));
/// Of a four in line, both of them at compile time.
const LANCHESTER: Option<[[f64; 2]; 2]> =
    free_forces(&Cylinder::in_line([0.0, PI, PI, 0.0], Length(0.1)), 2).balance_shafts(&CRANK, 2);

/// Turning masses beside the pistons' own forces, every force by itself.
#[test]
fn two_shafts_balance_the_second_order_of_four_in_line() {
    let [with, against] = LANCHESTER.unwrap();
    let (lambda, speed) = (CRANK.lambda(), 200.0);
    // half of the second order of four, over the square of twice the speed: lambda + lambda^3/4 + 15 lambda^5/128 ...
    let unbalance = 0.5 * (lambda + lambda.powi(3) / 4.0 + 15.0 * lambda.powi(5) / 128.0) * 0.7 * 0.04;
    for shaft in [with, against] {
        // the next power
        assert!((shaft[0] / unbalance + 1.0).abs() < lambda.powi(6) && shaft[1].abs() < 1e-16, "{shaft:?}");
    }
    for step in 0..60 {
        let phi = f64::from(step) * 0.11;
        let pistons: f64 = [0.0, PI, PI, 0.0].iter().map(|throw| CRANK.mass_force(phi + throw, speed, 0.0)).sum();
        // at twice the speed, one each way: only along the cylinders something is left
        let turned = |shaft: [f64; 2], sense: f64| {
            let (sine, cosine) = f64::sin_cos(sense * 2.0 * phi);
            [0, 1].map(|axis| {
                let across = [-shaft[1], shaft[0]][axis];
                (shaft[axis] * cosine + across * sine) * (2.0 * speed).powi(2)
            })
        };
        let shafts = [turned(with, 1.0), turned(against, -1.0)];
        let left = pistons + shafts[0][0] + shafts[1][0];
        let second = 4.0 * lambda * 0.7 * 0.04 * speed * speed;
        // of each piston the fourth order, lambda^3/4, and higher ones
        assert!(left.abs() < 0.3 * lambda.powi(2) * second, "{phi}: {left} {second}");
        assert!((shafts[0][1] + shafts[1][1]).abs() < 1e-12 * second, "{phi}");
    }
    assert_eq!(free_forces(&Cylinder::in_line([0.0], Length(0.1)), 1).balance_shafts(&CRANK, 0), None);
}

/// The first order of three in line is a moment along a line: counterweights of half the reciprocating mass at the
/// throws, and one shaft against the crank, leave none of it in either direction.
#[test]
fn one_shaft_balances_the_moment_of_three_in_line() {
    let (throws, speed) = ([0.0, THIRD, 2.0 * THIRD], 200.0);
    let moment = free_moments(&Cylinder::in_line(throws, Length(PITCH)), 1, PITCH);
    let left = moment.counterweighted(0.5);
    // the sum of three sines
    assert!(left.forward.iter().all(|part| part.abs() < 1e-16), "{left:?}");
    let [none, shaft] = left.balance_shafts(&CRANK, 1).unwrap();
    let unit = 0.7 * 0.04;
    // half of sqrt 3 times the pitch
    assert!((f64::hypot(shaft[0], shaft[1]) / (0.5 * 3f64.sqrt() * PITCH * unit) - 1.0).abs() < 1e-14, "{shaft:?}");
    assert!(none.iter().all(|part| part.abs() < 1e-17), "{none:?}");
    for step in 0..60 {
        let phi = f64::from(step) * 0.11;
        let (sine, cosine) = f64::sin_cos(phi);
        let mut sum = [shaft[0] * cosine + shaft[1] * sine, shaft[1] * cosine - shaft[0] * sine];
        for (throw, place) in throws.into_iter().zip([-PITCH, 0.0, PITCH]) {
            let (sine, cosine) = f64::sin_cos(phi + throw);
            // the piston along its axis, half of it opposite to the throw
            sum = [sum[0] + unit * place * (cosine - 0.5 * cosine), sum[1] - unit * place * 0.5 * sine];
        }
        let size = f64::hypot(sum[0], sum[1]) * speed * speed;
        assert!(size < 1e-12, "{phi}: {sum:?}");
    }
}

#[test]
fn mass_torque_by_the_series_in_lambda() {
    // derived: -s' s'' of s = r (1 - cos phi) + l (1 - sqrt(1 - lambda^2 sin^2 phi)), expanded to lambda^6
    let series = |l: f64| {
        [
            0.0,
            l / 4.0 + l.powi(3) / 16.0 + 15.0 * l.powi(5) / 512.0,
            -0.5 - l.powi(4) / 32.0 - l.powi(6) / 32.0,
            -0.75 * l - 9.0 * l.powi(3) / 32.0 - 81.0 * l.powi(5) / 512.0,
            -l * l / 4.0 - l.powi(4) / 8.0 - l.powi(6) / 16.0,
        ]
    };
    for (rod, least) in [(3.0, 2e-15), (0.3, 0.0)] {
        let crank = CrankSlider::massless_rod(Length(0.06), Length(rod), Inertia(0.7), Mass(1.5));
        let unit = 1.5 * 0.06 * 0.06 * 200.0 * 200.0;
        for (found, expected) in crank.mass_torque::<5>(200.0).into_iter().zip(series(crank.lambda())) {
            // the next power of lambda, or the rounding of 256 terms
            let off = (found / unit - expected).abs();
            assert!(off < least + crank.lambda().powi(7) / 4.0, "{rod}: {found} {expected} {off:e}");
        }
    }
}

#[test]
fn gas_torque_of_a_constant_pressure_and_of_a_whole_diagram() {
    const CRANK: CrankSlider = CrankSlider::massless_rod(Length(0.05), Length(0.16), Inertia(0.1), Mass(1.0));
    let (crank, bore, four) = (CRANK, Diameter(0.1), WorkingCycle::FourStroke);
    let area = PI * 0.01 / 4.0;
    let even = crank.gas_torque::<6>(bore, &[2e5; 720], four);
    // s' of a turn has r sin phi and even orders only: derived
    for (index, harmonic) in even.into_iter().enumerate() {
        let expected = if index == 2 { 2e5 * area * 0.05 } else { harmonic.sine * f64::from(index == 4) };
        // 720 terms of 80 N m, each rounded
        assert!((harmonic.sine - expected).abs() < 1e-11 && harmonic.cosine.abs() < 1e-11, "{index}: {harmonic:?}");
    }
    const DIESEL: Indicator = Indicator { compression: 17.0, exponent: 1.3, charge: 1.6e5, peak: 1.2e7 };
    assert_eq!(DIESEL.check(), Ok(()));
    let pressure = DIESEL.sample::<1440>(&crank, four);
    let orders = crank.gas_torque::<25>(bore, &pressure, four);
    // the compiler has the same bits, of a diagram that does not take it seconds
    const PRESSURE: [f64; 60] = DIESEL.sample(&CRANK, WorkingCycle::FourStroke);
    const ORDERS: [Harmonic; 7] = CRANK.gas_torque(Diameter(0.1), &PRESSURE, WorkingCycle::FourStroke);
    assert_eq!(crank.gas_torque(bore, &DIESEL.sample::<60>(&crank, four), four), ORDERS);
    // the work between two polytropes, derived: (p_peak - p_0 eps^n) V_c (1 - eps^(1-n))/(n - 1)
    let clearance = area * 0.1 / 16.0;
    let work = (1.2e7 - 1.6e5 * 17f64.powf(1.3)) * clearance * (1.0 - 17f64.powf(-0.3)) / 0.3;
    // the trapezoidal rule: h^2/12 times the kink of the torque at the firing dead centre, a tenth more for the other
    // terms
    let kink = (1.2e7 - 1.6e5 * 17f64.powf(1.3)) * area * 0.05 * (1.0 + crank.lambda());
    let step = 2.0 * TAU / 1440.0;
    let off = 1.1 * step * step / 12.0 * kink / (2.0 * TAU);
    assert!((orders[0].cosine - work / (2.0 * TAU)).abs() < off, "{:?} {work} {off}", orders[0]);
    // an order by the integral itself, over many more angles in the middle of their steps
    let many = 100_000;
    let mut whole = [0.0; 2];
    for step in 0..many {
        let phi = 2.0 * TAU * (f64::from(step) + 0.5) / f64::from(many);
        let volume = 1.0 + 16.0 * crank.travel(phi).travel / 0.1;
        let pressure = match phi {
            phi if phi < PI => 1.2e7 * volume.powf(-1.3),
            phi if phi > 3.0 * PI => 1.6e5 * (17.0 / volume).powf(1.3),
            _ => 1.6e5,
        };
        let torque = (pressure - 101_325.0) * area * crank.travel(phi).first * 2.0 / f64::from(many);
        whole = [whole[0] + torque * (1.5 * phi).cos(), whole[1] + torque * (1.5 * phi).sin()];
    }
    // the same kink, twice for an amplitude
    assert!(f64::hypot(whole[0] - orders[3].cosine, whole[1] - orders[3].sine) < 2.0 * off, "{whole:?}");
    let wrong = |indicator: Indicator| assert_eq!(indicator.check(), Err(Error::Indicator));
    wrong(Indicator { compression: 1.0, ..DIESEL });
    wrong(Indicator { peak: 1.6e5 * 17f64.powf(1.3) * 0.999, ..DIESEL });
    wrong(Indicator { charge: f64::NAN, ..DIESEL });
    wrong(Indicator { compression: f64::INFINITY, ..DIESEL });
}

#[test]
fn phasor_sums_by_order_and_shape() {
    const SIX: [Cylinder; 6] = Cylinder::fired(
        Cylinder::in_line([0.0, 2.0 * THIRD, THIRD, THIRD, 2.0 * THIRD, 0.0], Length(0.1)),
        [1, 5, 3, 6, 2, 4],
    );
    // they fire every 120 degrees
    for (cylinder, firing) in SIX.iter().zip([0.0, 4.0, 2.0, 5.0, 1.0, 3.0]) {
        // half a dozen additions of a third of a turn
        assert!((cylinder.firing - firing * THIRD).abs() < 1e-14, "{cylinder:?}");
    }
    let (rigid, twisted) = ([1.0; 6], [1.0, 0.6, 0.2, -0.2, -0.6, -1.0]);
    for (order, stiff, elastic) in [
        (3.0, 6.0, 0.0),            // all together
        (1.5, 0.0, 3.6),            // 1, 3, 2 against 5, 6, 4
        (0.5, 0.0, 1.92f64.sqrt()), // 60 degrees apart: 2 - 1.2 exp 60 + 0.4 exp 120
        (6.0, 6.0, 0.0),
        (4.5, 0.0, 3.6),
    ] {
        // six sines of up to nine turns, each rounded
        assert!((phasor_sum(&SIX, &rigid, order) - stiff).abs() < 1e-13, "{order}");
        assert!((phasor_sum(&SIX, &twisted, order) - elastic).abs() < 1e-13, "{order}");
    }
    // a star of five on two turns, every second cylinder
    let star = Cylinder::fired(star::<5>(), [1, 3, 5, 2, 4]);
    let mut firing = star.map(|cylinder| cylinder.firing);
    firing.sort_by(f64::total_cmp);
    assert!(firing.iter().enumerate().all(|(j, angle)| (angle - 0.4 * j as f64 * TAU).abs() < 1e-14), "{firing:?}");
    // two cylinders at their dead centre at the same time fire one turn apart
    let twin = Cylinder::fired(Cylinder::in_line([0.0; 2], Length(0.1)), [1, 2]);
    assert_eq!(twin.map(|cylinder| cylinder.firing), [0.0, TAU]);
    // the second fires an eighth of a turn after the first, or the first seven eighths after the second
    for (order, firing) in [([1, 2], [0.0, 0.125]), ([2, 1], [1.0, 0.125])] {
        let mut vee = [0.0, 0.125].map(|turn| Cylinder::new(0.0, turn * TAU, Length(0.0)));
        Cylinder::try_fire(&mut vee, &order).unwrap();
        assert_eq!(vee.map(|cylinder| cylinder.firing / TAU), firing);
    }
}

#[test]
fn wrong_firing_orders_are_refused() {
    let six = Cylinder::in_line([0.0, 2.0 * THIRD, THIRD, THIRD, 2.0 * THIRD, 0.0], Length(0.1));
    let wrong: [&[usize]; 5] =
        [&[1, 5, 3, 6, 2], &[1, 5, 3, 6, 2, 2], &[0, 5, 3, 6, 2, 4], &[1, 5, 3, 6, 2, 7], &[1, 2, 3, 4, 5, 6]];
    for order in wrong {
        assert_eq!(Cylinder::try_fire(&mut six.clone(), order), Err(Error::FiringOrder), "{order:?}");
    }
}
