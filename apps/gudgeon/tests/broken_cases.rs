//! Broken case files: every one is refused with exit code 2, its mistake is found in the line where it stands, the message
//! says what is wrong and the help what would be right, and nothing is written.
//!
//! `tests/broken/base.toml` is valid. Each entry of [`EDITS`] makes one mistake in it; [`APPENDED`] and [`FILES`] hold what
//! cannot be written as an edit.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

/// One mistake: what is replaced in the base, and what must be said about it.
struct Edit {
    name: &'static str,
    from: &'static str,
    to: &'static str,
    /// Text that stands in the line the mistake is reported in.
    line: &'static str,
    /// Part of the headline, path included.
    says: &'static str,
    /// Part of the advice.
    help: &'static str,
}

macro_rules! edits {
    ($($name:literal: $from:literal => $to:literal, at $line:literal: $says:literal, $help:literal;)*) => {
        &[$(Edit { name: $name, from: $from, to: $to, line: $line, says: $says, help: $help }),*]
    };
}

/// In the order: keys, models and kinds, words, units and numbers, missing things, wrong shapes, syntax, geometry, solver.
const EDITS: &[Edit] = edits! {
    "misspelt key": "bore = \"100 mm\"" => "boore = \"100 mm\"", at "boore": "engine: unknown key `boore`", "did you mean `bore`?";
    "key in capitals": "stroke =" => "Stroke =", at "Stroke": "engine: unknown key `Stroke`", "did you mean `stroke`?";
    "key with a hyphen": "rod_length =" => "rod-length =", at "rod-length": "unknown key `rod-length`", "did you mean `rod_length`?";
    "key with a unit": "rod_length =" => "rod_length_mm =", at "rod_length_mm": "unknown key `rod_length_mm`", "did you mean `rod_length`?";
    "key nobody knows": "cylinders = 4" => "colour = 4", at "colour": "engine: unknown key `colour`", "valid: `speed`, `bore`";
    "key of another table": "gamma = 1.4" => "gamma = 1.4\nbore = 1", at "bore = 1": "gas: unknown key `bore`", "`bore` belongs to `[engine]`";
    "top-level key below a table": "cylinders = 4" => "cylinders = 4\nsource = \"a book\"", at "a book": "engine: unknown key `source`", "top of the file, before the first table";
    "misspelt table": "[engine]" => "[engin]", at "[engin]": "unknown key `engin`", "did you mean `engine`?";
    "misspelt array of tables": "[[piston.lands]]\ndiameter = \"99.5 mm\"" => "[[piston.land]]\ndiameter = \"99.5 mm\"", at "[[piston.land]]": "piston: unknown key `land`", "did you mean `lands`?";
    "misspelt key in an array": "tangential_force = \"40 N\"" => "tangental_force = \"40 N\"", at "tangental": "rings.1: unknown key `tangental_force`", "did you mean `tangential_force`?";
    "misspelt key two tables deep": "leak_lower =" => "leek_lower =", at "leek": "rings.0.groove: unknown key `leek_lower`", "did you mean `leak_lower`?";
    "key in Greek": "gamma = 1.4" => "\"γ\" = 1.4", at "γ": "gas: unknown key `γ`", "valid: `gamma`";
    "empty key": "gamma = 1.4" => "\"\" = 1.4", at "\"\" = 1.4": "gas: unknown key ``", "valid: `gamma`";
    "unknown output": "results = [\"all\"]" => "results = [\"blowby\"]", at "blowby": "outputs.results.0: there is no result `blowby`", "blow_by";

    "misspelt model": "model = \"orifice_network\"" => "model = \"orifice_netwrok\"", at "netwrok": "there is no gas_flow model `orifice_netwrok`", "did you mean `orifice_network`?";
    "model nobody knows": "model = \"orifice_network\"" => "model = \"banana\"", at "banana": "there is no gas_flow model `banana`", "`narrow_channel`, `orifice_network`";
    "model of another kind": "model = \"orifice_network\"" => "model = \"greenwood_tripp\"", at "greenwood": "there is no gas_flow model `greenwood_tripp`", "`orifice_network`";
    "model in capitals": "model = \"vogel_grade\"" => "model = \"Vogel_Grade\"", at "Vogel_Grade": "there is no oil model", "did you mean `vogel_grade`?";
    "model as a number": "model = \"vogel_grade\"" => "model = 3", at "model = 3": "models.oil.model: a name is wanted here", "`vogel_grade`";
    "no model": "model = \"vogel_grade\"\n" => "", at "[models.oil]": "models.oil: missing key `model`", "`vogel_grade`";
    "misspelt model key": "model = \"vogel_grade\"" => "modle = \"vogel_grade\"", at "modle": "models.oil: unknown key `modle`", "did you mean `model`?";
    "misspelt kind": "[models.gas_flow]" => "[models.gas_flows]", at "gas_flows": "models: unknown key `gas_flows`", "did you mean `gas_flow`?";
    "kind nobody knows": "[models.gas_flow]" => "[models.turbulence]", at "turbulence": "models: unknown key `turbulence`", "valid: `kinematics`";
    "key of another model": "gap_split = 0.5" => "face_conductance = 0.5", at "face_conductance": "models.gas_flow: unknown key `face_conductance`", "valid:";
    "model as a bare word": "[models.film_temperature]\nmodel = \"liner_linear\"\ntdc = \"180 degC\"\nbdc = \"110 degC\"" => "[models]\nfilm_temperature = \"liner_linear\"", at "film_temperature =": "a table with the key `model` is wanted", "film_temperature = { model = \"liner_linear\" }";
    "model of one ring": "gap = \"0.4 mm\"" => "gap = \"0.4 mm\"\nmodels.contact.model = \"of\"", at "\"of\"": "there is no contact model `of`", "did you mean `off`?";

    "wrong scene": "scene = \"ring_pack\"" => "scene = \"ring_packs\"", at "ring_packs": "scene: `ring_packs` is not a valid word here", "`ring_pack`";
    "scene nobody knows": "scene = \"ring_pack\"" => "scene = \"gearbox\"", at "gearbox": "scene: `gearbox` is not a valid word here", "`ring_pack`";
    "wrong word": "design = \"twin_land\"" => "design = \"two_lands\"", at "two_lands": "rings.1.design: `two_lands` is not a valid word here", "`compression`, `twin_land`, `three_piece`";
    "misspelt word": "shape = \"parabola\"" => "shape = \"parabla\"", at "parabla": "rings.0.face.shape: `parabla`", "did you mean `parabola`?";
    "boolean for a word": "method = \"implicit\"" => "method = true", at "method = true": "solver.method: a name is wanted here, not a boolean", "`substep_march`";
    "wrong oil grade": "grade = \"sae_30\"" => "grade = \"sae_35\"", at "sae_35": "models.oil.grade: `sae_35`", "`sae_30`";

    "unit of another dimension": "bore = \"100 mm\"" => "bore = \"100 bar\"", at "100 bar": "engine.bore: `bar` is not a unit of a length", "`bar` is a unit of a pressure";
    "unit in capitals": "bore = \"100 mm\"" => "bore = \"100 MM\"", at "100 MM": "engine.bore: `MM` is not a unit", "did you mean `mm`?";
    "unit nobody knows": "speed = \"2000 rpm\"" => "speed = \"2000 furlongs\"", at "furlongs": "engine.speed: `furlongs` is not a unit of a rotational speed", "`rpm`";
    "Fahrenheit": "temperature = \"220 degC\"" => "temperature = \"430 degF\"", at "degF": "`degF` is not a unit of a temperature", "(F - 32)/1.8";
    "no number": "bore = \"100 mm\"" => "bore = \"wide\"", at "wide": "engine.bore: `wide` does not start with a number", "write a length like";
    "empty text": "bore = \"100 mm\"" => "bore = \"\"", at "bore = \"\"": "engine.bore: `` does not start with a number", "write a length like";
    "decimal comma": "mass = \"20 g\"" => "mass = \"20,5 g\"", at "20,5": "rings.0.mass: `20,5 g` is not a number with a unit", "the decimal mark is a point, minus a hyphen: `\"20.5 g\"`";
    "decimal comma without quotes": "gamma = 1.4" => "gamma = 1,4", at "1,4": "", "the decimal mark is a point: `gamma = 1.4`";
    "decimal comma with a unit, without quotes": "mass = \"20 g\"" => "mass = 20,5 g", at "20,5": "", "`mass = \"20.5 g\"`";
    "minus of a typesetter": "pin_to_ring1 = \"50 mm\"" => "pin_to_ring1 = \"−50 mm\"", at "−50": "piston.pin_to_ring1: `−50 mm` is not a number with a unit", "`\"-50 mm\"`";
    "unit written out": "bore = \"100 mm\"" => "bore = \"100 millimetres\"", at "100 milli": "engine.bore: `millimetres` is not a unit of a length", "did you mean `mm`?";
    "unit with a letter too many": "crankcase_pressure = \"1 bar\"" => "crankcase_pressure = \"1 barr\"", at "barr": "gas.crankcase_pressure: `barr` is not a unit", "did you mean `bar`?";
    "number in quotes": "eta_beta_sigma = 0.05" => "eta_beta_sigma = \"x\"", at "eta_beta": "models.contact.eta_beta_sigma", "";
    "two numbers": "mass = \"20 g\"" => "mass = \"20 25 g\"", at "20 25": "rings.0.mass: `25 g` is not a unit", "`g`";
    "negative length": "bore = \"100 mm\"" => "bore = \"-100 mm\"", at "-100 mm": "engine.bore: `-100 mm` must be greater than zero", "";
    "zero speed": "speed = \"2000 rpm\"" => "speed = 0", at "speed = 0": "engine.speed: `0` must be greater than zero", "";
    "negative clearance": "clearance = \"0.04 mm\"" => "clearance = \"-0.04 mm\"", at "-0.04 mm": "rings.1.groove.clearance: `-0.04 mm` must be greater than zero", "";
    "negative leak": "leak_lower = \"0.02 um\"" => "leak_lower = -2e-8", at "-2e-8": "rings.0.groove.leak_lower: `-2e-8` must be zero or greater", "";
    "below absolute zero": "temperature = \"220 degC\"" => "temperature = \"-300 degC\"", at "-300": "`-300 degC` must be greater than zero", "";
    "fraction above one": "gap_split = 0.5" => "gap_split = 1.5", at "gap_split": "models.gas_flow.gap_split: `1.5` must be between 0 and 1", "";
    "nan": "gamma = 1.4" => "gamma = nan", at "nan": "gas.gamma: `nan` must be finite", "";
    "nan with a unit": "stroke = \"110 mm\"" => "stroke = \"nan mm\"", at "nan mm": "engine.stroke: `nan mm` must be finite", "";
    "infinite": "stroke = \"110 mm\"" => "stroke = inf", at "inf": "engine.stroke: `inf` must be finite", "";
    "overflow": "stroke = \"110 mm\"" => "stroke = \"1e999 mm\"", at "1e999": "engine.stroke: `1e999 mm` must be finite", "";
    "fractional count": "cylinders = 4" => "cylinders = 4.5", at "4.5": "engine.cylinders: a whole number is wanted", "";
    "negative count": "cylinders = 4" => "cylinders = -4", at "-4": "engine.cylinders: `-4` must be", "";
    "huge count": "cylinders = 4" => "cylinders = 99999999999", at "99999999999": "engine.cylinders: `99999999999` must be at most 1000", "";
    "no cylinder": "cylinders = 4" => "cylinders = 0", at "cylinders = 0": "engine.cylinders: `0` must be at least 1", "";
    "count as text": "cylinders = 4" => "cylinders = \"4\"", at "cylinders": "engine.cylinders: a whole number is wanted here, not a text", "write it without quotes: `4`";

    "missing key": "bore = \"100 mm\"\n" => "", at "[engine]": "engine: missing key `bore`", "Cylinder bore";
    "missing keys": "height = \"2.5 mm\"\nwidth = \"4 mm\"\n" => "", at "[[rings]]": "rings.0: missing keys `height`, `width`", "Axial thickness";
    "missing scene": "scene = \"ring_pack\"\n" => "", at "": "missing key `scene`", "What is simulated";
    "missing kind": "[models.oil]\nmodel = \"vogel_grade\"\ntable = \"zottin1992\"\ngrade = \"sae_30\"\n" => "", at "[models.": "models: missing key `oil`", "Lubricant";
    "missing parameter of a model": "tdc = \"180 degC\"\n" => "", at "[models.film_temperature]": "models.film_temperature: missing key `tdc`", "";
    "missing end gap": "gap = \"0.4 mm\"\n\n[rings.face]\nshape = \"parabola\"" => "\n[rings.face]\nshape = \"parabola\"", at "[[rings]]": "rings.0: the ring has no end gap", "`cold_gap`";

    "number for a table": "[gas]\ngamma = 1.4\ncrankcase_pressure = \"1 bar\"" => "[outputs.gas]", at "[outputs.gas]": "outputs: unknown key `gas`", "";
    "text for a table": "[outputs]\nresults = [\"all\"]\nseries_step = \"1 deg\"" => "[models.kinematics]\nmodel = { name = \"x\" }", at "name": "models.kinematics.model: a name is wanted here, not a table", "";
    "text for an array": "results = [\"all\"]" => "results = \"all\"", at "results": "outputs.results: an array is wanted here, not a text", "";
    "table for a number": "bore = \"100 mm\"" => "bore = { value = 100, unit = \"mm\" }", at "value": "engine.bore: a length is wanted here, not a table", "write it like";
    "array for a number": "bore = \"100 mm\"" => "bore = [100, 110]", at "[100": "engine.bore: a length is wanted here, not an array", "write it like";
    "boolean for a number": "gamma = 1.4" => "gamma = true", at "true": "gas.gamma: a number is wanted here, not a boolean", "";
    "date for a number": "gamma = 1.4" => "gamma = 1992-01-01", at "1992": "gas.gamma: a number is wanted here, not a date", "";
    "table for an array of tables": "[[piston.lands]]\ndiameter = \"99.3 mm\"\nheight = \"8 mm\"\ntemperature = \"250 degC\"\n\n[[piston.lands]]" => "[piston.lands]", at "[piston.lands]": "piston.lands: an array is wanted here, not a table", "";
    "number among texts": "results = [\"all\"]" => "results = [\"all\", 3]", at "3]": "outputs.results.1: a text in quotes is wanted here", "";

    "value without quotes": "bore = \"100 mm\"" => "bore = 100 mm", at "100 mm": "", "quotes: `bore = \"100 mm\"`";
    "word without quotes": "method = \"implicit\"" => "method = implicit", at "implicit": "", "quotes: `method = \"implicit\"`";
    "open quote": "bore = \"100 mm\"" => "bore = \"100 mm", at "bore": "", "";
    "open header": "[engine]" => "[engine", at "[engine": "", "";
    "colon for an equals sign": "speed = \"2000 rpm\"" => "speed: \"2000 rpm\"", at "speed:": "", "";
    "slashes for a comment": "gamma = 1.4" => "gamma = 1.4 // air", at "//": "", "";
    "duplicate key": "bore = \"100 mm\"" => "bore = \"100 mm\"\nbore = \"110 mm\"", at "110 mm": "`bore` stands here for the second time", "the first one is in line 7";
    "duplicate table": "[gas]" => "[engine]\nspeed = 1\n[gas]", at "[engine]": "`engine` stands here for the second time", "line 5";
    "leading zero": "cylinders = 4" => "cylinders = 04", at "04": "", "";

    "rod shorter than the crank": "rod_length = \"190 mm\"" => "rod_length = \"50 mm\"", at "rod_length": "", "";
    "groove lower than its ring": "height = \"2.55 mm\"" => "height = \"2.4 mm\"", at "2.4 mm": "rings.0.groove.height: the ring has an axial clearance of -0.1", "higher groove";
    "land wider than the bore": "diameter = \"99.5 mm\"" => "diameter = \"105 mm\"", at "105 mm": "piston.lands.1", "";
    "face longer than the ring": "length = \"2.2 mm\"" => "length = \"22 mm\"", at "22 mm": "rings.0.face.length: a face of 22", "";
    "ring thicker than its groove is deep": "width = \"4 mm\"" => "width = \"40 mm\"", at "root_diameter": "rings.0.groove.root_diameter: a ring 40", "";
    "end gap that closes hot": "cold_gap = \"0.4 mm\"" => "cold_gap = \"0.2 mm\"", at "cold_gap": "rings.1.cold_gap: the end gap of ring 2 closes when hot: 0.2000 mm cold", "a larger gap";
    "more lands than rings": "[[liner.distortion]]\nposition = \"60 mm\"" => "[[piston.lands]]\nclearance = \"1 mm\"\ntemperature = 400\n[[liner.distortion]]\nposition = \"60 mm\"", at "[[piston.lands]]": "piston.lands: there are 2 rings but 3 lands", "one `[[piston.lands]]`";
    "both gaps": "cold_gap = \"0.4 mm\"" => "cold_gap = \"0.4 mm\"\ngap = \"0.3 mm\"", at "gap = \"0.3 mm\"": "rings.1.gap: both `gap` and `cold_gap` are given", "keep one";
    "cold gap without temperature": "cold_gap = \"0.4 mm\"\ntemperature = \"150 degC\"" => "cold_gap = \"0.4 mm\"", at "cold_gap": "rings.1.cold_gap", "";
    "face without its drop": "drop = \"5 um\"\n" => "", at "parabola": "rings.0.face.shape: a `parabola` needs its `drop`", "";
    "face table of one point": "drops = [\"1 um\", \"0 um\", \"1 um\"]" => "drops = [\"1 um\"]", at "drops": "rings.1.face.drops: a table needs at least two drops", "";
    "face behind the liner": "drops = [\"1 um\", \"0 um\", \"1 um\"]" => "drops = [\"1 um\", \"-2 um\", \"1 um\"]", at "-2 um": "rings.1.face.drops.1", "";
    "liner table not monotone": "position = \"0 mm\"" => "position = \"70 mm\"", at "": "liner.distortion", "";
    "liner table too short": "position = \"-120 mm\"" => "position = \"-20 mm\"", at "[[liner.distortion]]": "liner.distortion: the rings travel from", "cover the whole travel";
    "distorted liner without a pin": "pin_to_ring1 = \"50 mm\"\n" => "", at "[piston]": "piston: a distorted liner needs `pin_to_ring1`", "";
    "gas without heat capacity": "gamma = 1.4" => "gamma = 1", at "gamma": "gas.gamma: `1` must be greater than one", "";

    "hopeless tolerance": "tolerance = 1e-4" => "tolerance = 1e-30", at "1e-30": "solver.tolerance", "";
    "endless rows": "series_step = \"1 deg\"" => "series_step = \"1e-9 deg\"", at "1e-9": "outputs.series_step", "between";
    "scheme that cannot move a ring": "method = \"implicit\"\ntolerance = 1e-4\n" => "method = \"degree_march\"\n", at "degree_march": "solver.method", "substep_march";
    "scheme that became a method": "method = \"implicit\"" => "method = \"as_published\"", at "as_published": "solver: `as_published` is no longer a method", "`method = \"substep_march\"`";
};

/// `--set` arguments, and what must be said about them.
const ARGUMENTS: &[(&str, &str, &str)] = &[
    ("engine.bore", "no `=`", "PATH=VALUE"),
    ("=1", "empty step", "PATH=VALUE"),
    ("engine.bore=", "no value", "PATH=VALUE"),
    ("engine..bore=1", "empty step", "PATH=VALUE"),
    ("bore=100 mm", "unknown key `bore`", "did you mean `engine.bore`?"),
    ("engine.boore=100 mm", "engine: unknown key `boore`", "did you mean `bore`?"),
    ("ring.0.gap=1 mm", "unknown key `ring`", "did you mean `rings`?"),
    ("rings.7.gap=1 mm", "rings: no entry `7`", "numbered 0 to 1"),
    ("rings.first.gap=1 mm", "rings: no entry `first`", "numbered 0 to 1"),
    ("engine.bore.x=1", "engine.bore: is a text", ""),
    ("engine.bore=5 bar", "`bar` is not a unit of a length", "is a unit of a pressure"),
    ("engine.bore=-5 mm", "must be greater than zero", ""),
    ("rings.0.face.drops=[1 um]", "", ""),
    ("models.gas_flow.model=banana", "there is no gas_flow model `banana`", "`orifice_network`"),
    (
        "models.gas_flow=narrow_channel",
        "a table with the key `model`",
        "models.gas_flow.model=narrow_channel",
    ),
    ("models.gas_flw.model=narrow_channel", "unknown key `gas_flw`", "did you mean `gas_flow`?"),
    ("solver.method=fast", "unknown method `fast`", "`substep_march`"),
    ("engine=1", "engine: a table is wanted", ""),
    ("rings=[]", "rings: a ring pack needs at least one ring", "`[[rings]]`"),
    ("rings=[{ mass = \"1 g\" }]", "rings.0: missing keys", ""),
    ("rings.0.face={ shape = \"parabola\" }", "rings.0.face.shape: a `parabola` needs its `drop`", ""),
    ("rings.1.face.drops=[\"1 um\"]", "rings.1.face.drops: a table needs at least two drops", ""),
    ("rings.1.face.drops=[\"1 um\", \"-2 um\"]", "rings.1.face.drops.1: a drop is measured away", ""),
    (
        "liner.distortion=[{ position = \"0 mm\", diametral = \"0 mm\" }]",
        "liner.distortion: a distortion table needs at least two",
        "",
    ),
    (
        "piston.lands=[{ clearance = \"1 mm\", temperature = 400 }]",
        "piston.lands: there are 2 rings but 1 lands",
        "one `[[piston.lands]]`",
    ),
    ("models.oil={ model = \"vogel_grade\", table = \"zottin1992\" }", "models.oil: missing key `grade`", ""),
    ("models={}", "models: missing keys", ""),
    ("solver.max_cycles=99999999999", "solver.max_cycles: `99999999999` must be at most 1000", ""),
    ("solver.max_cycles=\"4\"", "solver.max_cycles: a whole number is wanted here, not a text", "`4`"),
    ("rings.1.cold_gap=0,2 mm", "`0,2 mm` is not a number with a unit", "`\"0.2 mm\"`"),
    (
        "rings.1.cold_gap=200 \u{3bc}m",
        "rings.1.cold_gap: the end gap of ring 2 closes when hot: 0.2000 mm cold",
        "a larger gap",
    ),
    ("rings.0.groove.height=2.4 mm", "axial clearance of -0.1", "higher groove"),
];

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/broken")
}
fn base() -> String {
    fs::read_to_string(corpus().join("base.toml")).expect("the base is in the repository")
}

/// An empty folder of its own, removed at the end.
struct Folder(PathBuf);
impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gudgeon-broken-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("the temporary folder can be written");
        Self(path)
    }
    fn entries(&self) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(&self.0)
            .expect("exists")
            .map(|e| e.expect("readable").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}
impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn gudgeon(folder: &Folder, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gudgeon"))
        .args(args)
        .current_dir(&folder.0)
        .env("NO_COLOR", "1")
        .output()
        .expect("the program starts")
}
fn stderr(o: &Output) -> String {
    String::from_utf8_lossy(&o.stderr).into_owned()
}

/// The mistakes that `check --json` reports; checks the exit code.
fn mistakes(folder: &Folder, args: &[&str]) -> Vec<Value> {
    let mut all = vec!["check", "case.toml", "--json"];
    all.extend(args);
    let o = gudgeon(folder, &all);
    assert_eq!(o.status.code(), Some(2), "{args:?}: {}", stderr(&o));
    let v: Value = serde_json::from_slice(&o.stdout).expect("JSON on standard output");
    assert_eq!(v["ok"], false);
    v["mistakes"].as_array().expect("a list").clone()
}
fn headline(m: &Value) -> String {
    match m["path"].as_str() {
        None | Some("") => m["message"].as_str().unwrap_or_default().to_owned(),
        Some(p) => format!("{p}: {}", m["message"].as_str().unwrap_or_default()),
    }
}

fn shown(found: &[Value]) -> String {
    let line =
        |m: &Value| format!("  {}:{}:{} {} | {}\n", m["in"], m["line"], m["column"], headline(m), m["help"]);
    found.iter().map(line).collect()
}

#[test]
fn the_base_is_valid() {
    let folder = Folder::new("base");
    fs::write(folder.0.join("case.toml"), base()).expect("written");
    let o = gudgeon(&folder, &["check", "case.toml"]);
    assert_eq!(o.status.code(), Some(0), "{}", stderr(&o));
    assert_eq!(String::from_utf8_lossy(&o.stdout), "case.toml: ok\n");
    assert_eq!(folder.entries(), ["case.toml"], "check writes nothing");
}

#[test]
fn a_forgotten_unit_is_told() {
    let folder = Folder::new("unit");
    let text = base().replacen("rod_length = \"190 mm\"", "rod_length = 190", 1);
    fs::write(folder.0.join("case.toml"), text).expect("written");
    let o = gudgeon(&folder, &["check", "case.toml"]);
    assert!(stderr(&o).contains("note: engine.rod_length is 190 m"), "{}", stderr(&o));
}

#[test]
fn every_edit_is_refused_where_it_stands() {
    let folder = Folder::new("edits");
    let base = base();
    let mut wrong = Vec::new();
    for e in EDITS {
        if !base.contains(e.from) {
            wrong.push(format!("{}: `{}` is not in the base", e.name, e.from));
            continue;
        }
        // The first occurrence: several values of the base are alike.
        let text = base.replacen(e.from, e.to, 1);
        fs::write(folder.0.join("case.toml"), &text).expect("written");
        let o = gudgeon(&folder, &["check", "case.toml", "--json"]);
        if o.status.code() != Some(2) {
            wrong.push(format!("{}: exit code {:?}: {}", e.name, o.status.code(), stderr(&o)));
            continue;
        }
        let v: Value = serde_json::from_slice(&o.stdout).expect("JSON on standard output");
        let found = v["mistakes"].as_array().expect("a list");
        let fits = |m: &&Value| {
            let line = m["line"].as_u64().and_then(|n| text.lines().nth(n as usize - 1)).unwrap_or_default();
            headline(m).contains(e.says)
                && m["help"].as_str().unwrap_or_default().contains(e.help)
                && line.contains(e.line)
                && m["line"].is_u64()
                && !headline(m).is_empty()
        };
        if found.iter().filter(fits).count() != 1 || found.len() != 1 {
            wrong.push(format!("{}:\n{}", e.name, shown(found)));
        }
    }
    assert!(wrong.is_empty(), "{} of {} cases:\n{}", wrong.len(), EDITS.len(), wrong.join("\n"));
    assert_eq!(folder.entries(), ["case.toml"]);
}

#[test]
fn a_refused_run_writes_nothing_and_shows_the_line() {
    let folder = Folder::new("run");
    // One of each stage: syntax, schema, geometry.
    for (from, to, place) in [
        ("bore = \"100 mm\"", "bore = 100 mm", "[case.toml:7:"),
        ("bore = \"100 mm\"", "bore = \"100 bar\"", "[case.toml:7:8]"),
        ("height = \"2.55 mm\"", "height = \"2.4 mm\"", "[case.toml:53:10]"),
    ] {
        let text = base().replacen(from, to, 1);
        fs::write(folder.0.join("case.toml"), &text).expect("written");
        for command in [
            &["run", "case.toml"][..],
            &["run", "case.toml", "--json"],
            &["explain", "case.toml"],
            &["bench", "case.toml"],
            &["compare", "case.toml", "--swap", "gas_flow=orifice_network,narrow_channel"],
        ] {
            let o = gudgeon(&folder, command);
            assert_eq!(o.status.code(), Some(2), "{command:?}: {}", stderr(&o));
            assert!(o.stdout.is_empty(), "{command:?}");
            assert!(stderr(&o).contains(place) && stderr(&o).contains("──"), "{command:?}: {}", stderr(&o));
            assert!(stderr(&o).contains(to), "the line is shown: {}", stderr(&o));
            assert_eq!(folder.entries(), ["case.toml"], "{command:?}");
        }
    }
}

#[test]
fn wrong_arguments_are_shown() {
    let folder = Folder::new("arguments");
    fs::write(folder.0.join("case.toml"), base()).expect("written");
    let mut wrong = Vec::new();
    for (set, says, help) in ARGUMENTS {
        let found = mistakes(&folder, &["--set", set]);
        let fits = |m: &Value| {
            headline(m).contains(says)
                && m["help"].as_str().unwrap_or_default().contains(help)
                && m["in"] == "--set"
        };
        if found.len() != 1 || !fits(&found[0]) {
            wrong.push(format!("{set}:\n{}", shown(&found)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let o = gudgeon(&folder, &["check", "case.toml", "--set", "engine.bore=5 bar"]);
    assert!(stderr(&o).contains("[--set:1:13]"), "{}", stderr(&o));
}

#[test]
fn all_mistakes_of_a_file_come_together_in_its_order() {
    let folder = Folder::new("all");
    let text = base()
        .replace("bore = \"100 mm\"", "bore = \"100 bar\"")
        .replace("gamma = 1.4", "gama = 1.4")
        .replace("model = \"vogel_grade\"", "model = \"vogel\"\ngrad = 1")
        .replace("tolerance = 1e-4", "tolerance = nan");
    fs::write(folder.0.join("case.toml"), &text).expect("written");
    let found = mistakes(&folder, &["--set", "rings.0.mass=20 mm"]);
    let lines: Vec<_> = found.iter().map(|m| m["line"].as_u64()).collect();
    assert!(found.len() >= 5, "{found:#?}");
    assert_eq!(found[found.len() - 1]["in"], "--set");
    assert!(lines[..lines.len() - 1].is_sorted(), "{lines:?}");
    let o = gudgeon(&folder, &["check", "case.toml"]);
    assert!(stderr(&o).contains(&format!("{} mistakes in case.toml", found.len() - 1)), "{}", stderr(&o));
}

/// What is no TOML text, or reads it badly. Real files, so that their bytes survive.
const FILES: &[(&str, &str)] = &[
    ("01_empty.toml", "the file says nothing"),
    ("02_only_a_comment.toml", "the file says nothing"),
    ("03_binary.toml", "is not UTF-8 text"),
    ("04_latin1.toml", "is not UTF-8 text: line 3"),
    ("05_nul.toml", ""),
    ("06_crlf.toml", "engine.bore: `bar` is not a unit"),
    ("07_byte_order_mark.toml", "engine.bore: `bar` is not a unit"),
    ("08_json.toml", ""),
    ("09_yaml.toml", ""),
    ("10_deep.toml", ""),
    ("11_no_newline.toml", "outputs.series_step"),
    ("12_utf16.toml", "is not UTF-8 text"),
];

#[test]
fn odd_files_are_refused() {
    for (file, says) in FILES {
        let folder = Folder::new(file);
        fs::copy(corpus().join(file), folder.0.join("case.toml")).expect("the file is in the repository");
        let found = mistakes(&folder, &[]);
        assert!(!found.is_empty() && headline(&found[0]).contains(says), "{file}: {found:#?}");
        let o = gudgeon(&folder, &["run", "case.toml"]);
        assert_eq!(o.status.code(), Some(2), "{file}");
        assert_eq!(folder.entries(), ["case.toml"], "{file}");
    }
}

#[test]
fn a_file_that_is_not_there() {
    let folder = Folder::new("absent");
    fs::write(folder.0.join("case.toml"), base()).expect("written");
    let o = gudgeon(&folder, &["run", "cas.toml"]);
    assert_eq!(o.status.code(), Some(2));
    assert!(
        stderr(&o).contains("cannot read `cas.toml`") && stderr(&o).contains("did you mean `case.toml`?"),
        "{}",
        stderr(&o)
    );
    let o = gudgeon(&folder, &["run", "."]);
    assert_eq!(o.status.code(), Some(2));
    assert!(stderr(&o).contains("is a folder"), "{}", stderr(&o));
    // Results that cannot be written are refused before the run, not after it.
    let o = gudgeon(&folder, &["run", "case.toml", "--out", "case.toml/results"]);
    assert_eq!(o.status.code(), Some(2));
    assert!(stderr(&o).contains("`case.toml` is a file"), "{}", stderr(&o));
    assert_eq!(folder.entries(), ["case.toml"]);
}
