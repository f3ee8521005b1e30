//! Changes written into a text, the inputs of a case, and help on a place.

use std::path::Path;

use gudgeon_case::{InputValue, help_at, load_str};

use crate::{Bench, GOOD, good};

fn rewritten(text: &str, set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    let c = load_str::<Bench>("bench.toml", text, Path::new("."), &[]).unwrap_or_else(|r| panic!("{r}"));
    c.rewritten(&set).unwrap_or_else(|r| panic!("{r}"))
}

/// What is written gives the case that the overrides give: `rewritten` itself refuses anything else.
#[test]
fn a_value_changes_where_it_stands_and_nothing_else_does() {
    let new = rewritten(GOOD, &["rings.1.gap=\"0.8 mm\""]);
    let changed: Vec<(&str, &str)> = GOOD.lines().zip(new.lines()).filter(|(a, b)| a != b).collect();
    assert_eq!(changed.len(), 1, "{new}");
    assert!(changed[0].1.contains("\"0.8 mm\""), "{new}");
}

#[test]
fn a_new_key_goes_into_its_table_and_a_new_table_to_the_end() {
    let new = rewritten(GOOD, &["machine.offset=\"1 mm\""]);
    assert!(new.contains("[machine]\noffset = \"1 mm\"\n"), "{new}");
    let new = rewritten(GOOD, &["solver.rtol=1e-3"]);
    assert!(new.ends_with("\n[solver]\nrtol = 1e-3\n"), "{new}");
    let new = rewritten(GOOD, &["title=A bench"]);
    assert!(new.contains("title = \"A bench\"\n"), "{new}");
    let new = rewritten(GOOD, &["models.oil.cd=0.9"]);
    assert!(new.contains("[models.oil]\nmodel = \"orifice\"\ncd = 0.9\n"), "{new}");
}

#[test]
fn another_model_loses_the_lines_that_it_does_not_know() {
    let new = rewritten(GOOD, &["models.gas.model=channel"]);
    assert!(new.contains("model = \"channel\"") && !new.contains("cd"), "{new}");
    let inline = format!("{GOOD}wall = {{ model = \"channel\" }}\n");
    let new = rewritten(&inline, &["models.wall.area=2.0"]);
    assert!(new.contains("wall = { model = \"channel\", area = 2.0 }"), "{new}");
}

#[test]
fn inputs_have_the_unit_of_the_text_and_its_line() {
    let all = good(&[]).inputs();
    let find = |path: &str| all.iter().find(|i| i.path == path).unwrap_or_else(|| panic!("{path}: {all:#?}"));
    let InputValue::Number(gap) = &find("rings.0.gap").value else { panic!("a number") };
    assert_eq!((gap.dimension.as_str(), gap.unit.as_str()), ("a length", "mm"));
    assert!(find("rings.0.gap").line.is_some() && find("machine.cylinders").line.is_none());
    let InputValue::Choice(gas) = &find("models.gas.model").value else { panic!("a choice") };
    assert!(gas.words.told().any(|(w, _)| w == "channel"), "{gas:?}");
    let about = find("machine.speed").about;
    assert_eq!(
        (about.told().as_str(), about.brief().as_str()),
        ("Crankshaft speed. More text.", "Crankshaft speed")
    );
}

#[test]
fn help_knows_the_key_under_the_cursor_and_the_keys_of_its_table() {
    let at = |text: &str, what: &str| help_at::<Bench>(text, text.find(what).expect("stands in the text"));
    let speed = at(GOOD, "speed");
    assert_eq!(
        (speed.path.as_str(), speed.wants.as_str()),
        ("machine.speed", "a rotational speed, greater than zero")
    );
    assert!(speed.units.contains(&"rpm".to_owned()));
    assert!(speed.keys.iter().any(|k| k.key == "bore" && k.required && k.present));
    assert!(speed.keys.iter().any(|k| k.key == "offset" && !k.required && !k.present));
    let model = at(GOOD, "model =");
    assert!(model.words.iter().any(|(w, _)| w == "channel"), "{model:?}");
    let second = GOOD.rfind("gap").expect("stands in the text");
    assert_eq!(help_at::<Bench>(GOOD, second).path, "rings.1.gap");
    // A text with mistakes, and places that are none.
    let broken = GOOD.replace("bore =", "bore = = ");
    assert_eq!(help_at::<Bench>(&broken, broken.find("speed").expect("stands")).path, "machine.speed");
    assert_eq!(help_at::<Bench>("é[[x", 99), help_at::<Bench>("é[[x", 1));
}
