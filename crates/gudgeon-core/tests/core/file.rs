//! Files that a user names.

#[cfg(unix)]
use std::path::Path;

#[cfg(unix)]
use gudgeon_core::file::read_bytes;
use gudgeon_core::file::{Files, ReadError, read_text};

#[test]
fn files_are_read_once_and_repeated_from_their_record() {
    let folder = std::env::temp_dir().join(format!("gudgeon-files-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("part")).expect("the temporary folder can be written");
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("written");
    write("a.csv", "1");
    write("part/b.csv", "2");
    let files = Files::of(&folder);
    assert_eq!(&*files.text("a.csv").expect("there"), "1");
    write("a.csv", "changed");
    assert_eq!(&*files.text("a.csv").expect("kept"), "1");
    assert_eq!(&*files.beside("part/case.toml").text("b.csv").expect("there"), "2");
    let record = files.read_so_far();
    assert_eq!(record.keys().collect::<Vec<_>>(), ["a.csv", "part/b.csv"]);
    let _ = std::fs::remove_dir_all(&folder);
    let again = Files::recorded(record.into_iter().map(|(k, v)| (k, v.to_string())));
    assert_eq!(&*again.beside("part/case.toml").text("b.csv").expect("recorded"), "2");
    assert!(again.text("c.csv").is_err_and(|e| e.to_string().contains("does not hold `c.csv`")));
}

#[test]
fn only_regular_files_of_a_bounded_size() {
    let folder = std::env::temp_dir().join(format!("gudgeon-read-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("the temporary folder can be written");
    let file = folder.join("x");
    let said = |most| read_text(&file, most).map_err(|e| e.to_string());
    assert!(said(9).is_err());
    std::fs::write(&file, "0123\n56789").expect("written");
    assert_eq!(said(10).as_deref(), Ok("0123\n56789"));
    assert!(said(9).is_err_and(|e| e.contains("too large")));
    std::fs::write(&file, b"ab\nc\xff").expect("written");
    assert_eq!(said(9), Err("it is not UTF-8 text (line 2, column 2)".into()));
    assert!(matches!(read_text(&folder, 9), Err(ReadError::Folder)));
    let _ = std::fs::remove_dir_all(&folder);
    #[cfg(unix)]
    assert!(matches!(read_bytes(Path::new("/dev/zero"), 9), Err(ReadError::Special)));
}
