//! The colours of the curves for readers with each kind of colour blindness, and against the page.
//!
//! Protanopia, deuteranopia and tritanopia are simulated by the matrices of Machado, Oliveira and Fernandes (2009) for
//! a severity of 1, in linear RGB; distances are those of CIELAB (CIE 1976, D65).

type Colour = [f64; 3];

const STYLE: &str = include_str!("../../src/page/style.css");

const EYES: [(&str, [Colour; 3]); 4] = [
    ("all cones", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ("protanopia", [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
    (
        "deuteranopia",
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    ),
    ("tritanopia", [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]),
];

/// From linear sRGB to CIE XYZ (IEC 61966-2-1).
const XYZ: [Colour; 3] =
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]];

fn times(matrix: &[Colour; 3], colour: Colour) -> Colour {
    matrix.map(|row| row.iter().zip(colour).map(|(a, b)| a * b).sum())
}

/// A colour of the style, `#rrggbb`, as linear RGB; in the light theme or the dark one.
fn colour(name: &str, theme: usize) -> Colour {
    let value = STYLE.split(&format!("--{name}:#")).nth(1 + theme).unwrap_or_else(|| panic!("--{name}"));
    let long = if value.as_bytes()[3].is_ascii_hexdigit() { value[..6].to_owned() } else { value[..3].repeat(2) };
    [0, 2, 4].map(|at| {
        let share = f64::from(u8::from_str_radix(&long[at..at + 2], 16).unwrap()) / 255.0;
        if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
    })
}

fn lab(rgb: Colour) -> Colour {
    let xyz = times(&XYZ, rgb.map(|part| part.clamp(0.0, 1.0)));
    let white = times(&XYZ, [1.0; 3]);
    let [x, y, z] = [0, 1, 2].map(|i| {
        let share: f64 = xyz[i] / white[i];
        if share > 216.0 / 24389.0 { share.cbrt() } else { (24389.0 / 27.0 * share + 16.0) / 116.0 }
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn distance(a: Colour, b: Colour) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// A difference of 2.3 is just noticeable between large fields (Mahy and others, 1994); a thin line needs eight of
/// them.
#[test]
fn curves_are_told_apart_by_every_eye() {
    for theme in [0, 1] {
        for names in [&["a", "b", "c", "d", "e", "f"][..], &["truth", "estimate", "error"]] {
            for (eye, matrix) in &EYES {
                let seen: Vec<Colour> = names.iter().map(|name| lab(times(matrix, colour(name, theme)))).collect();
                for (i, one) in seen.iter().enumerate() {
                    for (j, other) in seen.iter().enumerate().skip(i + 1) {
                        let apart = distance(*one, *other);
                        assert!(apart >= 18.0, "{} and {}, {eye}, theme {theme}: {apart:.1}", names[i], names[j]);
                    }
                }
            }
        }
    }
}

/// Graphics need three to one against what lies beside them (WCAG 2.1, 1.4.11).
#[test]
fn curves_stand_out_from_the_page() {
    let luminance = |name: &str, theme| times(&XYZ, colour(name, theme))[1] + 0.05;
    for theme in [0, 1] {
        let sheet = luminance("sheet", theme);
        for name in ["a", "b", "c", "d", "e", "f", "estimate", "error"] {
            let one = luminance(name, theme);
            let contrast = one.max(sheet) / one.min(sheet);
            assert!(contrast >= 3.0, "{name}, theme {theme}: {contrast:.2}");
        }
    }
}

/// Published values: white, and the red of sRGB as CIELAB has it.
#[test]
fn colours_are_converted_as_published() {
    assert!(distance(lab([1.0; 3]), [100.0, 0.0, 0.0]) < 1e-3);
    // Lindbloom's calculator, sRGB, D65: rounded to four digits, the white by the matrix's own sum
    assert!(distance(lab([1.0, 0.0, 0.0]), [53.24, 80.09, 67.20]) < 0.02);
}
