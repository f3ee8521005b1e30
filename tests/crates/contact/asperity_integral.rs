//! The integrals of a Gaussian height distribution, against values with many digits and their identities.

use gudgeon_contact::{asperity_integral, f_1, f_2, f_3_2, f_5_2};

/// Where the asymptotic series for deep overlap begins.
const DEEP: f64 = -8.0;
/// Where the tables end.
const FAR: f64 = 10.0;
/// Segments of the tables per unit of `λ`.
const PER_UNIT: f64 = 8.0;

/// λ, F_0, F_(1/2), F_1, F_(3/2), F_2, F_(5/2), computed with 25 digits from parabolic cylinder functions.
#[rustfmt::skip]
const EXACT: &[[f64; 7]] = &[
    [-2.0, 0.9772498680518208, 1.3566405981393808, 2.0084907026168297, 3.111292885687599, 4.99423127328548, 8.257546668584268],
    [-1.0, 0.8413447460685429, 0.9006029312703163, 1.0833154705876864, 1.4045974704739523, 1.9246602166562292, 2.7555018673794267],
    [0.0, 0.5, 0.4110894793312293, 0.3989422804014327, 0.4300199936622598, 0.5, 0.6166342189968439],
    [0.25, 0.4012936743170763, 0.310513512489138, 0.28634469822358016, 0.29516724046157017, 0.32970749976118124, 0.3919784586183145],
    [0.5, 0.3085375387259869, 0.2253355816973116, 0.19779655740130603, 0.19520360374379064, 0.20963926002533387, 0.2404015706740721],
    [0.75, 0.2266273523768682, 0.15668774956470094, 0.13116691787215326, 0.12409268046780335, 0.12825216397275327, 0.14196211399619887],
    [1.0, 0.15865525393145705, 0.1041536753078577, 0.0833154705876863, 0.07566817739097507, 0.07533978334377076, 0.08056233557081147],
    [1.25, 0.10564977366685525, 0.06604636703277829, 0.05058686830545283, 0.044170735496362815, 0.042416188285039215, 0.04385613117871391],
    [1.5, 0.06680720126885807, 0.039881517654695796, 0.02930679376260463, 0.024639480307483735, 0.022847010624951123, 0.02286305602081809],
    [1.75, 0.04005915686381709, 0.02289594621254856, 0.016173794314831607, 0.013112911644412651, 0.01175501681286178, 0.011396323941100697],
    [2.0, 0.02275013194817921, 0.012480040296439067, 0.008490702616829637, 0.006648177623587093, 0.005768726714519932, 0.005423705197484414],
    [2.25, 0.012224472655044703, 0.006451034146934628, 0.0042345883618168335, 0.0032068043757752978, 0.0026966488409568275, 0.002461241374907522],
    [2.5, 0.006209665325776135, 0.0031590230326521717, 0.0020041371791281993, 0.0014699382395379915, 0.0011993223779556365, 0.0010636889501332788],
    [2.75, 0.002979763235054557, 0.0014641973550413403, 0.0008992136051910217, 0.0006396276495975517, 0.0005069258207792471, 0.00043731999616874307],
    [3.0, 0.0013498980316300946, 0.0006418504393485508, 0.0003821543170477236, 0.0002639675542694673, 0.00020343508048692373, 0.00017087299621442438],
    [3.25, 0.000577025042390767, 0.0002659273168148375, 0.0001537166695297749, 0.00010323011667738047, 7.744586641899863e-05, 6.339309602076967e-05],
    [3.5, 0.00023262907903552504, 0.00010407145290773235, 5.848091842142244e-05, 3.8227077760961094e-05, 2.7945864560546504e-05, 2.2312407198234688e-05],
    [3.75, 8.841728520080387e-05, 3.845177088673138e-05, 2.1030862864430887e-05, 1.3395389355621701e-05, 9.551549459188045e-06, 7.444946246515686e-06],
    [4.0, 3.1671241833119924e-05, 1.340666992449641e-05, 7.145258432405667e-06, 4.439155958539252e-06, 3.090208103497254e-06, 2.353381052587606e-06],
    [4.5, 3.3976731247300603e-06, 1.3674721507435336e-06, 6.942120456202026e-07, 4.1149986385075114e-07, 2.7371891943914856e-07, 1.9945883878692032e-07],
    [5.0, 2.866515718791939e-07, 1.1014563207789281e-07, 5.346165533832815e-08, 3.033850561878485e-08, 1.9343295187553163e-08, 1.3525920022914967e-08],
    [6.0, 9.86587645037698e-10, 3.490963471387392e-10, 1.5635697959709664e-10, 8.203580589815166e-11, 4.8445767455118286e-11, 3.142968531919884e-11],
    [8.0, 6.220960574271784e-16, 1.9240743960372775e-16, 7.550262411946499e-17, 3.4783997922186915e-17, 1.80750644714585e-17, 1.0339176028096326e-17],
    [10.0, 7.619853024160525e-24, 2.117479299141611e-24, 7.474560254589328e-25, 3.101206508673169e-25, 1.4529276957119804e-25, 7.501244003924727e-26],
];

/// (λ, F_(5/2)) of overlapping mean planes, from the same source.
const OVERLAP: [(f64, f64); 9] = [
    (-6.0, 92.766_303_514_607_79),
    (-5.25, 67.439_804_852_394_24),
    (-4.5, 46.921_511_256_376_57),
    (-3.7, 29.922_497_811_960_83),
    (-3.0, 18.811_329_832_415_762),
    (-2.3, 10.826_520_024_186_844),
    (-1.6, 5.536_845_623_213_327),
    (-0.9, 2.420_923_032_586_102_5),
    (-0.25, 0.937_889_204_159_909_3),
];

#[test]
fn quadrature_meets_the_parabolic_cylinder_values() {
    for row in EXACT {
        for (i, n) in [(2, 0.5), (3, 1.0), (4, 1.5), (5, 2.0), (6, 2.5)] {
            let f = asperity_integral(n, row[0]);
            // Rounding of exp(-λ²/2): half an ulp of λ²/2 <= 50 is 4e-15, times a few.
            assert!((f / row[i] - 1.0).abs() < 4e-14, "n {n} λ {}: {f:e}", row[0]);
        }
    }
}

#[test]
fn tables_meet_the_parabolic_cylinder_values() {
    for row in EXACT {
        // The documented bound of the Taylor pieces; λ = 10 lies outside, the last piece ends there.
        if row[0] < FAR {
            assert!((f_3_2(row[0]) / row[4] - 1.0).abs() < 1e-10, "F_3/2({})", row[0]);
            assert!((f_2(row[0]) / row[5] - 1.0).abs() < 1e-10, "F_2({})", row[0]);
            assert!((f_5_2(row[0]) / row[6] - 1.0).abs() < 1e-10, "F_5/2({})", row[0]);
        }
    }
}

#[test]
fn overlapping_mean_planes_meet_the_parabolic_cylinder_values() {
    for (l, exact) in OVERLAP {
        // As documented: rounding and, between the nodes of the pieces, 1e-11.
        assert!((f_5_2(l) / exact - 1.0).abs() < 1e-11, "{l}: {:e}", f_5_2(l));
        assert!((asperity_integral(2.5, l) / exact - 1.0).abs() < 1e-13, "{l}");
    }
}

#[test]
fn mean_gap_is_closed() {
    // F_1(-H) - F_1(H) = H for every H, and F_1(0) = 1/√(2π); Taylor pieces to 1e-11 of themselves.
    for h in [0.0, 0.3, 1.7, 4.4, 7.9, 8.1, 12.0] {
        assert!((f_1(-h) - f_1(h) - h).abs() < 1e-11 * (h + 1.0), "{h}");
    }
    assert!((f_1(0.0) * std::f64::consts::TAU.sqrt() - 1.0).abs() < 1e-14);
}

#[test]
fn tables_meet_the_quadrature_everywhere() {
    let (mut worst, mut worst_near) = (0.0_f64, 0.0_f64);
    // An irrational-looking step visits every part of every piece, ends included.
    let mut l = -12.0;
    while l < FAR {
        for (n, f) in [(1.5, f_3_2(l)), (2.0, f_2(l)), (2.5, f_5_2(l))] {
            let e = (f / asperity_integral(n, l) - 1.0).abs();
            worst = worst.max(e);
            if l < 6.7 {
                worst_near = worst_near.max(e);
            }
        }
        l += 0.003_717;
    }
    // First neglected Taylor terms as documented at TERMS, with their headroom.
    assert!(worst < 2e-10, "worst {worst:e}");
    assert!(worst_near < 4e-12, "worst below 6.7: {worst_near:e}");
}

#[test]
fn identities_hold() {
    let mut l = -9.0;
    while l < 9.5 {
        let f = |n| asperity_integral(n, l);
        // F_(n+1) = n F_(n-1) - λ F_n cancels at large λ: the difference is measured against its largest term.
        let scale = f(3.0).abs().max((l * f(2.0)).abs());
        assert!((f(3.0) - (2.0 * f(1.0) - l * f(2.0))).abs() < 1e-13 * scale.max(2.0 * f(1.0)), "{l}");
        l += 0.37;
    }
    // F_2(0) = 1/2 and F_1(0) = 1/√(2π); quadrature rounding only.
    assert!((asperity_integral(2.0, 0.0) - 0.5).abs() < 1e-15);
    assert!((asperity_integral(1.0, 0.0) - 1.0 / std::f64::consts::TAU.sqrt()).abs() < 1e-15);
}

#[test]
fn extremes() {
    assert_eq!(f_5_2(f64::INFINITY), 0.0);
    assert_eq!(f_5_2(1e300), 0.0);
    assert_eq!(f_2(FAR), 0.0);
    // Deep overlap: F_n -> |λ|^n; the next term of the series is 15/8 λ^-2.
    assert!((f_5_2(-1e6) / 1e15 - 1.0).abs() < 2e-12);
    assert!(f_5_2(f64::NAN).is_nan());
}

#[test]
fn value_and_slope_are_continuous_across_pieces() {
    // Left and right of every joint, one ulp apart: the jump is twice the truncation of one piece.
    for i in 0..((6.7 - DEEP) * PER_UNIT) as usize {
        let joint = DEEP + i as f64 / PER_UNIT;
        let (left, right) = (f_5_2(joint.next_down()), f_5_2(joint));
        assert!((left / right - 1.0).abs() < 1e-11, "{joint}: {left:e} {right:e}");
        // One-sided difference quotients against -n F_(n-1): h²F'''/F' is below 1e-5 for h = 1e-4 up to λ = 6.7,
        // the jump of 1e-12 F divided by h contributes 1e-8.
        let h = 1e-4;
        for side in [-h, h] {
            let mid = joint + side;
            let slope = (f_5_2(mid + 0.5 * h) - f_5_2(mid - 0.5 * h)) / h;
            let exact = -2.5 * asperity_integral(1.5, mid);
            assert!((slope / exact - 1.0).abs() < 1e-5, "{joint}: {slope:e} {exact:e}");
        }
    }
}
