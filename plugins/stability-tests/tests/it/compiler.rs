//! A guard against a compiler that gets plain floating-point code wrong.
//!
//! LLVM 22 (rustc 1.95) was seen to vectorise the loop below wrongly for CPUs with AVX2 (`target-cpu`
//! x86-64-v3 or native), with a wrong boolean as result. The project sets no `target-cpu`; whoever does
//! learns here that stability verdicts cannot be trusted.

use std::hint::black_box;

/// Whether every plane through two of the vectors (and the origin) has others on both sides: they span space
/// positively.
#[inline(never)]
fn spans_positively(vectors: &[[f64; 3]; 6]) -> bool {
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    for first in 0..6 {
        for second in first + 1..6 {
            let (a, b) = (&vectors[first], &vectors[second]);
            let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            if dot(&normal, &normal) < 1e-18 {
                continue;
            }
            let (mut above, mut below) = (false, false);
            for (other, vector) in vectors.iter().enumerate() {
                if other != first && other != second {
                    let height = dot(&normal, vector);
                    above |= height > 1e-9;
                    below |= height < -1e-9;
                }
            }
            if !(above && below) {
                return false;
            }
        }
    }
    true
}

/// The same in whole numbers, which no vectoriser of floating-point code touches.
fn spans_positively_exactly(vectors: &[[i128; 3]; 6]) -> bool {
    let dot = |a: &[i128; 3], b: &[i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    (0..6).flat_map(|first| (first + 1..6).map(move |second| (first, second))).all(|(first, second)| {
        let (a, b) = (&vectors[first], &vectors[second]);
        let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let side = |sign: i128| {
            let others = (0..6).filter(|other| *other != first && *other != second);
            others.map(|other| dot(&normal, &vectors[other])).any(|height| height * sign > 0)
        };
        side(1) && side(-1)
    })
}

/// A set of vectors on which the miscompilation was seen: scaled by 10¹⁰ they are whole numbers.
const SEEN: [[i64; 3]; 6] = [
    [-3_023_291_468, 9_532_035_916, -8_227_799_477],
    [7_916_140_829, 6_110_213_938, 4_971_997_841],
    [-7_835_971_482, 6_212_692_728, -5_248_765_037],
    [3_507_017_830, 9_364_871_913, 8_016_338_379],
    [4_766_938_579, -8_790_693_749, -10_500_094_090],
    [-6_938_735_225, -7_200_968_927, 13_948_764_737],
];

#[test]
fn plain_loops_over_floating_point_numbers_are_compiled_rightly() {
    assert!(spans_positively_exactly(&SEEN.map(|v| v.map(i128::from))));
    let scaled = SEEN.map(|vector| vector.map(|x| x as f64 * 1e-10));
    assert!(
        spans_positively(black_box(&scaled)),
        "this build miscompiles floating-point loops: build without a target-cpu, or with `-C \
            no-vectorize-slp`"
    );
}

#[test]
fn random_sets_agree_with_whole_numbers() {
    let mut random = regrasp_api::Random::from_key(31, 0, 0, 0);
    let mut spanning = 0;
    for _ in 0..20_000 {
        let whole: [[i64; 3]; 6] =
            std::array::from_fn(|_| std::array::from_fn(|_| (random.normal() * 1e6) as i64));
        let exact = spans_positively_exactly(&whole.map(|v| v.map(i128::from)));
        let scaled = whole.map(|vector| vector.map(|x| x as f64 * 1e-6));
        assert_eq!(spans_positively(black_box(&scaled)), exact, "{whole:?}");
        spanning += usize::from(exact);
    }
    assert!((2_000..18_000).contains(&spanning), "{spanning}");
}
