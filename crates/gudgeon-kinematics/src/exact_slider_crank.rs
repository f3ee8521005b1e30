use gudgeon_core::kinds::{Kinematics, KinematicsCtx, KinematicsSpec, PistonMotion};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The slider-crank mechanism as it is, offset included.
///
/// ```text
/// sin φ = (r sin θ - e)/l
/// y = r cos θ + l cos φ
/// v = -ω r sin(θ + φ)/cos φ
/// a = -ω² r cos θ - l (φ'² cos φ + φ'' sin φ),  φ' = ω r cos θ/(l cos φ),  φ'' = (φ'² sin φ - ω² (r/l) sin θ)/cos φ
/// ```
///
/// `r` crank radius, `l` rod length, `e` offset, positive on the side the throw moves to after top dead centre. The highest
/// and lowest positions are `√((l±r)² - e²)`, reached at `sin θ = e/(l±r)`.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExactSliderCrank {}

#[register_model(
    name = "exact_slider_crank",
    summary = "exact slider-crank with crank or pin offset",
    equations = "y = r cos(theta) + l cos(phi);  sin(phi) = (r sin(theta) - e)/l;  v = -omega r sin(theta + phi)/cos(phi);  a = dv/dt",
    validity = "Rigid parts, constant crank speed, rod longer than crank radius plus offset.",
    references = ["zottin1992", "heywood1988"],
    example = "",
)]
impl KinematicsSpec for ExactSliderCrank {
    fn build(&self, ctx: &KinematicsCtx) -> Result<Box<dyn Kinematics>, BuildError> {
        super::check_mechanism(ctx)?;
        let KinematicsCtx { crank_radius: r, rod_length: l, offset: e, omega } = *ctx;
        // √((l+r)² - e²) without squaring the large sum twice, and the difference of the two dead centres without
        // cancellation: stroke = 4 l r/(top + bottom).
        let (top, bottom) = (((l + r - e) * (l + r + e)).sqrt(), ((l - r - e) * (l - r + e)).sqrt());
        Ok(Box::new(Exact { r, l, e, omega, y_tdc: top, stroke: 4.0 * l * r / (top + bottom) }))
    }
}

#[derive(Debug, Clone)]
pub(crate) struct Exact {
    pub(crate) r: f64,
    pub(crate) l: f64,
    pub(crate) e: f64,
    pub(crate) omega: f64,
    pub(crate) y_tdc: f64,
    pub(crate) stroke: f64,
}

impl Kinematics for Exact {
    fn motion(&self, theta: f64) -> PistonMotion {
        let Self { r, l, e, omega, .. } = *self;
        let (sin, cos) = theta.sin_cos();
        let sin_phi = (r * sin - e) / l;
        let cos_phi = ((1.0 - sin_phi) * (1.0 + sin_phi)).sqrt();
        let tan_phi = sin_phi / cos_phi;
        // φ' = ω q with q = r cos θ/(l cos φ). With φ'' inserted, l (φ'² cos φ + φ'' sin φ) = ω² (l q²/cos φ - r sin θ tan φ).
        let q = r * cos / (l * cos_phi);
        PistonMotion {
            y: r * cos + l * cos_phi,
            v: -omega * r * (sin + cos * tan_phi),
            a: -omega * omega * (r * (cos - sin * tan_phi) + l * q * q / cos_phi),
            rod_angle: sin_phi.asin(),
        }
    }
    fn y_tdc(&self) -> f64 {
        self.y_tdc
    }
    fn stroke(&self) -> f64 {
        self.stroke
    }
    fn omega(&self) -> f64 {
        self.omega
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Case {
        r: f64,
        l: f64,
        e: f64,
        rpm: f64,
        y_tdc: f64,
        stroke: f64,
        theta_tdc: f64,
        theta_bdc: f64,
        /// θ \[deg\], y, v, a, φ.
        rows: &'static [[f64; 5]],
        /// cosine and sine coefficients of y/r, orders 0 to 8.
        fourier: [[f64; 2]; 9],
    }

    /// Slider-crank values computed with 25 digits (zeros below 1e-38 written as zero).
    #[rustfmt::skip]
    const CASES: &[Case] = &[
        Case {
            r: 0.045, l: 0.144, e: 0.0, rpm: 3000.0, y_tdc: 0.189, stroke: 0.09, theta_tdc: 0.0, theta_bdc: std::f64::consts::PI,
            rows: &[
                [0.0, 0.189, 0.0, -5829.235099393402, 0.0],
                [10.0, 0.18810417444302044, -3.2115074511344277, -5683.965858825813, 0.05429172322470306],
                [45.0, 0.17226018396233975, -12.261406848708221, -3177.0158753621486, 0.2228098353264114],
                [90.0, 0.13678815738213598, -14.137166941154069, 1461.0876624628063, 0.31782370392788073],
                [135.0, 0.10862057365555047, -7.731566373004426, 3103.9619043128428, 0.2228098353264114],
                [180.0, 0.099, 0.0, 3053.4088615870205, 0.0],
                [200.0, 0.10088896956642933, 3.4071413293208255, 3089.9053469818537, -0.10708584310895727],
                [270.0, 0.13678815738213598, 14.137166941154069, 1461.0876624628063, -0.31782370392788073],
                [315.0, 0.17226018396233975, 12.261406848708221, -3177.0158753621486, -0.2228098353264114],
                [350.0, 0.18810417444302044, 3.2115074511344277, -5683.965858825813, -0.05429172322470306],
            ],
            fourier: [[3.1203829671576466, 0.0], [1.0, 0.0], [0.08012497642328816, 0.0], [0.0, 0.0], [-0.0005144457174639579, 0.0], [0.0, 0.0], [6.606312327864412e-06, 0.0], [0.0, 0.0], [-1.0604637441235102e-07, 0.0]],
        },
        Case {
            r: 0.045, l: 0.144, e: 0.0008, rpm: 3000.0, y_tdc: 0.18899830687072305, stroke: 0.09000153924672434, theta_tdc: 0.004232816872505205, theta_bdc: 3.1496735496185853,
            rows: &[
                [0.0, 0.18899777776063073, 0.07854102840200468, -5829.299357109461, -0.0055555841339131554],
                [10.0, 0.18814541912984228, -3.1338519425288323, -5687.10476841669, 0.048728782044344277],
                [45.0, 0.17243904881600802, -12.201654686082755, -3192.9366001207554, 0.2171171084061381],
                [90.0, 0.13704875045034157, -14.137166941154069, 1432.3839574794026, 0.31198082664458593],
                [135.0, 0.10879943850921873, -7.791318535629894, 3088.0411795542364, 0.2171171084061381],
                [180.0, 0.09899777776063073, -0.07854102840200468, 3053.3446038709617, -0.0055555841339131554],
                [200.0, 0.10080070968916864, 3.331986197982666, 3096.190212434197, -0.112675113602864],
                [270.0, 0.13652237911785745, 14.137166941154069, 1489.9575294600534, -0.32367783399927025],
                [315.0, 0.1720765280288225, 12.321390820647892, -3161.1138439468673, -0.22850991437345694],
                [350.0, 0.1880584655728784, 3.2892334337757605, -5680.950462201229, -0.05985634671690398],
            ],
            fourier: [[3.1203296010649675, 0.0], [1.0, 0.005772485915978728], [0.08012908756123095, 0.0], [0.0, -7.461236735755156e-05], [-0.0005145777038003506, 0.0], [0.0, 1.440497337464907e-06], [6.610267455368735e-06, 0.0], [0.0, -3.086947482572014e-08], [-1.0616066614170145e-07, 0.0]],
        },
        Case {
            r: 0.045, l: 0.144, e: -0.0008, rpm: 6000.0, y_tdc: 0.18899830687072305, stroke: 0.09000153924672434, theta_tdc: -0.004232816872505205, theta_bdc: 3.133511757561001,
            rows: &[
                [0.0, 0.18899777776063073, -0.15708205680400936, -23317.197428437845, 0.0055555841339131554],
                [10.0, 0.1880584655728784, -6.578466867551521, -22723.801848804917, 0.05985634671690398],
                [45.0, 0.1720765280288225, -24.642781641295784, -12644.45537578747, 0.22850991437345694],
                [90.0, 0.13652237911785745, -28.274333882308138, 5959.8301178402135, 0.32367783399927025],
                [135.0, 0.10843691772203322, -15.343164802129511, 12479.455742912496, 0.22850991437345694],
                [180.0, 0.09899777776063073, 0.15708205680400936, 12213.378415483847, 0.0055555841339131554],
                [200.0, 0.10097270770233209, 6.9643223087443165, 12334.049663447518, -0.10149992884501981],
                [270.0, 0.13704875045034157, 28.274333882308138, 5729.5358299176105, -0.31198082664458593],
                [315.0, 0.17243904881600802, 24.40330937216551, -12771.746400483022, -0.2171171084061381],
                [350.0, 0.18814541912984228, 6.2677038850576645, -22748.41907366676, -0.048728782044344277],
            ],
            fourier: [[3.1203296010649675, 0.0], [1.0, -0.005772485915978728], [0.08012908756123095, 0.0], [0.0, 7.461236735755156e-05], [-0.0005145777038003506, 0.0], [0.0, -1.440497337464907e-06], [6.610267455368735e-06, 0.0], [0.0, 3.086947482572014e-08], [-1.0616066614170145e-07, 0.0]],
        },
        Case {
            r: 0.045, l: 0.144, e: 0.01, rpm: 6000.0, y_tdc: 0.18873526432545668, stroke: 0.09024160970750679, theta_tdc: 0.052934770778313, theta_bdc: 3.2427753164335473,
            rows: &[
                [0.0, 0.18865235814284428, 1.968247110443732, -23357.343378351023, -0.06950038225193148],
                [10.0, 0.1882997581327469, -4.487071056885695, -22928.336837238956, -0.015179971907547074],
                [45.0, 0.1741570669756873, -23.057826195204953, -13510.497617937477, 0.15211234652746244],
                [90.0, 0.1396817812028469, -28.274333882308138, 4451.440065513402, 0.24551463117242628],
                [135.0, 0.11051745666889802, -16.928120248220342, 11613.41350076249, 0.15211234652746244],
                [180.0, 0.09865235814284429, -1.968247110443732, 12173.232465570669, -0.06950038225193148],
                [200.0, 0.09945762159230571, 4.910989993078835, 12642.261229266209, -0.1772524478609334],
                [270.0, 0.133082681067072, 28.274333882308138, 7341.983403651187, -0.39189933931503657],
                [315.0, 0.16961350565139313, 26.060756012560944, -11917.502530832362, -0.2946608286840886],
                [350.0, 0.18721020956068646, 8.381115858225776, -22621.064694028755, -0.1240272355842472],
            ],
            fourier: [[3.1120309669386628, 0.0], [1.0, 0.07235883881284916], [0.08077194414027583, 0.0], [0.0, -0.000945494055183576], [-0.0005354057395374248, 0.0], [0.0, 1.8583986316129706e-05], [7.242390129674522e-06, 0.0], [0.0, -4.0827545647996146e-07], [-1.2472699692984504e-07, 0.0]],
        },
        Case {
            r: 0.02, l: 0.07, e: 0.004, rpm: 1450.0, y_tdc: 0.08991106717195609, stroke: 0.04007132399444764, theta_tdc: 0.04445908938177131, theta_bdc: 3.2216782336234524,
            rows: &[
                [0.0, 0.0898856208386246, 0.17381961336411025, -593.529192719276, -0.057174001080663006],
                [10.0, 0.08969417097915354, -0.5048292797796661, -582.5166170388111, -0.0075291632308704835],
                [45.0, 0.08340350353535862, -2.46184223856305, -346.32681562568945, 0.14539942519940371],
                [90.0, 0.06814690014960328, -3.0368728984701336, 108.26725184818055, 0.23061001128611341],
                [135.0, 0.055119232287896724, -1.8329446016567041, 305.8092723627881, 0.14539942519940371],
                [180.0, 0.04988562083862459, -0.17381961336411025, 328.7305074269629, -0.057174001080663006],
                [200.0, 0.050361665554229024, 0.5913386229463371, 337.38924090909984, -0.15548867572834157],
                [270.0, 0.06575712889109439, 3.0368728984701336, 168.3029138952219, -0.3499567112430624],
                [315.0, 0.0817502927869768, 2.723630139165428, -311.68777598543136, -0.26216622587692295],
                [350.0, 0.08929611781691862, 0.8484634345779772, -575.5212186590654, -0.1069604530895517],
            ],
            fourier: [[3.421339566724632, 0.0], [1.0, 0.05909686436598188], [0.07333576386132541, 0.0], [0.0, -0.0006369186330496987], [-0.00039862143215368614, 0.0], [0.0, 1.030875446664931e-05], [4.393125890939618e-06, 0.0], [0.0, -1.860956658329993e-07], [-6.130153929735667e-08, 0.0]],
        },
    ];

    fn build(c: &Case) -> Box<dyn Kinematics> {
        let omega = c.rpm * std::f64::consts::PI / 30.0;
        ExactSliderCrank {}
            .build(&KinematicsCtx { crank_radius: c.r, rod_length: c.l, offset: c.e, omega })
            .expect("builds")
    }

    #[test]
    fn meets_25_digit_values() {
        for c in CASES {
            let k = build(c);
            let w = k.omega();
            for &[deg, y, v, a, phi] in c.rows {
                let m = k.motion(deg.to_radians());
                // Rounding only. v and a are measured against r ω and r ω²: they pass through zero, where the rounding of
                // θ itself (π is not a double) leaves 1e-16 of those scales; a few ulp more from the products.
                assert!((m.y - y).abs() < 5e-16, "{deg}: y {}", m.y);
                assert!((m.v - v).abs() < 2e-15 * c.r * w, "{deg}: v {}", m.v);
                assert!((m.a - a).abs() < 3e-15 * c.r * w * w, "{deg}: a {}", m.a);
                assert!((m.rod_angle - phi).abs() < 5e-16, "{deg}: phi {}", m.rod_angle);
            }
            assert!((k.y_tdc() / c.y_tdc - 1.0).abs() < 5e-16);
            assert!((k.stroke() / c.stroke - 1.0).abs() < 5e-16);
            // The dead centres: position reached, velocity zero to the rounding of θ.
            for (theta, y) in [(c.theta_tdc, c.y_tdc), (c.theta_bdc, c.y_tdc - c.stroke)] {
                let m = k.motion(theta);
                assert!((m.y - y).abs() < 5e-16);
                assert!(m.v.abs() < 2e-15 * c.r * w);
            }
        }
    }

    #[test]
    fn has_the_exact_fourier_coefficients() {
        for c in CASES {
            let k = build(c);
            // 64 samples alias orders above 55 onto those below 9: (r/4l)^27 is below 1e-30.
            let n = 64;
            for (order, [cos, sin]) in c.fourier.iter().enumerate() {
                let (mut s_cos, mut s_sin) = (0.0, 0.0);
                for i in 0..n {
                    let t = std::f64::consts::TAU * f64::from(i) / f64::from(n);
                    let y = k.motion(t).y / c.r;
                    s_cos += y * (order as f64 * t).cos();
                    s_sin += y * (order as f64 * t).sin();
                }
                let norm = if order == 0 { f64::from(n) } else { f64::from(n) / 2.0 };
                // 64 roundings of numbers near 4, averaged.
                assert!((s_cos / norm - cos).abs() < 4e-15, "order {order}: {}", s_cos / norm);
                assert!((s_sin / norm - sin).abs() < 4e-15, "order {order}: {}", s_sin / norm);
            }
        }
    }

    #[test]
    fn v_and_a_are_the_derivatives_of_y() {
        for c in CASES {
            let k = build(c);
            let w = k.omega();
            for i in 0..24 {
                let t = 0.1 + 0.26 * f64::from(i);
                // Fourth-order central differences: truncation h⁴/30 y⁗⁺ᵢ < 1e-13 for h = 1e-3 times derivatives below 3 r
                // (8e-14); rounding 1e-16 l/h = 2e-14 m, which is 4e-12 of the smallest crank radius.
                let h = 1e-3;
                let d = |f: &dyn Fn(f64) -> f64| {
                    (8.0 * (f(t + h) - f(t - h)) - (f(t + 2.0 * h) - f(t - 2.0 * h))) / (12.0 * h) * w
                };
                let m = k.motion(t);
                assert!((d(&|x| k.motion(x).y) - m.v).abs() < 2e-11 * c.r * w);
                assert!((d(&|x| k.motion(x).v) - m.a).abs() < 2e-11 * c.r * w * w);
            }
        }
    }

    #[test]
    fn printed_values_of_a_diesel_crank() {
        // Zottin (1992) kinematics, r 70 mm, l 240 mm, 2000 1/min: θ, y, v, a; NaN where none is stated.
        let rows = [
            (30.0, 0.298_056_0, -9.201_979, -3_126.548_3),
            (75.0, f64::NAN, -15.275_356, 8.227_4),
            (90.0, 0.229_564_8, -14.660_766, 936.284_9),
            (0.0, f64::NAN, 0.0, -3_966.118_8),
            (180.0, f64::NAN, 0.0, 2_174.968_4),
        ];
        let omega = 2000.0 * std::f64::consts::PI / 30.0;
        let k = ExactSliderCrank {}
            .build(&KinematicsCtx { crank_radius: 0.07, rod_length: 0.24, offset: 0.0, omega })
            .expect("builds");
        for (deg, y, v, a) in rows {
            let m = k.motion(f64::to_radians(deg));
            // Half a unit of the last digit stated.
            assert!(y.is_nan() || (m.y - y).abs() <= 0.5e-7);
            assert!((m.v - v).abs() <= 0.5e-6, "{deg}: {}", m.v);
            assert!((m.a - a).abs() <= 0.5e-4, "{deg}: {}", m.a);
        }
        // A free ring, -(a + 9.8), changes sides at 74.74° and 285.26°.
        let side = |deg: f64| k.motion(deg.to_radians()).a + 9.8;
        // The stated angles have two decimals.
        assert!(side(74.735) < 0.0 && side(74.745) > 0.0);
        assert!(side(285.255) > 0.0 && side(285.265) < 0.0);
    }

    #[test]
    fn refuses_a_crank_that_cannot_turn() {
        let e = |r, l, e, omega| {
            ExactSliderCrank {}
                .build(&KinematicsCtx { crank_radius: r, rod_length: l, offset: e, omega })
                .err()
                .map(|e| e.field)
                .unwrap_or_default()
        };
        assert_eq!(e(0.05, 0.05, 0.0, 100.0), "rod_length");
        assert_eq!(e(0.05, 0.06, -0.01, 100.0), "rod_length");
        assert_eq!(e(0.05, 0.0601, -0.01, 100.0), "");
        assert_eq!(e(f64::NAN, 0.06, 0.0, 100.0), "crank_radius");
        assert_eq!(e(0.05, 0.15, f64::INFINITY, 100.0), "offset");
        assert_eq!(e(0.05, 0.15, 0.0, 0.0), "omega");
    }
}
