//! Fixed point against integers of 128 bits: every operation of the tick path, to the bit, and that the carry takes the
//! bias away.

use driveline::number::{Coefficient, Fixed, GAIN_SHIFT, INNOVATION_SHIFT, Number, SPEED_SHIFT, TURN_SHIFT};
use driveline::observer::{AngleTracker, Stiction};
use proptest::prelude::*;

/// The coefficient with these bits: exact, since `f64` holds 32 bits.
fn coefficient(bits: i32) -> Coefficient {
    Coefficient::from_f64(f64::from(bits) / 4_294_967_296.0).unwrap()
}

/// The sum x 2^32 + carry + sum c y as the integers have it: its upper words, wrapped, and its lower word.
fn reference(x: i32, carry: u32, terms: &[(i32, i32)]) -> (i32, u32) {
    let start = i128::from(x) * (1 << 32) + i128::from(carry);
    let sum = terms.iter().fold(start, |sum, &(c, y)| sum + i128::from(c) * i128::from(y));
    ((sum >> 32) as i32, sum as u32)
}

fn held(x: i128, low: i128, high: i128) -> i128 {
    x.max(low).min(high)
}

/// Any bits, and those at the edges.
fn bits() -> impl Strategy<Value = i32> {
    prop_oneof![4 => any::<i32>(), 1 => prop::sample::select(vec![
        i32::MIN, i32::MIN + 1, -(1 << 29), -(1 << 28) - 1, -(1 << 28), -1, 0, 1,
        (1 << 26) - 1, 1 << 26, (1 << 28) - 1, 1 << 28,
        (1 << 29) - 1, 1 << 29, i32::MAX,
    ])]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn sums(x in bits(), carry: u32, c: [i32; 3], y in [bits(), bits(), bits()]) {
        let terms: Vec<_> = c.into_iter().zip(y).collect();
        let (c, y) = (c.map(coefficient), y.map(Fixed::from_bits));
        let x = Fixed::from_bits(x);
        let start = x.to_bits();
        let mut left = carry;
        let sum = x.accumulate(&mut left, [c[0]], [y[0]]).to_bits();
        prop_assert_eq!((sum, left), reference(start, carry, &terms[..1]));
        left = carry;
        let sum = x.accumulate(&mut left, [c[0], c[1]], [y[0], y[1]]);
        prop_assert_eq!((sum.to_bits(), left), reference(start, carry, &terms[..2]));
        left = carry;
        prop_assert_eq!((x.accumulate(&mut left, c, y).to_bits(), left), reference(start, carry, &terms));
        left = carry;
        prop_assert_eq!((Fixed::sum(&mut left, [c[0]], [y[0]]).to_bits(), left), reference(0, carry, &terms[..1]));
        left = carry;
        let sum = Fixed::sum(&mut left, [c[0], c[1]], [y[0], y[1]]);
        prop_assert_eq!((sum.to_bits(), left), reference(0, carry, &terms[..2]));
    }

    #[test]
    fn single_operations(x in bits(), y in bits(), limit in bits(), c: i32) {
        let (wide, number) = (i128::from(x), Fixed::from_bits(x));
        let wrapped = |value: i128| value as i32;
        prop_assert_eq!((number + Fixed::from_bits(y)).to_bits(), wrapped(wide + i128::from(y)));
        prop_assert_eq!((number - Fixed::from_bits(y)).to_bits(), wrapped(wide - i128::from(y)));
        prop_assert_eq!(number.widened().to_bits(), wrapped(wide * 4));
        let less = wide - (i128::from(y) << TURN_SHIFT) - i128::from(c as u32 >> (32 - TURN_SHIFT));
        prop_assert_eq!(number.less_turn(Fixed::from_bits(y), c as u32).to_bits(), wrapped(less));
        // an innovation to 2^-32 turn, whatever the carry of the states
        let predicted = AngleTracker::<Fixed>::new(0).predict((), ([coefficient(c)], [Fixed::from_bits(y)]), x as u32, c as u32);
        let turn = (i128::from(c) * i128::from(y)) >> (32 - TURN_SHIFT);
        prop_assert_eq!(predicted.innovation().to_bits(), wrapped(wide - turn));
        prop_assert_eq!(i128::from(number.times(coefficient(c)).to_bits()), (wide * i128::from(c)) >> 32);
        prop_assert_eq!(i128::from(number.braked(()).to_bits()), held(wide, -(1 << 25), (1 << 25) - 1) << 4);
        prop_assert_eq!(number.innovation_operand().to_bits(), wrapped(wide << INNOVATION_SHIFT));
        prop_assert_eq!(i128::from(number.saturated().to_bits()), held(wide, -(1 << 29), (1 << 29) - 1));
        prop_assert_eq!(i128::from(number.addable().to_bits()), held(wide, -(1 << 30), (1 << 30) - 1));
        let gained = |bases: i128| {
            let most = bases << (28 - GAIN_SHIFT);
            held((wide * i128::from(c)) >> 32, -most, most - 1) << GAIN_SHIFT
        };
        prop_assert_eq!(i128::from(number.gained::<1>(coefficient(c)).to_bits()), gained(1));
        prop_assert_eq!(i128::from(number.gained::<4>(coefficient(c)).to_bits()), gained(4));
        let speed = held((wide * i128::from(c)) >> (32 - SPEED_SHIFT), -(1 << 30), 1 << 30);
        prop_assert_eq!(i128::from(number.speed_of_turn(coefficient(c)).to_bits()), speed);
        // A negative number comes out a unit short, as documented.
        prop_assert_eq!(i128::from(number.magnitude().to_bits()), if x < 0 { -wide - 1 } else { wide });
        prop_assert_eq!((Fixed::from_angle(x).to_bits(), Fixed::from_word(x as u32).to_bits()), (x, x));
        prop_assert_eq!(number.to_word(), x as u32);
        // A limit is a magnitude; the most negative number has none, and is beyond every limit.
        let limit = (limit & i32::MAX, i128::from(limit & i32::MAX));
        prop_assert_eq!(number.exceeds(Fixed::from_bits(limit.0)), wide.abs() > limit.1);
        let limited = held(wide, -limit.1, limit.1);
        prop_assert_eq!(i128::from(number.limited(Fixed::from_bits(limit.0)).to_bits()), limited);
        // Beyond its limit a gear slips; then every innovation but half a turn is too large to be left out.
        let deadband = Fixed::from_bits(y & i32::MAX);
        let (friction, left_out) = number.friction(Fixed::from_bits(limit.0), &deadband);
        let all_exceed = [i32::MIN + 1, c | 1, 0, i32::MAX].map(|x| Fixed::from_bits(x).exceeds(left_out));
        prop_assert_eq!(i128::from(friction.to_bits()), limited);
        let as_documented = if limited == wide { left_out == deadband } else { all_exceed == [true; 4] };
        prop_assert!(as_documented);
    }

    #[test]
    fn beyond_the_base(states in [bits(), bits(), bits(), bits()]) {
        let states = states.map(|x| Fixed::from_bits(x).saturated().to_bits());
        // From -2^28, the base itself, to just under it.
        let beyond = states.iter().any(|&x| !(-(1 << 28)..1 << 28).contains(&x));
        prop_assert_eq!(Fixed::beyond_base(states.map(Fixed::from_bits)), u32::from(beyond));
    }

    #[test]
    fn conversions_round_to_the_nearest(value in -9.0_f64..9.0, bits: i32) {
        let nearest = (value * 268_435_456.0).round().clamp(-2_147_483_648.0, 2_147_483_647.0);
        prop_assert_eq!(f64::from(Fixed::from_f64(value).to_bits()), nearest);
        prop_assert_eq!(Fixed::from_f64(Fixed::from_bits(bits).to_f64()).to_bits(), bits);
        prop_assert_eq!(coefficient(bits).to_f64() * 4_294_967_296.0, f64::from(bits));
    }
}

/// The error of a tick's sums against the same sums without truncation. A chain of `length` sums hands its remainder
/// on; the remainder at the end is uniform over a unit, so the error of the chain's total has mean zero (the chain
/// begins with half a unit) and a variance of 1/12. Cutting each sum off would lose half a unit a sum instead: thirty
/// standard errors and more.
#[test]
fn the_carry_takes_the_bias_away() {
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        // splitmix64 [Steele, Lea and Flood 2014]
        random = random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (random ^ random >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 32) as i32
    };
    const CHAINS: u32 = 40_000;
    for length in [1, 3, 8] {
        let (mut with, mut without) = (0.0, 0.0);
        for _ in 0..CHAINS {
            let mut carry = Fixed::CARRY;
            let (mut total, mut cut_off, mut exact) = (0_i64, 0_i64, 0_i128);
            for _ in 0..length {
                let (c, y) = (next(), next() >> 3);
                exact += i128::from(c) * i128::from(y);
                total += i64::from(Fixed::sum(&mut carry, [coefficient(c)], [Fixed::from_bits(y)]).to_bits());
                cut_off += i64::from(Fixed::sum(&mut 0, [coefficient(c)], [Fixed::from_bits(y)]).to_bits());
            }
            let exact = exact as f64 / 4_294_967_296.0;
            with += total as f64 - exact;
            without += cut_off as f64 - exact;
        }
        let mean = |sum: f64| sum / f64::from(CHAINS);
        let standard_error = (1.0 / 12.0 / f64::from(CHAINS)).sqrt();
        // Four standard errors: one run in 16,000, and the seed is fixed.
        assert!(mean(with).abs() < 4.0 * standard_error, "{length}: {} +-{standard_error}", mean(with));
        let expected = -0.5 * f64::from(length);
        let spread = standard_error * f64::from(length).sqrt();
        assert!((mean(without) - expected).abs() < 4.0 * spread, "{length}: {} instead of {expected}", mean(without));
    }
}
