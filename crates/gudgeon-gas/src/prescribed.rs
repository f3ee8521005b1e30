//! Land pressures that are given: the gas flow switched off.

use gudgeon_core::geometry::{BackVolume, LandGeometry, PackGeometry, Vent};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec, GasIn, GasOut};
use gudgeon_core::quantity::PosPressure;
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, EvalError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Constant pressures between the rings, no flow.
///
/// The space behind a ring has the pressure of the land it faces: `p_back = (1 - e) p_above + e p_below` with the position `e` in the
/// groove (0 on the lower flank, 1 on the upper one); a groove that is open to the crankcase has its pressure. What a film or a ring does under known
/// pressures, without a gas model.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prescribed {
    /// Absolute pressures of the lands between the rings, from the top: one less than there are rings. A space between rails that is open to the
    /// crankcase has its pressure and is not named.
    #[serde(default)]
    pub lands: Vec<PosPressure>,
}

#[register_model(
    name = "prescribed",
    summary = "given constant pressures between the rings; no flow is computed",
    equations = "p_land given;  p_back = (1 - e) p_above + e p_below, or p_crankcase of a vented groove;  m' = 0",
    validity = "Studies of films and rings under known pressures. Blow-by is zero by definition.",
    references = [],
    example = "lands = [\"6 bar\", \"2 bar\"]\n",
)]
impl GasFlowSpec for Prescribed {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        let spaces: Vec<Space> = (0..ctx.pack.rings.len()).map(|i| Space::behind(ctx.pack, i)).collect();
        let own = |land: &LandGeometry| land.vent != Vent::Open;
        let between = ctx.pack.lands.iter().take(ctx.pack.rings.len()).skip(1).filter(|l| own(l)).count();
        let drained = |vent: Vent| matches!(vent, Vent::Drain(_));
        let grooves = ctx.pack.rings.iter().zip(&ctx.pack.lands);
        if let Some(i) = grooves.map(|(r, l)| drained(r.vent) || drained(l.vent)).position(|d| d) {
            let what = format!("the groove of ring {} has a drain, and no flow is computed", i + 1);
            return Err(
                BuildError::new(what).help("leave the groove vented or closed, or take another `gas_flow`")
            );
        }
        if self.lands.len() != between {
            return Err(BuildError::at(
                "lands",
                format!(
                    "{} pressures are given, {} rings have {between} lands between them",
                    self.lands.len(),
                    ctx.pack.rings.len()
                ),
            ));
        }
        let mut given = self.lands.iter().map(|p| p.si());
        let inner = &ctx.pack.lands[1..spaces.len().max(1)];
        let lands = inner.iter().map(|land| if own(land) { given.next() } else { None }).collect();
        Ok(Box::new(Runtime { lands, spaces }))
    }
}

/// What has the pressure behind a ring.
enum Space {
    /// The land that it faces.
    Faced,
    /// The land above or below, or the crankcase.
    Land(usize),
}

impl Space {
    fn behind(pack: &PackGeometry, i: usize) -> Self {
        let ring = &pack.rings[i];
        match ring.back {
            BackVolume::OpenBelow => Self::Land(i + 1),
            BackVolume::OpenAbove => Self::Land(i),
            BackVolume::Geometric | BackVolume::Fixed(_) if ring.vent == Vent::Open => {
                Self::Land(pack.rings.len())
            }
            _ => Self::Faced,
        }
    }
}

struct Runtime {
    /// Pressures between the rings \[Pa\]; `None`: that of the crankcase.
    lands: Vec<Option<f64>>,
    spaces: Vec<Space>,
}

impl Stateful for Runtime {}

impl GasFlow for Runtime {
    fn uses_end_gaps(&self) -> bool {
        false
    }
    fn uses_film_height(&self) -> bool {
        false
    }
    fn at_pressures(&self, _: &GasIn<'_>, _: &[f64], _: &mut [f64]) {}

    fn pressures(&mut self, inp: &GasIn<'_>, _: &[f64], out: &mut GasOut) -> Result<(), EvalError> {
        for (name, p) in [("cylinder", inp.p_cylinder), ("crankcase", inp.p_crankcase)] {
            if !(p > 0.0 && p.is_finite()) {
                return Err(EvalError::recoverable(
                    "prescribed",
                    format!("the {name} has the absolute pressure {p:e} Pa"),
                ));
            }
        }
        let n = inp.rings.len();
        out.p_land[0] = inp.p_cylinder;
        for (p, given) in out.p_land[1..n].iter_mut().zip(&self.lands) {
            *p = given.unwrap_or(inp.p_crankcase);
        }
        out.p_land[n] = inp.p_crankcase;
        for (i, ring) in inp.rings.iter().enumerate() {
            let e = ring.lift_fraction.clamp(0.0, 1.0);
            out.p_back[i] = match self.spaces[i] {
                Space::Faced => (1.0 - e) * out.p_land[i] + e * out.p_land[i + 1],
                Space::Land(k) => out.p_land[k],
            };
        }
        Ok(())
    }

    fn rates(
        &mut self,
        inp: &GasIn<'_>,
        state: &[f64],
        _: &mut [f64],
        out: &mut GasOut,
    ) -> Result<(), EvalError> {
        self.pressures(inp, state, out)?;
        out.flow_in.fill(0.0);
        out.flow_out.fill(0.0);
        Ok(())
    }
}
