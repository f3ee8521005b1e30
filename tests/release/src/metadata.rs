//! What the manifests say.

use std::path::PathBuf;

use serde_json::Value;

/// A package of the workspace.
#[derive(Debug, Clone, Default)]
pub struct Package {
    /// Name.
    pub name: String,
    /// Version.
    pub version: String,
    /// Folder.
    pub folder: PathBuf,
    /// Whether it may be published.
    pub published: bool,
    /// Its README, as the manifest names it.
    pub readme: Option<String>,
    /// Where its source is kept.
    pub repository: Option<String>,
    /// Texts that the index asks for: key and value.
    pub texts: Vec<(&'static str, Option<String>)>,
    /// Keywords.
    pub keywords: Vec<String>,
    /// Categories.
    pub categories: Vec<String>,
    /// Dependencies on packages of the workspace.
    pub dependencies: Vec<Dependency>,
}

/// A dependency on a package of the workspace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dependency {
    /// Name of the package.
    pub name: String,
    /// Version requirement; `*` where a path alone is given.
    pub requirement: String,
    /// Whether it is for tests alone.
    pub dev: bool,
}

impl Dependency {
    /// Whether a published package keeps it: Cargo drops dev-dependencies without a version.
    #[must_use]
    pub fn is_kept(&self) -> bool {
        !(self.dev && self.requirement == "*")
    }
}

/// The packages of `cargo metadata --no-deps`.
///
/// # Errors
/// The text is not that.
pub fn packages(metadata: &str) -> Result<Vec<Package>, String> {
    let v: Value = serde_json::from_str(metadata).map_err(|e| format!("cargo metadata: {e}"))?;
    let all = v["packages"].as_array().ok_or("cargo metadata names no packages")?;
    all.iter().map(package).collect()
}

fn package(v: &Value) -> Result<Package, String> {
    let text = |key: &str| v[key].as_str().map(str::to_owned);
    let list = |key: &str| {
        v[key].as_array().into_iter().flatten().filter_map(Value::as_str).map(str::to_owned).collect()
    };
    let manifest = PathBuf::from(text("manifest_path").ok_or("a package without a manifest")?);
    let dependencies = v["dependencies"].as_array().into_iter().flatten().filter(|d| d["path"].is_string());
    Ok(Package {
        name: text("name").ok_or("a package without a name")?,
        version: text("version").unwrap_or_default(),
        folder: manifest.parent().map(PathBuf::from).unwrap_or_default(),
        // `publish = false` is an empty list of registries.
        published: v["publish"].as_array().is_none_or(|registries| !registries.is_empty()),
        readme: text("readme"),
        repository: text("repository"),
        texts: ["description", "license", "documentation", "rust_version"]
            .map(|key| (key, text(key)))
            .to_vec(),
        keywords: list("keywords"),
        categories: list("categories"),
        dependencies: dependencies.filter_map(dependency).collect(),
    })
}

fn dependency(v: &Value) -> Option<Dependency> {
    Some(Dependency {
        name: v["name"].as_str()?.to_owned(),
        requirement: v["req"].as_str()?.to_owned(),
        dev: v["kind"].as_str() == Some("dev"),
    })
}

/// What the index of packages would refuse, what a reader would miss, and versions that do not go together.
#[must_use]
pub fn complaints(all: &[Package]) -> Vec<String> {
    let mut wrong = Vec::new();
    let version = all.first().map_or("", |p| p.version.as_str());
    for p in all {
        let mut say = |what: String| wrong.push(format!("{}: {what}", p.name));
        if p.version != version {
            say(format!("version {} where others have {version}", p.version));
        }
        for d in p.dependencies.iter().filter(|d| p.published && d.is_kept()) {
            if d.requirement != format!("^{version}") {
                say(format!("asks for {} {} instead of {version}", d.name, d.requirement));
            }
            if all.iter().any(|q| q.name == d.name && !q.published) {
                say(format!("depends on {}, which is not published", d.name));
            }
        }
        if !p.published {
            continue;
        }
        for (key, value) in &p.texts {
            if value.as_ref().is_none_or(String::is_empty) {
                say(format!("no `{key}`"));
            }
        }
        if p.readme.as_deref() != Some("README.md") {
            say("no README.md of its own".into());
        }
        if p.categories.is_empty() {
            say("no `categories`".into());
        }
        // What crates.io takes: one to five words of at most 20 letters.
        if !(1..=5).contains(&p.keywords.len()) || p.keywords.iter().any(|k| k.len() > 20) {
            say(format!("keywords {:?}", p.keywords));
        }
    }
    wrong
}
