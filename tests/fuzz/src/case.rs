//! A case of the fuzzer: a shipped one and its changes.

use serde::{Deserialize, Serialize};

/// One change, as `--set` takes it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Change {
    /// The table of the case that names the file which is changed (`ring_pack` of a power cylinder); empty for the case itself.
    pub part: String,
    /// Path in it.
    pub path: String,
    /// TOML text of the value.
    pub value: String,
    /// Whether no engineer would mean it.
    pub wild: bool,
}

/// A case that can be run again from what it says.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Case {
    /// Its number under the seed.
    pub index: u64,
    /// Scene.
    pub scene: String,
    /// File below the folder of cases.
    pub base: String,
    /// What shortens the shipped case, before its changes.
    pub shortened: Vec<Change>,
    /// The changes.
    pub changes: Vec<Change>,
    /// Whether it is run a second time with its numerical settings one level finer.
    pub refine: bool,
    /// Whether it is run a second time as it stands.
    pub twice: bool,
}

impl Case {
    /// Whether any of its changes is wild.
    #[must_use]
    pub fn wild(&self) -> bool {
        self.changes.iter().any(|c| c.wild)
    }

    /// The `--set` arguments: changes of a part become its list `set`.
    #[must_use]
    pub fn set(&self) -> Vec<String> {
        let mut out = Vec::new();
        let mut parts: Vec<(&str, Vec<String>)> = Vec::new();
        for c in self.shortened.iter().chain(&self.changes) {
            let text = format!("{}={}", c.path, c.value);
            if c.part.is_empty() {
                out.push(text);
            } else if let Some((_, set)) = parts.iter_mut().find(|(p, _)| *p == c.part) {
                set.push(text);
            } else {
                parts.push((&c.part, vec![text]));
            }
        }
        for (part, set) in parts {
            let texts: Vec<String> = set.into_iter().map(|s| toml::Value::String(s).to_string()).collect();
            out.push(format!("{part}.set=[{}]", texts.join(", ")));
        }
        out
    }

    /// The command that runs it.
    #[must_use]
    pub fn command(&self) -> String {
        command(&self.base, &self.set())
    }
}

/// The command that runs a case with some `--set` arguments, for a shell.
#[must_use]
pub fn command(base: &str, set: &[String]) -> String {
    let mut s = format!("gudgeon run cases/{base}");
    for one in set {
        s.push_str(" --set '");
        s.push_str(&one.replace('\'', r"'\''"));
        s.push('\'');
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_can_be_given_to_a_shell() {
        let change = |part: &str, path: &str, value: &str| Change {
            part: part.into(),
            path: path.into(),
            value: value.into(),
            wild: false,
        };
        let case = Case {
            base: "a.toml".into(),
            shortened: vec![change("", "sweeps", "[]")],
            changes: vec![
                change("", "b", "1 mm"),
                change("ring_pack", "c.0", "it's"),
                change("ring_pack", "d", "2"),
            ],
            ..Case::default()
        };
        assert_eq!(case.set(), ["sweeps=[]", "b=1 mm", "ring_pack.set=[\"c.0=it's\", \"d=2\"]"]);
        assert_eq!(
            case.command(),
            r#"gudgeon run cases/a.toml --set 'sweeps=[]' --set 'b=1 mm' --set 'ring_pack.set=["c.0=it'\''s", "d=2"]'"#
        );
    }
}
