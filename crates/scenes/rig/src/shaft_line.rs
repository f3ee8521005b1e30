use std::f64::consts::PI;

use gudgeon_core::kinds::{
    CouplingSpec, Line, LineLink, LineNode, Mode, NaturalFrequenciesSpec, Rig, RigCtx, RigOut, RigSpec, named,
};
use gudgeon_core::quantity::{
    Inertia, NonNegative, PosFrequency, Torque, TorsionalDamping, TorsionalStiffness, quantity,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use gudgeon_numerics::linalg::Complex;
use gudgeon_torsion::natural_frequencies::Eigenvalues;
use gudgeon_torsion::tree::{Singular, Tree, Work};
use serde::{Deserialize, Serialize};

/// A chain of inertias: natural frequencies, and vibration under harmonic torques of one frequency.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShaftLineRig {
    /// Inertias along the chain.
    #[schemars(length(max = 2000))]
    pub inertias: Vec<Inertia<NonNegative>>,
    /// What joins each to the next.
    pub couplings: Vec<Box<dyn CouplingSpec>>,
    /// Damping of each inertia against the ground; empty: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub damping: Vec<TorsionalDamping<NonNegative>>,
    /// Stiffness against the ground of the first and the last inertia.
    #[serde(default = "free")]
    pub ends: [TorsionalStiffness<NonNegative>; 2],
    /// Frequency of the torques; without it only natural frequencies are sought.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency: Option<PosFrequency>,
    /// Amplitude of the torque on each inertia; empty: 1 N m on the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub torque: Vec<Torque>,
    /// Angle in degrees by which each of them lags; empty: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lag_deg: Vec<f64>,
    /// The model of natural frequencies.
    #[serde(default = "eigenvalues")]
    pub natural_frequencies: Box<dyn NaturalFrequenciesSpec>,
}

/// As many modes as the longest chain has inertias.
const MAX_INERTIAS: usize = 2000;

fn free() -> [TorsionalStiffness<NonNegative>; 2] {
    [quantity(0.0), quantity(0.0)]
}
fn eigenvalues() -> Box<dyn NaturalFrequenciesSpec> {
    Box::new(Eigenvalues { max_modes: MAX_INERTIAS })
}

#[register_model(
    name = "shaft_line",
    summary = "natural frequencies and harmonic response of a chain of inertias",
    equations = "(K - omega^2 J) phi = 0;  (K (1 + i eta) + i omega C - omega^2 J) a = T",
    validity = "Chains with linear or linearised couplings.",
    references = ["holzer1921"],
    example = "inertias = [\"0.5 kg m2\", \"0.2 kg m2\"]\ncouplings = [{ model = \"linear\", stiffness = \"10 kN m/rad\" }]\n",
)]
impl RigSpec for ShaftLineRig {
    fn models(&self) -> Vec<(&'static str, &'static str)> {
        let couplings = self.couplings.iter().map(|c| ("coupling", c.typetag_name()));
        std::iter::once(("natural_frequencies", self.natural_frequencies.typetag_name()))
            .chain(couplings)
            .collect()
    }
    fn build(&self, _: &RigCtx<'_>) -> Result<Box<dyn Rig>, Vec<BuildError>> {
        let n = self.inertias.len();
        let mut errors = Vec::new();
        let mut long = |name: &str, len: usize, wanted: usize| {
            if len != wanted {
                errors.push(BuildError::at(
                    name,
                    format!("{len} values, {wanted} are needed for {n} inertias"),
                ));
            }
        };
        long("couplings", self.couplings.len(), n.saturating_sub(1));
        for (name, len) in
            [("damping", self.damping.len()), ("torque", self.torque.len()), ("lag_deg", self.lag_deg.len())]
        {
            if len != 0 {
                long(name, len, n);
            }
        }
        if let Some(k) = self.lag_deg.iter().position(|v| !v.is_finite()) {
            errors.push(BuildError::at(format!("lag_deg.{k}"), "is not a finite number"));
        }
        let mut line = Line::default();
        for (i, j) in self.inertias.iter().enumerate() {
            let mut ground = 0.0;
            if i == 0 {
                ground += self.ends[0].si();
            }
            if i + 1 == n {
                ground += self.ends[1].si();
            }
            let damping = self.damping.get(i).map_or(0.0, |d| d.si());
            line.nodes.push(LineNode {
                name: format!("inertia {}", i + 1),
                inertia: j.si(),
                damping,
                ground,
                ratio: 1.0,
            });
        }
        for (i, c) in self.couplings.iter().enumerate() {
            match c.build() {
                Ok(coupling) => line.links.push(LineLink {
                    name: format!("shaft {}", i + 1),
                    nodes: [i, i + 1],
                    coupling,
                }),
                Err(e) => errors.push(e.within(&format!("couplings.{i}"))),
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        let tree = Tree::new(&line).map_err(|mut e| {
            e.field = e.field.replace("links", "couplings");
            vec![e]
        })?;
        // Checked with everything else, built again when it runs.
        self.natural_frequencies.build(&line).map_err(|e| vec![e.within("natural_frequencies")])?;
        Ok(Box::new(Bench { spec: self.clone(), line, tree }))
    }
}

struct Bench {
    spec: ShaftLineRig,
    line: Line,
    tree: Tree,
}

impl Bench {
    /// Amplitudes of the torque on the inertias, in the order of the tree.
    fn torque(&self) -> Vec<Complex> {
        (0..self.tree.len())
            .map(|p| {
                let i = self.tree.node[p];
                let size =
                    if self.spec.torque.is_empty() { f64::from(i == 0) } else { self.spec.torque[i].si() };
                let lag = self.spec.lag_deg.get(i).copied().unwrap_or(0.0).to_radians();
                Complex::new(size * elementary::cos(lag), -size * elementary::sin(lag))
            })
            .collect()
    }

    /// Vibration under the torques at one angular frequency \[rad/s\].
    fn forced(&mut self, omega: f64, out: &mut RigOut) -> Result<(), EvalError> {
        let n = self.tree.len();
        self.tree.linearise(&self.line, omega, &[]);
        let torque = self.torque();
        let (mut x, mut t) = (vec![Complex::default(); n], vec![Complex::default(); n]);
        let mut work = Work::new(n);
        self.tree
            .solve(Complex::new(0.0, omega), &torque, &mut x, &mut t, Singular::Refuse, &mut work)
            .map_err(|_| {
                EvalError::fatal(
                    "shaft_line",
                    "the frequency is an undamped natural frequency: the vibration grows without bound",
                )
            })?;
        for p in 0..n {
            let i = self.tree.node[p] + 1;
            out.result(
                format!("inertia{i}.amplitude"),
                x[p].abs(),
                "rad",
                format!("amplitude of inertia {i}"),
            );
            out.result(
                format!("inertia{i}.phase"),
                elementary::atan2(x[p].im, x[p].re),
                "rad",
                format!("phase of inertia {i}"),
            );
        }
        for p in 0..n - 1 {
            let i = self.tree.link[p] + 1;
            out.result(
                format!("shaft{i}.torque"),
                t[p].abs(),
                "N m",
                format!("torque amplitude of shaft {i}"),
            );
        }
        Ok(())
    }
}

impl Rig for Bench {
    fn results(&self) -> Vec<String> {
        let n = self.tree.len();
        let mode = |k: usize| {
            ["omega", "frequency", "decay", "damped_omega", "damping_ratio"]
                .map(|what| format!("mode.{k}.{what}"))
        };
        let mut names = named(&["rigid_modes"]);
        names.extend((1..=n).flat_map(mode));
        if self.spec.frequency.is_some() {
            names.extend(
                (1..=n).flat_map(|i| ["amplitude", "phase"].map(|what| format!("inertia{i}.{what}"))),
            );
            names.extend((1..=self.line.links.len()).map(|i| format!("shaft{i}.torque")));
        }
        names
    }

    fn run(&mut self, out: &mut RigOut) -> Result<(), EvalError> {
        let refused = |e: BuildError| EvalError::fatal("shaft_line", e.to_string());
        let modes = self.spec.natural_frequencies.build(&self.line).map_err(refused)?.modes()?;
        let rigid = modes.iter().filter(|m| m.omega == 0.0).count();
        out.result("rigid_modes", rigid as f64, "", "number of modes at frequency zero");
        frequencies(&modes[rigid..], out);
        shapes(&modes[rigid..], self.tree.len(), out);
        match self.spec.frequency {
            Some(frequency) => self.forced(2.0 * PI * frequency.si(), out),
            None => Ok(()),
        }
    }
}

/// Frequencies and damping of the elastic modes.
fn frequencies(modes: &[Mode], out: &mut RigOut) {
    for (k, m) in modes.iter().enumerate() {
        let k = k + 1;
        out.result(format!("mode.{k}.omega"), m.omega, "rad/s", format!("angular frequency of mode {k}"));
        out.result(
            format!("mode.{k}.frequency"),
            m.omega / (2.0 * PI),
            "Hz",
            format!("frequency of mode {k}"),
        );
        if let Some((decay, omega)) = m.damped {
            out.result(format!("mode.{k}.decay"), decay, "1/s", format!("decay rate of mode {k}"));
            out.result(
                format!("mode.{k}.damped_omega"),
                omega,
                "rad/s",
                format!("angular frequency of mode {k} with damping"),
            );
            out.result(
                format!("mode.{k}.damping_ratio"),
                decay / elementary::hypot(decay, omega),
                "",
                format!("damping ratio of mode {k}"),
            );
        }
    }
}

/// Shapes of the elastic modes over the inertias.
fn shapes(modes: &[Mode], n: usize, out: &mut RigOut) {
    out.axis("inertia", "", (1..=n).map(|i| i as f64).collect());
    for (k, m) in modes.iter().enumerate().filter(|(_, m)| m.shape.len() == n) {
        out.column(format!("mode{}", k + 1), "", m.shape.clone());
    }
    let lines: Vec<(String, String)> = out
        .series
        .columns
        .iter()
        .take(6)
        .enumerate()
        .map(|(k, c)| (format!("mode {}", k + 1), c.name.clone()))
        .collect();
    let lines: Vec<(&str, &str)> = lines.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    if !lines.is_empty() {
        out.curves("Mode shapes", "angle of each inertia, the largest 1", &lines);
    }
}
