//! As much of Markdown as links, citations, headings and fenced blocks need.

/// A fenced block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// First word behind the fence: `sh`, `output`, `toml`.
    pub language: String,
    /// Further words: `file=engine.toml`.
    pub words: Vec<String>,
    /// Line of the fence, counted from 1.
    pub line: usize,
    /// What stands in it.
    pub text: String,
}

impl Block {
    /// The value of `key=value` behind the fence.
    #[must_use]
    pub fn word(&self, key: &str) -> Option<&str> {
        self.words.iter().find_map(|w| w.split_once('=').filter(|(k, _)| *k == key).map(|(_, v)| v))
    }
}

/// All fenced blocks of a page.
#[must_use]
pub fn blocks(text: &str) -> Vec<Block> {
    let mut out: Vec<Block> = Vec::new();
    let mut open = false;
    for (n, line) in text.lines().enumerate() {
        if let Some(info) = line.strip_prefix("```") {
            open = !open;
            if open {
                let mut words = info.split_whitespace().map(str::to_owned);
                let language = words.next().unwrap_or_default();
                out.push(Block { language, words: words.collect(), line: n + 1, text: String::new() });
            }
        } else if let Some(block) = out.last_mut().filter(|_| open) {
            block.text.push_str(line);
            block.text.push('\n');
        }
    }
    out
}

/// Lines that are prose, with their number: neither in a fenced nor in an indented block; code between backticks is blanked.
fn prose(text: &str) -> impl Iterator<Item = (usize, String)> + '_ {
    let mut open = false;
    text.lines().enumerate().filter_map(move |(n, line)| {
        if line.trim_start().starts_with("```") {
            open = !open;
            return None;
        }
        (!open && !line.starts_with("    ")).then(|| (n + 1, blanked(line)))
    })
}

/// A line whose code spans are spaces, so that places stay where they are.
fn blanked(line: &str) -> String {
    let mut inside = false;
    let blank = |c: char| " ".repeat(c.len_utf8());
    line.chars()
        .map(|c| {
            if c == '`' {
                inside = !inside;
            }
            if inside || c == '`' { blank(c) } else { c.to_string() }
        })
        .collect()
}

/// A link or a picture: line, and the byte range of its target in that line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Line, counted from 1.
    pub line: usize,
    /// Where the target begins and ends in its line.
    pub span: (usize, usize),
    /// The target.
    pub target: String,
}

/// All links `[…](target)` of a page.
#[must_use]
pub fn links(text: &str) -> Vec<Link> {
    let mut out = Vec::new();
    for (line, shown) in prose(text) {
        let mut at = 0;
        while let Some(found) = shown[at..].find("](") {
            let begin = at + found + 2;
            let Some(length) = shown[begin..].find(')') else { break };
            let target = shown[begin..begin + length].to_owned();
            out.push(Link { line, span: (begin, begin + length), target });
            at = begin + length;
        }
    }
    out
}

/// All citations `[@key]` of a page, with their lines.
#[must_use]
pub fn citations(text: &str) -> Vec<(usize, String)> {
    let mut out = Vec::new();
    for (line, shown) in prose(text) {
        for part in shown.split("[@").skip(1) {
            if let Some((key, _)) = part.split_once(']') {
                out.push((line, key.to_owned()));
            }
        }
    }
    out
}

/// The anchors of a page: its headings as mdBook and the forges name them, and `<a id="…">`.
#[must_use]
pub fn anchors(text: &str) -> Vec<String> {
    let mut out = Vec::new();
    let mut open = false;
    for line in text.lines() {
        if line.starts_with("```") {
            open = !open;
        }
        if !open && line.starts_with('#') {
            out.push(slug(line.trim_start_matches('#').trim()));
        }
        for part in line.split("<a id=\"").skip(1) {
            out.extend(part.split_once('"').map(|(id, _)| id.to_owned()));
        }
    }
    out
}

/// The anchor of a heading.
#[must_use]
pub fn slug(heading: &str) -> String {
    let keep = |c: char| match c {
        c if c.is_alphanumeric() || c == '_' || c == '-' => Some(c.to_lowercase().to_string()),
        c if c.is_whitespace() => Some("-".into()),
        _ => None,
    };
    heading.chars().filter_map(keep).collect()
}

/// Text that stands in a cell of a table.
#[must_use]
pub fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
