//! The pages that are written from the registry, the schemas, the cases and REFERENCES.bib.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use gudgeon_case::catalogue::{equations, example, schema};
use gudgeon_core::{KindInfo, ModelInfo, Registry};
use gudgeon_scene::{SceneInfo, case_schemas, scenes};
use schemars::SchemaGenerator;
use serde_json::{Map, Value};

use crate::benches::{self, Bench};
use crate::bib::{self, Entry};
use crate::cases::{self, Case, users};
use crate::compared;
use crate::keys::{Names, list};
use crate::markdown::cell;
use crate::{Outcome, read, source};

/// Pages by their path below the sources of the guide.
pub type Pages = BTreeMap<String, String>;

/// Where the generated part of the table of contents begins.
const MARK: &str = "# Reference";

/// Everything that the pages are made of.
#[derive(Debug)]
pub struct Facts {
    registry: Registry,
    /// Schemas of the cases of all scenes.
    schemas: Vec<Value>,
    cases: Vec<Case>,
    benches: Vec<Bench>,
    works: BTreeMap<String, Entry>,
}

impl Facts {
    /// Collects it.
    ///
    /// # Errors
    /// A file that cannot be read, or a case that is wrong.
    pub fn collect() -> Outcome<Self> {
        gudgeon_models::link();
        Ok(Self {
            registry: Registry::collect(),
            schemas: case_schemas(),
            cases: cases::all()?,
            benches: benches::all()?,
            works: bib::entries()?,
        })
    }

    /// The figures to draw.
    #[must_use]
    pub fn benches(&self) -> &[Bench] {
        &self.benches
    }

    /// Every generated page.
    ///
    /// # Errors
    /// The table of contents cannot be read.
    pub fn pages(&self) -> Outcome<Pages> {
        let mut pages = Pages::new();
        pages.insert("SUMMARY.md".into(), self.summary(&read(&source().join("SUMMARY.md"))?)?);
        pages.insert("reference/models.md".into(), self.catalogue());
        pages.insert("reference/cases.md".into(), self.case_list());
        pages.insert("reference/works.md".into(), self.work_list());
        for scene in scenes() {
            pages.insert(format!("reference/scenes/{}.md", scene.name), self.scene(scene));
        }
        for kind in self.registry.kinds() {
            pages.insert(format!("reference/kinds/{}.md", kind.kind), self.kind(kind));
            for model in self.registry.models(kind.kind) {
                pages.insert(format!("reference/models/{}/{}.md", kind.kind, model.name), self.model(model));
            }
        }
        pages.extend(compared::pages()?);
        Ok(pages)
    }

    fn summary(&self, stands: &str) -> Outcome<String> {
        let (own, _) =
            stands.split_once(MARK).ok_or_else(|| format!("SUMMARY.md has no heading `{MARK}`"))?;
        let mut s = format!("{own}{MARK}\n\n- [Cases](reference/cases.md)\n");
        for scene in scenes() {
            line(&mut s, &format!("- [Scene `{0}`](reference/scenes/{0}.md)", scene.name));
        }
        line(&mut s, "- [Models](reference/models.md)");
        for k in self.registry.kinds() {
            line(&mut s, &format!("  - [`{0}`](reference/kinds/{0}.md)", k.kind));
            for m in self.registry.models(k.kind) {
                line(&mut s, &format!("    - [`{1}`](reference/models/{0}/{1}.md)", k.kind, m.name));
            }
        }
        line(&mut s, "- [Works referred to](reference/works.md)");
        Ok(s)
    }

    fn catalogue(&self) -> String {
        let mut s = "# Models\n\nEvery kind of sub-model and its models, from the registry of the program.\n"
            .to_owned();
        for k in self.registry.kinds() {
            line(&mut s, &format!("\n## [{0}](kinds/{0}.md)\n\n{1}\n", k.kind, sentence(k.summary)));
            for m in self.registry.models(k.kind) {
                line(&mut s, &format!("- [`{1}`](models/{0}/{1}.md): {2}", k.kind, m.name, m.summary));
            }
        }
        s
    }

    fn case_list(&self) -> String {
        let mut s = "# Cases\n\nThe cases that come with Gudgeon, by scene, and the pages that compare them with their sources.\n".to_owned();
        for scene in scenes() {
            line(
                &mut s,
                &format!("\n## {}\n\n| case | what | compared with its sources |\n|---|---|---|", scene.name),
            );
            for c in self.cases.iter().filter(|c| c.scene == scene.name) {
                let page =
                    c.validation.as_ref().map_or(String::new(), |p| format!("[page](../../../../{p})"));
                line(
                    &mut s,
                    &format!(
                        "| <a id=\"{0}\"></a>[`{0}`](../../../../{1}) | {2} | {page} |",
                        c.name(),
                        c.path,
                        cell(&c.title)
                    ),
                );
            }
        }
        s
    }

    fn work_list(&self) -> String {
        let mut s =
            "# Works referred to\n\nFrom `REFERENCES.bib`, with the models and scenes that name them.\n\n"
                .to_owned();
        for (key, work) in &self.works {
            line(&mut s, &format!("- <a id=\"{key}\"></a>**{key}**: {}{}", work.line(), self.cited_by(key)));
        }
        s
    }

    fn cited_by(&self, key: &str) -> String {
        let models = self.registry.kinds().flat_map(|k| self.registry.models(k.kind));
        let by_models = models
            .filter(|m| m.references.contains(&key))
            .map(|m| format!("[{0}/{1}](models/{0}/{1}.md)", m.kind, m.name));
        let by_scenes = scenes()
            .iter()
            .filter(|s| s.references.contains(&key))
            .map(|s| format!("[scene {0}](scenes/{0}.md)", s.name));
        let all: Vec<String> = by_scenes.chain(by_models).collect();
        if all.is_empty() { String::new() } else { format!(" Named by {}.", all.join(", ")) }
    }

    fn scene(&self, scene: &SceneInfo) -> String {
        let mut g = SchemaGenerator::default();
        let reference = (scene.schema)(&mut g).to_value();
        let definitions = g.take_definitions(true);
        let names = Names { definitions: &definitions, registry: &self.registry };
        let case = gudgeon_case::catalogue::resolve(&reference, &definitions).0;
        let mut s = format!("# Scene `{}`\n\n{}\n", scene.name, sentence(scene.summary));
        let all = scene.equations.split(";  ").map(str::trim).filter(|e| !e.is_empty());
        section(&mut s, "Equations", &code(all));
        section(&mut s, "Validity", &escaped(scene.validity));
        section(&mut s, "References", &cited(scene.references));
        section(&mut s, "Keys of a case", &list(case, &names, "../kinds/"));
        let own: Vec<&Case> = self.cases.iter().filter(|c| c.scene == scene.name).collect();
        section(&mut s, "Cases", &case_links(&own, "../"));
        s
    }

    fn kind(&self, kind: &KindInfo) -> String {
        let mut s = format!("# {}\n\n{}\n\n| model | |\n|---|---|\n", kind.kind, sentence(kind.summary));
        for m in self.registry.models(kind.kind) {
            line(
                &mut s,
                &format!("| [`{1}`](../models/{0}/{1}.md) | {2} |", kind.kind, m.name, cell(m.summary)),
            );
        }
        section(&mut s, "Asked by", &self.asked_by(kind.kind));
        section(&mut s, "Test bench", &self.bench(kind.kind, "../"));
        let prefix = format!("{}/", kind.kind);
        let own: Vec<&Case> =
            self.cases.iter().filter(|c| c.models.iter().any(|m| m.starts_with(&prefix))).collect();
        section(&mut s, "Cases", &case_links(&own, "../"));
        s
    }

    /// Scenes and models whose keys take a model of the kind.
    fn asked_by(&self, kind: &str) -> String {
        let mut by = BTreeSet::new();
        for scene in scenes() {
            let mut g = SchemaGenerator::default();
            (scene.schema)(&mut g);
            if self.takes(&g.take_definitions(true), kind) {
                by.insert(format!("scene [{0}](../scenes/{0}.md)", scene.name));
            }
        }
        for m in self.registry.kinds().flat_map(|k| self.registry.models(k.kind)) {
            let (own, mut definitions) = schema(m);
            definitions.insert(String::new(), own);
            if self.takes(&definitions, kind) {
                by.insert(format!("[{0}/{1}](../models/{0}/{1}.md)", m.kind, m.name));
            }
        }
        by.into_iter().map(|b| format!("- {b}\n")).collect()
    }

    /// Whether something among these definitions takes a model of the kind, models of other kinds apart.
    fn takes(&self, definitions: &Map<String, Value>, kind: &str) -> bool {
        let reference = format!("\"#/$defs/{kind}\"");
        definitions
            .iter()
            .filter(|(name, _)| self.registry.kind(name).is_none())
            .any(|(_, schema)| schema.to_string().contains(&reference))
    }

    fn bench(&self, kind: &str, up: &str) -> String {
        let found = self.benches.iter().filter(|b| b.kind == kind);
        found.map(|b| format!("{}\n", b.page(up))).collect()
    }

    fn model(&self, m: &ModelInfo) -> String {
        let (schema, definitions) = schema(m);
        let names = Names { definitions: &definitions, registry: &self.registry };
        let mut s = format!("# {}/{}\n\n{}\n", m.kind, m.name, sentence(m.summary));
        line(&mut s, &format!("\nKind: [{0}](../../kinds/{0}.md).", m.kind));
        section(&mut s, "Equations", &code(equations(m)));
        section(&mut s, "Validity", &escaped(m.validity));
        let keys = list(&schema, &names, "../../kinds/");
        section(&mut s, "Keys", if keys.is_empty() { "None." } else { &keys });
        let example = example(&self.registry, m, &self.schemas);
        section(&mut s, "Example", &format!("```toml\n{}\n```", example.trim_end()));
        section(&mut s, "References", &cited(m.references));
        let users = users(&self.cases);
        let used = users.get(format!("{}/{}", m.kind, m.name).as_str());
        let text = used.map_or_else(|| "In no case of the repository.".into(), |c| case_links(c, "../../"));
        section(&mut s, "Where it is used", &text);
        section(&mut s, "Test bench", &self.bench(m.kind, "../../"));
        section(&mut s, "Source", &format!("[`{0}`](../../../../../../{0})", m.file));
        s
    }
}

fn line(s: &mut String, text: &str) {
    // Writing to a String cannot fail.
    let _ = writeln!(s, "{text}");
}

/// A section, unless there is nothing to say.
fn section(s: &mut String, heading: &str, text: &str) {
    if !text.trim().is_empty() {
        line(s, &format!("\n## {heading}\n\n{}", text.trim_end()));
    }
}

fn sentence(text: &str) -> String {
    let mut c = text.chars();
    let first = c.next().map_or(String::new(), |f| f.to_uppercase().to_string());
    let stop = if text.ends_with('.') { "" } else { "." };
    format!("{first}{}{stop}", escaped(c.as_str()))
}

/// Signs that Markdown would take for something else.
fn escaped(text: &str) -> String {
    text.replace('<', "&lt;").replace('*', "\\*")
}

fn code<'a>(lines: impl Iterator<Item = &'a str>) -> String {
    let all: Vec<&str> = lines.collect();
    if all.is_empty() { String::new() } else { format!("```text\n{}\n```", all.join("\n")) }
}

fn cited(keys: &[&str]) -> String {
    keys.iter().map(|k| format!("[@{k}]")).collect::<Vec<_>>().join(", ")
}

fn case_links(cases: &[&Case], up: &str) -> String {
    let links: Vec<String> = cases.iter().map(|c| format!("[{0}]({up}cases.md#{0})", c.name())).collect();
    links.join(", ")
}
