//! Draws cases. Seed and index say all of one.

use fastrand::Rng;
use gudgeon_core::Registry;
use serde_json::Value;

use crate::case::{Case, Change};
use crate::corpus::{Base, Corpus};
use crate::sites::{Site, What, sites};
use crate::text::{float, inline};

mod value;

/// Most changes of a case.
const MOST: usize = 6;
/// Share of plausible cases that are run again one level finer.
const REFINED: f64 = 0.05;
/// Share of all cases that are run twice as they stand.
const TWICE: f64 = 0.02;
/// Share of changes of a wild case that are wild, besides the one that makes it so.
const ALSO_WILD: f64 = 0.15;

/// How often each sort of value is chosen, where the case has it: plausible, wild.
const fn weight(what: &What, wild: bool) -> f64 {
    let (plausible, absurd) = match what {
        What::Number { .. } => (0.45, 0.65),
        What::Model { .. } => (0.22, 0.05),
        What::Word { .. } => (0.12, 0.02),
        What::Whole(_) => (0.06, 0.15),
        What::Switch(_) => (0.05, 0.02),
        What::List(_) => (0.04, 0.05),
        What::Results => (0.03, 0.03),
        What::Table { .. } => (0.03, 0.02),
        What::Text => (0.0, 0.03),
        What::Part { .. } => (1.0, 1.0),
    };
    if wild { absurd } else { plausible }
}

/// Draws cases from a corpus.
#[derive(Debug)]
pub struct Draw<'a> {
    corpus: &'a Corpus,
    registry: Registry,
    scenes: Vec<&'a str>,
    seed: u64,
    wild: f64,
}

/// A case while it is changed: a file and the values it has by now.
struct Draft<'a> {
    part: String,
    base: &'a Base,
    doc: Value,
}

impl<'a> Draw<'a> {
    /// `wild` is the share of wild cases.
    #[must_use]
    pub fn new(corpus: &'a Corpus, seed: u64, wild: f64) -> Self {
        let scenes = corpus.schemas.keys().map(String::as_str).collect();
        Self { corpus, registry: Registry::collect(), scenes, seed, wild }
    }

    /// The scenes, in the order in which indices take turns among them.
    #[must_use]
    pub fn scenes(&self) -> &[&'a str] {
        &self.scenes
    }

    /// The indices of a scene, from one on; none of a scene that there is not.
    pub fn of_scene(&self, scene: &str, from: u64) -> impl Iterator<Item = u64> + use<> {
        let n = self.scenes.len() as u64;
        let place = self.scenes.iter().position(|s| *s == scene).map(|p| p as u64);
        place.into_iter().flat_map(move |p| (from..).filter(move |i| i % n == p))
    }

    /// The case of an index.
    ///
    /// # Errors
    /// A scene without a shipped case.
    pub fn case(&self, index: u64) -> Result<Case, String> {
        let mut rng = Rng::with_seed(mixed(self.seed, index));
        // There are few scenes.
        let scene = self.scenes[(index % self.scenes.len() as u64) as usize];
        let bases: Vec<&Base> = self.corpus.of_scene(scene).collect();
        let base = *rng.choice(&bases).ok_or_else(|| format!("no shipped case of the scene `{scene}`"))?;
        let wild = rng.f64() < self.wild;
        let n = rng.usize(1..=MOST);
        let certain = rng.usize(0..n);
        let mut drafts = vec![Draft { part: String::new(), base, doc: base.resolved.clone() }];
        let mut changes = Vec::new();
        for k in 0..n {
            let wild = wild && (k == certain || rng.f64() < ALSO_WILD);
            changes.extend(self.change(&mut rng, &mut drafts, 0, wild));
        }
        let wild = changes.iter().any(|c: &Change| c.wild);
        let refine = rng.f64() < REFINED && !wild;
        let twice = rng.f64() < TWICE;
        Ok(Case {
            index,
            scene: scene.to_owned(),
            base: base.file.clone(),
            shortened: self.shortened(base),
            changes,
            refine,
            twice,
        })
    }

    /// What shortens a case and the cases that are parts of it.
    fn shortened(&self, base: &Base) -> Vec<Change> {
        let of = |part: &str, base: &Base| {
            let part = part.to_owned();
            base.shortened
                .iter()
                .filter_map(|s| s.split_once('='))
                .map(move |(path, value)| Change {
                    part: part.clone(),
                    path: path.into(),
                    value: value.into(),
                    wild: false,
                })
                .collect::<Vec<_>>()
        };
        let mut out = of("", base);
        for site in sites(self.corpus, &self.registry, &base.scene, &base.resolved) {
            if let What::Part { file } = &site.what {
                out.extend(self.corpus.base(file).map_or_else(Vec::new, |b| of(&site.path, b)));
            }
        }
        out
    }

    /// One change of a draft, or of a part that it names; none where nothing could be drawn.
    fn change(&self, rng: &mut Rng, drafts: &mut Vec<Draft<'a>>, at: usize, wild: bool) -> Option<Change> {
        let all = sites(self.corpus, &self.registry, &drafts[at].base.scene, &drafts[at].doc);
        // Not every value can be changed (a zero has no scale); one of the first few can.
        for _ in 0..30 {
            let site = choose(rng, &all, wild)?;
            if let What::Part { file } = &site.what {
                let Some(base) = self.corpus.base(file) else { continue };
                let k = drafts.iter().position(|d| d.part == site.path).unwrap_or_else(|| {
                    drafts.push(Draft { part: site.path.clone(), base, doc: base.resolved.clone() });
                    drafts.len() - 1
                });
                return self.change(rng, drafts, k, wild);
            }
            let draft = &mut drafts[at];
            let drawn = if wild { self.wild_value(rng, site) } else { self.plausible(rng, site, draft) };
            let Some(new) = drawn else { continue };
            if let Some(v) = draft.doc.pointer_mut(&format!("/{}", site.path.replace('.', "/"))) {
                *v = new.value;
            }
            let path = format!("{}{}", site.path, new.below);
            return Some(Change { part: draft.part.clone(), path, value: new.text, wild });
        }
        None
    }
}

/// A value that was drawn.
struct New {
    /// What `--set` is given.
    text: String,
    /// What stands there then; null where that is not known, which keeps further changes away from it.
    value: Value,
    /// What follows the path of the site, where only a key of it is set.
    below: &'static str,
}

impl New {
    fn of(value: Value) -> Self {
        Self { text: inline(&value), value, below: "" }
    }

    fn text(text: impl Into<String>) -> Self {
        Self { text: text.into(), value: Value::Null, below: "" }
    }
}

/// A site: first the sort of value, then one of that sort, so that many numbers do not hide the models.
fn choose<'s>(rng: &mut Rng, all: &'s [Site], wild: bool) -> Option<&'s Site> {
    let mut sorts: Vec<(std::mem::Discriminant<What>, f64, Vec<&Site>)> = Vec::new();
    for s in all {
        let d = std::mem::discriminant(&s.what);
        match sorts.iter_mut().find(|(k, ..)| *k == d) {
            Some((.., list)) => list.push(s),
            None => sorts.push((d, weight(&s.what, wild), vec![s])),
        }
    }
    let mut left = rng.f64() * sorts.iter().map(|(_, w, _)| w).sum::<f64>();
    for (_, w, list) in &sorts {
        left -= w;
        if left < 0.0 {
            return rng.choice(list.iter().copied());
        }
    }
    None
}

/// Seed of one case: neighbours share nothing (splitmix64).
fn mixed(seed: u64, index: u64) -> u64 {
    let mut z = seed.rotate_left(32) ^ index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// A value with its unit, as a person would type it.
fn quantity(value: f64, unit: &str) -> New {
    let number = float(value);
    if unit.is_empty() {
        return New { text: number, value: value.into(), below: "" };
    }
    let text = format!("{number} {unit}");
    New { value: Value::String(text.clone()), text, below: "" }
}

#[cfg(test)]
mod tests;
