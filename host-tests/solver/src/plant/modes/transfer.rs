//! Transfer matrices of a free chain: angle and torque carried from one end to the other
//! `[derived; headings: Pfützner 1980 ch. 1, Wang 1989 ch. 3]`. A third way to its frequencies, with shapes, beside
//! Jacobi's and Holzer's.

/// Angle and torque behind a part from those before it, row by row.
pub type Transfer = [[f64; 2]; 2];

/// Of a disc, kg m2, at `omega` rad/s: its torque of inertia is added.
#[must_use]
pub const fn disc(inertia: f64, omega: f64) -> Transfer {
    [[1.0, 0.0], [-inertia * omega * omega, 1.0]]
}

/// Of a shaft, N m/rad, above zero: its twist is added.
#[must_use]
pub const fn shaft(stiffness: f64) -> Transfer {
    [[1.0, 1.0 / stiffness], [0.0, 1.0]]
}

/// `after` behind `before`.
#[must_use]
pub fn product(after: &Transfer, before: &Transfer) -> Transfer {
    let entry = |r: usize, c: usize| after[r][0] * before[0][c] + after[r][1] * before[1][c];
    [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
}

/// The whole chain from its first disc to its last. With free ends, its torque per angle, the entry `[1][0]`, is zero
/// at a natural frequency; with the first disc held, the entry `[1][1]`; surplus numbers are left out.
#[must_use]
pub fn chain(inertia: &[f64], stiffness: &[f64], omega: f64) -> Transfer {
    let mut whole = [[1.0, 0.0], [0.0, 1.0]];
    for (j, &mass) in inertia.iter().enumerate() {
        whole = product(&disc(mass, omega), &whole);
        if let Some(&k) = stiffness.get(j).filter(|_| j + 1 < inertia.len()) {
            whole = product(&shaft(k), &whole);
        }
    }
    whole
}

/// Natural frequencies, rad/s, of a free chain in rising order, without its rigid turning: the number of changes of
/// sign of the angles along the chain says how many lie below a frequency (Sturm), and halving finds each to the last
/// digit.
#[must_use]
pub fn frequencies(inertia: &[f64], stiffness: &[f64]) -> Vec<f64> {
    let most = stiffness.iter().zip(inertia).zip(inertia.iter().skip(1));
    // twice the sum of all the squares of pairs bounds the highest
    let top = 2.0 * most.map(|((k, a), b)| k / a + k / b).sum::<f64>().sqrt();
    (1..inertia.len().min(stiffness.len() + 1)).map(|mode| nth(inertia, stiffness, mode, top)).collect()
}

fn nth(inertia: &[f64], stiffness: &[f64], mode: usize, top: f64) -> f64 {
    let (mut low, mut high) = (0.0, top);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if below(inertia, stiffness, middle) > mode { high = middle } else { low = middle }
    }
}

/// How many natural frequencies lie below `omega`, the rigid turning among them: by the torque per angle behind every
/// disc, which is passed on as a fraction so that nothing overflows.
fn below(inertia: &[f64], stiffness: &[f64], omega: f64) -> usize {
    let square = omega * omega;
    let mut count = 0;
    // torque that the chain so far gives per angle of its last disc
    let mut dynamic = 0.0;
    for (j, disc) in inertia.iter().enumerate() {
        dynamic -= square * disc;
        if let Some(k) = stiffness.get(j).filter(|_| j + 1 < inertia.len()) {
            // through the shaft: angle behind it per angle before it
            let through = 1.0 + dynamic / k;
            count += usize::from(through < 0.0);
            dynamic /= if through == 0.0 { f64::MIN_POSITIVE } else { through };
        }
    }
    count + usize::from(dynamic < 0.0)
}
