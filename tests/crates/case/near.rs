//! Names that are meant.

use gudgeon_case::nearest;

#[test]
fn finds_typos_and_nothing_far_off() {
    let names = ["bore", "stroke", "rod_length", "clearance"];
    let near = |w| nearest(w, names);
    assert_eq!(near("bor"), Some("bore"));
    assert_eq!(near("Stroke"), Some("stroke"));
    assert_eq!(near("rod-length"), Some("rod_length"));
    assert_eq!(near("rodlength"), Some("rod_length"));
    assert_eq!(near("clear"), Some("clearance"));
    assert_eq!(near("claer"), Some("clearance"));
    assert_eq!(nearest("narow", ["narrow_channel", "orifice_network"]), Some("narrow_channel"));
    assert_eq!(near("temperature"), None);
    assert_eq!(near(""), None);
    assert_eq!(near("x"), None);
}
