//! Paths of keys.

use gudgeon_case::for_tests::{Step, steps};

#[test]
fn paths_in_both_styles() {
    let texts = |p: &str| steps(p, 0).into_iter().map(|s| s.text).collect::<Vec<_>>();
    assert_eq!(texts("rings.0.gap"), ["rings", "0", "gap"]);
    assert_eq!(texts("rings[0].gap"), ["rings", "0", "gap"]);
    assert_eq!(texts("a[1][2]"), ["a", "1", "2"]);
    assert_eq!(texts("a..b"), ["a", "", "b"]);
    assert_eq!(texts("a."), ["a", ""]);
    assert_eq!(texts(""), [""]);
    assert_eq!(steps(" a . bc", 10)[1], Step { text: "bc".into(), span: 15..17 });
}
