//! A table of columns, with holes where a row has no value.

use indexmap::IndexMap;

/// The values of a column, by row.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers.
    Numbers(Vec<Option<f64>>),
    /// Whole numbers.
    Integers(Vec<Option<i64>>),
    /// Text.
    Texts(Vec<Option<String>>),
}

/// A column.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Column {
    /// Unit of its numbers, as a person writes it; empty where there is none.
    pub unit: String,
    /// One line saying what it is; empty where its name does.
    pub what: String,
    /// Its values.
    pub values: Values,
}

/// A table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Table {
    /// Columns of equal length, by name.
    pub columns: IndexMap<String, Column>,
    /// What is known of all of it, by name.
    pub about: IndexMap<String, String>,
}

impl Default for Values {
    fn default() -> Self {
        Self::Numbers(Vec::new())
    }
}

impl Values {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(v) => v.len(),
            Self::Integers(v) => v.len(),
            Self::Texts(v) => v.len(),
        }
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Nothing, `n` times.
    fn nothing(like: &Self, n: usize) -> Self {
        match like {
            Self::Numbers(_) => Self::Numbers(vec![None; n]),
            Self::Integers(_) => Self::Integers(vec![None; n]),
            Self::Texts(_) => Self::Texts(vec![None; n]),
        }
    }

    /// Appends rows; whether they are of the same type.
    fn extend(&mut self, more: Self) -> bool {
        match (self, more) {
            (Self::Numbers(a), Self::Numbers(b)) => a.extend(b),
            (Self::Integers(a), Self::Integers(b)) => a.extend(b),
            (Self::Texts(a), Self::Texts(b)) => a.extend(b),
            _ => return false,
        }
        true
    }

    /// A row as text; empty where it has no value.
    #[must_use]
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Numbers(v) => v[row].map_or_else(String::new, |v| format!("{v}")),
            Self::Integers(v) => v[row].map_or_else(String::new, |v| format!("{v}")),
            Self::Texts(v) => v[row].clone().unwrap_or_default(),
        }
    }
}

impl Table {
    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, c)| c.values.len())
    }

    /// Adds a column.
    pub fn push(&mut self, name: impl Into<String>, unit: impl Into<String>, values: Values) {
        self.columns.insert(name.into(), Column { unit: unit.into(), values, ..Column::default() });
    }

    /// The numbers of a column, not a number where there is none; none where the column has no numbers.
    #[must_use]
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        match &self.columns.get(name)?.values {
            Values::Numbers(v) => Some(v.iter().map(|v| v.unwrap_or(f64::NAN)).collect()),
            _ => None,
        }
    }

    /// Appends the rows of another table; columns that only one of them has have no value in the rows of the other.
    ///
    /// # Errors
    /// The name of a column that has numbers in one and text in the other.
    pub fn append(&mut self, more: Self) -> Result<(), String> {
        let (before, added) = (self.rows(), more.rows());
        for (name, column) in more.columns {
            let Column { unit, what, values } = column;
            let nothing = Values::nothing(&values, before);
            let own = self.columns.entry(name.clone()).or_insert(Column { unit, what, values: nothing });
            if !own.values.extend(values) {
                return Err(name);
            }
        }
        for column in self.columns.values_mut() {
            let missing = before + added - column.values.len();
            let nothing = Values::nothing(&column.values, missing);
            column.values.extend(nothing);
        }
        Ok(())
    }
}
