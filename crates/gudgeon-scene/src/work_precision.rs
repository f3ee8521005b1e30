//! What a scene says of its solvers and of other methods for its equations, for diagrams of run time against error.

/// One method at one setting.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MethodSetting {
    /// Method: settings of one method form one curve.
    pub method: String,
    /// The setting: `tolerance 1e-4`, `16 sub-steps`.
    pub setting: String,
    /// Whether a case that says nothing has it.
    pub is_default: bool,
    /// The setting as `--set` takes it.
    pub set: Vec<String>,
    /// The error that it asks for, where it is a tolerance.
    pub asked: Option<Asked>,
}

/// An error that a setting asks for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Asked {
    /// Relative error.
    pub tolerance: f64,
    /// The settings by which that error is judged: all else equal, the tolerance far tighter. Empty where the reference itself is that, because
    /// nothing but the tolerance separates the two.
    pub against: Vec<String>,
    /// A result that tells the error itself, as the gap of a proof does.
    pub told_by: Option<&'static str>,
}

/// What errors are counted from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reference {
    /// Settings that give it.
    pub set: Vec<String>,
    /// Settings that tell how far it can be trusted.
    pub check: Vec<String>,
    /// Both in words, up to "by at most".
    pub is: String,
    /// Whether it is another method than those that are raced, and not one of them refined.
    pub independent: bool,
    /// Results that the reference tells by another name: `(of the methods, of the reference)`.
    pub told_as: Vec<(&'static str, &'static str)>,
}

/// Another method for the equations of a case.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OtherMethod {
    /// Its name.
    pub label: String,
    /// The changes that put it in place, as `--set` takes them.
    pub set: Vec<String>,
}

/// What `bench` runs for a case. All of it may be empty: the numerical settings that the case declares are then coarsened and refined.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct WorkPrecision {
    /// Every solver at every setting; none where the declared numerical settings are the sweep.
    pub settings: Vec<MethodSetting>,
    /// The reference, where the scene knows one.
    pub reference: Option<Reference>,
    /// What the case has now, where there are other methods: the label of its curve.
    pub own: String,
    /// Other methods for the same equations: they are raced, and the first one, refined, is the reference where none is named.
    pub others: Vec<OtherMethod>,
    /// Changes that all runs share: what no method needs for the results is left out.
    pub all: Vec<String>,
    /// Names of groups of declared numerical settings that change nothing here, and are no sweep.
    pub idle: Vec<&'static str>,
    /// Results that are looked at unless told otherwise; those that the case has.
    pub results: Vec<String>,
}
