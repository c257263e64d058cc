//! A compiler fault that would make stability tests wrong must show itself here.
//!
//! rustc 1.95 (LLVM 22) at opt-level 3 with `target-cpu` x86-64-v3 or `native` compiles this plain f64 code
//! wrongly (the SLP vectoriser): the answer comes out false. At the baseline target it is right; the project
//! sets no `target-cpu`, and neither should whoever builds it.

/// Whether the vectors span all of space with nonnegative weights: no plane through two of them has all
/// others on one side.
///
/// Written out, since the fault goes away where loops and products are functions of their own.
#[expect(clippy::needless_range_loop, reason = "other loops hide the fault")]
#[inline(never)]
fn spans_positively(w: &[[f64; 3]; 6]) -> bool {
    for i in 0..6 {
        for j in i + 1..6 {
            let (a, b) = (&w[i], &w[j]);
            let c = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            if c[0] * c[0] + c[1] * c[1] + c[2] * c[2] < 1e-18 {
                continue;
            }
            let (mut above, mut below) = (false, false);
            for k in 0..6 {
                if k != i && k != j {
                    let height = c[0] * w[k][0] + c[1] * w[k][1] + c[2] * w[k][2];
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

#[test]
fn booleans_survive_vectorised_arithmetic() {
    let vectors = [
        [-0.3023291468377799, 0.9532035915649605, -0.8227799477366823],
        [0.7916140829364479, 0.6110213938125953, 0.49719784309809756],
        [-0.7835971482179097, 0.6212692727833553, -0.5248765036840195],
        [0.3507017830298945, 0.9364871912523165, 0.801633837924367],
        [0.47669385780029194, -0.8790693749275281, -1.0500094089767489],
        [-0.6938735224638897, -0.7200968926634485, 1.3948764737143926],
    ];
    assert!(
        spans_positively(std::hint::black_box(&vectors)),
        "this compiler miscompiles f64 code; set no target-cpu"
    );
}
