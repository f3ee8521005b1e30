//! Reduces a bad case to the changes that make it bad.

use crate::case::Case;

/// Drops one change after the other as long as `same` says that the case is still bad in the same way. At most one pass: what a change
/// alone does not do is kept.
pub fn shrink<E>(case: &Case, mut same: impl FnMut(&Case) -> Result<bool, E>) -> Result<Case, E> {
    let mut least = case.clone();
    let mut k = least.changes.len();
    while k > 0 {
        k -= 1;
        let mut fewer = least.clone();
        fewer.changes.remove(k);
        if same(&fewer)? {
            least = fewer;
        }
    }
    Ok(least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Change;

    #[test]
    fn only_the_changes_that_matter_are_left() {
        let change = |path: &str| Change { path: path.into(), ..Change::default() };
        let case = Case { changes: ["a", "b", "c", "d", "e"].map(change).to_vec(), ..Case::default() };
        let needs = |c: &Case, p: &str| c.changes.iter().any(|x| x.path == p);
        let least = shrink(&case, |c| Ok::<_, ()>(needs(c, "b") && needs(c, "d")));
        let left: Vec<String> = least.expect("no errors").changes.into_iter().map(|c| c.path).collect();
        assert_eq!(left, ["b", "d"]);
    }
}
