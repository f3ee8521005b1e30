//! A diagonally implicit method whose first stage is the end of the step before.

/// A stiffly accurate, L-stable method: stage `i` stands at `c_i h`, its place is `y + h Σ_{j<i} a_ij w_j + h γ w_i`, and the last one is the end of the step.
pub struct Formula {
    /// Weight `γ` of the own rate of every implicit stage.
    pub diagonal: f64,
    /// Where the stages stand in the step.
    pub c: &'static [f64],
    /// Weights of the rates of the stages before, stage after stage.
    pub a: &'static [&'static [f64]],
    /// Weights of the rates in the result that the end is compared with; the difference goes with the cube of the step.
    pub compared: &'static [f64],
    /// The stage nearest to the middle of the step.
    pub middle: usize,
}

/// The implicit part of ARK3(2)4L\[2\]SA: order 3, compared with order 2 (`kennedy2003`).
pub const ESDIRK3: Formula = {
    const D: f64 = 1_767_732_205_903.0 / 4_055_673_282_236.0;
    Formula {
        diagonal: D,
        c: &[0.0, 2.0 * D, 0.6, 1.0],
        a: &[
            &[],
            &[D],
            &[2_746_238_789_719.0 / 10_658_868_560_708.0, -640_167_445_237.0 / 6_845_629_431_997.0],
            &[
                1_471_266_399_579.0 / 7_840_856_788_654.0,
                -4_482_444_167_858.0 / 7_529_755_066_697.0,
                11_266_239_266_428.0 / 11_593_286_722_821.0,
            ],
        ],
        compared: &[
            2_756_255_671_327.0 / 12_835_298_489_170.0,
            -10_771_552_573_575.0 / 22_201_958_757_719.0,
            9_247_589_265_047.0 / 10_645_013_368_117.0,
            2_193_209_047_091.0 / 5_459_859_503_100.0,
        ],
        middle: 2,
    }
};

impl Formula {
    /// Weight of rate `j` in the end of the step less that in the result it is compared with.
    #[must_use]
    pub fn difference(&self, j: usize) -> f64 {
        let end = self.c.len() - 1;
        self.a[end].get(j).copied().unwrap_or(self.diagonal) - self.compared[j]
    }

    /// A guess of the rates of the stage after those in `before`, in a step of `time` \[s\]: the polynomial through them, with the `slope` of the step before
    /// where they are one alone.
    pub fn foresee(&self, before: &[Vec<f64>], slope: &[f64], time: f64, guess: &mut [f64]) {
        let c = self.c[before.len()];
        guess.fill(0.0);
        if let [first] = before {
            for (g, (w, slope)) in guess.iter_mut().zip(first.iter().zip(slope)) {
                *g = w + c * time * slope;
            }
            return;
        }
        for (i, rates) in before.iter().enumerate() {
            let others = (0..before.len()).filter(|j| *j != i);
            let part: f64 = others.map(|j| (c - self.c[j]) / (self.c[i] - self.c[j])).product();
            guess.iter_mut().zip(rates).for_each(|(g, w)| *g += part * w);
        }
    }
}
