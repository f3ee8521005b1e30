//! The series of a cycle, and its totals.

use std::f64::consts::PI;

use gudgeon_core::kinds::{FlankFlow, OilLedger, OilPassed};
use gudgeon_core::result::{Balance, Column, Series};

use super::pack::Pack;

/// Totals of a cycle, integrated by the solver itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Totals {
    /// Gas that entered each ring from above \[kg\].
    pub flow_in: Vec<f64>,
    /// Gas that left the last ring to the crankcase \[kg\].
    pub blow_by: f64,
    /// Gas that passed each passage of the gas model \[kg\]; empty where a solver does not follow them
    /// ([`Pack::follow_passages`]): there is no balance of blow-by then, and results of passages are 0.
    pub passages: Vec<f64>,
    /// Friction work of each ring \[J\].
    pub friction_work: Vec<f64>,
    /// The part of it that solid contact takes \[J\].
    pub boundary_work: Vec<f64>,
    /// Closures.
    pub balance: Balance,
    /// True error estimate of the periodic state.
    pub periodicity_error: f64,
    /// Oil that came and went, per circumference \[m²\].
    pub oil: OilLedger,
    /// What each ring scraped and let pass, per circumference \[m²\]; empty where oil on the liner is not followed.
    pub passed: Vec<OilPassed>,
    /// Oil on the land above each ring at the end of the cycle, per circumference \[m²\].
    pub on_land: Vec<f64>,
    /// Height \[m\] of the way of ring 1 that evaporation left without oil.
    pub dried: f64,
    /// Oil that came to the flanks of each ring and left them, per circumference \[m²\]; empty where it is not followed.
    pub flank: Vec<FlankFlow>,
}

impl Totals {
    /// The totals that a solver has as the quadratures `q` of a cycle, in the order of the layout of `pack`.
    #[must_use]
    pub fn of_cycle(pack: &Pack, q: &[f64]) -> Self {
        let n = pack.n_rings();
        let followed =
            pack.oil_pack.iter().flat_map(|oil| (0..n).map(move |i| (oil.passed(i), oil.on_land(i))));
        let (passed, on_land) = followed.unzip();
        let flank = |i| pack.layout.flank_quad(i).map(|k| FlankFlow { fed: q[k], lost: q[k + 1] });
        Self {
            flow_in: q[..n].to_vec(),
            blow_by: q[n],
            passages: q[pack.layout.passage_quad()..].to_vec(),
            friction_work: q[n + 1..2 * n + 1].to_vec(),
            boundary_work: q[2 * n + 1..3 * n + 1].to_vec(),
            oil: pack.oil_pack.as_ref().map_or_else(OilLedger::default, |o| o.ledger()),
            dried: pack.oil_pack.as_ref().map_or(0.0, |o| o.dried()),
            passed,
            on_land,
            flank: (0..n).filter_map(flank).collect(),
            ..Self::default()
        }
    }

    /// Those of a cycle that a scheme begins to march, which sums up what passes.
    #[must_use]
    pub fn begun(pack: &Pack) -> Self {
        let n = pack.n_rings();
        Self {
            flow_in: vec![0.0; n],
            passages: vec![0.0; pack.at.gas.passages.len()],
            friction_work: vec![0.0; n],
            boundary_work: vec![0.0; n],
            ..Self::default()
        }
    }

    /// Adds an explicit step of the gas over `dt` \[s\] with the flows of `pack`.
    pub fn march(&mut self, pack: &Pack, dt: f64) {
        let gas = &pack.at.gas;
        for (sum, flow) in self.flow_in.iter_mut().zip(&gas.flow_in) {
            *sum += flow * dt;
        }
        self.blow_by += gas.flow_out[pack.n_rings() - 1] * dt;
        for (sum, flow) in self.passages.iter_mut().zip(&gas.passages) {
            *sum += flow * dt;
        }
    }

    /// Gas \[kg\] that passed each ring, the last of them to the crankcase, and each passage, as [`Measures`](super::measure::Measures) samples it.
    pub fn passed(&self) -> impl Iterator<Item = f64> {
        self.flow_in.iter().chain([&self.blow_by]).chain(&self.passages).copied()
    }
}

/// A recorded cycle.
pub struct Record {
    /// Crank angles \[rad\].
    pub theta: Vec<f64>,
    columns: Vec<Column>,
}

impl Record {
    /// Columns that this pack computes, with room for as many rows.
    #[must_use]
    pub fn new(pack: &Pack, rows: usize) -> Self {
        let mut columns = Vec::new();
        let mut add = |name: String, unit: &str| {
            columns.push(Column { name, unit: unit.into(), values: Vec::with_capacity(rows) });
        };
        let n = pack.n_rings();
        for (name, unit) in
            [("piston.y", "m"), ("piston.v", "m/s"), ("piston.a", "m/s2"), ("cylinder.p", "Pa")]
        {
            add(name.into(), unit);
        }
        for i in 1..=n {
            if pack.geo.rings[i - 1].has_room() {
                add(format!("ring{i}.back.p"), "Pa");
            }
            add(format!("land{}.p", i + 1), "Pa");
        }
        for i in 1..=n {
            add(format!("ring{i}.flow"), "kg/s");
            add(format!("ring{i}.cumulative_mass"), "kg");
        }
        add("blow_by.rate".into(), "kg/s");
        add("blow_by.cumulative".into(), "kg");
        for i in 1..=n {
            let ring = &pack.rings[i - 1];
            if pack.geo.rings[i - 1].has_clearance {
                add(format!("ring{i}.position"), "-");
                add(format!("ring{i}.lift"), "m");
                if ring.is_integrated() {
                    add(format!("ring{i}.axial_velocity"), "m/s");
                }
            }
            if pack.plan.axial && ring.motion.moves() {
                for f in ["gas", "inertia", "film"] {
                    add(format!("ring{i}.force_{f}"), "N");
                }
                if ring.expander != 0.0 {
                    add(format!("ring{i}.force_expander"), "N");
                }
                if ring.is_integrated() {
                    add(format!("ring{i}.force_damping"), "N");
                    add(format!("ring{i}.force_flank"), "N");
                }
            }
            for c in ring.motion.columns() {
                add(format!("ring{i}.{}", c.name), c.unit);
            }
            for c in ring.radial.columns() {
                add(format!("ring{i}.{}", c.name), c.unit);
            }
            if pack.plan.film {
                for (name, unit) in [
                    ("h_min", "m"),
                    ("h_rate", "m/s"),
                    ("radial_load", "N"),
                    ("contact_load", "N"),
                    ("friction_force", "N"),
                    ("friction_power", "W"),
                    ("film_p_max", "Pa"),
                    ("viscosity", "Pa s"),
                ] {
                    add(format!("ring{i}.{name}"), unit);
                }
                if pack.oil_pack.is_some() {
                    for (name, unit) in [("wetted", "1"), ("oil_held", "m3"), ("oil_left", "m")] {
                        add(format!("ring{i}.{name}"), unit);
                    }
                }
            }
        }
        for (block, prefix) in pack.shared_blocks() {
            for c in pack.block(block).columns() {
                add(format!("{prefix}.{}", c.name), c.unit);
            }
        }
        Self { theta: Vec::with_capacity(rows), columns }
    }

    /// Adds the instant that `pack` holds, as crank angle `theta` \[rad\]; `entered`: gas \[kg\] that has entered each ring since the cycle
    /// began, `left`: gas that has left the last one.
    pub fn push(&mut self, theta: f64, pack: &Pack, entered: &[f64], left: f64) {
        self.theta.push(theta);
        let at = &pack.at;
        let mut columns = self.columns.iter_mut();
        let mut put = |v: f64| {
            if let Some(c) = columns.next() {
                c.values.push(v);
            }
        };
        let n = pack.n_rings();
        let mut own = Vec::new();
        put(at.piston.y);
        put(at.piston.v);
        put(at.piston.a);
        put(at.gas.p_land[0]);
        for i in 0..n {
            if pack.geo.rings[i].has_room() {
                put(at.gas.p_back[i]);
            }
            put(at.gas.p_land[i + 1]);
        }
        for i in 0..n {
            put(at.gas.flow_in[i]);
            put(entered[i]);
        }
        put(at.gas.flow_out[n - 1]);
        put(left);
        for i in 0..n {
            let (ring, place, r) = (&pack.rings[i], &at.places[i], &at.rings[i]);
            if pack.geo.rings[i].has_clearance {
                put(place.lift_fraction);
                put(place.s.clamp(0.0, place.clearance));
                if ring.is_integrated() {
                    put(place.v);
                }
            }
            if pack.plan.axial && ring.motion.moves() {
                put(r.axial.gas);
                put(r.axial.inertia);
                put(r.axial.film);
                if ring.expander != 0.0 {
                    put(r.axial.expander);
                }
                if ring.is_integrated() {
                    put(r.axial.damping);
                    put(r.reaction);
                }
            }
            own.clear();
            ring.motion.record(&pack.state[pack.layout.motion[i].clone()], &mut own);
            ring.radial.record(&pack.state[pack.layout.radial[i].clone()], &mut own);
            own.iter().for_each(|v| put(*v));
            if pack.plan.film {
                let circumference = 2.0 * PI * place.r_outer * pack.geo.rings[i].rails as f64;
                put(place.h);
                put(r.hdot);
                put(r.load * circumference);
                put(r.contact * circumference);
                put(r.friction);
                put(r.power);
                put(r.film_p_max);
                put(r.mu);
                if let Some(oil) = &pack.oil_pack {
                    let o = oil.ring(i, at.piston.v);
                    put(o.wetted);
                    put(o.held * circumference);
                    put(o.left);
                }
            }
        }
        own.clear();
        for (block, _) in pack.shared_blocks() {
            pack.block(block).record(&pack.state[pack.range(block)], &mut own);
        }
        own.iter().for_each(|v| put(*v));
    }

    /// The series.
    #[must_use]
    pub fn series(self) -> Series {
        let theta_deg = self.theta.iter().map(|t| round_deg(t.to_degrees())).collect();
        Series::over_cycle(theta_deg, self.columns)
    }
}

/// Angles in degrees come from radians; what is a whole number of thousandths of a degree is written as such.
pub(super) fn round_deg(deg: f64) -> f64 {
    let r = (deg * 1e3).round() / 1e3;
    if (r - deg).abs() < 1e-9 { r } else { deg }
}
