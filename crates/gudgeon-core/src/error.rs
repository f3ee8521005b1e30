//! Errors that cross the border between a sub-model and what drives it.

pub use gudgeon_numerics::EvalError;

/// A well-formed specification that cannot be built: values that contradict each other or a combination with no meaning.
///
/// `field` is a dotted path inside the specification (`""` for the whole); the loader turns it into a place in the file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct BuildError {
    /// Dotted path of the offending value, relative to the specification that was being built.
    pub field: String,
    /// What is wrong, with the values.
    pub message: String,
    /// What would be right, when that is known.
    pub help: Option<String>,
}

impl BuildError {
    /// An error about one value of the specification.
    pub fn at(field: impl Into<String>, message: impl Into<String>) -> Self {
        Self { field: field.into(), message: message.into(), help: None }
    }

    /// An error about the specification as a whole.
    pub fn new(message: impl Into<String>) -> Self {
        Self::at("", message)
    }

    /// Adds the advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Prepends `prefix` to the path: what a container does with an error of one of its parts.
    #[must_use]
    pub fn within(mut self, prefix: &str) -> Self {
        self.field = match (prefix.is_empty(), self.field.is_empty()) {
            (true, _) => self.field,
            (false, true) => prefix.to_owned(),
            (false, false) => format!("{prefix}.{}", self.field),
        };
        self
    }
}
