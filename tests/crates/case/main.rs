//! The loader against a small schema of its own: two tables, an array of tables, words, and a kind of model.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod near;
mod paths;
mod plain;
mod published;
mod refine;
mod render;
mod sets;
mod write;

use std::path::Path;

use dyn_clone::DynClone;
use gudgeon_core::quantity::{Length, PosAngularSpeed, PosLength, PosPressure, Ratio, quantity};
use gudgeon_core::{BuildError, Word, register_kind, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use gudgeon_case::{Loaded, Origin, Report, load_str};

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Bench {
    #[serde(default)]
    title: String,
    /// The machine.
    machine: Machine,
    rings: Vec<Ring>,
    models: Models,
    #[serde(default)]
    solver: Solver,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-renamed" = { "pin_shift": "offset" }))]
struct Machine {
    /// Crankshaft speed. More text.
    speed: PosAngularSpeed,
    bore: PosLength,
    #[serde(default = "one")]
    cylinders: u32,
    #[serde(default)]
    design: Design,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    offset: Option<Length>,
}
fn one() -> u32 {
    1
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Design {
    /// Documented, so that the schema is a list of constants.
    #[default]
    TwinLand,
    /// The other.
    ThreePiece,
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Ring {
    gap: PosLength,
    #[serde(default)]
    drops: Vec<Length>,
    #[serde(default)]
    window: [f64; 2],
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Models {
    gas: Box<dyn GasSpec>,
    #[serde(default = "default_oil")]
    oil: Box<dyn GasSpec>,
    #[serde(default = "default_wall")]
    wall: Word<dyn GasSpec>,
}
fn default_wall() -> Word<dyn GasSpec> {
    Word(Box::new(Off {}))
}
fn default_oil() -> Box<dyn GasSpec> {
    Box::new(Orifice { cd: 0.65, area: quantity(2.0) })
}

#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
struct Solver {
    rtol: f64,
    start: PosPressure,
}
impl Default for Solver {
    fn default() -> Self {
        Self { rtol: 1e-6, start: quantity(1e5) }
    }
}

#[register_kind(name = "gas", summary = "a kind with three models")]
trait GasSpec: std::fmt::Debug + DynClone {
    fn cd(&self) -> Option<f64>;
}
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Orifice {
    cd: f64,
    #[serde(default = "area")]
    area: Ratio,
}
fn area() -> Ratio {
    quantity(2.0)
}
#[register_model(name = "orifice", summary = "", equations = "", validity = "", references = [], example = "")]
impl GasSpec for Orifice {
    fn cd(&self) -> Option<f64> {
        Some(self.cd)
    }
}
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Channel {
    #[serde(default = "area")]
    area: Ratio,
    #[serde(default)]
    thickness: Option<PosLength>,
}
#[register_model(name = "channel", summary = "", equations = "", validity = "", references = [], example = "")]
impl GasSpec for Channel {
    fn cd(&self) -> Option<f64> {
        None
    }
}
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Off {}
#[register_model(name = "off", summary = "", equations = "", validity = "", references = [], example = "")]
impl GasSpec for Off {
    fn cd(&self) -> Option<f64> {
        None
    }
}

const GOOD: &str = r#"title = "A bench"

[machine]
speed = "2000 rpm"
bore = "120 mm"
design = "three_piece"

[[rings]]
gap = "0.4 mm"

[[rings]]
gap = "0.5 mm"
drops = ["1 um", 0.0]

[models]
gas = { area = 3, model = "orifice", cd = 0.6 }
"#;

fn try_set(text: &str, overrides: &[&str]) -> Result<Loaded<Bench>, Report> {
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_owned()).collect();
    load_str("bench.toml", text, Path::new("."), &overrides)
}
fn good(overrides: &[&str]) -> Loaded<Bench> {
    try_set(GOOD, overrides).unwrap_or_else(|r| panic!("{r}"))
}
/// `line:column headline | help` of every mistake.
fn mistakes(text: &str, overrides: &[&str]) -> Vec<String> {
    let report = try_set(text, overrides).expect_err("must be refused");
    report
        .diagnostics
        .iter()
        .map(|d| {
            let (name, line, column) = report.place(d).expect("has a place");
            let name = if name == "bench.toml" { String::new() } else { format!("{name}:") };
            let help = d.help.as_ref().map_or_else(String::new, |h| format!(" | {h}"));
            format!("{name}{line}:{column} {}{help}", d.headline())
        })
        .collect()
}
fn edited(from: &str, to: &str) -> String {
    assert_eq!(GOOD.matches(from).count(), 1, "`{from}` must stand once in the base");
    GOOD.replace(from, to)
}

#[test]
fn reads_a_good_case() {
    let c = good(&[]);
    assert_eq!(c.value.machine.bore.si(), 0.12);
    assert_eq!(c.value.machine.design, Design::ThreePiece);
    assert_eq!(c.value.rings.len(), 2);
    assert_eq!(c.value.models.gas.cd(), Some(0.6));
    let r = c.resolved().expect("serialises");
    assert_eq!(r["machine"]["cylinders"], 1);
    assert_eq!(r["machine"]["bore"], "0.12 m");
    assert_eq!(r["models"]["oil"]["model"], "orifice");
}

#[test]
fn all_mistakes_in_one_go_in_file_order() {
    let text = r#"titel = "A bench"
[machine]
speed = "2000 bar"
bore = "-120 mm"
design = "three_pieces"
cylinders = 1.5
[[rings]]
gab = "0.4 mm"
[[rings]]
gap = true
drops = ["1 um", "x", nan]
window = [1.0]
[models]
gas = { area = 3, model = "orifise", cd = "zero" }
oil = { model = "channel", tickness = 1 }
[solver]
rtol = inf
"#;
    let units = "valid: `rad/s`, `rpm`, `1/min`, `rev/s`";
    assert_eq!(
        mistakes(text, &[]),
        [
            "1:1 unknown key `titel` | did you mean `title`? valid: `title`, `machine`, `rings`, `models`, `solver`",
            &format!(
                "3:9 machine.speed: `bar` is not a unit of a rotational speed | `bar` is a unit of a pressure; {units}"
            ),
            "4:8 machine.bore: `-120 mm` must be greater than zero",
            "5:10 machine.design: `three_pieces` is not a valid word here | did you mean `three_piece`? valid: `twin_land`, `three_piece`",
            "6:13 machine.cylinders: a whole number is wanted here, not a number",
            "8:1 rings.0: unknown key `gab` | did you mean `gap`? valid: `gap`, `drops`, `window`",
            "10:7 rings.1.gap: a length is wanted here, not a boolean | write it like `\"1.5 mm\"`",
            "11:18 rings.1.drops.1: `x` does not start with a number | write a length like `\"1.5 mm\"`",
            "11:23 rings.1.drops.2: `nan` must be finite",
            "12:10 rings.1.window: 1 value is given, exactly 2 wanted",
            "14:27 models.gas: there is no gas model `orifise` | did you mean `orifice`? valid: `channel`, `off`, `orifice`",
            "15:28 models.oil: unknown key `tickness` | did you mean `thickness`? valid: `area`, `thickness`, `model`",
            "17:8 solver.rtol: `inf` must be finite",
        ]
    );
}

#[test]
fn missing_keys_are_told_with_their_meaning() {
    assert_eq!(
        mistakes(&edited("speed = \"2000 rpm\"\n", ""), &[]),
        ["3:1 machine: missing key `speed` | `speed`: Crankshaft speed"]
    );
    assert_eq!(
        mistakes("title = \"x\"\n[models]\n", &[]),
        [
            "2:1 models: missing key `gas` | `gas`: one of the models `channel`, `off`, `orifice`",
            "3:1 missing keys `machine`, `rings` | `machine`: The machine",
        ]
    );
    assert_eq!(
        mistakes("", &[]),
        ["1:1 the file says nothing | a case needs at least `machine`, `rings`, `models`"]
    );
    assert_eq!(
        mistakes(&edited("model = \"orifice\", ", ""), &[]),
        ["16:7 models.gas: missing key `model` | valid: `channel`, `off`, `orifice`"]
    );
}

#[test]
fn a_key_in_the_wrong_table_is_sent_home() {
    assert_eq!(
        mistakes(&edited("bore = \"120 mm\"", "bore = \"120 mm\"\ntitle = \"x\""), &[])[0],
        "6:1 machine: unknown key `title` | `title` belongs to the top of the file, before the first table; \
         valid: `speed`, `bore`, `cylinders`, `design`, `offset`"
    );
    let d = &mistakes(&format!("{GOOD}bore = 1\n"), &[])[0];
    assert!(d.starts_with("17:1 models: unknown key `bore` | `bore` belongs to `[machine]`"), "{d}");
}

#[test]
fn wrong_shapes() {
    let one = |from: &str, to: &str| mistakes(&edited(from, to), &[]).join("\n");
    assert_eq!(
        one("gas = { area = 3, model = \"orifice\", cd = 0.6 }", "gas = \"chanel\""),
        "16:7 models.gas: a table with the key `model` is wanted here, not a text | write `gas = { model = \"channel\" }`"
    );
    assert_eq!(
        one("model = \"orifice\"", "model = 3"),
        "16:27 models.gas.model: a name is wanted here, not an integer | valid: `channel`, `off`, `orifice`"
    );
    assert_eq!(
        one("\"120 mm\"", "2020-01-01"),
        "5:8 machine.bore: a length is wanted here, not a date | write it like `\"1.5 mm\"`"
    );
    assert_eq!(
        one("\"120 mm\"", "\"120 MM\""),
        "5:8 machine.bore: `MM` is not a unit of a length | did you mean `mm`? valid: `m`, `cm`, `mm`, `um`, `µm`, `nm`, `in`"
    );
    assert_eq!(
        one("\"three_piece\"", "\"three_piece\"\ncylinders = -1"),
        "7:13 machine.cylinders: `-1` must be zero or greater"
    );
    assert_eq!(
        mistakes("machine = 1\nrings = 2\nmodels = []\n", &[]),
        [
            "1:11 machine: a table is wanted here, not an integer",
            "2:9 rings: an array is wanted here, not an integer",
            "3:10 models: a table is wanted here, not an array",
        ]
    );
}

#[test]
fn syntax_errors_stand_alone_with_advice() {
    assert_eq!(
        mistakes(&edited("\"120 mm\"", "120 mm"), &[]).len(),
        1,
        "whatever else is wrong behind a syntax error is guesswork"
    );
    let d = &mistakes(&edited("\"120 mm\"", "120 mm"), &[])[0];
    assert!(d.starts_with("5:") && d.ends_with("quotes: `bore = \"120 mm\"`"), "{d}");
    let d = &mistakes(&edited("\"120 mm\"", "\"120 mm"), &[])[0];
    assert!(d.starts_with("5:"), "{d}");
}

#[test]
fn duplicates_do_not_hide_the_rest() {
    let text = edited("bore = \"120 mm\"", "bore = \"120 mm\"\nbore = \"1 m\"\nspede = 1");
    let all = mistakes(&text, &[]);
    assert_eq!(all.len(), 2, "{all:#?}");
    assert_eq!(
        all[0],
        "6:1 `bore` stands here for the second time | the first one is in line 5; a key may stand in a table only once"
    );
    let twice = mistakes(&format!("{GOOD}[machine]\nspeed = 1\n"), &[]);
    assert!(
        twice[0].contains("`machine` stands here for the second time | the first one is in line 3"),
        "{twice:#?}"
    );
}

#[test]
fn overrides_replace_add_and_reach_into_defaults() {
    let c = good(&[
        "rings.0.gap=0.7 mm",
        "rings[1].gap=\"0.8 mm\"",
        "title=2024",
        "machine.offset = 1e-3",
        "rings.0.drops=[\"1 um\", 2e-6]",
        "models.oil.cd=0.9",
        "solver.rtol=1e-3",
    ]);
    assert_eq!(c.value.rings[0].gap.si(), 0.7e-3);
    assert_eq!(c.value.rings[1].gap.si(), 0.8e-3);
    assert_eq!(c.value.title, "2024");
    assert_eq!(c.value.machine.offset.map(|o| o.si()), Some(1e-3));
    assert_eq!(c.value.rings[0].drops.len(), 2);
    assert_eq!(c.value.models.oil.cd(), Some(0.9), "the default model is the one that is changed");
    assert_eq!((c.value.solver.rtol, c.value.solver.start.si()), (1e-3, 1e5));
    assert!(c.notes.is_empty());
    assert_eq!(c.given_by("rings.0.gap"), (Origin::Override(0), None));
    assert_eq!(c.given_by("machine.bore"), (Origin::File, Some(5)));
    assert_eq!(c.given_by("machine.cylinders"), (Origin::Default, None));
    assert_eq!(c.given_by("solver.start"), (Origin::Default, None));
}

#[test]
fn another_model_keeps_what_it_knows_and_tells_what_it_drops() {
    let c = good(&["models.gas.model=channel"]);
    assert_eq!(c.notes, ["models.gas: `channel` does not have `cd`, dropped; kept `area`"]);
    assert_eq!(c.resolved().expect("serialises")["models"]["gas"]["area"], 3.0);
    let c = good(&["models.gas.model=off"]);
    assert_eq!(c.notes, ["models.gas: `off` does not have `area`, `cd`, dropped"]);
    let c = good(&["models.oil.model=channel"]);
    assert!(c.notes.is_empty(), "defaults of the old model are nobody's choice: {:?}", c.notes);
    let c = good(&["models.oil.model=channel", "models.oil.thickness=3 um"]);
    assert!(c.resolved().expect("serialises")["models"]["oil"]["thickness"].is_string());
    let c = good(&["models.gas.model=orifice"]);
    assert_eq!((c.notes.len(), c.value.models.gas.cd()), (0, Some(0.6)), "no change");
}

/// A case whose machine needs its offset.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Offset {
    #[schemars(extend("required" = ["offset"]))]
    machine: Machine,
}

fn offset(keys: &str) -> Result<Loaded<Offset>, Report> {
    let text = format!("[machine]\nspeed = 1.0\nbore = 0.1\n{keys}\n");
    load_str("offset.toml", &text, Path::new("."), &[])
}

#[test]
fn a_table_may_be_asked_for_more_where_it_stands() {
    let read = offset("offset = \"1 mm\"").unwrap_or_else(|r| panic!("{r}"));
    assert_eq!(read.value.machine.offset.map(|o| o.si()), Some(1e-3));
    let told = offset("").expect_err("no offset").to_string();
    assert!(told.contains("missing key `offset`") && told.contains("offset.toml:1:1"), "{told}");
    assert!(try_set(GOOD, &[]).is_ok(), "elsewhere it is not asked for");
}

#[test]
fn a_key_that_had_another_name_is_told_the_new_one() {
    let told = offset("pin_shift = \"1 mm\"").expect_err("an old name").to_string();
    assert!(told.contains("unknown key `pin_shift`") && told.contains("it is called `offset` now"), "{told}");
    assert!(!told.contains("missing"), "{told}");
    let all = mistakes(GOOD, &["machine.pin_shift=1 mm"]);
    assert!(all.len() == 1 && all[0].ends_with("| it is called `offset` now"), "{all:?}");
}

#[test]
fn the_table_of_a_wrong_key_is_no_advice() {
    let all = mistakes(GOOD, &["solver.xy=1"]);
    assert!(all.len() == 1 && !all[0].contains("did you mean `solver`"), "{all:?}");
}

#[test]
fn a_model_chosen_by_a_word_has_keys_to_change() {
    let word = format!("{GOOD}wall = \"channel\"\n");
    let table = format!("{GOOD}wall = {{ model = \"channel\", area = 2.0 }}\n");
    for text in [GOOD, &word, &table] {
        for change in ["models.wall=channel", "models.wall.model=channel"] {
            let c =
                try_set(text, &[change, "models.wall.area=4"]).unwrap_or_else(|r| panic!("{change}: {r}"));
            let wall = c.resolved().expect("serialises")["models"]["wall"].clone();
            assert_eq!(
                (wall["model"].as_str(), wall["area"].as_f64()),
                (Some("channel"), Some(4.0)),
                "{change}"
            );
        }
    }
    let wrong = try_set(&word, &["models.wall.model=chanel"]).expect_err("no such model").to_string();
    assert!(wrong.contains("channel"), "{wrong}");
}

#[test]
fn overrides_are_blamed_where_they_are_wrong() {
    let one = |o: &str| mistakes(GOOD, &[o]).join("\n");
    assert_eq!(
        one("machine.bore=120 bar"),
        "--set:1:14 machine.bore: `bar` is not a unit of a length | `bar` is a unit of a pressure; \
         valid: `m`, `cm`, `mm`, `um`, `µm`, `nm`, `in`"
    );
    assert_eq!(
        one("models.gas.model=nothing"),
        "--set:1:18 models.gas: there is no gas model `nothing` | valid: `channel`, `off`, `orifice`"
    );
    assert_eq!(one("rings.2.gap=1"), "--set:1:7 rings: no entry `2` | it has 2 entries, numbered 0 to 1");
    assert_eq!(one("machine.bore.x=1"), "--set:1:14 machine.bore: is a text, which has no `x`");
    assert!(one("machine.bore").starts_with("--set:1:1 no `=` between path and value"));
    assert!(one("machine.bore=").starts_with("--set:1:13 no value after `=`"));
    assert!(one("=3").starts_with("--set:1:1 the path has an empty step"));
    assert!(one("machine..bore=3").starts_with("--set:1:1 the path has an empty step"));
    assert!(one("rings.0.drops=[1 um]").starts_with("--set:1:1"), "{}", one("rings.0.drops=[1 um]"));
    let d = one("bore=120 mm");
    assert!(d.starts_with("--set:1:1 unknown key `bore` | did you mean `machine.bore`?"), "{d}");
    let d = one("ring.1.gap=1");
    assert!(d.starts_with("--set:1:1 unknown key `ring` | did you mean `rings`?"), "{d}");
    assert_eq!(
        one("models.gas=channel"),
        "--set:1:12 models.gas: a table with the key `model` is wanted here, not a text | set `models.gas.model=channel`"
    );
    // File first, then the arguments in order.
    let all = mistakes(&edited("\"0.4 mm\"", "0"), &["solver.rtol=x", "title=[]"]);
    assert_eq!(all.len(), 3, "{all:#?}");
    assert!(all[0].starts_with("9:7") && all[1].contains("solver.rtol") && all[2].contains("title"));
}

#[test]
fn a_forgotten_unit_is_told() {
    let c = try_set(&edited("\"120 mm\"", "120"), &["rings.0.drops=[1e-6, 5]", "solver.start=1"])
        .expect("possible");
    assert_eq!(
        c.notes,
        [
            "machine.bore is 120 m: a number without a unit is SI; `\"120 mm\"` has one",
            "rings.0.drops.1 is 5 m: a number without a unit is SI; `\"5 mm\"` has one",
            "solver.start is 1 Pa: a number without a unit is SI; `\"1 bar\"` has one",
        ]
    );
    assert!(try_set(&edited("\"120 mm\"", "\"120 m\""), &[]).expect("possible").notes.is_empty());
}

#[test]
fn later_errors_find_their_place() {
    let c = good(&["rings.1.gap=0.7 mm"]);
    let place = |field: &str| {
        let d = c.locate(&BuildError::at(field, "too large").help("smaller"));
        let report = Report::new(vec![d.clone()], c.source.clone(), c.overrides.clone());
        let (name, line, column) = report.place(&d).expect("has a place");
        format!("{name}:{line}:{column} {}", d.headline())
    };
    assert_eq!(place("rings[0].gap"), "bench.toml:9:7 rings.0.gap: too large");
    assert_eq!(place("rings.1.gap"), "--set:1:13 rings.1.gap: too large");
    assert_eq!(place("rings.0.nothing"), "bench.toml:8:1 rings.0.nothing: too large");
    assert_eq!(place("models.gas.cd"), "bench.toml:16:43 models.gas.cd: too large");
    assert_eq!(
        place("models.oil.cd"),
        "bench.toml:15:1 models.oil.cd: too large",
        "a default: its nearest parent"
    );
    assert_eq!(place("solver.rtol"), "bench.toml:17:1 solver.rtol: too large", "a default at the top");
}

#[test]
fn odd_texts_are_read_or_refused_with_a_place() {
    let crlf = GOOD.replace('\n', "\r\n");
    assert!(try_set(&crlf, &[]).is_ok());
    assert_eq!(mistakes(&crlf.replace("0.5 mm", "0.5 bar"), &[])[0].split(' ').next(), Some("12:7"));
    let bom = format!("\u{feff}{GOOD}");
    assert!(try_set(&bom, &[]).is_ok());
    assert_eq!(mistakes(&bom.replace("0.5 mm", "0.5 bar"), &[])[0].split(' ').next(), Some("12:7"));
    // Columns count characters, not bytes.
    let greek = edited("\"orifice\"", "\"Ωorifice\", \"Ω\" = 1");
    assert!(mistakes(&greek, &[])[0].starts_with("16:27"));
    let greek = edited("model = \"orifice\", cd = 0.6", "\"Ωµ\" = 1, model = \"orifice\", cd = \"x\"");
    let columns: Vec<_> =
        mistakes(&greek, &[]).iter().map(|m| m.split(' ').next().map(str::to_owned)).collect();
    assert_eq!(columns, [Some("16:19".to_owned()), Some("16:53".to_owned())]);
    // A value nested beyond the parser's limit, and a text of a megabyte where a number is wanted.
    assert_eq!(mistakes(&format!("a = {}", "[".repeat(5000)), &[]).len(), 1);
    let long = mistakes(&edited("\"120 mm\"", &format!("\"{}x\"", "1".repeat(1 << 20))), &[]);
    assert!(long[0].len() < 400 && long[0].starts_with("5:8"), "{}", long[0].len());
    let huge = edited("\"120 mm\"", "99999999999999999999999999");
    let said = "5:8 machine.bore: `1e26` is beyond any machine: a length is at most 1e6 m";
    assert_eq!(mistakes(&huge, &[]), [said]);
    assert_eq!(mistakes(&edited("\"120 mm\"", "1e999"), &[]), ["5:8 machine.bore: `inf` must be finite"]);
}

#[test]
fn no_damage_to_a_text_makes_it_panic_or_lose_its_place() {
    let judge = |text: &str, set: &[&str]| {
        if let Err(report) = try_set(text, set) {
            assert!(!report.diagnostics.is_empty(), "{text}");
            for d in &report.diagnostics {
                assert!(report.place(d).is_some() && !d.message.is_empty(), "{text}\n{d:?}");
            }
            assert!(!report.render(false).is_empty());
        }
    };
    for (i, c) in GOOD.char_indices() {
        judge(&GOOD[..i], &[]);
        let rest = &GOOD[i + c.len_utf8()..];
        for put in ["", "\"", "[", "]", "{", "=", ".", "#", "\n", "\r", "0", "-", "µ", "\u{0}", "\u{feff}"] {
            judge(&format!("{}{put}{rest}", &GOOD[..i]), &[]);
        }
    }
    let set = "rings[1].drops=[\"1 um\", { a = 'b' }]";
    for (i, c) in set.char_indices() {
        for put in ["", "\"", "[", "]", "=", ".", "\n", "µ"] {
            judge(GOOD, &[&format!("{}{put}{}", &set[..i], &set[i + c.len_utf8()..])]);
        }
    }
}

#[test]
fn rendering_shows_place_line_and_help() {
    let render = |text: &str, set: &[&str]| try_set(text, set).expect_err("refused").render(false);
    assert_eq!(
        render(&edited("\"120 mm\"", "\"120 bar\" # wide"), &[]),
        r#"  × machine.bore: `bar` is not a unit of a length
   ╭─[bench.toml:5:8]
 5 │ bore = "120 bar" # wide
   ·        ─────────
   ╰────
  help: `bar` is a unit of a pressure; valid: `m`, `cm`, `mm`, `um`, `µm`, `nm`, `in`
"#
    );
    assert_eq!(
        render(GOOD, &["solver.rtol=1", "machine.speed=2000 rpn"]),
        r#"  × machine.speed: `rpn` is not a unit of a rotational speed
   ╭─[--set:1:15]
 1 │ machine.speed=2000 rpn
   ·               ────────
   ╰────
  help: did you mean `rpm`? valid: `rad/s`, `rpm`, `1/min`, `rev/s`
"#
    );
    // The end of the file, a value over several lines, CRLF, a line of a megabyte.
    assert!(render("title = \"x\"\n", &[]).contains("[bench.toml:2:1]"));
    let several = edited("\"120 mm\"", "[\n 1,\n 2 ]");
    assert!(render(&several, &[]).contains("5 │ bore = [\n   ·        ─\n"), "{}", render(&several, &[]));
    let crlf = edited("\"120 mm\"", "[\n 1,\n 2 ]").replace('\n', "\r\n");
    assert!(render(&crlf, &[]).contains("5 │ bore = [\n   ·        ─\n"), "{:?}", render(&crlf, &[]));
    let long = render(&edited("\"120 mm\"", &format!("\"{}\"", "µ".repeat(1 << 20))), &[]);
    assert!(long.len() < 3000, "{}", long.len());
}
