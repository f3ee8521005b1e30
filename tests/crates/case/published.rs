//! Schemas as editors read them.

use gudgeon_case::published;
use serde_json::json;

#[test]
fn choices_become_words_and_rules() {
    let a = json!({ "type": "object", "properties": { "model": { "const": "a" }, "x": { "type": ["number", "null"], "default": null } },
        "required": ["model"], "additionalProperties": false, "description": "the first" });
    let b = json!({ "type": "object", "properties": { "model": { "const": "b" } }, "required": ["model"] });
    let p = published(
        &json!({ "anyOf": [{ "oneOf": [a, b] }, { "type": "null" }], "description": "one of two" }),
    );
    assert_eq!(p["properties"]["model"]["enum"], json!(["a", "b"]));
    assert_eq!(p["description"], "one of two");
    assert_eq!(p["allOf"][0]["then"]["properties"]["x"], json!({ "type": "number" }));
    assert_eq!(p["allOf"][1]["if"]["properties"]["model"]["const"], "b");
    assert!(p.get("anyOf").is_none() && p.get("oneOf").is_none());
    let p = published(&json!({ "oneOf": [{ "const": "x", "description": "an x" }, { "enum": ["y", "z"] }] }));
    assert_eq!(p["enum"], json!(["x", "y", "z"]));
    assert_eq!(p["markdownEnumDescriptions"], json!(["an x", "", ""]));
    // A default that looks like a schema stays what it is; a property may be called like a keyword.
    let default = json!({ "default": { "oneOf": [1] }, "properties": { "oneOf": { "type": "array" } } });
    let p = published(&default);
    assert_eq!(p["default"], default["default"]);
    assert_eq!(p["properties"]["oneOf"]["maxItems"], 100_000);
}
